// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "input.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "console.hpp"
#include "pgdr/error.hpp"
#include "pgdr/joined_plc.hpp"

namespace pgdr::tool {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw UsageError({.code = Errc::bad_option, .message = what}); }

template <int D>
Point<D> point_of_seed(const SeedText& seed, const char* flag) {
  if (seed.point.size() != D)
    refuse(std::string(flag) + " takes " + std::to_string(D) + " coordinates in " + std::to_string(D) + "D, not " +
           std::to_string(seed.point.size()));
  Point<D> p;
  std::copy_n(seed.point.begin(), D, p.x.begin());
  return p;
}

/// The number that a label is, or the label of that name; a new one gets the least positive number that no seed has.
template <int D>
double label_of(const std::string& text, Plc<D>& plc) {
  if (text.empty()) return 0;
  if (const std::optional<double> number = label_number(text)) return *number;
  for (const auto& [label, name] : plc.names.regions)
    if (name == text) return label;
  double label = 1;
  const auto is_taken = [&plc, &label] {
    return plc.names.regions.contains(label) ||
           std::any_of(plc.regions.begin(), plc.regions.end(), [&label](const auto& r) { return r.attribute == label; });
  };
  while (is_taken()) ++label;
  plc.names.regions[label] = text;
  return label;
}

template <int D>
void add_seeds(const InputArguments& reading, Plc<D>& plc) {
  std::vector<SeedText> seeds;
  for (const std::string& text : reading.seeds) seeds.push_back(split_seed(text).value());
  // Numbers first, so that no name takes one.
  std::vector<double> labels(seeds.size());
  const std::size_t own = plc.regions.size();
  for (const SeedText& seed : seeds)
    plc.regions.push_back({point_of_seed<D>(seed, "--seed"), label_number(seed.label).value_or(0)});
  for (std::size_t i = 0; i < seeds.size(); ++i) plc.regions[own + i].attribute = label_of<D>(seeds[i].label, plc);
  for (const std::string& text : reading.holes) plc.holes.push_back(point_of_seed<D>(split_seed(text).value(), "--hole"));
}

/// The labels or markers that have a name.
template <class Label>
JsonObject json_of_names(const std::map<Label, std::string>& names) {
  JsonObject object;
  for (const auto& [label, name] : names) object.set(digits(static_cast<double>(label)), name);
  return object;
}

}  // namespace

Inputs::Inputs(const std::vector<std::string>& names) {
  for (const std::string& name : names) files_.emplace_back(name);
}

int Inputs::dimension() {
  const int dimension = files_.front().dimension();
  for (InputFile& file : files_)
    if (file.dimension() != dimension)
      throw UsageError({.code = Errc::bad_option,
                        .message = "this input is " + std::to_string(file.dimension()) + "D, " + files_.front().name().string() +
                                   " is " + std::to_string(dimension) + "D",
                        .file = file.name().string()});
  return dimension;
}

template <int D>
Plc<D> Inputs::as_asked(Plc<D> plc, const InputArguments& reading) {
  if (D == 3 && reading.region_areas) refuse("--region-areas is for 2D");
  if (D == 2 && (reading.markers || reading.close_openings)) refuse("--markers and --close-planar-openings are for 3D");
  plc.tolerance = reading.tolerance;
  plc.is_coarse = reading.yes_coarse;
  add_seeds<D>(reading, plc);
  return plc;
}

template <int D>
Plc<D> Inputs::read_given(const InputArguments& reading) {
  std::vector<Plc<D>> all;
  for (InputFile& file : files_) all.push_back(file.read_plc<D>({.region_areas = reading.region_areas}));
  return as_asked<D>(all.size() == 1 ? std::move(all.front()) : joined<D>(all), reading);
}

std::string Inputs::words() const {
  std::string words;
  for (const InputFile& file : files_) words += (words.empty() ? "" : ", ") + file.name().string();
  return words;
}

std::vector<Diagnostic> Inputs::warnings() const {
  std::vector<Diagnostic> all;
  for (const InputFile& file : files_) all.insert(all.end(), file.warnings().begin(), file.warnings().end());
  return all;
}

Json Inputs::json() const {
  if (files_.size() == 1) return files_.front().name().string();
  std::vector<Json> names;
  for (const InputFile& file : files_) names.push_back(file.name().string());
  return names;
}

void set_names(Report& report, const Names& names) {
  report.set("region_names", json_of_names(names.regions));
  report.set("marker_names", json_of_names(names.markers));
}

template Plc<2> Inputs::as_asked<2>(Plc<2>, const InputArguments&);
template Plc<3> Inputs::as_asked<3>(Plc<3>, const InputArguments&);
template Plc<2> Inputs::read_given<2>(const InputArguments&);
template Plc<3> Inputs::read_given<3>(const InputArguments&);

}  // namespace pgdr::tool

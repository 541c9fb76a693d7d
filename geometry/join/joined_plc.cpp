// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/joined_plc.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "input/words.hpp"
#include "pgdr/error.hpp"

namespace pgdr {
namespace {

/// Of each input: what each of its numbers is in the joined one.
template <class Number>
using Renumbering = std::vector<std::map<Number, Number>>;

/// @param used  the numbers of each input
template <class Number>
Renumbering<Number> renumbered(const std::vector<std::set<Number>>& used) {
  Renumbering<Number> now(used.size());
  std::set<Number> taken;
  for (std::size_t i = 0; i < used.size(); ++i)
    for (const Number n : used[i])
      if (n != 0 && taken.insert(n).second) now[i].emplace(n, n);
  Number next = 1;
  for (std::size_t i = 0; i < used.size(); ++i)
    for (const Number n : used[i]) {
      if (now[i].contains(n)) continue;
      while (taken.contains(next)) ++next;
      now[i].emplace(n, next);
      taken.insert(next);
    }
  return now;
}

/// Names of things of several inputs, by input and number there.
template <class Number>
using NamesOfInputs = std::vector<std::map<Number, std::string>>;

/// Tells inputs apart that have the same name.
template <class Number>
void make_distinct(NamesOfInputs<Number>& names, std::span<const std::string> inputs) {
  std::map<std::string, std::set<std::size_t>> users;
  for (std::size_t i = 0; i < names.size(); ++i)
    for (const auto& [number, name] : names[i]) users[name].insert(i);
  std::map<std::string, std::size_t> owner;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::map<std::string, std::string> now;  // of this input
    for (auto& [number, name] : names[i]) {
      auto& given = now[name];
      if (given.empty()) {
        const std::string base = users[name].size() > 1 && name != inputs[i] ? inputs[i] + ":" + name : name;
        given = base;
        for (int k = 2; !owner.emplace(given, i).second; ++k) given = base + ":" + std::to_string(k);
      }
      name = given;
    }
  }
}

/// The markers of what bounds volumes (areas).
template <int D>
std::set<int> wall_markers(const Plc<D>& plc) {
  std::set<int> markers;
  if constexpr (D == 3)
    for (const auto& f : plc.facets) markers.insert(f.marker);
  else
    for (const auto& s : plc.segments) markers.insert(s.marker);
  return markers;
}

template <int D>
class Joiner {
 public:
  Joiner(std::span<const Plc<D>> inputs, std::span<const std::string> names) : inputs_(inputs) {
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const std::filesystem::path file(inputs[i].source.file);
      input_names_.push_back(i < names.size() && !names[i].empty() ? names[i] : file.stem().string());
      if (input_names_.back().empty()) input_names_.back() = "input" + std::to_string(i + 1);
      wall_markers_.push_back(wall_markers<D>(inputs[i]));
    }
  }

  Plc<D> join() {
    number_markers();
    number_labels();
    name_bodies();
    for (const Plc<D>& plc : inputs_) attributes_ = std::max(attributes_, attributes_of(plc));
    for (std::size_t i = 0; i < inputs_.size(); ++i) append(i);
    out_.source.file = inputs_.front().source.file + " and " + std::to_string(inputs_.size() - 1) + " more";
    const auto begins_alike = [this](const Plc<D>& plc) { return plc.first_index == inputs_.front().first_index; };
    if (std::all_of(inputs_.begin(), inputs_.end(), begins_alike)) out_.first_index = inputs_.front().first_index;
    return std::move(out_);
  }

 private:
  static std::size_t attributes_of(const Plc<D>& plc) {
    return plc.points.empty() ? 0 : plc.point_attributes.size() / plc.points.size();
  }
  const std::string* own_name(std::size_t i, int marker) const {
    const auto it = inputs_[i].names.markers.find(marker);
    return it == inputs_[i].names.markers.end() ? nullptr : &it->second;
  }

  void number_markers() {
    std::vector<std::set<int>> used = wall_markers_;
    NamesOfInputs<int> names(inputs_.size());
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      const auto add = [&](int marker) {
        if (marker != 0) used[i].insert(marker);
      };
      for (const auto& s : inputs_[i].segments) add(s.marker);
      for (const int marker : inputs_[i].point_markers) add(marker);
      for (const int marker : used[i]) {
        const bool alone = marker == 0 || wall_markers_[i].size() == 1;
        if (const std::string* own = own_name(i, marker))
          names[i][marker] = *own;
        else if (wall_markers_[i].contains(marker))
          names[i][marker] = alone ? input_names_[i] : input_names_[i] + ":" + std::to_string(marker);
      }
    }
    markers_ = renumbered(used);
    make_distinct(names, input_names_);
    for (std::size_t i = 0; i < inputs_.size(); ++i)
      for (const auto& [marker, name] : names[i]) out_.names.markers[markers_[i].at(marker)] = name;
  }

  void number_labels() {
    std::vector<std::set<double>> used(inputs_.size());
    NamesOfInputs<double> names(inputs_.size());
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      for (const auto& r : inputs_[i].regions)
        if (!std::isnan(r.attribute)) used[i].insert(r.attribute);  // else the Domain refuses it
      for (const double label : used[i]) {
        const auto own = inputs_[i].names.regions.find(label);
        if (own != inputs_[i].names.regions.end())
          names[i][label] = own->second;
        else if (label == 0)
          names[i][label] = input_names_[i];
      }
    }
    labels_ = renumbered(used);
    make_distinct(names, input_names_);
    for (std::size_t i = 0; i < inputs_.size(); ++i)
      for (const auto& [label, name] : names[i]) out_.names.regions[labels_[i].at(label)] = name;
  }

  void name_bodies() {
    if (D == 2) return;
    NamesOfInputs<std::uint32_t> names(inputs_.size());
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      const Plc<D>& plc = inputs_[i];
      for (std::uint32_t b = 0; !plc.facet_bodies.empty() && b < plc.body_names.size(); ++b) names[i][b] = plc.body_names[b];
      if (!names[i].empty()) continue;
      const std::string* only = wall_markers_[i].size() == 1 ? own_name(i, *wall_markers_[i].begin()) : nullptr;
      names[i][0] = only ? *only : input_names_[i];
    }
    make_distinct(names, input_names_);
    for (const auto& of_input : names) {
      first_body_.push_back(static_cast<std::uint32_t>(out_.body_names.size()));
      for (const auto& [body, name] : of_input) out_.body_names.push_back(name);
    }
  }

  int marker_of(std::size_t i, int marker, bool of_wall) const { return marker == 0 && !of_wall ? 0 : markers_[i].at(marker); }

  void append(std::size_t i) {
    const Plc<D>& plc = inputs_[i];
    note_source(plc);
    append_points(i);
    const auto first = static_cast<std::uint32_t>(out_.points.size() - plc.points.size());
    for (auto s : plc.segments) {
      for (auto& v : s.points) v += first;
      s.marker = marker_of(i, s.marker, D == 2);
      out_.segments.push_back(s);
    }
    for (auto f : plc.facets) {
      for (auto& polygon : f.polygons)
        for (auto& v : polygon) v += first;
      f.marker = D == 3 ? markers_[i].at(f.marker) : f.marker;
      out_.facets.push_back(std::move(f));
    }
    for (std::size_t f = 0; D == 3 && f < plc.facets.size(); ++f)
      out_.facet_bodies.push_back(first_body_[i] + (f < plc.facet_bodies.size() ? plc.facet_bodies[f] : 0));
    out_.holes.insert(out_.holes.end(), plc.holes.begin(), plc.holes.end());
    for (auto r : plc.regions) {
      if (!std::isnan(r.attribute)) r.attribute = labels_[i].at(r.attribute);
      out_.regions.push_back(r);
    }
    if (plc.tolerance) out_.tolerance = std::max(out_.tolerance.value_or(0), *plc.tolerance);
    out_.is_coarse = out_.is_coarse || plc.is_coarse;
    out_.are_floats = out_.are_floats || plc.are_floats;
  }

  void append_points(std::size_t i) {
    const Plc<D>& plc = inputs_[i];
    const std::size_t before = out_.points.size(), own = attributes_of(plc);
    constexpr std::uint32_t most_points = 0xfffffffd;
    if (plc.points.size() > most_points - before)
      throw ResourceError(Diagnostic{Errc::ids_exhausted, "more than 2^32 - 3 points", plc.source.file, 0, {}, {}});
    out_.points.insert(out_.points.end(), plc.points.begin(), plc.points.end());
    if (!plc.point_markers.empty()) {
      out_.point_markers.resize(before);
      for (const int marker : plc.point_markers) out_.point_markers.push_back(marker_of(i, marker, false));
    }
    const auto is_marked = [](const Plc<D>& other) { return !other.point_markers.empty(); };
    if (std::any_of(inputs_.begin(), inputs_.end(), is_marked)) out_.point_markers.resize(out_.points.size());
    out_.point_attributes.resize(attributes_ * out_.points.size());
    for (std::size_t p = 0; p < plc.points.size(); ++p)
      std::copy_n(plc.point_attributes.begin() + static_cast<std::ptrdiff_t>(p * own), own,
                  out_.point_attributes.begin() + static_cast<std::ptrdiff_t>((before + p) * attributes_));
  }

  /// To be called before the input's things are appended.
  void note_source(const Plc<D>& plc) {
    PlcSource& to = out_.source;
    const PlcSource& from = plc.source;
    const std::array<std::size_t, 5> added{plc.points.size(), plc.segments.size(), plc.facets.size(), plc.holes.size(),
                                           plc.regions.size()};
    const std::array lines{&PlcSource::point_lines, &PlcSource::segment_lines, &PlcSource::facet_lines, &PlcSource::hole_lines,
                           &PlcSource::region_lines};
    std::uint32_t last = 0;
    for (std::size_t k = 0; k < lines.size(); ++k)
      for (std::size_t i = 0; i < added[k]; ++i) {
        const std::uint32_t line = i < (from.*lines[k]).size() ? (from.*lines[k])[i] : 0;
        last = std::max(last, line);
        (to.*lines[k]).push_back(next_line_ + line);
      }
    to.parts.push_back({from.file, next_line_});
    for (const PlcSource::Part& own : from.parts) to.parts.push_back({own.file, next_line_ + own.first_line});
    next_line_ += last + 1;
    if (!from.void_widths.empty()) {
      to.void_widths.resize(out_.holes.size(), std::numeric_limits<double>::infinity());
      to.void_widths.insert(to.void_widths.end(), from.void_widths.begin(), from.void_widths.end());
    }
    if (to.cell_regions == out_.regions.size()) to.cell_regions += from.cell_regions;
  }

  std::span<const Plc<D>> inputs_;
  std::vector<std::string> input_names_;
  std::vector<std::set<int>> wall_markers_;
  Renumbering<int> markers_;
  Renumbering<double> labels_;
  std::vector<std::uint32_t> first_body_;
  std::size_t attributes_ = 0;   // of each point
  std::uint32_t next_line_ = 1;  // 0 is what was not given
  Plc<D> out_;
};

}  // namespace

template <int D>
Plc<D> joined(std::span<const Plc<D>> inputs, std::span<const std::string> names) {
  const auto refuse = [](const char* what) { throw UsageError(Diagnostic{Errc::bad_option, what, {}, 0, {}, {}}); };
  if (inputs.empty()) refuse("no input is given to be joined");
  if (!names.empty() && names.size() != inputs.size()) refuse("there must be one name an input");
  return inputs.size() == 1 ? inputs.front() : Joiner<D>(inputs, names).join();
}

template PGDR_API Plc<2> joined<2>(std::span<const Plc<2>>, std::span<const std::string>);
template PGDR_API Plc<3> joined<3>(std::span<const Plc<3>>, std::span<const std::string>);

}  // namespace pgdr

// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "bodies.hpp"

#include <algorithm>
#include <utility>

#include "console.hpp"

namespace pgdr::tool {
namespace {

JsonObject to_json_with_bodies(const RegionVolume& volume, const BodyTable& bodies) {
  JsonObject region = to_json(volume);
  const auto at = std::ranges::find(bodies.regions, volume.label, &BodyRegion::label);
  std::vector<Json> list;
  if (at != bodies.regions.end())
    for (const std::uint32_t b : at->bodies) list.emplace_back(b);
  region.set("bodies", list);
  return region;
}

std::string words(const BodyRegion& region, const BodyTable& bodies) {
  std::string text;
  for (const std::uint32_t b : region.bodies) {
    text += text.empty() ? "" : ", ";
    text += bodies.names[b].empty() ? std::to_string(b) : bodies.names[b];
  }
  return (region.bodies.size() == 1 ? "body "
          : region.bodies.empty()   ? "no body"
                                    : "bodies ") +
         text + ", volume " + digits(region.volume);
}

}  // namespace

template <int D>
std::optional<BodyTable> label_bodies(Plc<D>& plc, const InputArguments& reading) {
  if (!reading.bodies) return std::nullopt;
  if constexpr (D == 2) {
    throw UsageError({.code = Errc::bad_option,
                      .message = std::string("--regions ") + name(*reading.bodies) +
                                 " is for bodies in 3D; in 2D there are seeds, auto and all"});
  } else {
    BodyOptions options;
    options.resolve_crossings = reading.resolve_crossings;
    options.markers = reading.markers.value_or(SharedMarker::smallest);
    WithBodies made = with_bodies(plc, *reading.bodies, options);
    plc = std::move(made.plc);
    return BodyTable{std::move(made.regions), std::move(made.body_names), std::move(made.repairs), std::move(made.warnings)};
  }
}

template std::optional<BodyTable> label_bodies<2>(Plc<2>&, const InputArguments&);
template std::optional<BodyTable> label_bodies<3>(Plc<3>&, const InputArguments&);

const char* name(RegionMode mode, const std::optional<BodyMode>& bodies) { return bodies ? name(*bodies) : name(mode); }

void set_regions(Report& report, const std::vector<RegionVolume>& volumes, const BodyTable& bodies) {
  std::vector<Json> list;
  for (const RegionVolume& v : volumes) list.emplace_back(to_json_with_bodies(v, bodies));
  report.set("regions", list);
  std::vector<Json> names;
  for (const std::string& n : bodies.names) names.emplace_back(n);
  report.set("body_names", names);
}

void print_bodies(const BodyTable& bodies) {
  constexpr std::size_t most = 20;
  print_row("bodies", count(bodies.names.size(), "body", "bodies") + " in " + count(bodies.regions.size(), "region", "regions"));
  for (std::size_t i = 0; i < std::min(most, bodies.regions.size()); ++i)
    print_row("region " + digits(bodies.regions[i].label), words(bodies.regions[i], bodies));
  if (bodies.regions.size() > most) print_row("", count(bodies.regions.size() - most, "more region", "more regions"));
}

}  // namespace pgdr::tool

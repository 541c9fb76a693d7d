// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "periodic.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "console.hpp"

namespace pgdr::tool {
namespace {

/// A flag in its parts.
struct PeriodicText {
  std::string from, to;
  std::vector<double> motion;  ///< empty: none was given
};

std::optional<double> finite_number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<PeriodicText> split(const std::string& text) {
  const std::size_t at = text.find('='), colon = text.rfind(':');
  const bool has_motion = colon != std::string::npos && at != std::string::npos && colon > at;
  if (at == std::string::npos || at == 0) return std::nullopt;
  PeriodicText parts{text.substr(0, at), text.substr(at + 1, has_motion ? colon - at - 1 : std::string::npos), {}};
  if (parts.to.empty()) return std::nullopt;
  for (std::size_t begin = colon + 1; has_motion;) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::optional<double> number = finite_number(text.substr(begin, end - begin));
    if (!number) return std::nullopt;
    parts.motion.push_back(*number);
    if (end == text.size()) break;
    begin = end + 1;
  }
  if (has_motion && parts.motion.size() != 6 && parts.motion.size() != 12) return std::nullopt;
  return parts;
}

int marker_of(const std::string& text, const Names& names) {
  int marker = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), marker);
  if (error == std::errc() && end == text.data() + text.size()) return marker;
  for (const auto& [number, name] : names.markers)
    if (name == text) return number;
  throw UsageError({.code = Errc::bad_option, .message = "--periodic: no marker is called \"" + text + '"'});
}

}  // namespace

bool is_periodic(const std::string& text) { return split(text).has_value(); }

template <int D>
std::vector<PeriodicSides<D>> periodic_sides(const std::vector<std::string>& flags, const Names& names) {
  std::vector<PeriodicSides<D>> all;
  for (const std::string& flag : flags) {
    const PeriodicText text = split(flag).value();
    PeriodicSides<D> sides{marker_of(text.from, names), marker_of(text.to, names), {}};
    if (!text.motion.empty()) {
      if (text.motion.size() != D * (D + 1))
        throw UsageError(
            {.code = Errc::bad_option, .message = format("--periodic takes a motion of %d numbers in %dD", D * (D + 1), D)});
      std::ranges::copy(text.motion, sides.motion.emplace().begin());
    }
    all.push_back(sides);
  }
  return all;
}

template <int D>
std::vector<std::string> flags_of(const std::vector<PeriodicSides<D>>& sides) {
  std::vector<std::string> flags;
  for (const PeriodicSides<D>& side : sides) {
    std::string& flag = flags.emplace_back(std::to_string(side.from) + "=" + std::to_string(side.to));
    for (std::size_t k = 0; side.motion && k < side.motion->size(); ++k)
      flag += (k == 0 ? ":" : ",") + format("%.17g", (*side.motion)[k]);
  }
  return flags;
}

template <int D>
StatedPeriods periods_of(InputFile& file) {
  StatedPeriods stated = file.read_periods<D>();
  std::erase_if(stated.pairs, [](const PeriodicPairs& p) { return p.from == p.to; });
  return stated;
}

void set_periodic(Report& report, const std::vector<PeriodicPairs>& pairs) {
  std::vector<Json> list;
  for (const PeriodicPairs& p : pairs)
    list.push_back(JsonObject{{"from", p.from},
                              {"to", p.to},
                              {"motion", p.motion},
                              {"walls", p.walls},
                              {"exact", p.exact},
                              {"largest_gap", p.largest_gap},
                              {"points", p.points}});
  report.set("periodic", list);
}

void print_periodic(const std::vector<PeriodicPairs>& pairs) {
  for (const PeriodicPairs& p : pairs)
    print_row("periodic",
              std::to_string(p.from) + " = " + std::to_string(p.to) + ": " +
                  count(p.points.size(), "pair of vertices", "pairs of vertices") +
                  (p.exact == p.points.size() ? std::string(", exactly") : format(", %.3g apart at most", p.largest_gap)));
}

template <int D>
PeriodicCheck check_periodic(const OutputMesh<D>& mesh, const std::vector<PeriodicSides<D>>& sides, const StatedPeriods& stated,
                             double tolerance) {
  PeriodicCheck check;
  try {
    for (const PeriodicSides<D>& side : sides) check.pairs.push_back(periodic_pairs(mesh, side, tolerance));
    std::vector<PeriodicPairs> found;
    for (const PeriodicSides<D>& side : stated_sides<D>(stated)) found.push_back(periodic_pairs(mesh, side, tolerance));
    require_as_stated(found, stated);
    for (PeriodicPairs& p : found)
      if (std::ranges::none_of(sides, [&](const auto& side) { return side.from == p.from && side.to == p.to; }))
        check.pairs.push_back(std::move(p));
  } catch (const UsageError& e) {
    check.failure = e.diagnostic();
  }
  return check;
}

#define PGDR_INSTANTIATE(D)                                                                                                  \
  template std::vector<PeriodicSides<D>> periodic_sides<D>(const std::vector<std::string>&, const Names&);                   \
  template std::vector<std::string> flags_of<D>(const std::vector<PeriodicSides<D>>&);                                       \
  template StatedPeriods periods_of<D>(InputFile&);                                                                          \
  template PeriodicCheck check_periodic<D>(const OutputMesh<D>&, const std::vector<PeriodicSides<D>>&, const StatedPeriods&, \
                                           double);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::tool

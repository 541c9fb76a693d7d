// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "given/given_bodies.hpp"
#include "given/regions.hpp"
#include "numbers/signed_measure.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/check_bodies.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {
namespace {

using namespace checking;
using Windings = std::map<std::uint32_t, int>;

/// Cells that no walls are between, and what rays from one of them say.
struct Part {
  double label = 0, volume = 0;
  std::uint32_t largest = none;  ///< cell
  double largest_volume = 0;
  Windings windings;
};

class BodyChecker {
 public:
  BodyChecker(const OutputMesh<3>& mesh, const GivenInput<3>& input, BodyMode mode, Findings& findings)
      : mesh_(mesh), input_(input), bodies_(input), mode_(mode), findings_(findings) {}

  BodyCheck check() {
    if (!bodies_.unfit().empty()) return {false, bodies_.unfit()};
    find_parts();
    if (!wind()) return {false, "a part of the mesh is no thicker than what is joined"};
    check_labels();
    if (mode_ == BodyMode::united) check_least_points();
    if (mode_ == BodyMode::fragments || mode_ == BodyMode::disjoint) check_volumes();
    return {true, {}};
  }

 private:
  void find_parts() {
    CheckReport ignored;
    Findings unheard(ignored, 0, {});
    const Links<3> links = link_cells(mesh_, unheard);
    const Components components = flood_cells(mesh_, links, unheard);
    parts_.resize(components.of_cell.empty() ? 0 : 1 + *std::ranges::max_element(components.of_cell));
    for (std::uint32_t c = 0; c < mesh_.cells.size(); ++c) {
      if (c % 65536 == 0) findings_.heed_stop();
      const Simplex<3> s = corners_of(mesh_, c);
      const double volume = std::abs(signed_measure<3>({s[0], s[1], s[2]}, s[3]).first) / 6;
      Part& part = parts_[components.of_cell[c]];
      part.label = mesh_.regions.empty() ? 0 : mesh_.regions[c];
      part.volume += volume;
      if (part.largest == none || volume > part.largest_volume) {
        part.largest = c;
        part.largest_volume = volume;
      }
    }
  }

  /// The least height of a cell.
  static double height(const Simplex<3>& s, double volume) {
    double area = 0;
    for (int k = 0; k < 4; ++k) {
      const Point<3>&a = s[(k + 1) % 4], &b = s[(k + 2) % 4], &c = s[(k + 3) % 4];
      const auto n = detail::cross(detail::difference(b, a), detail::difference(c, a));
      area = std::max(area, std::sqrt(detail::dot(n, n)) / 2);
    }
    return 3 * volume / area;
  }

  /// Points that are not all on facets which the mesh has no more.
  static Point<3> about_middle(const Simplex<3>& s, int k) {
    std::array<double, 4> weights;
    for (std::size_t i = 0; i < 4; ++i) weights[i] = 1 + 0.03125 * ((k * static_cast<int>(2 * i + 3)) % 17);
    const double sum = weights[0] + weights[1] + weights[2] + weights[3];
    Point<3> x{};
    for (std::size_t v = 0; v < 4; ++v)
      for (int i = 0; i < 3; ++i) x[i] += weights[v] / sum * s[v][i];
    return x;
  }

  /// False if a part is so thin that rays from its cells may begin beyond what was given.
  bool wind() {
    constexpr double far = 32;  // a point is an eighth of the cell's height above its faces, or higher
    constexpr int most_points = 8;
    for (Part& part : parts_) {
      const Simplex<3> s = corners_of(mesh_, part.largest);
      if (!(height(s, part.largest_volume) > far * input_.reach())) return false;
      std::optional<Windings> found;
      for (int k = 0; k < most_points && !found; ++k) found = bodies_.windings(about_middle(s, k));
      if (!found) return false;
      part.windings = *std::move(found);
    }
    return true;
  }

  std::vector<std::uint32_t> bodies_of(const Part& part) const {
    std::vector<std::uint32_t> found;
    for (const auto& [body, times] : part.windings) found.push_back(body);
    if (mode_ == BodyMode::priority && found.size() > 1) found.resize(1);
    return found;
  }

  void check_labels() {
    std::map<std::vector<std::uint32_t>, double> label_of;
    std::map<double, std::vector<std::uint32_t>> of_label;
    bool some_positive = false;
    for (const Part& part : parts_) some_positive = some_positive || sum(part) > 0;
    for (const Part& part : parts_) {
      const auto say = [&](const char* what) {
        findings_.add(Kind::wrong_region, {part.largest}, [&] { return "The " + cell_words(mesh_, part.largest) + what; });
      };
      if (mode_ == BodyMode::united) {
        if (some_positive ? sum(part) <= 0 : sum(part) == 0) say(" is in no body, by the facets that go round it.");
        continue;
      }
      const std::vector<std::uint32_t> its = bodies_of(part);
      if (its.empty()) say(" is in no body, by the facets that go round it.");
      if (mode_ == BodyMode::disjoint && its.size() > 1) say(" is in several bodies, by the facets that go round it.");
      if (label_of.try_emplace(its, part.label).first->second != part.label)
        say(" has another label than cells in the same bodies.");
      if (of_label.try_emplace(part.label, its).first->second != its) say(" has the label of cells in other bodies.");
    }
  }

  static int sum(const Part& part) {
    int all = 0;
    for (const auto& [body, times] : part.windings) all += times;
    return all;
  }

  void check_volumes() {
    for (std::uint32_t b = 0; b < bodies_.count(); ++b) {
      double meshed = 0;
      for (const Part& part : parts_)
        if (const auto at = part.windings.find(b); at != part.windings.end()) meshed += at->second * part.volume;
      const double given = bodies_.volume(b), rounding = 0x1p-40 * std::abs(given);
      if (std::abs(meshed - given) <= bodies_.slack(b, input_.reach()) + rounding) continue;
      findings_.add(Kind::wrong_volume, {b}, [&] {
        return "Body " + std::to_string(b) + " has a volume of " + words(given) + ", the cells in it one of " + words(meshed) +
               ".";
      });
    }
  }

  void check_least_points() {
    for (std::uint32_t b = 0; b < bodies_.count(); ++b)
      if (bodies_.volume(b) < 0) return;  // it may take away from others
    std::vector<detail::Box<3>> boxes;
    for (std::uint32_t c = 0; c < mesh_.cells.size(); ++c) boxes.push_back(detail::Box<3>::of(corners_of(mesh_, c)));
    const detail::BoxTree<3> tree(boxes);
    const double reach = 2 * input_.reach();
    for (std::uint32_t b = 0; b < bodies_.count(); ++b) {
      if (bodies_.volume(b) == 0) continue;
      const Point<3>& x = bodies_.least_point(b);
      bool found = false;
      tree.meeting(detail::Box<3>::around(x).widened(reach), [&](std::uint32_t c) { found = found || is_in(c, x, reach); });
      if (!found)
        findings_.add(Kind::wrong_volume, {b},
                      [&] { return "The point " + words(x) + " of body " + std::to_string(b) + " is in no cell, nor on one."; });
    }
  }

  /// Within so much.
  bool is_in(std::uint32_t cell, const Point<3>& x, double reach) const {
    const Simplex<3> s = corners_of(mesh_, cell);
    for (int k = 0; k < 4; ++k) {
      std::array<Point<3>, 3> face{s[(k + 1) % 4], s[(k + 2) % 4], s[(k + 3) % 4]};
      if (orient3d(face[0], face[1], face[2], s[k]) == Sign::negative) std::swap(face[0], face[1]);
      const auto n = detail::cross(detail::difference(face[1], face[0]), detail::difference(face[2], face[0]));
      if (signed_measure<3>(face, x).first < -reach * std::sqrt(detail::dot(n, n))) return false;
    }
    return true;
  }

  const OutputMesh<3>& mesh_;
  const GivenInput<3>& input_;
  const GivenBodies bodies_;
  const BodyMode mode_;
  Findings& findings_;
  std::vector<Part> parts_;
};

}  // namespace

BodyCheck check_bodies(const OutputMesh<3>& mesh, const Plc<3>& given, BodyMode mode, std::optional<double> tolerance,
                       CheckReport& report, const std::stop_token& stop) {
  if (report.finding_count > 0) return {false, "the mesh is not sound"};
  if (!given.holes.empty() || !given.regions.empty()) return {false, "seeds of the input win"};
  CheckReport of_input;  // a facet that cannot be triangulated is a finding of check() already
  Findings unheard(of_input, 1, stop);
  const GivenInput<3> input(given, tolerance, unheard);
  Findings findings(report, CheckOptions<3>{}.max_listed, stop);
  return BodyChecker(mesh, input, mode, findings).check();
}

}  // namespace pgdr

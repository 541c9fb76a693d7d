// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/planar_map.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace pgdr {
namespace {

/// Puts the features into an input, one after the other.
class MapReader {
 public:
  explicit MapReader(std::optional<double> tolerance) { plc_.tolerance = tolerance; }

  void add(const MapFeature& feature) {
    bool has_polygons = false, has_edges = false;
    for (const MapPart& part : feature.parts) {
      RingPolygon polygon;
      polygon.feature = static_cast<std::uint32_t>(features_);
      for (const MapPath& path : part.paths) {
        std::vector<std::uint32_t> numbers = numbers_of(path);
        if (part.kind == MapPart::Kind::point) continue;
        has_edges = true;
        if (part.kind == MapPart::Kind::polygon && numbers.size() > 1 && numbers.front() == numbers.back()) numbers.pop_back();
        add_edges(numbers, path, part.kind == MapPart::Kind::polygon, feature.marker);
        if (numbers.size() < 3) continue;  // which encloses nothing
        auto& ring = polygon.rings.emplace_back();
        for (const std::uint32_t p : numbers) ring.push_back(plc_.points[p]);
      }
      if (part.kind != MapPart::Kind::polygon || polygon.rings.empty()) continue;
      has_polygons = true;
      polygons_.push_back(std::move(polygon));
    }
    if (has_polygons && !feature.label_name.empty()) plc_.names.regions.emplace(feature.label, feature.label_name);
    if (has_edges && !feature.marker_name.empty()) plc_.names.markers.emplace(feature.marker, feature.marker_name);
    ++features_;
  }

  Plc<2> made(std::span<const MapFeature> features) {
    if (polygons_.empty()) return std::move(plc_);
    for (const FaceSeed& seed : seeds_of_faces(plc_, polygons_)) {
      if (seed.feature < 0) {
        plc_.holes.push_back(seed.point);
        continue;
      }
      const MapFeature& of = features[static_cast<std::size_t>(seed.feature)];
      plc_.regions.push_back({seed.point, of.label, of.size});
    }
    return std::move(plc_);
  }

 private:
  /// The points of a path, no two in succession the same.
  std::vector<std::uint32_t> numbers_of(const MapPath& path) {
    std::vector<std::uint32_t> numbers;
    for (std::size_t i = 0; i < path.points.size(); ++i) {
      const Point2& p = path.points[i];
      const auto [it, is_new] = number_of_.emplace(std::pair(p[0], p[1]), static_cast<std::uint32_t>(plc_.points.size()));
      if (is_new) {
        plc_.points.push_back(p);
        if (!path.lines.empty()) plc_.source.point_lines.push_back(path.lines[i]);
      }
      if (numbers.empty() || numbers.back() != it->second) numbers.push_back(it->second);
    }
    return numbers;
  }

  void add_edges(const std::vector<std::uint32_t>& numbers, const MapPath& path, bool closed, int marker) {
    for (std::size_t i = closed ? 0 : 1; i < numbers.size(); ++i) {
      const std::uint32_t a = numbers[i == 0 ? numbers.size() - 1 : i - 1], b = numbers[i];
      if (a == b || !edges_.insert(std::minmax(a, b)).second) continue;
      plc_.segments.push_back({{a, b}, marker});
      if (!path.lines.empty()) plc_.source.segment_lines.push_back(path.lines.back());
    }
  }

  Plc<2> plc_;
  std::size_t features_ = 0;
  std::vector<RingPolygon> polygons_;
  std::map<std::pair<double, double>, std::uint32_t> number_of_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges_;
};

}  // namespace

Plc<2> plc_of_map(std::span<const MapFeature> features, std::optional<double> tolerance) {
  MapReader reader(tolerance);
  for (const MapFeature& feature : features) reader.add(feature);
  return reader.made(features);
}

}  // namespace pgdr

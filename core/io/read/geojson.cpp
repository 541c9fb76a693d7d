// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// GeoJSON (RFC 7946): polygons are what is meshed, lines and points lie in it. Features, or geometries that stand alone, are
// numbered from 1. The edges of a feature have its property `marker`, else its number, as marker; cells in its polygons have
// `label`, else its number, as label, and no larger area than `size`; `name` is the name of the label, and of the marker where it
// has lines. Equal points are one, equal edges one with the marker of the first feature, and where polygons overlap the first one
// counts. What edges enclose and no polygon has is a hole. Heights, other properties and members are stepped over, and geometries
// that are null or empty. Nothing is asked of the reference system: coordinates are taken as they are.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "io/formats.hpp"
#include "io/read/polygon_seeds.hpp"
#include "pgdr/error.hpp"
#include "scan/json_scanner.hpp"
#include "scan/line_scanner.hpp"

namespace pgdr::detail {
namespace {

/// What its properties say of a feature.
struct Properties {
  std::string name;
  std::optional<double> label, size;
  std::optional<int> marker;
};

class GeoJsonReader {
 public:
  GeoJsonReader(std::string_view text, const std::filesystem::path& file) : in_(text, file.string()) {
    plc_.source.file = file.string();
  }

  Plc<2> read() {
    read_object(true);
    in_.end();
    if (plc_.segments.empty()) in_.fail(Errc::syntax, "there are no polygons and no lines, which could enclose an area");
    if (!polygons_.empty()) add_seeds();
    return std::move(plc_);
  }

 private:
  static constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();

  /// An object of any type. @param alone  it begins a feature, unless it is a collection of such
  void read_object(bool alone);
  void read_properties(Properties& to);
  void read_geometry(const std::string& type, std::size_t coordinates);
  void read_polygon();
  std::vector<std::uint32_t> read_path();
  std::uint32_t read_point();
  void add_edges(const std::vector<std::uint32_t>& path, bool closed);
  void begin_feature(Properties properties);
  void name_feature();
  void add_seeds();

  /// Calls `read` for the value at a place, and comes back.
  template <class F>
  void at(std::size_t place, const F& read) {
    const std::size_t back = in_.place();
    in_.return_to(place);
    read();
    in_.return_to(back);
  }

  JsonScanner in_;
  Plc<2> plc_;
  std::map<std::pair<double, double>, std::uint32_t> number_of_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges_;
  std::vector<RingPolygon> polygons_;
  std::vector<Properties> features_;
  bool has_lines_ = false;  ///< the last feature
};

void GeoJsonReader::begin_feature(Properties properties) {
  features_.push_back(std::move(properties));
  has_lines_ = false;
}

void GeoJsonReader::name_feature() {
  const Properties& p = features_.back();
  const auto number = static_cast<std::uint32_t>(features_.size() - 1);
  if (p.name.empty()) return;
  if (!polygons_.empty() && polygons_.back().feature == number)
    plc_.names.regions.emplace(p.label.value_or(number + 1.0), p.name);
  if (has_lines_) plc_.names.markers.emplace(p.marker.value_or(static_cast<int>(number) + 1), p.name);
}

void GeoJsonReader::read_properties(Properties& to) {
  if (in_.null()) return;
  in_.object([&](const std::string& key) {
    const char c = in_.next();
    const bool is_number = c == '-' || (c >= '0' && c <= '9');
    if (key == "name" && c == '"') {
      to.name = in_.string();
    } else if (key == "label" && is_number) {
      to.label = in_.number();
    } else if (key == "size" && is_number) {
      to.size = in_.number();
    } else if (key == "marker" && is_number) {
      const double marker = in_.number();
      if (marker != std::floor(marker) || std::abs(marker) > std::numeric_limits<int>::max())
        in_.fail(Errc::syntax, "the property marker is no whole number of 32 bits");
      to.marker = static_cast<int>(marker);
    } else {
      in_.skip();
    }
  });
}

void GeoJsonReader::read_object(bool alone) {
  if (in_.null()) return;
  std::string type;
  Properties properties;
  std::size_t coordinates = nowhere, parts = nowhere, geometry = nowhere;
  in_.object([&](const std::string& key) {
    if (key == "type") {
      type = in_.string();
      return;
    }
    in_.next();
    if (key == "coordinates") coordinates = in_.place();
    if (key == "features" || key == "geometries") parts = in_.place();
    if (key == "geometry") geometry = in_.place();
    if (key == "properties") return read_properties(properties);
    in_.skip();
  });
  const auto require = [&](std::size_t place, const char* what) {
    if (place == nowhere) in_.fail(Errc::syntax, "the " + detail::quoted(type) + " has no " + what);
  };
  if (type == "FeatureCollection") {
    require(parts, "features");
    return at(parts, [this] { in_.array([this] { read_object(true); }); });
  }
  if (alone) begin_feature(std::move(properties));
  if (type == "Feature") {
    require(geometry, "geometry");
    at(geometry, [this] { read_object(false); });
  } else if (type == "GeometryCollection") {
    require(parts, "geometries");
    at(parts, [this] { in_.array([this] { read_object(false); }); });
  } else {
    require(coordinates, "coordinates");
    read_geometry(type, coordinates);
  }
  if (alone) name_feature();
}

void GeoJsonReader::read_geometry(const std::string& type, std::size_t coordinates) {
  const auto read_line = [this] {
    add_edges(read_path(), false);
    has_lines_ = true;
  };
  at(coordinates, [&] {
    if (type == "Polygon") return read_polygon();
    if (type == "MultiPolygon") return in_.array([this] { read_polygon(); });
    if (type == "LineString") return read_line();
    if (type == "MultiLineString") return in_.array(read_line);
    if (type == "MultiPoint") return in_.array([this] { read_point(); });
    if (type != "Point") in_.fail(Errc::syntax, detail::quoted(type) + " is no type of GeoJSON");
    read_point();
  });
}

std::uint32_t GeoJsonReader::read_point() {
  Point2 p;
  int count = 0;
  in_.array([&] {
    const double x = in_.number();
    if (count < 2) p[count] = x;
    ++count;
  });
  if (count < 2) in_.fail(Errc::syntax, "a position has fewer than two coordinates");
  const auto [it, is_new] = number_of_.emplace(std::pair(p[0], p[1]), static_cast<std::uint32_t>(plc_.points.size()));
  if (is_new) {
    plc_.points.push_back(p);
    plc_.source.point_lines.push_back(in_.line());
  }
  return it->second;
}

/// Points one behind the other, no two in succession the same.
std::vector<std::uint32_t> GeoJsonReader::read_path() {
  std::vector<std::uint32_t> path;
  in_.array([&] {
    const std::uint32_t p = read_point();
    if (path.empty() || path.back() != p) path.push_back(p);
  });
  return path;
}

void GeoJsonReader::add_edges(const std::vector<std::uint32_t>& path, bool closed) {
  const int marker = features_.back().marker.value_or(static_cast<int>(features_.size()));
  for (std::size_t i = closed ? 0 : 1; i < path.size(); ++i) {
    const std::uint32_t a = path[i == 0 ? path.size() - 1 : i - 1], b = path[i];
    if (!edges_.insert(std::minmax(a, b)).second) continue;
    plc_.segments.push_back({{a, b}, marker});
    plc_.source.segment_lines.push_back(in_.line());
  }
}

void GeoJsonReader::read_polygon() {
  RingPolygon polygon;
  polygon.feature = static_cast<std::uint32_t>(features_.size() - 1);
  in_.array([&] {
    std::vector<std::uint32_t> path = read_path();
    if (path.size() > 1 && path.front() == path.back()) path.pop_back();
    if (path.size() < 3) in_.fail(Errc::degenerate_facet, "a ring has fewer than three different corners");
    add_edges(path, true);
    auto& ring = polygon.rings.emplace_back();
    for (const std::uint32_t p : path) ring.push_back(plc_.points[p]);
  });
  if (!polygon.rings.empty()) polygons_.push_back(std::move(polygon));
}

void GeoJsonReader::add_seeds() {
  for (const FaceSeed& seed : seeds_of_faces(plc_, polygons_)) {
    if (seed.feature < 0) {
      plc_.holes.push_back(seed.point);
      continue;
    }
    const Properties& of = features_[static_cast<std::size_t>(seed.feature)];
    plc_.regions.push_back({seed.point, of.label.value_or(static_cast<double>(seed.feature) + 1), of.size.value_or(0)});
  }
}

}  // namespace

Plc<2> read_geojson(std::string_view text, const std::filesystem::path& file) { return GeoJsonReader(text, file).read(); }

}  // namespace pgdr::detail

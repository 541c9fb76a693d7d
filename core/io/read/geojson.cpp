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
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/formats.hpp"
#include "pgdr/error.hpp"
#include "pgdr/planar_map.hpp"
#include "scan/json_scanner.hpp"
#include "scan/line_scanner.hpp"

namespace pgdr::detail {
namespace {

class GeoJsonReader {
 public:
  GeoJsonReader(std::string_view text, const std::filesystem::path& file) : in_(text, file.string()), file_(file.string()) {}

  Plc<2> read() {
    read_object(true);
    in_.end();
    Plc<2> plc = plc_of_map(features_);
    plc.source.file = file_;
    if (plc.segments.empty()) in_.fail(Errc::syntax, "there are no polygons and no lines, which could enclose an area");
    return plc;
  }

 private:
  static constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();

  /// An object of any type. @param alone  it begins a feature, unless it is a collection of such
  void read_object(bool alone);
  void read_properties(MapFeature& to);
  void read_geometry(const std::string& type, std::size_t coordinates);
  void read_polygon();
  MapPath read_path();
  void read_point(MapPath& to);
  MapPart& begin_part(MapPart::Kind kind);
  void name_feature(const std::string& name);

  /// Calls `read` for the value at a place, and comes back.
  template <class F>
  void at(std::size_t place, const F& read) {
    const std::size_t back = in_.place();
    in_.return_to(place);
    read();
    in_.return_to(back);
  }

  JsonScanner in_;
  std::string file_;
  std::vector<MapFeature> features_;
};

void GeoJsonReader::name_feature(const std::string& name) {
  MapFeature& feature = features_.back();
  feature.label_name = name;
  const auto is_line = [](const MapPart& part) { return part.kind == MapPart::Kind::line; };
  if (std::ranges::any_of(feature.parts, is_line)) feature.marker_name = name;
}

void GeoJsonReader::read_properties(MapFeature& to) {
  if (in_.null()) return;
  in_.object([&](const std::string& key) {
    const char c = in_.next();
    const bool is_number = c == '-' || (c >= '0' && c <= '9');
    if (key == "name" && c == '"') {
      to.label_name = in_.string();
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
  MapFeature feature;  // numbered from 1, unless its properties say otherwise
  feature.label = static_cast<double>(features_.size()) + 1;
  feature.marker = static_cast<int>(features_.size()) + 1;
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
    if (key == "properties") return read_properties(feature);
    in_.skip();
  });
  const auto require = [&](std::size_t place, const char* what) {
    if (place == nowhere) in_.fail(Errc::syntax, "the " + detail::quoted(type) + " has no " + what);
  };
  if (type == "FeatureCollection") {
    require(parts, "features");
    return at(parts, [this] { in_.array([this] { read_object(true); }); });
  }
  const std::string name = std::exchange(feature.label_name, {});
  if (alone) features_.push_back(std::move(feature));
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
  if (alone) name_feature(name);
}

void GeoJsonReader::read_geometry(const std::string& type, std::size_t coordinates) {
  const auto read_line = [this] { begin_part(MapPart::Kind::line).paths.push_back(read_path()); };
  const auto read_alone = [this] { read_point(begin_part(MapPart::Kind::point).paths.emplace_back()); };
  at(coordinates, [&] {
    if (type == "Polygon") return read_polygon();
    if (type == "MultiPolygon") return in_.array([this] { read_polygon(); });
    if (type == "LineString") return read_line();
    if (type == "MultiLineString") return in_.array(read_line);
    if (type == "MultiPoint") return in_.array(read_alone);
    if (type != "Point") in_.fail(Errc::syntax, detail::quoted(type) + " is no type of GeoJSON");
    read_alone();
  });
}

MapPart& GeoJsonReader::begin_part(MapPart::Kind kind) {
  MapPart& part = features_.back().parts.emplace_back();
  part.kind = kind;
  return part;
}

void GeoJsonReader::read_point(MapPath& to) {
  Point2 p;
  int count = 0;
  in_.array([&] {
    const double x = in_.number();
    if (count < 2) p[count] = x;
    ++count;
  });
  if (count < 2) in_.fail(Errc::syntax, "a position has fewer than two coordinates");
  to.points.push_back(p);
  to.lines.push_back(in_.line());
}

MapPath GeoJsonReader::read_path() {
  MapPath path;
  in_.array([&] { read_point(path); });
  return path;
}

/// How many of successive points differ from the one before.
std::size_t steps_of(const MapPath& ring) {
  std::size_t steps = 0;
  for (std::size_t i = 0; i < ring.points.size(); ++i)
    if (ring.points[i] != ring.points[i == 0 ? ring.points.size() - 1 : i - 1]) ++steps;
  return steps;
}

void GeoJsonReader::read_polygon() {
  MapPart& part = begin_part(MapPart::Kind::polygon);
  in_.array([&] {
    part.paths.push_back(read_path());
    if (steps_of(part.paths.back()) < 3) in_.fail(Errc::degenerate_facet, "a ring has fewer than three different corners");
  });
}

}  // namespace

Plc<2> read_geojson(std::string_view text, const std::filesystem::path& file) { return GeoJsonReader(text, file).read(); }

}  // namespace pgdr::detail

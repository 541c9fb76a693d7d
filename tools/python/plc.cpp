// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Inputs: made once, from arrays or a file, and never changed, so that any number of threads may read one.
#include "pgdr/plc.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bind.hpp"
#include "errors.hpp"
#include "pgdr/arrangement.hpp"
#include "pgdr/bodies.hpp"
#include "pgdr/convex_hull.hpp"
#include "pgdr/io.hpp"
#include "pgdr/joined_plc.hpp"
#include "pgdr/openings.hpp"
#include "pgdr/planar_map.hpp"
#include "pgdr/planar_plc.hpp"
#include "run.hpp"

namespace pgdr::python {
namespace {

/// Indices as they are stored. @throws InputError index_out_of_range
class Indices {
 public:
  Indices(const py::array& array, std::size_t points) : all_(indices_of(array)), points_(points) {}
  std::size_t size() const {
    return std::visit([](const auto& all) { return all.size(); }, all_);
  }
  /// Index i, of this segment or facet.
  std::uint32_t at(std::size_t i, const char* what, std::size_t number) const {
    return std::visit(
        [&](const auto& all) {
          const auto index = all[i];  // once: another thread may be writing to the array
          if (!std::in_range<std::uint32_t>(index) || static_cast<std::size_t>(index) >= points_)
            bad_input(Errc::index_out_of_range,
                      std::string(what) + ' ' + std::to_string(number) + " has index " + std::to_string(index) + ", there are " +
                          std::to_string(points_) + " points, counted from 0",
                      {static_cast<std::int64_t>(number), static_cast<std::int64_t>(index)});
          return static_cast<std::uint32_t>(index);
        },
        all_);
  }

 private:
  IndexArray all_;
  std::size_t points_;
};

template <int D>
void set_segments(Plc<D>& plc, const py::array& array, const Dense<int>& markers) {
  const Indices indices(array, plc.points.size());
  const auto marker = span_of(markers);
  plc.segments.resize(indices.size() / 2);
  if (!marker.empty() && marker.size() != plc.segments.size()) bad_argument("there must be one marker a segment");
  for (std::size_t s = 0; s < plc.segments.size(); ++s)
    plc.segments[s] = {{indices.at(2 * s, "segment", s), indices.at(2 * s + 1, "segment", s)}, marker.empty() ? 0 : marker[s]};
}

/// Facets as arrays: the corners of all polygons, how many each polygon has, and how many polygons each facet has (empty: one);
/// (facet, x, y, z) of each hole of a facet.
struct FacetArrays {
  py::array corners;
  Dense<std::int64_t> polygon_sizes, facet_sizes;
  Dense<int> markers;
  Dense<double> holes;
};

template <int D>
void set_facets(Plc<D>& plc, const FacetArrays& arrays) {
  const Indices corners(arrays.corners, plc.points.size());
  const auto sizes = span_of(arrays.polygon_sizes), counts = span_of(arrays.facet_sizes);
  const auto marker = span_of(arrays.markers);
  const std::size_t facets = counts.empty() ? sizes.size() : counts.size();
  if (!marker.empty() && marker.size() != facets) bad_argument("there must be one marker a facet");
  plc.facets.resize(facets);
  std::size_t corner = 0, polygon = 0;
  for (std::size_t f = 0; f < facets; ++f) {
    auto& facet = plc.facets[f];
    facet.marker = marker.empty() ? 0 : marker[f];
    facet.polygons.resize(counts.empty() ? 1 : static_cast<std::size_t>(std::max<std::int64_t>(counts[f], 0)));
    for (auto& points : facet.polygons) {
      if (polygon >= sizes.size() || sizes[polygon] < 0 || corner + static_cast<std::size_t>(sizes[polygon]) > corners.size())
        bad_argument("the sizes of polygons and facets do not fit the corners");
      points.resize(static_cast<std::size_t>(sizes[polygon++]));
      for (std::uint32_t& point : points) point = corners.at(corner++, "facet", f);
    }
  }
  const auto holes = span_of(arrays.holes);
  for (std::size_t i = 0; i + D < holes.size(); i += D + 1) {
    if (!(holes[i] >= 0 && holes[i] < static_cast<double>(facets))) bad_argument("a hole of a facet that is not there");
    Point<D> hole;
    std::copy_n(holes.begin() + static_cast<std::ptrdiff_t>(i) + 1, D, hole.x.begin());
    plc.facets[static_cast<std::size_t>(holes[i])].holes.push_back(hole);
  }
}

/// Rows of D coordinates, attribute, size.
template <int D>
void set_regions(Plc<D>& plc, const Dense<double>& rows) {
  const auto numbers = span_of(rows);
  for (std::size_t i = 0; i + D + 1 < numbers.size(); i += D + 2) {
    RegionSeed<D> seed;
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(i), D, seed.point.x.begin());
    seed.attribute = numbers[i + D];
    seed.size = numbers[i + D + 1];
    plc.regions.push_back(seed);
  }
}

template <int D>
std::vector<Point<D>> points_of_any(const py::array& array) {
  return std::visit(
      [](const auto& numbers) {
        std::vector<Point<D>> points(numbers.size() / D);
        for (std::size_t i = 0; i < points.size(); ++i)
          std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(i * D), D, points[i].x.begin());
        return points;
      },
      coordinates_of(array));
}

/// What pgdr/_plc.py passes, and pickles.
template <int D>
std::shared_ptr<Plc<D>> make_plc(const py::array& points, bool are_floats, const py::array& segments,
                                 const Dense<int>& segment_markers, const FacetArrays& facets, const Dense<double>& holes,
                                 const Dense<double>& regions, const Dense<int>& point_markers,
                                 const Dense<double>& point_attributes, std::optional<double> tolerance, bool is_coarse) {
  auto plc = std::make_shared<Plc<D>>();
  plc->points = points_of_any<D>(points);
  plc->are_floats = are_floats;
  require_finite<D>(plc->points, "point");
  set_segments<D>(*plc, segments, segment_markers);
  set_facets<D>(*plc, facets);
  plc->holes = points_of<D>(holes);
  require_finite<D>(plc->holes, "the hole");
  set_regions<D>(*plc, regions);
  plc->point_markers = vector_of(point_markers);
  plc->point_attributes = vector_of(point_attributes);
  plc->tolerance = tolerance;
  plc->is_coarse = is_coarse;
  return plc;
}

template <int D>
FacetArrays facet_arrays(const Plc<D>& plc) {
  std::vector<std::int64_t> corners, polygon_sizes, facet_sizes;
  std::vector<double> holes;
  std::vector<int> markers;
  bool is_simple = true;
  for (std::size_t f = 0; f < plc.facets.size(); ++f) {
    const auto& facet = plc.facets[f];
    is_simple = is_simple && facet.polygons.size() == 1;
    facet_sizes.push_back(static_cast<std::int64_t>(facet.polygons.size()));
    for (const auto& polygon : facet.polygons) {
      polygon_sizes.push_back(static_cast<std::int64_t>(polygon.size()));
      corners.insert(corners.end(), polygon.begin(), polygon.end());
    }
    for (const Point<D>& hole : facet.holes) {
      holes.push_back(static_cast<double>(f));
      holes.insert(holes.end(), hole.x.begin(), hole.x.end());
    }
    markers.push_back(facet.marker);
  }
  if (is_simple) facet_sizes.clear();
  const auto count = static_cast<py::ssize_t>(holes.size() / (D + 1));
  return {own(std::move(corners)), own(std::move(polygon_sizes)), own(std::move(facet_sizes)), own(std::move(markers)),
          own(std::move(holes), {count, D + 1})};
}

template <int D>
py::array region_rows(const Plc<D>& plc) {
  std::vector<double> rows;
  for (const RegionSeed<D>& seed : plc.regions) {
    rows.insert(rows.end(), seed.point.x.begin(), seed.point.x.end());
    rows.insert(rows.end(), {seed.attribute, seed.size});
  }
  return own(std::move(rows), {static_cast<py::ssize_t>(plc.regions.size()), D + 2});
}

template <int D>
std::shared_ptr<Plc<D>> with_tolerance(const Plc<D>& plc, std::optional<double> tolerance, bool is_coarse) {
  auto made = std::make_shared<Plc<D>>(plc);
  made->tolerance = tolerance;
  made->is_coarse = is_coarse;
  return made;
}

/// Names of regions and of markers.
using NameDicts = std::pair<std::map<double, std::string>, std::map<int, std::string>>;

template <int D>
std::shared_ptr<Plc<D>> with_names(const Plc<D>& plc, const NameDicts& names, const Dense<std::uint32_t>& facet_bodies,
                                   const std::vector<std::string>& body_names) {
  auto made = std::make_shared<Plc<D>>(plc);
  made->names = {names.first, names.second};
  made->facet_bodies = vector_of(facet_bodies);
  made->body_names = body_names;
  if (!made->facet_bodies.empty() && made->facet_bodies.size() != made->facets.size())
    bad_argument("there must be one body a facet");
  if (std::ranges::any_of(made->facet_bodies, [&](std::uint32_t body) { return body >= body_names.size(); }))
    bad_argument("a facet of a body that has no name");
  return made;
}

template <int D>
std::shared_ptr<Plc<D>> join(const std::vector<std::shared_ptr<Plc<D>>>& inputs, const std::vector<std::string>& names) {
  const py::gil_scoped_release others_run;
  std::vector<Plc<D>> all;
  for (const auto& input : inputs) all.push_back(*input);
  return std::make_shared<Plc<D>>(joined<D>(all, names));
}

template <int D>
void bind(py::module_& module) {
  using Held = Plc<D>;
  const auto get = [](auto read) { return [read](const py::object& self) { return read(self, self.cast<const Held&>()); }; };
  using Self = const py::object&;
  py::class_<Held, std::shared_ptr<Held>>(module, with_dimension<D>("Plc").c_str())
      .def(py::init([](const py::array& points, bool are_floats, const py::array& segments, const Dense<int>& segment_markers,
                       const py::array& corners, const Dense<std::int64_t>& polygon_sizes, const Dense<std::int64_t>& facet_sizes,
                       const Dense<int>& facet_markers, const Dense<double>& facet_holes, const Dense<double>& holes,
                       const Dense<double>& regions, const Dense<int>& point_markers, const Dense<double>& point_attributes,
                       std::optional<double> tolerance, bool is_coarse) {
        return make_plc<D>(points, are_floats, segments, segment_markers,
                           {corners, polygon_sizes, facet_sizes, facet_markers, facet_holes}, holes, regions, point_markers,
                           point_attributes, tolerance, is_coarse);
      }))
      .def_property_readonly("points", get([](Self self, const Held& p) { return view_points<D>(self, p.points); }))
      .def_property_readonly("are_floats", [](const Held& p) { return p.are_floats; })
      .def_property_readonly("segments",
                             get([](Self self, const Held& p) { return view_member(self, p.segments, &Held::Segment::points); }))
      .def_property_readonly("segment_markers",
                             get([](Self self, const Held& p) { return view_member(self, p.segments, &Held::Segment::marker); }))
      .def_property_readonly("facet_arrays",
                             [](const Held& p) {
                               const FacetArrays f = facet_arrays<D>(p);
                               return py::make_tuple(f.corners, f.polygon_sizes, f.facet_sizes, f.markers, f.holes);
                             })
      .def_property_readonly("facet_count", [](const Held& p) { return p.facets.size(); })
      .def_property_readonly("holes", get([](Self self, const Held& p) { return view_points<D>(self, p.holes); }))
      .def_property_readonly("regions", [](const Held& p) { return region_rows<D>(p); })
      .def_property_readonly("point_markers", get([](Self self, const Held& p) {
                               return view(self, p.point_markers.data(), {static_cast<py::ssize_t>(p.point_markers.size())});
                             }))
      .def_property_readonly("point_attributes", get([](Self self, const Held& p) {
                               const std::size_t all = p.point_attributes.size(), points = p.points.size();
                               const auto each = static_cast<py::ssize_t>(points == 0 ? 0 : all / points);
                               return view(self, p.point_attributes.data(), {static_cast<py::ssize_t>(points), each});
                             }))
      .def_property_readonly("tolerance", [](const Held& p) { return p.tolerance; })
      .def_property_readonly("effective_tolerance", [](const Held& p) { return tolerance_of(p); })
      .def_property_readonly("is_coarse", [](const Held& p) { return p.is_coarse; })
      .def_property_readonly("first_index", [](const Held& p) { return p.first_index; })
      .def_property_readonly("file", [](const Held& p) { return p.source.file; })
      .def_property_readonly("names", [](const Held& p) { return NameDicts(p.names.regions, p.names.markers); })
      .def_property_readonly("facet_bodies", get([](Self self, const Held& p) {
                               return view(self, p.facet_bodies.data(), {static_cast<py::ssize_t>(p.facet_bodies.size())});
                             }))
      .def_property_readonly("body_names", [](const Held& p) { return p.body_names; })
      .def("with_names", &with_names<D>)
      .def("with_tolerance", &with_tolerance<D>);
  module.def(with_dimension<D>("joined").c_str(), &join<D>);
  module.def(with_dimension<D>("read_plc").c_str(), [](const std::string& file, bool region_areas) {
    const py::gil_scoped_release others_run;
    return std::make_shared<Held>(read_plc<D>(file, {.region_areas = region_areas}));
  });
}

SharedMarker shared_marker(const std::string& rule) {
  if (rule == "first") return SharedMarker::first;
  return rule == "last" ? SharedMarker::last : SharedMarker::smallest;
}

template <int D>
py::tuple resolve(const Plc<D>& plc, const std::string& markers) {
  std::vector<Diagnostic> repairs;
  std::shared_ptr<Plc<D>> made;
  run_watched([&](const std::stop_token& stop) {
    if constexpr (D == 2)
      made = std::make_shared<Plc<D>>(resolve_crossings(plc, repairs));
    else
      made = std::make_shared<Plc<D>>(resolve_crossings(plc, repairs, {.markers = shared_marker(markers), .stop = stop}));
  });
  return py::make_tuple(made, to_python(repairs));
}

py::tuple close_openings(const Plc<3>& plc) {
  std::vector<Diagnostic> repairs;
  std::shared_ptr<Plc<3>> made;
  run_watched([&](const std::stop_token& stop) { made = std::make_shared<Plc<3>>(close_planar_openings(plc, repairs, stop)); });
  return py::make_tuple(made, to_python(repairs));
}

/// (Plc, (label, volume, bodies) of each region, names of bodies, repairs, warnings).
py::tuple label_bodies(const Plc<3>& plc, const std::string& word, bool resolves_crossings, const std::string& markers) {
  const BodyMode mode = word == "union"       ? BodyMode::united
                        : word == "fragments" ? BodyMode::fragments
                        : word == "priority"  ? BodyMode::priority
                                              : BodyMode::disjoint;
  WithBodies made;
  std::shared_ptr<Plc<3>> seeded;
  run_watched([&](const std::stop_token& stop) {
    made = with_bodies(plc, mode, {resolves_crossings, shared_marker(markers), stop});
    seeded = std::make_shared<Plc<3>>(std::move(made.plc));
  });
  py::list regions;
  for (const BodyRegion& r : made.regions) regions.append(py::make_tuple(r.label, r.volume, r.bodies));
  return py::make_tuple(seeded, regions, made.body_names, to_python(made.repairs), to_python(made.warnings));
}

/// Paths of points that lie one behind the other, a list of them a group.
class Paths {
 public:
  Paths(const Dense<std::int64_t>& groups, const Dense<std::int64_t>& sizes, const Dense<double>& coordinates)
      : groups_(span_of(groups)), sizes_(span_of(sizes)), points_(points_of<2>(coordinates)) {
    require_finite<2>(points_, "point");
    const auto sum = [](std::span<const std::int64_t> all) {
      if (std::ranges::any_of(all, [](std::int64_t n) { return n < 0; })) bad_argument("there are no negative numbers of points");
      return static_cast<std::size_t>(std::accumulate(all.begin(), all.end(), std::int64_t{0}));
    };
    if (sum(groups_) != sizes_.size() || sum(sizes_) != points_.size()) bad_argument("paths and their points are not as many");
  }
  std::size_t groups() const { return groups_.size(); }
  /// The next group. @pre there is one
  std::vector<std::vector<Point2>> next() {
    std::vector<std::vector<Point2>> group(static_cast<std::size_t>(groups_[group_++]));
    for (auto& path : group) {
      const auto begin = points_.begin() + static_cast<std::ptrdiff_t>(point_);
      path.assign(begin, begin + sizes_[path_]);
      point_ += static_cast<std::size_t>(sizes_[path_++]);
    }
    return group;
  }

 private:
  std::span<const std::int64_t> groups_, sizes_;
  std::vector<Point2> points_;
  std::size_t group_ = 0, path_ = 0, point_ = 0;
};

/// ((k, 2) points in faces, (k,) the polygon of each or -1).
py::tuple face_seeds(const Plc<2>& plc, const Dense<std::int64_t>& rings, const Dense<std::int64_t>& corners,
                     const Dense<double>& coordinates) {
  Paths paths(rings, corners, coordinates);
  std::vector<std::array<double, 2>> points;
  std::vector<std::int64_t> owners;
  {
    const py::gil_scoped_release others_run;
    std::vector<RingPolygon> polygons(paths.groups());
    for (std::size_t k = 0; k < polygons.size(); ++k) polygons[k] = {paths.next(), static_cast<std::uint32_t>(k)};
    for (const FaceSeed& seed : seeds_of_faces(plc, polygons)) {
      points.push_back(seed.point.x);
      owners.push_back(seed.feature);
    }
  }
  return py::make_tuple(own(std::move(points)), own(std::move(owners)));
}

/// Of each feature label, size, marker and names; of each part its kind, the feature that it is of, and how many paths it has.
std::shared_ptr<Plc<2>> map_plc(const Dense<double>& labels, const Dense<double>& sizes, const Dense<int>& markers,
                                const std::vector<std::string>& label_names, const std::vector<std::string>& marker_names,
                                const Dense<std::uint8_t>& kinds, const Dense<std::int64_t>& owners,
                                const Dense<std::int64_t>& parts, const Dense<std::int64_t>& points,
                                const Dense<double>& coordinates, std::optional<double> tolerance) {
  Paths paths(parts, points, coordinates);
  const auto label = span_of(labels), size = span_of(sizes);
  const auto marker = span_of(markers);
  const auto kind = span_of(kinds);
  const auto owner = span_of(owners);
  std::vector<MapFeature> features(label.size());
  if (size.size() != features.size() || marker.size() != features.size() || label_names.size() != features.size() ||
      marker_names.size() != features.size() || kind.size() != paths.groups() || owner.size() != paths.groups())
    bad_argument("what is said of features or parts is not as much as these");
  for (std::size_t f = 0; f < features.size(); ++f)
    features[f] = {label[f], size[f], marker[f], label_names[f], marker_names[f], {}};
  for (std::size_t k = 0; k < paths.groups(); ++k) {
    if (owner[k] < 0 || static_cast<std::size_t>(owner[k]) >= features.size() || kind[k] > 2)
      bad_argument("a part of no feature");
    MapPart& part = features[static_cast<std::size_t>(owner[k])].parts.emplace_back();
    part.kind = static_cast<MapPart::Kind>(kind[k]);
    for (auto& path : paths.next()) part.paths.push_back({std::move(path), {}});
  }
  const py::gil_scoped_release others_run;
  return std::make_shared<Plc<2>>(plc_of_map(features, tolerance));
}

}  // namespace

CoordinateArray coordinates_of(const py::array& array) {
  if (py::isinstance<Dense<float>>(array)) return span_of(array.cast<Dense<float>>());
  if (py::isinstance<Dense<double>>(array)) return span_of(array.cast<Dense<double>>());
  bad_argument("coordinates are float64 or float32, contiguous");
}

IndexArray indices_of(const py::array& array) {
  if (py::isinstance<Dense<std::int64_t>>(array)) return span_of(array.cast<Dense<std::int64_t>>());
  if (py::isinstance<Dense<std::int32_t>>(array)) return span_of(array.cast<Dense<std::int32_t>>());
  if (py::isinstance<Dense<std::uint32_t>>(array)) return span_of(array.cast<Dense<std::uint32_t>>());
  if (py::isinstance<Dense<std::uint64_t>>(array)) return span_of(array.cast<Dense<std::uint64_t>>());
  bad_argument("indices are integers of 32 or 64 bits, contiguous");
}

template <int D>
std::shared_ptr<Plc<D>> hull(const Plc<D>& plc) {
  const py::gil_scoped_release others_run;
  return std::make_shared<Plc<D>>(with_convex_hull(plc));
}

void bind_plc(py::module_& module) {
  bind<2>(module);
  bind<3>(module);
  module.def("file_dimension", [](const std::string& file) { return file_dimension(file); });
  module.def("holds_cells", [](const std::string& file) { return holds_cells(file); });
  module.def("resolve_crossings2", &resolve<2>);
  module.def("resolve_crossings3", &resolve<3>);
  module.def("close_planar_openings", &close_openings);
  module.def("with_bodies", &label_bodies);
  module.def("seeds_of_faces", &face_seeds);
  module.def("plc_of_map", &map_plc);
  module.def("with_convex_hull2", &hull<2>);
  module.def("with_convex_hull3", &hull<3>);
}

}  // namespace pgdr::python

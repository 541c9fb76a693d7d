// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The formats of Triangle and TetGen: .poly, .smesh, .node. Where their manuals leave room the two programs decide: a
// marker or attribute that the header announces may be missing (0), one that it does not announce is ignored, point numbers start
// at 0 or 1, whatever follows the regions is not read. Unlike them, the point numbers must be consecutive, since a file
// where they are not would silently become another shape.
#include <algorithm>
#include <cstdint>
#include <string>

#include "io/formats.hpp"
#include "scan/line_scanner.hpp"

namespace pgdr::detail {
namespace {

struct NodeHeader {
  std::size_t points = 0;
  int dimension = 0;  ///< 0: not stated (a .poly that leaves its points to a .node file)
  std::size_t attributes = 0;
  bool markers = false;
};

NodeHeader read_node_header(LineScanner& in) {
  constexpr Subject header{"the header of the points"};
  NodeHeader h;
  in.require(header);
  h.points = in.count({"the list of points"}, 6);  // "1 0 0\n"
  if (in.more_on_line()) {
    const std::int64_t d = in.integer(header);
    if (d != 2 && d != 3) in.fail(Errc::syntax, "the dimension is " + std::to_string(d) + ", not 2 or 3");
    h.dimension = static_cast<int>(d);
  } else if (h.points != 0) {
    in.fail(Errc::syntax, "the header of the points states no dimension");
  }
  if (in.more_on_line()) h.attributes = in.count({"attributes of a point"}, std::max<std::size_t>(2 * h.points, 1));
  if (in.more_on_line()) h.markers = in.integer(header) != 0;
  in.end_line({"the list of points"});
  return h;
}

template <int D>
void require_dimension(const LineScanner& in, const NodeHeader& h) {
  if (h.dimension == D || h.dimension == 0) return;
  in.fail(Errc::syntax,
          "the points have " + std::to_string(h.dimension) + " coordinates, but " + std::to_string(D) + " are asked for");
}

template <int D>
Point<D> read_coordinates(LineScanner& in, Subject s) {
  Point<D> p;
  for (int i = 0; i < D; ++i) p[i] = in.number(s);
  return p;
}

/// The lines of the points, behind their header.
template <int D>
void read_points(LineScanner& in, const NodeHeader& h, Plc<D>& plc) {
  plc.points.reserve(h.points);
  plc.source.point_lines.reserve(h.points);
  if (h.markers) plc.point_markers.reserve(h.points);
  for (std::size_t i = 0; i < h.points; ++i) {
    Subject s{"point", static_cast<std::int64_t>(plc.first_index + i)};
    in.require(s);
    const std::int64_t id = in.integer(s);
    if (i == 0) {
      if (id != 0 && id != 1) in.fail(Errc::syntax, "the first point has number " + std::to_string(id) + ", not 0 or 1");
      plc.first_index = static_cast<std::uint32_t>(id);
      s.id = id;
    }
    if (id != s.id)
      in.fail(Errc::syntax, "point " + std::to_string(id) + " stands where point " + std::to_string(s.id) + " belongs", {id});
    plc.source.point_lines.push_back(static_cast<std::uint32_t>(in.line()));
    plc.points.push_back(read_coordinates<D>(in, s));
    for (std::size_t a = 0; a < h.attributes; ++a) plc.point_attributes.push_back(in.more_on_line() ? in.number(s, false) : 0);
    const int marker = in.more_on_line() ? in.marker(s) : 0;
    if (h.markers) plc.point_markers.push_back(marker);
    in.end_line({"the end of a point"});
  }
}

/// The points of a .poly or .smesh: its own, or those of the .node file beside it.
template <int D>
void read_point_section(LineScanner& in, const std::filesystem::path& file, FileTexts& texts, Plc<D>& plc) {
  const NodeHeader h = read_node_header(in);
  require_dimension<D>(in, h);
  if (h.points != 0) return read_points(in, h, plc);
  std::filesystem::path beside = file;
  beside.replace_extension(".node");
  Plc<D> nodes = read_node<D>(texts.of(beside), beside);
  plc.points = std::move(nodes.points);
  plc.point_markers = std::move(nodes.point_markers);
  plc.point_attributes = std::move(nodes.point_attributes);
  plc.first_index = nodes.first_index;
}

struct ListHeader {
  std::size_t entries = 0;
  bool markers = false;
};

/// "<number of entries> [<markers: 0 or 1>]"
ListHeader read_list_header(LineScanner& in, Subject s, std::size_t bytes_each) {
  ListHeader h;
  in.require(s);
  h.entries = in.count(s, bytes_each);
  if (in.more_on_line()) h.markers = in.integer(s) != 0;
  in.end_line({"the list"});
  return h;
}

/// The marker at the end of a line; one that the header does not announce is there in many files and means nothing.
int read_last_marker(LineScanner& in, const ListHeader& h, Subject s) {
  const int marker = in.more_on_line() ? in.marker(s) : 0;
  in.end_line({"the end of an entry"});
  return h.markers ? marker : 0;
}

void read_segments(LineScanner& in, Plc<2>& plc) {
  const ListHeader h = read_list_header(in, {"the list of segments"}, 6);  // "1 1 2\n"
  plc.segments.reserve(h.entries);
  for (std::size_t i = 0; i < h.entries; ++i) {
    const Subject s{"segment", static_cast<std::int64_t>(plc.first_index + i)};
    in.require(s);
    plc.source.segment_lines.push_back(static_cast<std::uint32_t>(in.line()));
    in.integer(s);
    Plc<2>::Segment segment;
    for (auto& p : segment.points) p = in.reference(s, plc.first_index, plc.points.size());
    segment.marker = read_last_marker(in, h, s);
    plc.segments.push_back(segment);
  }
}

/// "<number of corners> <corner> ...", over as many lines as it takes; what follows on the last one is left.
std::vector<std::uint32_t> read_polygon(LineScanner& in, Subject s, const Plc<3>& plc) {
  in.require(s);
  const std::size_t n = in.count(s, 2);
  if (n == 0) in.fail(Errc::degenerate_facet, "facet " + std::to_string(s.id) + " has a polygon without corners", {s.id});
  std::vector<std::uint32_t> corners(n);
  for (auto& c : corners) {
    in.require(s);
    c = in.reference(s, plc.first_index, plc.points.size());
  }
  return corners;
}

Plc<3>::Facet read_poly_facet(LineScanner& in, const ListHeader& h, Subject s, const Plc<3>& plc) {
  Plc<3>::Facet facet;
  const std::size_t polygons = in.count(s, 4);  // "1 1\n"
  if (polygons == 0) in.fail(Errc::degenerate_facet, "facet " + std::to_string(s.id) + " has no polygon", {s.id});
  const std::size_t holes = in.more_on_line() ? in.count({"the holes of facet", s.id}, 8) : 0;  // "1 0 0 0\n"
  facet.marker = read_last_marker(in, h, s);
  facet.polygons.reserve(polygons);
  for (std::size_t i = 0; i < polygons; ++i) {
    facet.polygons.push_back(read_polygon(in, s, plc));
    in.end_line({"the end of a polygon"});
  }
  facet.holes.reserve(holes);
  for (std::size_t i = 0; i < holes; ++i) {
    in.require({"a hole of facet", s.id});
    in.integer(s);
    facet.holes.push_back(read_coordinates<3>(in, s));
    in.end_line({"the end of a hole"});
  }
  return facet;
}

Plc<3>::Facet read_smesh_facet(LineScanner& in, const ListHeader& h, Subject s, const Plc<3>& plc) {
  Plc<3>::Facet facet;
  facet.polygons.push_back(read_polygon(in, s, plc));
  facet.marker = read_last_marker(in, h, s);
  return facet;
}

/// Facets of a .poly or a .smesh, as `read_facet` has it.
template <class ReadFacet>
void read_facets(LineScanner& in, Plc<3>& plc, std::size_t bytes_each, ReadFacet read_facet) {
  const ListHeader h = read_list_header(in, {"the list of facets"}, bytes_each);
  plc.facets.reserve(h.entries);
  for (std::size_t i = 0; i < h.entries; ++i) {
    const Subject s{"facet", static_cast<std::int64_t>(plc.first_index + i)};
    in.require(s);
    plc.source.facet_lines.push_back(static_cast<std::uint32_t>(in.line()));
    plc.facets.push_back(read_facet(in, h, s, plc));
  }
}

template <int D>
void read_holes(LineScanner& in, Plc<D>& plc) {
  const ListHeader h = read_list_header(in, {"the list of holes"}, 2 * (D + 1));
  plc.holes.reserve(h.entries);
  for (std::size_t i = 0; i < h.entries; ++i) {
    const Subject s{"hole", static_cast<std::int64_t>(i + 1)};
    in.require(s);
    plc.source.hole_lines.push_back(static_cast<std::uint32_t>(in.line()));
    in.integer(s);
    plc.holes.push_back(read_coordinates<D>(in, s));
    in.end_line({"the end of a hole"});
  }
}

/// The optional last part. A single number behind the point is the attribute, and in 2D the bound of the area as well where the
/// options say so: Triangle's manual has it that way, but such files mean labels, and Triangle heeds areas with -a alone.
template <int D>
void read_regions(LineScanner& in, const ReadOptions& options, Plc<D>& plc) {
  if (!in.advance()) return;
  const ListHeader h = read_list_header(in, {"the list of regions"}, 2 * (D + 2));
  plc.regions.reserve(h.entries);
  for (std::size_t i = 0; i < h.entries; ++i) {
    const Subject s{"region", static_cast<std::int64_t>(i + 1)};
    in.require(s);
    plc.source.region_lines.push_back(static_cast<std::uint32_t>(in.line()));
    in.integer(s);
    RegionSeed<D> region;
    region.point = read_coordinates<D>(in, s);
    region.attribute = in.number(s);
    if (in.more_on_line())
      region.size = in.number(s);
    else if (D == 2 && options.region_areas)
      region.size = region.attribute;
    in.end_line({"the end of a region"});
    plc.regions.push_back(region);
  }
}

}  // namespace

template <int D>
Plc<D> read_node(std::string_view text, const std::filesystem::path& file) {
  Plc<D> plc;
  plc.source.file = file.string();
  LineScanner in(text, plc.source.file);
  const NodeHeader h = read_node_header(in);
  require_dimension<D>(in, h);
  read_points(in, h, plc);
  if (in.advance()) in.fail(Errc::syntax, quoted(in.word({})) + " stands behind the last point");
  return plc;
}

template <int D>
Plc<D> read_poly(std::string_view text, const std::filesystem::path& file, FileTexts& beside, const ReadOptions& options) {
  Plc<D> plc;
  plc.source.file = file.string();
  LineScanner in(text, plc.source.file);
  read_point_section(in, file, beside, plc);
  if constexpr (D == 2)
    read_segments(in, plc);
  else
    read_facets(in, plc, 6, read_poly_facet);  // "1\n1 1\n"
  read_holes(in, plc);
  read_regions(in, options, plc);
  return plc;
}

Plc<3> read_smesh(std::string_view text, const std::filesystem::path& file, FileTexts& beside) {
  Plc<3> plc;
  plc.source.file = file.string();
  LineScanner in(text, plc.source.file);
  read_point_section(in, file, beside, plc);
  read_facets(in, plc, 4, read_smesh_facet);  // "1 1\n"
  read_holes(in, plc);
  read_regions(in, {}, plc);
  return plc;
}

int node_dimension(std::string_view text, const std::filesystem::path& file, FileTexts& texts) {
  LineScanner in(text, file.string());
  const NodeHeader h = read_node_header(in);
  if (h.dimension != 0) return h.dimension;
  std::filesystem::path beside = file;
  beside.replace_extension(".node");
  if (beside == file) in.fail(Errc::syntax, "the header of the points states no dimension");
  return node_dimension(texts.of(beside), beside, texts);
}

template Plc<2> read_node<2>(std::string_view, const std::filesystem::path&);
template Plc<3> read_node<3>(std::string_view, const std::filesystem::path&);
template Plc<2> read_poly<2>(std::string_view, const std::filesystem::path&, FileTexts&, const ReadOptions&);
template Plc<3> read_poly<3>(std::string_view, const std::filesystem::path&, FileTexts&, const ReadOptions&);

}  // namespace pgdr::detail

// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "surface_output.hpp"

#include <array>
#include <ostream>
#include <vector>

#include "files.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/error.hpp"
#include "pgdr/output_files.hpp"
#include "text.hpp"

namespace pgdr::tool {
namespace {

std::string coordinates(const Point3& p) { return digits(p[0]) + ' ' + digits(p[1]) + ' ' + digits(p[2]); }

void put_poly(std::ostream& out, const Plc<3>& plc) {
  const std::size_t attributes = plc.points.empty() ? 0 : plc.point_attributes.size() / plc.points.size();
  const bool is_marked = !plc.point_markers.empty();
  out << plc.points.size() << " 3 " << attributes << ' ' << is_marked << '\n';
  for (std::size_t i = 0; i < plc.points.size(); ++i) {
    out << i << ' ' << coordinates(plc.points[i]);
    for (std::size_t k = 0; k < attributes; ++k) out << ' ' << digits(plc.point_attributes[i * attributes + k]);
    if (is_marked) out << ' ' << plc.point_markers[i];
    out << '\n';
  }
  out << plc.facets.size() + plc.segments.size() << " 1\n";
  for (const auto& f : plc.facets) {
    out << f.polygons.size() << ' ' << f.holes.size() << ' ' << f.marker << '\n';
    for (const auto& polygon : f.polygons) {
      out << polygon.size();
      for (const std::uint32_t v : polygon) out << ' ' << v;
      out << '\n';
    }
    for (std::size_t k = 0; k < f.holes.size(); ++k) out << k << ' ' << coordinates(f.holes[k]) << '\n';
  }
  for (const auto& s : plc.segments) out << "1 0 " << s.marker << "\n2 " << s.points[0] << ' ' << s.points[1] << '\n';
  out << plc.holes.size() << '\n';
  for (std::size_t k = 0; k < plc.holes.size(); ++k) out << k << ' ' << coordinates(plc.holes[k]) << '\n';
  out << plc.regions.size() << '\n';
  for (std::size_t k = 0; k < plc.regions.size(); ++k) {
    const auto& r = plc.regions[k];
    out << k << ' ' << coordinates(r.point) << ' ' << digits(r.attribute) << ' ' << digits(r.size > 0 ? r.size : -1) << '\n';
  }
}

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

void put_vertices(std::ostream& out, const Domain<3>& domain, const char* before) {
  for (const Point3& p : domain.points()) out << before << coordinates(p) << '\n';
}

void put_triangles(std::ostream& out, const Triangles& triangles, const char* before, std::uint32_t first) {
  for (const auto& t : triangles) out << before << t[0] + first << ' ' << t[1] + first << ' ' << t[2] + first << '\n';
}

void put_stl(std::ostream& out, const Domain<3>& domain, const Triangles& triangles) {
  out << "solid surface\n";
  for (const auto& t : triangles) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t v : t) out << "vertex " << coordinates(domain.points()[v]) << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid surface\n";
}

void put_as_triangles(const std::string& file, std::ostream& out, const Domain<3>& domain) {
  Triangles triangles;
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    triangles.insert(triangles.end(), domain.triangles(f).begin(), domain.triangles(f).end());
  if (has_extension(file, {".stl"})) return put_stl(out, domain, triangles);
  if (has_extension(file, {".obj"})) {
    put_vertices(out, domain, "v ");
    return put_triangles(out, triangles, "f ", 1);
  }
  if (has_extension(file, {".ply"}))
    out << "ply\nformat ascii 1.0\nelement vertex " << domain.points().size()
        << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << triangles.size()
        << "\nproperty list uchar int vertex_indices\nend_header\n";
  else
    out << "OFF\n" << domain.points().size() << ' ' << triangles.size() << " 0\n";
  put_vertices(out, domain, "");
  put_triangles(out, triangles, "3 ", 0);
}

}  // namespace

void require_surface_writable(const std::string& file) {
  if (!has_extension(file, {".poly", ".off", ".obj", ".ply", ".stl"}))
    throw UsageError({.code = Errc::bad_option, .message = "--surface-output writes .poly .off .obj .ply .stl, not " + file});
  require_writable(file);
}

void write_surface(const std::string& file, const Plc<3>& plc) {
  if (has_extension(file, {".poly"})) return write_file(file, [&](std::ostream& out) { put_poly(out, plc); });
  const Domain<3> domain(plc);
  write_file(file, [&](std::ostream& out) { put_as_triangles(file, out, domain); });
}

}  // namespace pgdr::tool

// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// OFF surfaces: "[ST][C][N]OFF" (which may be missing, stand alone or before the counts), counts of points, faces and
// perhaps edges, one point a line, faces with their corners. Normals, colours and texture coordinates are checked to be
// numbers and dropped. A face is a facet, however many corners it has.
#include <string>

#include "io/formats.hpp"
#include "scan/line_scanner.hpp"

namespace pgdr::detail {
namespace {

struct OffHeader {
  std::size_t points = 0, faces = 0;
  bool more_a_point = false;  ///< normals, colours or texture coordinates follow the point
};

OffHeader read_off_header(LineScanner& in) {
  constexpr Subject header{"the header"};
  OffHeader h;
  in.require(header);
  bool keyword = in.accept("OFF");
  for (const std::string_view longer : {"COFF", "NOFF", "CNOFF", "STOFF", "STCOFF", "STNOFF", "STCNOFF"}) {
    if (!keyword && in.accept(longer)) keyword = h.more_a_point = true;
  }
  in.require(header);
  if (keyword && in.accept("BINARY")) in.fail(Errc::unknown_format, "binary OFF is not read");
  h.points = in.count({keyword ? "the list of points" : "the header (neither OFF nor the number of points)"}, 6);
  in.require(header);
  h.faces = in.count({"the list of faces"}, 4);  // "1 0\n"
  if (in.more_on_line()) in.integer({"the number of edges"});
  in.end_line({"the end of the header"});
  return h;
}

void skip_numbers(LineScanner& in, Subject s) {
  while (in.more_on_line()) in.number(s, false);
}

void read_off_points(LineScanner& in, const OffHeader& h, Plc<3>& plc) {
  plc.points.reserve(h.points);
  plc.source.point_lines.reserve(h.points);
  for (std::size_t i = 0; i < h.points; ++i) {
    const Subject s{"point", static_cast<std::int64_t>(i)};
    in.require(s);
    plc.source.point_lines.push_back(static_cast<std::uint32_t>(in.line()));
    Point<3> p;
    for (int k = 0; k < 3; ++k) p[k] = in.number(s);
    plc.points.push_back(p);
    if (h.more_a_point) skip_numbers(in, s);
    in.end_line({"the end of a point"});
  }
}

void read_off_faces(LineScanner& in, const OffHeader& h, Plc<3>& plc) {
  plc.facets.reserve(h.faces);
  plc.source.facet_lines.reserve(h.faces);
  for (std::size_t i = 0; i < h.faces; ++i) {
    const Subject s{"face", static_cast<std::int64_t>(i)};
    in.require(s);
    plc.source.facet_lines.push_back(static_cast<std::uint32_t>(in.line()));
    const std::size_t corners = in.count(s, 2);
    if (corners < 3) in.fail(Errc::degenerate_facet, "face " + std::to_string(i) + " has fewer than three corners", {s.id});
    auto& polygon = plc.facets.emplace_back().polygons.emplace_back(corners);
    for (auto& c : polygon) {
      in.require(s);
      c = in.reference(s, 0, plc.points.size());
    }
    skip_numbers(in, s);
  }
}

}  // namespace

Plc<3> read_off(std::string_view text, const std::filesystem::path& file) {
  Plc<3> plc;
  plc.source.file = file.string();
  LineScanner in(text, plc.source.file);
  const OffHeader h = read_off_header(in);
  read_off_points(in, h, plc);
  read_off_faces(in, h, plc);
  if (in.advance()) in.fail(Errc::syntax, quoted(in.word({})) + " stands behind the last face");
  return plc;
}

}  // namespace pgdr::detail

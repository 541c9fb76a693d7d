// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/values.hpp"

#include <optional>
#include <utility>

#include "transport/shared_error.hpp"

namespace pgdr::detail {
namespace {

void put_flag(MessageWriter& message, bool flag) { message.put(static_cast<std::uint8_t>(flag)); }
bool get_flag(MessageReader& message) { return message.get<std::uint8_t>() != 0; }

void put_optional(MessageWriter& message, const std::optional<double>& value) {
  put_flag(message, value.has_value());
  message.put(value.value_or(0));
}

std::optional<double> get_optional(MessageReader& message) {
  const bool is_there = get_flag(message);
  const auto value = message.get<double>();
  return is_there ? std::optional(value) : std::nullopt;
}

void put_diagnostics(MessageWriter& message, const std::vector<Diagnostic>& all) {
  message.put(static_cast<std::uint64_t>(all.size()));
  for (const Diagnostic& d : all) put_diagnostic(message, d);
}

std::vector<Diagnostic> get_diagnostics(MessageReader& message) {
  std::vector<Diagnostic> all(message.get_count(sizeof(Errc)));
  for (Diagnostic& d : all) d = get_diagnostic(message);
  return all;
}

void put_source(MessageWriter& message, const PlcSource& source) {
  message.put(source.file);
  for (const auto* lines :
       {&source.point_lines, &source.segment_lines, &source.facet_lines, &source.hole_lines, &source.region_lines})
    message.put(*lines);
  message.put(source.void_widths);
  message.put(source.cell_regions);
}

PlcSource get_source(MessageReader& message) {
  PlcSource source;
  source.file = message.get_text();
  for (auto* lines : {&source.point_lines, &source.segment_lines, &source.facet_lines, &source.hole_lines, &source.region_lines})
    *lines = message.get_all<std::uint32_t>();
  source.void_widths = message.get_all<double>();
  source.cell_regions = message.get<std::uint32_t>();
  return source;
}

}  // namespace

template <int D>
void put_plc(MessageWriter& message, const Plc<D>& plc) {
  message.put(plc.points);
  message.put(plc.point_markers);
  message.put(plc.point_attributes);
  message.put(plc.segments);
  message.put(static_cast<std::uint64_t>(plc.facets.size()));
  for (const auto& facet : plc.facets) {
    message.put(static_cast<std::uint64_t>(facet.polygons.size()));
    for (const std::vector<std::uint32_t>& polygon : facet.polygons) message.put(polygon);
    message.put(facet.holes);
    message.put(facet.marker);
  }
  message.put(plc.holes);
  message.put(plc.regions);
  put_optional(message, plc.tolerance);
  put_flag(message, plc.is_coarse);
  put_flag(message, plc.are_floats);
  message.put(plc.first_index);
  put_source(message, plc.source);
}

template <int D>
Plc<D> get_plc(MessageReader& message) {
  constexpr std::size_t least = sizeof(std::uint64_t);  // of a facet or a polygon: a length
  Plc<D> plc;
  plc.points = message.get_all<Point<D>>();
  plc.point_markers = message.get_all<int>();
  plc.point_attributes = message.get_all<double>();
  plc.segments = message.get_all<typename Plc<D>::Segment>();
  plc.facets.resize(message.get_count(least));
  for (auto& facet : plc.facets) {
    facet.polygons.resize(message.get_count(least));
    for (std::vector<std::uint32_t>& polygon : facet.polygons) polygon = message.get_all<std::uint32_t>();
    facet.holes = message.get_all<Point<D>>();
    facet.marker = message.get<int>();
  }
  plc.holes = message.get_all<Point<D>>();
  plc.regions = message.get_all<RegionSeed<D>>();
  plc.tolerance = get_optional(message);
  plc.is_coarse = get_flag(message);
  plc.are_floats = get_flag(message);
  plc.first_index = message.get<std::uint32_t>();
  plc.source = get_source(message);
  return plc;
}

template <int D>
void put_result(MessageWriter& message, const RefineResult<D>& r) {
  message.put(r.stop);
  message.put(r.poor_left);
  message.put(r.poor_unavoidable);
  put_flag(message, r.size_met);
  message.put(r.reasons);
  message.put(static_cast<std::uint64_t>(r.regions.size()));
  for (const RegionVolume& region : r.regions) {
    message.put(region.label);
    message.put(region.volume_meshed);
    put_optional(message, region.volume_given);
  }
  const RefineStatistics& s = r.statistics;
  for (const std::uint64_t n :
       {s.segment_points, s.facet_points, s.insertions_committed, s.insertions_refused, s.selector_outside})
    message.put(n);
  for (const double seconds : {s.seconds_mesh, s.seconds_initial, s.seconds_refine, s.seconds_optimize}) message.put(seconds);
  message.put(s.predicates);
  message.put(r.scheduler.leaves);
  message.put(r.scheduler.generations);
  message.put(r.scheduler.cycles);
  message.put(r.scheduler.visits);
  message.put(r.scheduler.set_aside);
  message.put(r.optimization);
  put_flag(message, r.delaunay);
  put_flag(message, r.violations_seen);
  message.put(r.unused_points);
  message.put(r.tolerance);
  message.put(r.largest_move);
  put_diagnostics(message, r.repairs);
  put_diagnostics(message, r.warnings);
}

template <int D>
RefineResult<D> get_result(MessageReader& message) {
  RefineResult<D> r;
  r.stop = message.get<StopCause>();
  r.poor_left = message.get<std::uint64_t>();
  r.poor_unavoidable = message.get<std::uint64_t>();
  r.size_met = get_flag(message);
  r.reasons = message.get_all<PoorReason>();
  r.regions.resize(message.get_count(sizeof(RegionVolume::label)));
  for (RegionVolume& region : r.regions) {
    region.label = message.get<double>();
    region.volume_meshed = message.get<double>();
    region.volume_given = get_optional(message);
  }
  RefineStatistics& s = r.statistics;
  for (std::uint64_t* n :
       {&s.segment_points, &s.facet_points, &s.insertions_committed, &s.insertions_refused, &s.selector_outside})
    *n = message.get<std::uint64_t>();
  for (double* seconds : {&s.seconds_mesh, &s.seconds_initial, &s.seconds_refine, &s.seconds_optimize})
    *seconds = message.get<double>();
  s.predicates = message.get<PredicateCounts>();
  r.scheduler.leaves = message.get<std::uint64_t>();
  r.scheduler.generations = message.get<std::uint64_t>();
  r.scheduler.cycles = message.get<std::uint64_t>();
  r.scheduler.visits = message.get<std::uint64_t>();
  r.scheduler.set_aside = message.get<std::uint64_t>();
  r.optimization = message.get<OptimizationStatistics>();
  r.delaunay = get_flag(message);
  r.violations_seen = get_flag(message);
  r.unused_points = message.get_all<std::uint32_t>();
  r.tolerance = message.get<double>();
  r.largest_move = message.get<double>();
  r.repairs = get_diagnostics(message);
  r.warnings = get_diagnostics(message);
  return r;
}

template <int D>
void put_piece(MessageWriter& message, const MeshPiece<D>& piece) {
  const OutputMesh<D>& m = piece.mesh;
  message.put(m.points);
  message.put(static_cast<std::uint64_t>(m.input_points));
  message.put(m.point_markers);
  message.put(m.point_attributes);
  message.put(m.cells);
  message.put(m.regions);
  message.put(m.leaves);
  message.put(m.subsegments);
  message.put(m.subfacets);
  message.put(piece.point_numbers);
  for (const std::uint64_t n :
       {piece.first_point, piece.own_points, piece.first_cell, piece.first_subfacet, piece.first_subsegment})
    message.put(n);
  const auto& t = piece.total;
  for (const std::uint64_t n : {t.points, t.input_points, t.cells, t.subfacets, t.subsegments, t.attributes_per_point})
    message.put(n);
  for (const bool flag : {t.point_markers, t.regions, t.leaves}) put_flag(message, flag);
}

template <int D>
MeshPiece<D> get_piece(MessageReader& message) {
  using Mesh = OutputMesh<D>;
  MeshPiece<D> piece;
  Mesh& m = piece.mesh;
  m.points = message.get_all<Point<D>>();
  m.input_points = message.get<std::uint64_t>();
  m.point_markers = message.get_all<int>();
  m.point_attributes = message.get_all<double>();
  m.cells = message.get_all<std::array<typename Mesh::Index, D + 1>>();
  m.regions = message.get_all<double>();
  m.leaves = message.get_all<std::uint32_t>();
  m.subsegments = message.get_all<typename Mesh::template Constraint<2>>();
  m.subfacets = message.get_all<typename Mesh::template Constraint<3>>();
  piece.point_numbers = message.get_all<std::uint64_t>();
  for (std::uint64_t* n :
       {&piece.first_point, &piece.own_points, &piece.first_cell, &piece.first_subfacet, &piece.first_subsegment})
    *n = message.get<std::uint64_t>();
  auto& t = piece.total;
  for (std::uint64_t* n : {&t.points, &t.input_points, &t.cells, &t.subfacets, &t.subsegments, &t.attributes_per_point})
    *n = message.get<std::uint64_t>();
  for (bool* flag : {&t.point_markers, &t.regions, &t.leaves}) *flag = get_flag(message);
  return piece;
}

template void put_plc<2>(MessageWriter&, const Plc<2>&);
template void put_plc<3>(MessageWriter&, const Plc<3>&);
template Plc<2> get_plc<2>(MessageReader&);
template Plc<3> get_plc<3>(MessageReader&);
template void put_result<2>(MessageWriter&, const RefineResult<2>&);
template void put_result<3>(MessageWriter&, const RefineResult<3>&);
template RefineResult<2> get_result<2>(MessageReader&);
template RefineResult<3> get_result<3>(MessageReader&);
template void put_piece<2>(MessageWriter&, const MeshPiece<2>&);
template void put_piece<3>(MessageWriter&, const MeshPiece<3>&);
template MeshPiece<2> get_piece<2>(MessageReader&);
template MeshPiece<3> get_piece<3>(MessageReader&);

}  // namespace pgdr::detail

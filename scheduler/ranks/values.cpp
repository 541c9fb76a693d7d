// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/values.hpp"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "transport/shared_error.hpp"

namespace pgdr::detail {
namespace {

constexpr std::size_t length = sizeof(std::uint64_t);  // which a list begins with

/// Writes values one after the other. Reading has the same functions, so that one list of its fields does for both of a type.
class Writing {
 public:
  explicit Writing(MessageWriter& message) : message_(message) {}
  template <class... T>
  void operator()(const T&... values) {
    (put(values), ...);
  }
  /// A list whose elements are no plain values: f(element) for each, which takes `least` bytes or more.
  template <class T, class F>
  void each(const std::vector<T>& list, std::size_t /*least*/, const F& f) {
    message_.put(static_cast<std::uint64_t>(list.size()));
    for (const T& value : list) f(value);
  }

 private:
  template <class T>
  void put(const T& value) {
    message_.put(value);
  }
  void put(bool flag) { message_.put(static_cast<std::uint8_t>(flag)); }
  void put(const std::optional<double>& value) { (*this)(value.has_value(), value.value_or(0)); }
  void put(const Diagnostic& value) { put_diagnostic(message_, value); }
  template <class Key>
  void put(const std::map<Key, std::string>& names) {
    message_.put(static_cast<std::uint64_t>(names.size()));
    for (const auto& [key, name] : names) (*this)(key, name);
  }
  void put(const std::vector<std::string>& texts) {
    each(texts, length, [this](const std::string& text) { put(text); });
  }

  MessageWriter& message_;
};

class Reading {
 public:
  explicit Reading(MessageReader& message) : message_(message) {}
  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }
  template <class T, class F>
  void each(std::vector<T>& list, std::size_t least, const F& f) {
    list.resize(message_.get_count(least));
    for (T& value : list) f(value);
  }

 private:
  template <Sendable T>
  void get(T& value) {
    value = message_.get<T>();
  }
  template <Sendable T>
  void get(std::vector<T>& values) {
    values = message_.get_all<T>();
  }
  void get(std::string& text) { text = message_.get_text(); }
  void get(bool& flag) { flag = message_.get<std::uint8_t>() != 0; }
  void get(std::optional<double>& value) {
    bool is_there = false;
    double number = 0;
    (*this)(is_there, number);
    value = is_there ? std::optional(number) : std::nullopt;
  }
  void get(Diagnostic& value) { value = get_diagnostic(message_); }
  template <class Key>
  void get(std::map<Key, std::string>& names) {
    const std::size_t count = message_.get_count(sizeof(Key) + length);
    for (std::size_t i = 0; i < count; ++i) {
      Key key{};
      std::string name;
      (*this)(key, name);
      names.emplace(key, std::move(name));
    }
  }
  void get(std::vector<std::string>& texts) {
    each(texts, length, [this](std::string& text) { get(text); });
  }

  MessageReader& message_;
};

// The fields of each type. Message: Writing, with a constant, or Reading.

template <class Message, class Value>
void plc_fields(Message& message, Value& plc) {
  message(plc.points, plc.point_markers, plc.point_attributes, plc.segments);
  message.each(plc.facets, length, [&](auto& facet) {
    message.each(facet.polygons, length, [&](auto& polygon) { message(polygon); });
    message(facet.holes, facet.marker);
  });
  message(plc.holes, plc.regions, plc.facet_bodies, plc.body_names, plc.names.regions, plc.names.markers);
  message(plc.tolerance, plc.is_coarse, plc.are_floats, plc.first_index);
  auto& source = plc.source;
  message(source.file, source.point_lines, source.segment_lines, source.facet_lines, source.hole_lines, source.region_lines,
          source.void_widths, source.cell_regions);
  message.each(source.parts, length, [&](auto& part) { message(part.file, part.first_line); });
}

template <class Message, class Value>
void result_fields(Message& message, Value& r) {
  message(r.stop, r.poor_left, r.poor_unavoidable, r.size_met, r.reasons);
  message.each(r.regions, sizeof(RegionVolume::label),
               [&](auto& region) { message(region.label, region.volume_meshed, region.volume_given); });
  auto& s = r.statistics;
  message(s.segment_points, s.facet_points, s.insertions_committed, s.insertions_refused, s.selector_outside, s.selector_further,
          s.selector_dropped, s.seconds_mesh, s.seconds_initial, s.seconds_refine, s.seconds_optimize, s.predicates);
  message(r.scheduler.leaves, r.scheduler.generations, r.scheduler.cycles, r.scheduler.visits, r.scheduler.set_aside);
  message(r.optimization, r.delaunay, r.violations_seen, r.unused_points, r.tolerance, r.largest_move);
  for (auto* diagnostics : {&r.repairs, &r.warnings})
    message.each(*diagnostics, sizeof(Errc), [&](auto& diagnostic) { message(diagnostic); });
}

template <class Message, class Value>
void piece_fields(Message& message, Value& piece) {
  auto& m = piece.mesh;
  message(m.points, m.input_points, m.point_markers, m.point_attributes, m.cells, m.regions, m.leaves, m.subsegments, m.subfacets,
          m.names.regions, m.names.markers);
  message(piece.point_numbers, piece.first_point, piece.own_points, piece.first_cell, piece.first_subfacet,
          piece.first_subsegment);
  auto& t = piece.total;
  message(t.points, t.input_points, t.cells, t.subfacets, t.subsegments, t.attributes_per_point, t.point_markers, t.regions,
          t.leaves);
}

}  // namespace

template <int D>
void put_plc(MessageWriter& message, const Plc<D>& plc) {
  Writing writing(message);
  plc_fields(writing, plc);
}

template <int D>
Plc<D> get_plc(MessageReader& message) {
  Reading reading(message);
  Plc<D> plc;
  plc_fields(reading, plc);
  return plc;
}

template <int D>
void put_result(MessageWriter& message, const RefineResult<D>& result) {
  Writing writing(message);
  result_fields(writing, result);
}

template <int D>
RefineResult<D> get_result(MessageReader& message) {
  Reading reading(message);
  RefineResult<D> result;
  result_fields(reading, result);
  return result;
}

template <int D>
void put_piece(MessageWriter& message, const MeshPiece<D>& piece) {
  Writing writing(message);
  piece_fields(writing, piece);
}

template <int D>
MeshPiece<D> get_piece(MessageReader& message) {
  Reading reading(message);
  MeshPiece<D> piece;
  piece_fields(reading, piece);
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

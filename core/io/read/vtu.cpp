// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads the .vtu files that io/write/vtu.cpp makes, and refuses all others by name. Further arrays of point and cell data, as of
// a solution, are fields.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "io/field_formats.hpp"
#include "io/formats.hpp"
#include "io/read/vtu_arrays.hpp"
#include "scan/clean_name.hpp"

namespace pgdr::detail {
namespace {

std::int64_t read_dimension(VtuArrays& arrays) {
  const auto d = little_endian<std::int64_t>(arrays.bytes("FieldData/dimension", "Int64", 1, sizeof(std::int64_t)), 0);
  if (d != 2 && d != 3) arrays.fail(Errc::syntax, "FieldData/dimension", " is neither 2 nor 3");
  return d;
}

/// Puts a mesh together out of the arrays.
template <int D>
class GridReader {
 public:
  explicit GridReader(VtuArrays& arrays) : arrays_(arrays) {}

  OutputMesh<D> read(std::size_t& left_out) {
    read_mesh();
    arrays_.check_end();
    left_out = left_out_;
    return std::move(mesh_);
  }

  MeshPiece<D> read_piece() {
    MeshPiece<D> piece;
    const std::vector<std::uint64_t> of_whole = numbers("FieldData/piece", 7);
    auto& total = piece.total;
    read_mesh();
    std::uint64_t* const to[] = {&total.points,      &total.input_points, &total.cells,     &total.subfacets,
                                 &total.subsegments, &piece.first_point,  &piece.own_points};
    for (std::size_t k = 0; k < std::size(to); ++k) *to[k] = of_whole[k];
    total.attributes_per_point = arrays_.has(attributes) ? arrays_.components(attributes) : 0;
    total.point_markers = arrays_.has("PointData/marker");
    total.regions = arrays_.has("CellData/region");
    total.leaves = arrays_.has("CellData/leaf");
    if (mesh_.point_attributes.size() != mesh_.points.size() * total.attributes_per_point)
      arrays_.fail(Errc::syntax, attributes, " has not as many numbers as it says");
    piece.point_numbers = numbers("PointData/" + std::string(point_ids), arrays_.points());
    read_cell_ids(piece);
    arrays_.check_end();
    piece.mesh = std::move(mesh_);
    return piece;
  }

 private:
  void read_mesh() {
    if (read_dimension(arrays_) != D) arrays_.fail(Errc::syntax, "FieldData/dimension", " is not " + std::to_string(D));
    read_points();
    read_input_points();
    read_types();
    read_offsets();
    read_connectivity();
    read_labels();
    read_names();
    drop_mid_sides();
  }

  /// Pairs of a label and a dimension.
  void read_names() {
    constexpr std::string_view section = "FieldData/";
    for (const std::string& array : arrays_.names_in(section)) {
      std::string_view own = std::string_view(array).substr(section.size());
      if (std::count(std::begin(own_field_data), std::end(own_field_data), own) > 0) continue;
      if (own.starts_with(field_data_escape)) own.remove_prefix(field_data_escape.size());
      const std::string name = clean_name(own);
      const bool integers = arrays_.type(array) == "Int64";
      const auto count = static_cast<std::size_t>(arrays_.size(array) / sizeof(double));
      const std::string_view bytes = arrays_.bytes(array, integers ? "Int64" : "Float64", count, sizeof(double));
      const auto number = [&](std::size_t i) {
        return integers ? static_cast<double>(little_endian<std::int64_t>(bytes, i)) : little_endian<double>(bytes, i);
      };
      for (std::size_t i = 0; i + 1 < count; i += 2) give_name(array, name, number(i), number(i + 1));
      if (count % 2 != 0 || name.empty()) arrays_.fail(Errc::syntax, array, " has no pairs of a label and a dimension");
    }
  }
  void give_name(const std::string& array, const std::string& name, double label, double dimension) {
    const bool is_marker = dimension == D - 1 && label >= -2147483648.0 && label <= 2147483647.0 && label == std::floor(label);
    if (dimension == D && !std::isnan(label))
      mesh_.names.regions[label] = name;
    else if (is_marker)
      mesh_.names.markers[static_cast<int>(label)] = name;
    else
      arrays_.fail(Errc::syntax, array, " has no pairs of a label and a dimension");
  }

  /// Numbers that count or name something.
  std::vector<std::uint64_t> numbers(const std::string& name, std::size_t n) {
    const std::string_view bytes = arrays_.bytes(name, "Int64", n, sizeof(std::int64_t));
    std::vector<std::uint64_t> all(n);
    for (std::size_t i = 0; i < n; ++i) {
      const auto value = little_endian<std::int64_t>(bytes, i);
      if (value < 0) arrays_.fail(Errc::index_out_of_range, name, " has a number below 0");
      all[i] = static_cast<std::uint64_t>(value);
    }
    return all;
  }

  /// Those of the cells, of the subfacets and of the subsegments are successive each.
  void read_cell_ids(MeshPiece<D>& piece) {
    const std::string name = "CellData/" + std::string(cell_ids);
    const std::vector<std::uint64_t> ids = numbers(name, arrays_.cells());
    std::size_t at = 0;
    const auto take = [&](std::size_t count, std::uint64_t begin) {
      const std::uint64_t first = count == 0 ? begin : ids[at];
      if (first < begin) arrays_.fail(Errc::index_out_of_range, name, " has the number of a cell for something else");
      for (std::size_t i = 0; i < count; ++i, ++at)
        if (ids[at] != first + i) arrays_.fail(Errc::syntax, name, " has " + std::to_string(ids[at]) + " out of its order");
      return first - begin;
    };
    piece.first_cell = take(mesh_.cells.size(), 0);
    piece.first_subfacet = take(mesh_.subfacets.size(), piece.total.cells);
    piece.first_subsegment = take(mesh_.subsegments.size(), piece.total.cells + piece.total.subfacets);
  }

  void read_points() {
    const std::string_view xyz = arrays_.bytes("Points/Points", "Float64", 3 * arrays_.points(), sizeof(double));
    mesh_.points.resize(arrays_.points());
    for (std::size_t i = 0; i < mesh_.points.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = little_endian<double>(xyz, 3 * i + k);
        if (!std::isfinite(x)) arrays_.fail(Errc::not_finite, "Points/Points", " has a coordinate that is not finite");
        if (k < D)
          mesh_.points[i].x[k] = x;
        else if (x != 0)
          arrays_.fail(Errc::syntax, "Points/Points", " has a third coordinate that is not 0, in 2D");
      }
    }
    read_point_attributes();
    if (!arrays_.has("PointData/marker")) return;
    const std::string_view markers = arrays_.bytes("PointData/marker", "Int32", arrays_.points(), sizeof(std::int32_t));
    mesh_.point_markers.resize(arrays_.points());
    for (std::size_t i = 0; i < mesh_.point_markers.size(); ++i) mesh_.point_markers[i] = little_endian<std::int32_t>(markers, i);
  }

  void read_point_attributes() {
    const std::string& name = attributes;
    if (!arrays_.has(name)) return;
    const std::uint64_t count = arrays_.size(name) / sizeof(double);
    if (arrays_.points() == 0 ? count != 0 : count % arrays_.points() != 0)
      arrays_.fail(Errc::syntax, name, " has not as many numbers for each point");
    const std::string_view values = arrays_.bytes(name, "Float64", static_cast<std::size_t>(count), sizeof(double));
    mesh_.point_attributes.resize(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < mesh_.point_attributes.size(); ++i) mesh_.point_attributes[i] = little_endian<double>(values, i);
  }

  void read_input_points() {
    const std::string name = "FieldData/input_points";
    const auto n = little_endian<std::int64_t>(arrays_.bytes(name, "Int64", 1, sizeof(std::int64_t)), 0);
    if (n < 0 || static_cast<std::uint64_t>(n) > arrays_.points())
      arrays_.fail(Errc::index_out_of_range, name, " is not a number of points");
    mesh_.input_points = static_cast<std::size_t>(n);
  }

  /// Cells, subfacets, subsegments, in this order.
  void read_types() {
    const std::string_view types = arrays_.bytes("Cells/types", "UInt8", arrays_.cells(), 1);
    is_second_order_ = !types.empty() && static_cast<std::uint8_t>(types[0]) > 20;  // VTK's numbers: linear, quadratic
    const std::uint8_t line = is_second_order_ ? 21 : 3, triangle = is_second_order_ ? 22 : 5,
                       tetrahedron = is_second_order_ ? 24 : 10;
    std::size_t at = 0;
    const auto run = [&](std::uint8_t type) {
      const std::size_t begin = std::exchange(at, std::min(types.find_first_not_of(static_cast<char>(type), at), types.size()));
      return at - begin;
    };
    mesh_.cells.resize(run(D == 3 ? tetrahedron : triangle));
    if constexpr (D == 3) mesh_.subfacets.resize(run(triangle));
    mesh_.subsegments.resize(run(line));
    if (at != types.size()) arrays_.fail(Errc::syntax, "Cells/types", " has a type that does not belong where it stands");
  }

  /// Of an element of so many corners.
  std::size_t nodes(std::size_t corners) const { return is_second_order_ ? corners * (corners + 1) / 2 : corners; }

  void read_offsets() {
    const std::string_view offsets = arrays_.bytes("Cells/offsets", "Int64", arrays_.cells(), sizeof(std::int64_t));
    std::int64_t end = 0;
    for (std::size_t i = 0; i < arrays_.cells(); ++i) {
      end += static_cast<std::int64_t>(nodes(i < mesh_.cells.size()                            ? D + 1
                                             : i < mesh_.cells.size() + mesh_.subfacets.size() ? 3
                                                                                               : 2));
      if (little_endian<std::int64_t>(offsets, i) != end)
        arrays_.fail(Errc::syntax, "Cells/offsets", " does not agree with the types of the cells");
    }
  }

  void read_connectivity() {
    const std::string name = "Cells/connectivity";
    const std::size_t count = nodes(D + 1) * mesh_.cells.size() + nodes(3) * mesh_.subfacets.size() +
                              nodes(2) * mesh_.subsegments.size();
    const std::string_view ids = arrays_.bytes(name, "Int64", count, sizeof(std::int64_t));
    std::size_t at = 0;
    const auto next = [&] {
      const auto id = static_cast<std::uint64_t>(little_endian<std::int64_t>(ids, at++));
      if (id >= arrays_.points()) arrays_.fail(Errc::index_out_of_range, name, " refers to a point that is not there");
      return static_cast<std::uint32_t>(id);
    };
    const auto fill = [&](auto& vertices) {
      for (std::uint32_t& v : vertices) last_corner_ = std::max<std::size_t>(last_corner_, v = next());
      for (std::size_t k = vertices.size(); k < nodes(vertices.size()); ++k)
        first_mid_side_ = std::min<std::size_t>(first_mid_side_, next());
    };
    for (auto& c : mesh_.cells) fill(c);
    for (auto& c : mesh_.subfacets) fill(c.vertices);
    for (auto& c : mesh_.subsegments) fill(c.vertices);
  }

  /// Nodes in the middles of edges lie behind all corners in what we write; others' files are not read.
  void drop_mid_sides() {
    const std::size_t kept = std::min(first_mid_side_, arrays_.points());
    left_out_ = arrays_.points() - kept;
    if (left_out_ > 0 && (last_corner_ >= kept || mesh_.input_points > kept))
      arrays_.fail(Errc::unknown_format, "Cells/connectivity", " has a node in the middle of an edge before a corner");
    mesh_.point_attributes.resize(mesh_.points.empty() ? 0 : mesh_.point_attributes.size() / mesh_.points.size() * kept);
    mesh_.points.resize(kept);
    if (!mesh_.point_markers.empty()) mesh_.point_markers.resize(kept);
  }

  void read_labels() {
    const std::string_view markers = arrays_.bytes("CellData/marker", "Int32", arrays_.cells(), sizeof(std::int32_t));
    std::size_t at = mesh_.cells.size();
    for (auto& c : mesh_.subfacets) c.marker = little_endian<std::int32_t>(markers, at++);
    for (auto& c : mesh_.subsegments) c.marker = little_endian<std::int32_t>(markers, at++);
    read_leaves();
    if (!arrays_.has("CellData/region")) return;
    const std::string_view regions = arrays_.bytes("CellData/region", "Float64", arrays_.cells(), sizeof(double));
    mesh_.regions.resize(mesh_.cells.size());
    for (std::size_t i = 0; i < mesh_.regions.size(); ++i) mesh_.regions[i] = little_endian<double>(regions, i);
  }

  void read_leaves() {
    const std::string name = "CellData/leaf";
    if (!arrays_.has(name)) return;
    const std::string_view leaves = arrays_.bytes(name, "Int64", arrays_.cells(), sizeof(std::int64_t));
    mesh_.leaves.resize(mesh_.cells.size());
    for (std::size_t i = 0; i < mesh_.leaves.size(); ++i) {
      const auto leaf = little_endian<std::int64_t>(leaves, i);
      if (leaf < 0 || leaf > std::int64_t{0xffffffff}) arrays_.fail(Errc::index_out_of_range, name, " has no leaf of a cell");
      mesh_.leaves[i] = static_cast<std::uint32_t>(leaf);
    }
  }

  static inline const std::string attributes = "PointData/attributes";
  VtuArrays& arrays_;
  OutputMesh<D> mesh_;
  bool is_second_order_ = false;
  std::size_t last_corner_ = 0, first_mid_side_ = ~std::size_t{0}, left_out_ = 0;
};

template <int D>
std::pair<std::size_t, std::size_t> rows_in(VtuArrays& arrays) {
  std::size_t left_out = 0;
  const OutputMesh<D> mesh = GridReader<D>(arrays).read(left_out);
  return {mesh.points.size(), mesh.cells.size()};
}

/// How many points and cells of the mesh there are: the first of those of the file, before nodes in the middles of edges, and
/// before its constraints.
std::pair<std::size_t, std::size_t> count_rows(VtuArrays& arrays) {
  const bool is_spatial = read_dimension(arrays) == 3;
  const char kind = is_spatial ? 10 : 5;
  const std::string_view types = arrays.bytes("Cells/types", "UInt8", arrays.cells(), 1);
  if (!types.empty() && types[0] > 20) return is_spatial ? rows_in<3>(arrays) : rows_in<2>(arrays);
  return {arrays.points(), std::min(types.find_first_not_of(kind), types.size())};
}

}  // namespace

std::vector<MeshField> read_vtu_fields(std::string_view text, const std::filesystem::path& file) {
  const std::string name = file.string();
  VtuArrays arrays(text, name);
  const auto [points, cells] = count_rows(arrays);
  std::vector<MeshField> fields;
  for (const std::string_view section : {"PointData/", "CellData/"})
    for (const std::string& array : arrays.names_in(section)) {
      const bool of_points = section == "PointData/";
      std::string_view name_there = std::string_view(array).substr(section.size());
      if (of_points ? std::ranges::count(own_point_data, name_there) > 0 : std::ranges::count(own_cell_data, name_there) > 0)
        continue;
      constexpr std::uint64_t most_components = 1024;  // no count of the file overflows
      if (const std::uint64_t n = arrays.components(array); n == 0 || n > most_components)
        arrays.fail(Errc::count_too_large, array, " has " + std::to_string(n) + " components");
      if (name_there.starts_with(field_data_escape)) name_there.remove_prefix(field_data_escape.size());
      fields.push_back({std::string(name_there), of_points, static_cast<std::size_t>(arrays.components(array)),
                        arrays.numbers(array, of_points ? points : cells, of_points ? arrays.points() : arrays.cells()),
                        !arrays.type(array).starts_with("Float")});
    }
  arrays.check_end();
  return fields;
}

template <int D>
OutputMesh<D> read_vtu(std::string_view text, const std::filesystem::path& file, std::size_t& left_out) {
  const std::string name = file.string();
  VtuArrays arrays(text, name);
  return GridReader<D>(arrays).read(left_out);
}

template <int D>
MeshPiece<D> read_vtu_piece(std::string_view text, const std::filesystem::path& file) {
  const std::string name = file.string();
  VtuArrays arrays(text, name);
  return GridReader<D>(arrays).read_piece();
}

template <int D>
StatedPeriods read_vtu_periods(std::string_view text, const std::filesystem::path& file) {
  const std::string name = file.string();
  VtuArrays arrays(text, name);
  StatedPeriods stated;
  const std::string sides = "FieldData/" + std::string(periodic_sides_array), of = "PointData/periodic_of",
                    motions = "FieldData/" + std::string(periodic_motions_array);
  if (!arrays.has(sides)) return stated;
  if (read_dimension(arrays) != D) arrays.fail(Errc::syntax, "FieldData/dimension", " is not " + std::to_string(D));
  const auto count = static_cast<std::size_t>(arrays.size(sides) / (2 * sizeof(std::int64_t)));
  const std::string_view markers = arrays.bytes(sides, "Int64", 2 * count, sizeof(std::int64_t));
  constexpr std::size_t numbers = D * (D + 1);
  const std::string_view motion = arrays.bytes(motions, "Float64", numbers * count, sizeof(double));
  for (std::size_t i = 0; i < count; ++i) {
    PeriodicPairs& pairs = stated.pairs.emplace_back();
    for (const auto& [marker, k] : {std::pair{&pairs.from, 2 * i}, {&pairs.to, 2 * i + 1}}) {
      const auto value = little_endian<std::int64_t>(markers, k);
      *marker = static_cast<int>(value);
      if (*marker != value) arrays.fail(Errc::syntax, sides, " has a number that is no marker");
    }
    for (std::size_t k = 0; k < numbers; ++k) pairs.motion.push_back(little_endian<double>(motion, numbers * i + k));
  }
  const std::string_view vertices = arrays.bytes(of, "Int64", arrays.points(), sizeof(std::int64_t));
  for (std::size_t v = 0; v < arrays.points(); ++v) {
    const auto first = little_endian<std::int64_t>(vertices, v);
    if (first < 0 || first > static_cast<std::int64_t>(v)) arrays.fail(Errc::index_out_of_range, of, " is not the least vertex");
    stated.periodic_of.push_back(static_cast<std::uint32_t>(first));
  }
  return stated;
}

int vtu_dimension(std::string_view text, const std::filesystem::path& file) {
  const std::string name = file.string();
  VtuArrays arrays(text, name);
  return static_cast<int>(read_dimension(arrays));
}

template OutputMesh<2> read_vtu<2>(std::string_view, const std::filesystem::path&, std::size_t&);
template OutputMesh<3> read_vtu<3>(std::string_view, const std::filesystem::path&, std::size_t&);
template StatedPeriods read_vtu_periods<2>(std::string_view, const std::filesystem::path&);
template StatedPeriods read_vtu_periods<3>(std::string_view, const std::filesystem::path&);
template MeshPiece<2> read_vtu_piece<2>(std::string_view, const std::filesystem::path&);
template MeshPiece<3> read_vtu_piece<3>(std::string_view, const std::filesystem::path&);

}  // namespace pgdr::detail

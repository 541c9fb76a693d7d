// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "io/write/vtu_layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <span>
#include <utility>

#include "io/field_formats.hpp"
#include "io/formats.hpp"
#include "io/write/valid_names.hpp"
#include "output/piece_join.hpp"

namespace pgdr::detail {
namespace {

using Number = std::uint64_t;

std::string bytes_of(std::initializer_list<Number> numbers) {
  TextBuffer bytes;
  for (const Number n : numbers) bytes.put_binary(static_cast<std::int64_t>(n));
  return std::string(bytes.text());
}

/// What puts rows [first, last) of some, by putting each.
template <class PutRow>
PutBlock block(PutRow put_row) {
  return [put_row](TextBuffer& bytes, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) put_row(bytes, i);
  };
}

template <int D>
class Layout {
 public:
  explicit Layout(const VtuPart<D>& part) : part_(part), mesh_(part.mesh), total_(part.total) {
    if (!part.point_numbers) return;
    const auto& numbers = *part.point_numbers;
    own_begin_ = static_cast<std::size_t>(std::lower_bound(numbers.begin(), numbers.end(), part.first_point) - numbers.begin());
  }

  std::vector<VtuArray> arrays() && {
    add_field_data();
    add_point_data();
    add_cell_data();
    const std::string vector = " NumberOfComponents=\"3\"";
    add_point_rows("Points", "Float64", "Points", vector, 24, [mesh = mesh_, own = own_begin_](TextBuffer& bytes, std::size_t i) {
      for (int k = 0; k < 3; ++k) bytes.put_binary(k < D ? mesh->points[own + i][k] : 0.0);
    });
    add_connectivity();
    add_offsets();
    add_types();
    // The last array announced comes first. VTK takes any order; meshio, which replaces offsets one after the other and looks
    // arrays up by offset, finds the right ones only in this.
    Number at = 0;
    for (auto a = arrays_.rbegin(); a != arrays_.rend(); ++a) {
      a->offset = at;
      at += sizeof(Number) + a->bytes;
    }
    return std::move(arrays_);
  }

 private:
  VtuArray& add(std::string_view section, std::string_view type, std::string_view name, std::string shape, Number bytes) {
    VtuArray& array = arrays_.emplace_back();
    array.section = section;
    array.type = type;
    array.name = name;
    array.shape = std::move(shape);
    array.bytes = bytes;
    return array;
  }
  void add_content(std::string_view name, std::initializer_list<Number> numbers) {
    const std::string shape = " NumberOfTuples=\"" + std::to_string(numbers.size()) + "\"";
    add("FieldData", "Int64", name, shape, sizeof(Number) * numbers.size()).content = bytes_of(numbers);
  }
  template <class PutRow>
  void add_point_rows(std::string_view section, std::string_view type, std::string_view name, std::string shape,
                      std::size_t row_bytes, PutRow put_row) {
    VtuArray& array = add(section, type, name, std::move(shape), row_bytes * total_.points);
    array.rows.push_back({row_bytes * part_.first_point, static_cast<std::size_t>(part_.own_points), block(put_row)});
  }
  /// `at`: where the rows of cells, subfacets and subsegments begin, and the array ends.
  template <class PutCell, class PutSubfacet, class PutSubsegment>
  void add_grid_rows(std::string_view section, std::string_view type, std::string_view name, std::string shape,
                     const std::array<Number, 4>& at, const std::array<std::size_t, 3>& row_bytes, PutCell put_cell,
                     PutSubfacet put_subfacet, PutSubsegment put_subsegment) {
    VtuArray& array = add(section, type, name, std::move(shape), at[3]);
    array.rows.push_back({at[0] + row_bytes[0] * part_.first_cell, mesh_->cells.size(), block(put_cell)});
    array.rows.push_back({at[1] + row_bytes[1] * part_.first_subfacet, mesh_->subfacets.size(), block(put_subfacet)});
    array.rows.push_back({at[2] + row_bytes[2] * part_.first_subsegment, mesh_->subsegments.size(), block(put_subsegment)});
  }
  /// An array with as many bytes for each cell, subfacet and subsegment.
  template <class PutCell, class PutSubfacet, class PutSubsegment>
  void add_cell_rows(std::string_view section, std::string_view type, std::string_view name, std::string shape, std::size_t row,
                     PutCell put_cell, PutSubfacet put_subfacet, PutSubsegment put_subsegment) {
    const Number subfacets = total_.cells, subsegments = subfacets + total_.subfacets, end = subsegments + total_.subsegments;
    add_grid_rows(section, type, name, std::move(shape), {0, row * subfacets, row * subsegments, row * end}, {row, row, row},
                  put_cell, put_subfacet, put_subsegment);
  }

  void add_names() {
    std::map<std::string, std::vector<double>> labels;
    const Names names = valid_names(mesh_->names, text_names);
    for (const auto& [label, name] : names.regions) labels[name].insert(labels[name].end(), {label, double{D}});
    for (const auto& [marker, name] : names.markers) labels[name].insert(labels[name].end(), {double(marker), double{D - 1}});
    for (const auto& [name, pairs] : labels) {
      const bool is_own = std::count(std::begin(own_field_data), std::end(own_field_data), name) > 0;
      const bool integers = std::all_of(pairs.begin(), pairs.end(), [](double x) { return is_integer(x); });
      VtuArray& array = add("FieldData", integers ? "Int64" : "Float64",
                            (is_own || name.starts_with(field_data_escape) ? std::string(field_data_escape) : "") + name,
                            " NumberOfTuples=\"" + std::to_string(pairs.size()) + "\"", sizeof(double) * pairs.size());
      TextBuffer bytes;
      for (const double x : pairs) integers ? bytes.put_binary(static_cast<std::int64_t>(x)) : bytes.put_binary(x);
      array.content = bytes.text();
    }
  }
  static bool is_integer(double x) {
    constexpr double most = 9007199254740992;  // 2^53
    return x >= -most && x <= most && x == std::floor(x) && !(x == 0 && std::signbit(x));
  }

  void add_field_data() {
    add_names();
    add_content("dimension", {D});
    add_content("input_points", {total_.input_points});
    add_sides();
    if (const auto* piece = part_.piece) {
      const auto& of_whole = piece->total;
      add_content("piece", {of_whole.points, of_whole.input_points, of_whole.cells, of_whole.subfacets, of_whole.subsegments,
                            piece->first_point, piece->own_points});
    }
  }

  void add_sides() {
    if (!part_.periodic) return;
    const std::vector<PeriodicPairs>& sides = *part_.periodic;
    TextBuffer markers, motions;
    for (const PeriodicPairs& p : sides) {
      for (const int marker : {p.from, p.to}) markers.put_binary(std::int64_t{marker});
      for (const double x : p.motion) motions.put_binary(x);
    }
    add("FieldData", "Int64", periodic_sides_array,
        " NumberOfComponents=\"2\" NumberOfTuples=\"" + std::to_string(sides.size()) + '"', markers.text().size())
        .content = markers.text();
    add("FieldData", "Float64", periodic_motions_array,
        " NumberOfComponents=\"" + std::to_string(D * (D + 1)) + "\" NumberOfTuples=\"" + std::to_string(sides.size()) + '"',
        motions.text().size())
        .content = motions.text();
  }

  void add_point_data() {
    if (part_.piece)
      add_point_rows("PointData", "Int64", point_ids, " IdType=\"1\"", 8,
                     [piece = part_.piece](TextBuffer& bytes, std::size_t i) {
                       bytes.put_binary(static_cast<std::int64_t>(piece->point_numbers[i]));
                     });
    if (total_.point_markers)
      add_point_rows("PointData", "Int32", "marker", "", 4, [mesh = mesh_, own = own_begin_](TextBuffer& bytes, std::size_t i) {
        bytes.put_binary(std::int32_t{mesh->point_markers[own + i]});
      });
    if (!part_.periodic_of.empty())
      add_point_rows("PointData", "Int64", "periodic_of", "", 8,
                     [of = &part_.periodic_of](TextBuffer& bytes, std::size_t i) { bytes.put_binary(std::int64_t{(*of)[i]}); });
    const auto columns = static_cast<std::size_t>(total_.attributes_per_point);
    if (columns > 0)
      add_point_rows("PointData", "Float64", "attributes", " NumberOfComponents=\"" + std::to_string(columns) + "\"", 8 * columns,
                     [mesh = mesh_, own = own_begin_, columns](TextBuffer& bytes, std::size_t i) {
                       for (std::size_t k = 0; k < columns; ++k)
                         bytes.put_binary(mesh->point_attributes[(own + i) * columns + k]);
                     });
    add_fields(false);
  }

  /// Further arrays, whose names are not those of the mesh's own.
  void add_fields(bool of_cells) {
    if (!part_.fields) return;
    const std::span<const std::string_view> own = of_cells ? std::span<const std::string_view>(own_cell_data)
                                                           : std::span<const std::string_view>(own_point_data);
    for (const MeshField& field : *part_.fields) {
      if (field.of_points == of_cells) continue;
      const bool is_own = std::ranges::count(own, field.name) > 0 || field.name.starts_with(field_data_escape);
      const std::string name = (is_own ? std::string(field_data_escape) : "") + field.name;
      const std::string shape = field.components == 1 ? "" : " NumberOfComponents=\"" + std::to_string(field.components) + "\"";
      const auto put = [&field](TextBuffer& bytes, std::size_t i) {
        for (std::size_t k = i * field.components; k < (i + 1) * field.components; ++k)
          field.is_integer ? bytes.put_binary(static_cast<std::int64_t>(field.values[k])) : bytes.put_binary(field.values[k]);
      };
      const auto put_nothing = [width = field.components](TextBuffer& bytes, std::size_t) {
        for (std::size_t k = 0; k < width; ++k) bytes.put_binary(std::int64_t{0});  // 0.0 has the same bytes
      };
      const std::string_view type = field.is_integer ? "Int64" : "Float64";
      if (of_cells)
        add_cell_rows("CellData", type, name, shape, 8 * field.components, put, put_nothing, put_nothing);
      else
        add_point_rows("PointData", type, name, shape, 8 * field.components, put);
    }
  }

  void add_cell_data() {
    const auto put_nothing = [](auto nothing) {
      return [nothing](TextBuffer& bytes, std::size_t) { bytes.put_binary(nothing); };
    };
    if (part_.piece) {
      const MeshPiece<D>& piece = *part_.piece;
      const auto from = [](Number first) {
        return [first](TextBuffer& bytes, std::size_t i) { bytes.put_binary(static_cast<std::int64_t>(first + i)); };
      };
      const Number subfacets = piece.total.cells, subsegments = subfacets + piece.total.subfacets;
      add_cell_rows("CellData", "Int64", cell_ids, " IdType=\"1\"", 8, from(piece.first_cell),
                    from(subfacets + piece.first_subfacet), from(subsegments + piece.first_subsegment));
    }
    if (total_.leaves)
      add_cell_rows(
          "CellData", "Int64", "leaf", "", 8,
          [mesh = mesh_](TextBuffer& bytes, std::size_t i) { bytes.put_binary(std::int64_t{mesh->leaves[i]}); },
          put_nothing(std::int64_t{-1}), put_nothing(std::int64_t{-1}));
    if (total_.regions)
      add_cell_rows(
          "CellData", "Float64", "region", "", 8,
          [mesh = mesh_](TextBuffer& bytes, std::size_t i) { bytes.put_binary(mesh->regions[i]); }, put_nothing(0.0),
          put_nothing(0.0));
    add_cell_rows(
        "CellData", "Int32", "marker", "", 4, put_nothing(std::int32_t{0}),
        [mesh = mesh_](TextBuffer& bytes, std::size_t i) { bytes.put_binary(std::int32_t{mesh->subfacets[i].marker}); },
        [mesh = mesh_](TextBuffer& bytes, std::size_t i) { bytes.put_binary(std::int32_t{mesh->subsegments[i].marker}); });
    add_fields(true);
  }

  void add_types() {
    const bool second = part_.middles != nullptr;  // VTK's numbers: linear, quadratic
    const auto put = [](char type) { return [type](TextBuffer& bytes, std::size_t) { bytes.put(type); }; };
    const char line = second ? 21 : 3, triangle = second ? 22 : 5, tetrahedron = second ? 24 : 10;
    add_cell_rows("Cells", "UInt8", "types", "", 1, put(D == 3 ? tetrahedron : triangle), put(triangle), put(line));
  }

  /// Of an element of so many corners.
  std::size_t nodes(std::size_t corners) const { return part_.middles ? nodes_of_second_order(corners) : corners; }

  void add_connectivity() {
    if (part_.middles) return add_connectivity_of_second_order();
    // A look at the numbers for each corner would cost the writer of a whole mesh a tenth of its time.
    if (const auto* numbers = part_.point_numbers)
      add_connectivity([numbers](std::uint32_t v) { return static_cast<std::int64_t>((*numbers)[v]); });
    else
      add_connectivity([](std::uint32_t v) { return std::int64_t{v}; });
  }
  template <class NumberOf>
  void add_connectivity(const NumberOf& number_of) {
    put_connectivity([number_of](TextBuffer& bytes, const auto& vertices) {
      for (const std::uint32_t v : vertices) bytes.put_binary(number_of(v));
    });
  }
  void add_connectivity_of_second_order() {
    put_connectivity([middles = part_.middles](TextBuffer& bytes, const auto& vertices) {
      for (const std::uint32_t v : vertices) bytes.put_binary(std::int64_t{v});
      for (std::size_t e = 0; e < mid_sides_of(vertices.size()); ++e)
        bytes.put_binary(std::int64_t{middles->between(vertices[vtk_mid_sides[e][0]], vertices[vtk_mid_sides[e][1]])});
    });
  }
  template <class Put>
  void put_connectivity(const Put& put) {
    const std::size_t cell = 8 * nodes(D + 1), subfacet = 8 * nodes(3), subsegment = 8 * nodes(2);
    const Number subfacets = cell * total_.cells, subsegments = subfacets + subfacet * total_.subfacets;
    add_grid_rows(
        "Cells", "Int64", "connectivity", "", {0, subfacets, subsegments, subsegments + subsegment * total_.subsegments},
        {cell, subfacet, subsegment}, [mesh = mesh_, put](TextBuffer& bytes, std::size_t i) { put(bytes, mesh->cells[i]); },
        [mesh = mesh_, put](TextBuffer& bytes, std::size_t i) { put(bytes, mesh->subfacets[i].vertices); },
        [mesh = mesh_, put](TextBuffer& bytes, std::size_t i) { put(bytes, mesh->subsegments[i].vertices); });
  }

  void add_offsets() {
    const auto from = [](Number begin, Number first, Number corners) {
      return [begin, first, corners](TextBuffer& bytes, std::size_t i) {
        bytes.put_binary(static_cast<std::int64_t>(begin + (first + i + 1) * corners));
      };
    };
    const Number subfacets = nodes(D + 1) * total_.cells, subsegments = subfacets + nodes(3) * total_.subfacets;
    add_cell_rows("Cells", "Int64", "offsets", "", 8, from(0, part_.first_cell, nodes(D + 1)),
                  from(subfacets, part_.first_subfacet, nodes(3)), from(subsegments, part_.first_subsegment, nodes(2)));
  }

  const VtuPart<D>& part_;
  const OutputMesh<D>* mesh_;  // what puts rows keeps it, but not this
  const typename MeshPiece<D>::Totals& total_;
  std::size_t own_begin_ = 0;  // in mesh_.points, of the rows of points
  std::vector<VtuArray> arrays_;
};

/// The announcements of one section.
void put_section(std::string& out, std::string_view section, std::string_view attributes, const std::vector<VtuArray>& arrays) {
  const auto put = [&out](std::initializer_list<std::string_view> parts) {
    for (const std::string_view part : parts) out += part;
  };
  put({"<", section, attributes, ">\n"});
  for (const VtuArray& a : arrays)
    if (a.section == section)
      put({"<DataArray type=\"", a.type, "\" Name=\"", xml_escaped(a.name), "\"", a.shape, " format=\"appended\" offset=\"",
           std::to_string(a.offset), "\"/>\n"});
  put({"</", section, ">\n"});
}

}  // namespace

template <int D>
VtuPart<D> VtuPart<D>::whole(const OutputMesh<D>& mesh) {
  VtuPart part{&mesh, totals_of<D>(mesh)};
  part.own_points = part.total.points;
  return part;
}

template <int D>
VtuPart<D> VtuPart<D>::rows_of(const MeshPiece<D>& piece) {
  return {&piece.mesh,      piece.total,      &piece.point_numbers, piece.first_point,
          piece.own_points, piece.first_cell, piece.first_subfacet, piece.first_subsegment,
          nullptr};
}

template <int D>
VtuPart<D> VtuPart<D>::file_of_piece(const MeshPiece<D>& piece) {
  VtuPart part = whole(piece.mesh);
  part.total.attributes_per_point = piece.total.attributes_per_point;  // a piece without rows has all arrays of the others
  part.total.point_markers = piece.total.point_markers;
  part.total.regions = piece.total.regions;
  part.total.leaves = piece.total.leaves;
  part.piece = &piece;
  return part;
}

template <int D>
std::vector<VtuArray> arrays_of(const VtuPart<D>& part) {
  return Layout<D>(part).arrays();
}

template <int D>
std::string vtu_head(const typename MeshPiece<D>::Totals& total, const std::vector<VtuArray>& arrays) {
  const bool numbered = std::any_of(arrays.begin(), arrays.end(), [](const VtuArray& a) { return a.name == point_ids; });
  std::string out =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "<UnstructuredGrid>\n";
  put_section(out, "FieldData", "", arrays);
  out += "<Piece NumberOfPoints=\"" + std::to_string(total.points) + "\" NumberOfCells=\"" +
         std::to_string(total.cells + total.subfacets + total.subsegments) + "\">\n";
  put_section(out, "PointData", numbered ? " GlobalIds=\"GlobalPointIds\"" : "", arrays);
  put_section(out, "CellData", numbered ? " GlobalIds=\"GlobalCellIds\"" : "", arrays);
  for (const std::string_view section : {"Points", "Cells"}) put_section(out, section, "", arrays);
  return out + "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
}

template struct VtuPart<2>;
template struct VtuPart<3>;
template std::vector<VtuArray> arrays_of<2>(const VtuPart<2>&);
template std::vector<VtuArray> arrays_of<3>(const VtuPart<3>&);
template std::string vtu_head<2>(const MeshPiece<2>::Totals&, const std::vector<VtuArray>&);
template std::string vtu_head<3>(const MeshPiece<3>::Totals&, const std::vector<VtuArray>&);

}  // namespace pgdr::detail

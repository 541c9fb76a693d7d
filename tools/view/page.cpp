// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "view/page.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <ostream>
#include <type_traits>
#include <utility>

#include "json.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/error.hpp"
#include "pgdr/quality.hpp"
#include "pgdr/version.hpp"
#include "view/colors.hpp"
#include "view/page_text.hpp"

namespace pgdr::tool {
namespace {

/// Writes bytes as base64 (RFC 4648).
void write_base64(const std::vector<unsigned char>& bytes, std::ostream& out) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  constexpr std::size_t most = 1 << 16;  // characters at once
  std::string text;
  text.reserve(most + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? digits[group >> (18 - 6 * k) & 63] : '=';
    if (text.size() < most) continue;
    out << text;
    text.clear();
  }
  out << text;
}

template <class T>
constexpr const char* type_name() {
  if constexpr (std::is_same_v<T, float>) return "f32";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "u8";
  if constexpr (std::is_same_v<T, std::uint16_t>) return "u16";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "u32";
}

/// The arrays of a page, and what their JSON says of them.
class ArrayWriter {
 public:
  explicit ArrayWriter(std::ostream& out) : out_(out) {}

  template <class T>
  void write(const std::string& name, const std::vector<T>& numbers, std::size_t components) {
    std::vector<unsigned char> bytes(numbers.size() * sizeof(T));
    if (!numbers.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
    if constexpr (std::endian::native == std::endian::big)
      for (auto at = bytes.begin(); at != bytes.end(); at += sizeof(T)) std::reverse(at, at + sizeof(T));
    out_ << "<script type=\"text/plain\" id=\"pgdr-" << name << "\">";
    write_base64(bytes, out_);
    out_ << "</script>\n";
    about_.set(name, JsonObject{{"type", type_name<T>()}, {"components", components}, {"rows", numbers.size() / components}});
  }

  /// Numbers below `end`, in as few bytes each as these need.
  void write_numbers(const std::string& name, const std::vector<std::uint32_t>& numbers, std::size_t end) {
    if (end <= 0x100)
      write(name, std::vector<std::uint8_t>(numbers.begin(), numbers.end()), 1);
    else if (end <= 0x10000)
      write(name, std::vector<std::uint16_t>(numbers.begin(), numbers.end()), 1);
    else
      write(name, numbers, 1);
  }

  const JsonObject& about() const { return about_; }

 private:
  std::ostream& out_;
  JsonObject about_;
};

/// Where the points lie, and what they are written as.
template <int D>
struct Place {
  Point<D> low, high, origin;
  double scale = 1;

  explicit Place(const OutputMesh<D>& mesh) {
    low.x.fill(std::numeric_limits<double>::infinity());
    high.x.fill(-std::numeric_limits<double>::infinity());
    for (const auto& cell : mesh.cells)  // points of no cell may lie far away
      for (const auto v : cell)
        for (int k = 0; k < D; ++k) {
          low[k] = std::min(low[k], mesh.points[v][k]);
          high[k] = std::max(high[k], mesh.points[v][k]);
        }
    double half = 0;
    for (int k = 0; k < D; ++k) {
      origin[k] = 0.5 * low[k] + 0.5 * high[k];
      half = std::max(half, 0.5 * high[k] - 0.5 * low[k]);
    }
    if (half > 0) scale = std::ldexp(1.0, std::ilogb(half) + 1);
  }
};

template <int D>
double measure_of(const Simplex<D>& s) {
  const auto edge = [&s](int i, int k) { return s[static_cast<std::size_t>(i)][k] - s[0][k]; };
  if constexpr (D == 2) return (edge(1, 0) * edge(2, 1) - edge(1, 1) * edge(2, 0)) / 2;
  const auto minor = [&edge](int k, int l) { return edge(2, k) * edge(3, l) - edge(2, l) * edge(3, k); };
  return (edge(1, 0) * minor(1, 2) + edge(1, 1) * minor(2, 0) + edge(1, 2) * minor(0, 1)) / 6;
}

template <int D>
void write_cells(const OutputMesh<D>& mesh, const Place<D>& place, ArrayWriter& arrays) {
  std::vector<float> points;
  points.reserve(D * mesh.points.size());
  for (const Point<D>& p : mesh.points)
    for (int k = 0; k < D; ++k) points.push_back(static_cast<float>((p[k] - place.origin[k]) / place.scale));
  arrays.write("points", points, D);
  std::vector<std::uint32_t> cells;
  cells.reserve((D + 1) * mesh.cells.size());
  for (const auto& cell : mesh.cells) cells.insert(cells.end(), cell.begin(), cell.end());
  arrays.write("cells", cells, D + 1);
}

/// What the page says of each cell.
template <int D>
void write_figures(const OutputMesh<D>& mesh, ArrayWriter& arrays) {
  const std::size_t n = mesh.cells.size();
  std::vector<float> measure(n), ratio(n), smallest(n), largest(n);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, 4096), [&](const tbb::blocked_range<std::size_t>& range) {
    for (std::size_t c = range.begin(); c < range.end(); ++c) {
      Simplex<D> s;
      for (std::size_t i = 0; i <= D; ++i) s[i] = mesh.points[mesh.cells[c][i]];
      const auto angles = angles_deg<D>(s);
      const auto [least, most] = std::minmax_element(angles.begin(), angles.end());
      measure[c] = static_cast<float>(measure_of(s));
      ratio[c] = static_cast<float>(std::sqrt(circumsphere(s).squared_radius / shortest_edge_squared(s)));
      smallest[c] = static_cast<float>(*least);
      largest[c] = static_cast<float>(*most);
    }
  });
  arrays.write("volume", measure, 1);
  arrays.write("radius_edge", ratio, 1);
  arrays.write("min_angle", smallest, 1);
  arrays.write("max_angle", largest, 1);
}

/// The labels, or the markers, that there are: the number of each, and the table of them with their names.
template <class Label>
struct LabelTable {
  std::map<Label, std::uint32_t> number;
  std::vector<Json> rows;

  LabelTable(const std::vector<Label>& labels, const std::map<Label, std::string>& names) {
    for (const Label label : labels) number.try_emplace(label);
    for (auto& [label, n] : number) {
      n = static_cast<std::uint32_t>(rows.size());
      const auto name = names.find(label);
      rows.push_back(JsonObject{{"label", label}, {"name", name == names.end() ? std::string() : name->second}});
    }
  }
};

/// The cells' labels and leaves. @returns the table of labels
template <int D>
std::vector<Json> write_regions(const OutputMesh<D>& mesh, ArrayWriter& arrays) {
  if (!mesh.leaves.empty()) arrays.write("leaf", mesh.leaves, 1);
  const LabelTable<double> table(mesh.regions, mesh.names.regions);
  if (mesh.regions.empty()) return table.rows;
  std::vector<std::uint32_t> numbers(mesh.cells.size());
  for (std::size_t c = 0; c < numbers.size(); ++c) numbers[c] = table.number.at(mesh.regions[c]);
  arrays.write_numbers("region", numbers, table.rows.size());
  return table.rows;
}

/// Subsegments and, in 3D, subfacets: vertices, and numbers of markers. @returns the table of markers
template <int D>
std::vector<Json> write_constraints(const OutputMesh<D>& mesh, ArrayWriter& arrays) {
  std::vector<int> markers;
  for (const auto& s : mesh.subsegments) markers.push_back(s.marker);
  for (const auto& s : mesh.subfacets) markers.push_back(s.marker);
  const LabelTable<int> table(markers, mesh.names.markers);
  const auto write = [&](const std::string& name, const auto& constraints, std::size_t corners) {
    std::vector<std::uint32_t> vertices, numbers;
    for (const auto& s : constraints) {
      vertices.insert(vertices.end(), s.vertices.begin(), s.vertices.end());
      numbers.push_back(table.number.at(s.marker));
    }
    arrays.write(name, vertices, corners);
    arrays.write_numbers(name + "_marker", numbers, table.rows.size());
  };
  write("subsegments", mesh.subsegments, 2);
  if (D == 3) write("subfacets", mesh.subfacets, 3);
  return table.rows;
}

/// The mesh's own numbers of points, as fields.
template <int D>
std::vector<MeshField> own_fields(const OutputMesh<D>& mesh) {
  std::vector<MeshField> fields;
  const std::size_t n = mesh.points.size();
  if (!mesh.point_markers.empty())
    fields.push_back({"point marker", true, 1, {mesh.point_markers.begin(), mesh.point_markers.end()}});
  if (n > 0 && !mesh.point_attributes.empty())
    fields.push_back({"attributes", true, mesh.point_attributes.size() / n, mesh.point_attributes});
  return fields;
}

/// The words of all colourings, in which fields are called as they are, or, where something else is, by what they are of, too.
template <int D>
std::vector<std::string> words_of(const OutputMesh<D>& mesh, const std::vector<MeshField>& fields) {
  std::vector<std::string> words{"quality", "dihedral", "radius_edge", "volume", "region", "marker"};
  if (!mesh.names.regions.empty()) words.emplace_back("name");
  if (!mesh.leaves.empty()) words.emplace_back("leaf");
  for (const MeshField& field : fields) {
    std::string word = field.name;
    while (std::find(words.begin(), words.end(), word) != words.end()) word += field.of_points ? " (points)" : " (cells)";
    words.push_back(word);
  }
  return words;
}

/// @param words  of colourings, the last of them those of the fields
std::vector<Json> write_fields(const std::vector<MeshField>& fields, const std::vector<std::string>& words, ArrayWriter& arrays) {
  std::vector<Json> rows;
  for (const MeshField& field : fields) {
    const std::string array = "field" + std::to_string(rows.size());
    arrays.write(array, std::vector<float>(field.values.begin(), field.values.end()), field.components);
    rows.push_back(JsonObject{{"name", words[words.size() - fields.size() + rows.size()]},
                              {"of", field.of_points ? "points" : "cells"},
                              {"array", array}});
  }
  return rows;
}

template <std::size_t N>
std::vector<std::string> hex_of(const std::array<Color, N>& colors) {
  std::vector<std::string> texts;
  for (const Color& c : colors) texts.push_back(hex(c));
  return texts;
}

Json colors() {
  constexpr std::size_t hues = 256;
  std::vector<std::string> palette;
  for (std::size_t i = 0; i < hues; ++i) palette.push_back(hex(region_color(i)));
  return JsonObject{{"quality", hex_of(quality_stops)},
                    {"angle_limits", angle_limits},
                    {"angle_classes", hex_of(angle_classes)},
                    {"palette", palette},
                    {"plain", hex(plain_cell)},
                    {"ink", hex(ink)}};
}

/// JSON that may stand in a <script>: no "</script>" ends it.
std::string within_script(const std::string& json) {
  std::string text;
  for (const char c : json) c == '<' ? text.append("\\u003c") : text.append(1, c);
  return text;
}

}  // namespace

bool has_page() { return !page_head.empty(); }

template <int D>
void write_page(const OutputMesh<D>& mesh, std::vector<MeshField> fields, const PageStart& start, std::ostream& out) {
  const auto refuse = [](const std::string& why) { throw UsageError({.code = Errc::bad_option, .message = why}); };
  if (!has_page()) refuse("this pgdr was built without three.js (Debian's package libjs-three): it makes no pages");
  const std::vector<MeshField> own = own_fields(mesh);
  fields.insert(fields.begin(), own.begin(), own.end());
  const std::vector<std::string> words = words_of(mesh, fields);
  if (std::find(words.begin(), words.end(), start.color) == words.end()) {
    std::string all;
    for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
    refuse("there is no colouring \"" + start.color + "\" of this mesh; there are " + all);
  }
  out << page_head;
  ArrayWriter arrays(out);
  const Place<D> place(mesh);
  write_cells(mesh, place, arrays);
  write_figures(mesh, arrays);
  JsonObject page{{"version", PGDR_VERSION_STRING},
                  {"title", start.title},
                  {"dimension", D},
                  {"origin", place.origin.x},
                  {"scale", place.scale},
                  {"low", place.low.x},
                  {"high", place.high.x},
                  {"color", start.color},
                  {"colors", colors()},
                  {"regions", write_regions(mesh, arrays)},
                  {"markers", write_constraints(mesh, arrays)},
                  {"fields", write_fields(fields, words, arrays)}};
  if (start.cut) page.set("cut", JsonObject{{"axis", start.cut->axis}, {"value", start.cut->value}});
  if (start.from) page.set("from", start.from->x);
  page.set("arrays", arrays.about());
  out << "<script type=\"application/json\" id=\"pgdr-data\">" << within_script(page.pretty()) << "</script>\n" << page_tail;
}

template void write_page<2>(const OutputMesh<2>&, std::vector<MeshField>, const PageStart&, std::ostream&);
template void write_page<3>(const OutputMesh<3>&, std::vector<MeshField>, const PageStart&, std::ostream&);

}  // namespace pgdr::tool

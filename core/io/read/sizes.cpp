// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads sizes at points and along lines, a text of numbers, and rasters of sizes, ESRI's ASCII grids (.asc).
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "paths/file_input.hpp"
#include "pgdr/io.hpp"
#include "scan/line_scanner.hpp"

namespace pgdr {
namespace {

using detail::LineScanner;
using detail::Subject;

/// The head of an ASCII grid.
struct GridHead {
  std::size_t columns = 0, rows = 0;
  double x = 0, y = 0, width = 0, height = 0;  ///< of the middle of the lower left value, and from value to value
  double nothing = -9999;                      ///< stands for no value, as ESRI's default does
};

GridHead read_grid_head(LineScanner& in) {
  GridHead head;
  bool corner_x = false, corner_y = false;
  while (in.advance()) {
    const char c = in.peek();
    if (c == '-' || c == '+' || c == '.' || (c >= '0' && c <= '9')) break;
    std::string key(in.word({"the head of the grid"}));
    for (char& letter : key) letter = letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    if (key == "nan") in.fail(Errc::syntax, "the first value is no number");
    const Subject value{"the head of the grid"};
    if (key == "ncols")
      head.columns = in.count(value, 1);
    else if (key == "nrows")
      head.rows = in.count(value, 1);
    else if (key == "xllcorner" || key == "xllcenter")
      head.x = in.number(value), corner_x = key == "xllcorner";
    else if (key == "yllcorner" || key == "yllcenter")
      head.y = in.number(value), corner_y = key == "yllcorner";
    else if (key == "cellsize")
      head.width = head.height = in.number(value);
    else if (key == "dx")
      head.width = in.number(value);
    else if (key == "dy")
      head.height = in.number(value);
    else if (key == "nodata_value")
      head.nothing = in.number(value, false);
    else
      in.fail(Errc::syntax, detail::quoted(key) + " is no entry of the head of an ASCII grid");
    in.end_line(value);
  }
  if (head.columns < 2 || head.rows < 2) in.fail(Errc::syntax, "a grid of sizes needs two columns and rows or more");
  if (!(head.width > 0) || !(head.height > 0)) in.fail(Errc::syntax, "the head of the grid has no cellsize above 0");
  if (head.rows > std::numeric_limits<std::uint32_t>::max() / head.columns)
    in.fail(Errc::count_too_large, "the grid has more values than can be numbered");
  in.check_count({"the values of the grid"}, std::uint64_t{head.columns} * head.rows, 2);
  if (corner_x) head.x += head.width / 2;
  if (corner_y) head.y += head.height / 2;
  return head;
}

/// Two triangles between each four values that are all there, one between three.
void add_triangles_between(const GridHead& head, const std::vector<bool>& there,
                           std::vector<std::array<std::uint32_t, 3>>& cells) {
  const auto columns = static_cast<std::uint32_t>(head.columns), rows = static_cast<std::uint32_t>(head.rows);
  for (std::uint32_t j = 0; j + 1 < rows; ++j)
    for (std::uint32_t i = 0; i + 1 < columns; ++i) {
      const std::uint32_t a = j * columns + i;  // a b below, d c above: the first row is the highest
      const std::array<std::uint32_t, 4> around{a + columns, a + columns + 1, a + 1, a};
      std::vector<std::uint32_t> known;
      for (const std::uint32_t v : around)
        if (there[v]) known.push_back(v);
      if (known.size() >= 3) cells.push_back({known[0], known[1], known[2]});
      if (known.size() == 4) cells.push_back({known[0], known[2], known[3]});
    }
}

}  // namespace

template <int D>
std::vector<SizedLine<D>> read_sized_lines(const std::filesystem::path& file) {
  const std::string text = detail::read_whole_file(file);
  LineScanner in(text, file.string());
  std::vector<SizedLine<D>> lines;
  while (in.advance()) {
    const Subject entry{"entry", static_cast<std::int64_t>(lines.size() + 1)};
    std::vector<double> numbers;
    while (in.more_on_line()) numbers.push_back(in.number(entry));
    if (numbers.size() != D + 1 && numbers.size() != 2 * D + 1)
      in.fail(Errc::syntax, "a line of sizes has " + std::to_string(D + 1) + " numbers, a point and its size, or " +
                                std::to_string(2 * D + 1) + ", two ends and the size between them; not " +
                                std::to_string(numbers.size()));
    SizedLine<D> line;
    for (int k = 0; k < D; ++k) {
      line.ends[0][k] = numbers[static_cast<std::size_t>(k)];
      line.ends[1][k] = numbers[static_cast<std::size_t>(numbers.size() > D + 1 ? D + k : k)];
    }
    line.size = numbers.back();
    if (!(line.size > 0)) in.fail(Errc::bad_size, "a size must be above 0");
    lines.push_back(line);
  }
  if (lines.empty()) in.fail(Errc::truncated, "there are no sizes");
  return lines;
}

SizeRaster read_size_raster(const std::filesystem::path& file) {
  const std::string text = detail::read_whole_file(file);
  LineScanner in(text, file.string());
  const GridHead head = read_grid_head(in);
  SizeRaster raster;
  raster.mesh.points.reserve(head.columns * head.rows);
  raster.values.reserve(head.columns * head.rows);
  std::vector<bool> there;
  for (std::size_t j = 0; j < head.rows; ++j)
    for (std::size_t i = 0; i < head.columns; ++i) {
      const Subject value{"value", static_cast<std::int64_t>(raster.values.size() + 1)};
      in.require(value);
      const double size = in.number(value, false);
      there.push_back(!std::isnan(size) && size != head.nothing);
      if (there.back() && !(size > 0 && std::isfinite(size))) in.fail(Errc::bad_size, "a size must be above 0, and finite");
      raster.values.push_back(there.back() ? size : 1);  // of a point that no cell has
      raster.mesh.points.push_back(
          {head.x + static_cast<double>(i) * head.width, head.y + static_cast<double>(head.rows - 1 - j) * head.height});
    }
  if (in.advance()) in.fail(Errc::syntax, detail::quoted(in.word({})) + " stands behind the last value");
  add_triangles_between(head, there, raster.mesh.cells);
  if (raster.mesh.cells.empty()) in.fail(Errc::syntax, "no three neighbouring values of the grid are there");
  return raster;
}

template PGDR_API std::vector<SizedLine<2>> read_sized_lines<2>(const std::filesystem::path&);
template PGDR_API std::vector<SizedLine<3>> read_sized_lines<3>(const std::filesystem::path&);

}  // namespace pgdr

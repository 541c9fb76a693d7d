// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads sizes from Medit's solution files, .sol.
#include <string>
#include <string_view>
#include <vector>

#include "paths/file_input.hpp"
#include "pgdr/io.hpp"
#include "scan/line_scanner.hpp"

namespace pgdr {

std::vector<double> read_vertex_values(const std::filesystem::path& file, int dimension) {
  const std::string text = detail::read_whole_file(file);
  detail::LineScanner scanner(text, file.string());
  while (scanner.advance()) {
    const std::string_view keyword = scanner.word({"the keyword of a section"});
    if (keyword == "MeshVersionFormatted") {
      scanner.require({"the version"});
      scanner.integer({"the version"});
    } else if (keyword == "Dimension") {
      scanner.require({"the dimension"});
      if (const auto d = scanner.integer({"the dimension"}); d != dimension)
        scanner.fail(Errc::syntax, "the dimension is " + std::to_string(d) + ", not that of the mesh");
    } else if (keyword == "SolAtVertices") {
      scanner.require({"the number of values"});
      std::vector<double> values(scanner.count({"the number of values"}, 2));
      for (const char* what : {"the number of fields", "the kind of the field"}) {
        scanner.require({what});
        if (scanner.integer({what}) != 1) scanner.fail(Errc::syntax, "only one scalar a vertex can be read");
      }
      for (std::size_t i = 0; i < values.size(); ++i) {
        const detail::Subject value{"value", static_cast<std::int64_t>(i + 1)};
        scanner.require(value);
        values[i] = scanner.number(value);
      }
      return values;
    } else if (keyword == "End") {
      break;
    } else {
      scanner.fail(Errc::syntax, "unknown section " + detail::quoted(keyword) + " before SolAtVertices");
    }
  }
  scanner.fail(Errc::truncated, "there is no section SolAtVertices");
}

}  // namespace pgdr

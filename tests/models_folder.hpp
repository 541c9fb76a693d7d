// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Real inputs: those of tests/models/real, or of the folder that PGDR_MODELS names. INDEX.tsv there has a row a file: set (which
// is its folder), file, origin, licence, format, counts of vertices and faces (or segments), and what is known of it.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace pgdr::test {

inline std::filesystem::path models_folder() {
  const char* const folder = std::getenv("PGDR_MODELS");
  return folder == nullptr ? PGDR_TEST_MODELS "/real" : folder;
}

struct IndexRow {
  std::string set, file, format, vertices, faces;
};

inline std::vector<IndexRow> models_index() {
  std::vector<IndexRow> rows;
  std::ifstream in(models_folder() / "INDEX.tsv");
  std::string line;
  std::getline(in, line);  // the names of the columns
  while (std::getline(in, line)) {
    std::vector<std::string> columns;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, '\t');) columns.push_back(cell);
    columns.resize(7);
    rows.push_back({columns[0], columns[1], columns[4], columns[5], columns[6]});
  }
  return rows;
}

}  // namespace pgdr::test

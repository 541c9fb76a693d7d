// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Real inputs (models_folder.hpp). Files of the formats that are read must have the counts of vertices and faces (or segments)
// that the index gives; those of the set "defective" may be refused instead, with a line.
#include <set>

#include "models_folder.hpp"
#include "test_io_support.hpp"

namespace pgdr::test::test_io_models {

/// Those of formats that are read. A format is that of the index up to its variant, as in stl-binary and poly(2D).
std::vector<IndexRow> models() {
  std::vector<IndexRow> all;
  for (IndexRow row : models_index()) {
    row.format = row.format.substr(0, row.format.find_first_of("-("));
    for (const std::string read : {"off", "stl", "obj", "ply", "poly", "smesh", "node"})
      if (row.format == read) all.push_back(row);
  }
  return all;
}

/// The index counts distinct points in use, and triangles, for surfaces; what the file lists for other inputs.
void expect_counts(const IndexRow& m, const Plc<3>& plc) {
  std::set<std::array<double, 3>> distinct;
  std::size_t triangles = 0;
  for (const auto& f : plc.facets) {
    for (const auto& polygon : f.polygons) {
      for (const std::uint32_t c : polygon) distinct.insert({plc.points[c][0], plc.points[c][1], plc.points[c][2]});
      triangles += polygon.size() - 2;
    }
  }
  const bool surface = m.format == "off" || m.format == "stl" || m.format == "obj" || m.format == "ply";
  EXPECT_EQ(std::to_string(surface ? distinct.size() : plc.points.size()), m.vertices);
  EXPECT_EQ(std::to_string(surface ? triangles : plc.facets.size()), m.faces);
}

void expect_counts(const IndexRow& m, const Plc<2>& plc) {
  EXPECT_EQ(std::to_string(plc.points.size()), m.vertices);
  if (m.format == "poly") {
    EXPECT_EQ(std::to_string(plc.segments.size()) + " segments", m.faces);
  }
}

template <int D>
void expect_readable(const IndexRow& m, const std::filesystem::path& file) {
  const Plc<D> plc = read_plc<D>(file);
  EXPECT_FALSE(plc.points.empty());
  if (!m.vertices.empty()) expect_counts(m, plc);
}

TEST(Models, AreReadAsTheIndexSays) {
  const auto all = models();
  EXPECT_GE(all.size(), 20u);
  for (const IndexRow& m : all) {
    SCOPED_TRACE(m.file);
    const auto file = models_folder() / m.file;
    try {
      if (file_dimension(file) == 2)
        expect_readable<2>(m, file);
      else
        expect_readable<3>(m, file);
    } catch (const InputError& e) {
      EXPECT_EQ(m.set, "defective") << e.what();
      EXPECT_NE(e.diagnostic().line, 0u) << e.what();
    }
  }
}

TEST(Models, MalformedOnesAreRefusedForTheRightReason) {
  const std::pair<std::string, Errc> reasons[] = {
      {"assimp_empty.off", Errc::truncated},          {"assimp_outofmemory.off", Errc::count_too_large},
      {"assimp_invalid.off", Errc::degenerate_facet}, {"assimp_malformed.obj", Errc::index_out_of_range},
      {"openscad_invalidvertex.stl", Errc::syntax},   {"mut_joint_truncated.off", Errc::truncated},
      {"mut_joint_count_high.off", Errc::truncated},  {"mut_joint_nan.off", Errc::not_finite},
      {"mut_spine_truncated.smesh", Errc::truncated}, {"mut_example_badindex.poly", Errc::index_out_of_range},
  };
  int tried = 0;
  for (const auto& [file, code] : reasons) {
    SCOPED_TRACE(file);
    const auto path = models_folder() / "defective" / file;
    if (!std::filesystem::exists(path)) continue;
    ++tried;
    EXPECT_EQ(name(error_of<InputError>([&] { read_plc<3>(path); }).code), name(code));
  }
  EXPECT_GE(tried, 3);
}

}  // namespace pgdr::test::test_io_models

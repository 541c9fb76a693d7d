// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the files of the corpus that are made, into the folders <folder>/<target>. What fuzzing found lies beside them.
#include <cstdio>
#include <filesystem>
#include <random>

#include "io/formats.hpp"
#include "msh_files.hpp"
#include "ply_files.hpp"
#include "rank_messages.hpp"
#include "test_io_support.hpp"

namespace pgdr::test {
namespace {

std::filesystem::path folder;

void put(const std::string& target, const std::string& name, const std::string& bytes) {
  std::filesystem::create_directories(folder / target);
  std::ofstream(folder / target / name, std::ios::binary) << bytes;
}

template <int D>
OutputMesh<D> simplex() {
  OutputMesh<D> mesh;
  mesh.points.resize(D + 1);
  for (int i = 0; i < D; ++i) mesh.points[static_cast<std::size_t>(i) + 1][i] = 1;
  mesh.input_points = D + 1;
  mesh.point_markers.assign(D + 1, 3);
  mesh.cells.emplace_back();
  for (std::uint32_t i = 0; i <= D; ++i) mesh.cells[0][i] = i;
  mesh.regions = {1};
  mesh.subsegments.push_back({{0, 1}, 5});
  if constexpr (D == 3) mesh.subfacets.push_back({{0, 2, 1}, 6});
  return mesh;
}

template <int D>
void put_meshes() {
  const TempFolder temporary;
  const std::string dimension = std::to_string(D) + "d";
  for (const std::string extension : {"mesh", "msh", "vtk", "vtu", "ele", "pvtu"})
    write_mesh<D>(simplex<D>(), temporary / ("a." + extension));
  for (const std::string extension : {"mesh", "msh", "vtk", "vtu"})
    put("read_" + extension, "simplex_" + dimension, content(temporary / ("a." + extension)));
  put("read_pvtu", "simplex_" + dimension, content(temporary / "a.pvtu"));
  put("read_vtu", "piece_" + dimension, content(temporary / "a_0.vtu"));
  std::string all = content(temporary / "a.node") + '\0' + content(temporary / "a.ele") + '\0';
  if (D == 3) all += content(temporary / "a.face");
  put("read_ele", "simplex_" + dimension, all + '\0' + content(temporary / "a.edge"));
}

void put_inputs() {
  put("read_poly", "triangle", triangle_poly);
  put("read_poly", "tetgen", tetgen_poly);
  put("read_poly", "points_beside", "0 3 0 0\n1 0\n1\n3 1 2 3\n0\n");
  put("read_smesh", "tetgen", tetgen_smesh);
  put("read_vtk", "surface",
      "# vtk DataFile Version 5.1\na\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\nPOLYGONS 3 6\nOFFSETS "
      "vtktypeint64\n0 3 6\nCONNECTIVITY vtktypeint64\n0 1 2 0 1 3\nCELL_DATA 2\nFIELD a 1\nb%20c 2 2 double\n1 2 3 4\n");
  put("read_node", "attributes", "2 3 1 1\n1 0.5 1 2 3 4\n2 -1e5 0 0 7 5\n");
  put("read_node", "plane", "2 2 0 0\n0 0.5 1\n1 -1e-5 0\n");
  put("read_off", "colours", colour_off);
  put("read_obj", "everything", wavefront_obj);
  put("read_stl", "text", ascii_stl);
  put("read_stl", "binary", binary_stl("solid", {{1, 2, 3}, {4, 5, 6, 7, 8, 9}}));
  for (const PlyEncoding e : ply_encodings) put("read_ply", ply_name(e), ply_file(e));
  for (const MshVariant& v : msh_variants) put("read_msh", v.name(), msh_file(two_tetrahedra(), v));
}

/// Random bytes, of all lengths up to `most`: see grid_input.hpp.
void put_random(const std::string& target, std::size_t files, std::size_t most) {
  std::mt19937_64 random(20260701);
  for (std::size_t k = 0; k < files; ++k) {
    std::string bytes(1 + k * most / files, '\0');
    for (char& c : bytes) c = static_cast<char>(random());
    bytes[0] = static_cast<char>(k % 8);
    put(target, "random_" + std::to_string(k), bytes);
  }
}

/// As above, each of them as another copy: see fuzz_rounded.cpp.
void put_copies(const std::string& target, std::size_t files, std::size_t most) {
  std::mt19937_64 random(20261126);
  for (std::size_t k = 0; k < files; ++k) {
    std::string bytes(5 + k * most / files, '\0');
    for (char& c : bytes) c = static_cast<char>(random());
    bytes[4] = static_cast<char>(k % 8);
    put(target, "random_" + std::to_string(k), bytes);
  }
}

/// A message of each kind: see read_any_message.
template <int D>
void put_messages() {
  for (unsigned kind = 0; kind < message_kinds; ++kind) {
    std::string bytes(1, static_cast<char>(2 * kind + D - 2));
    for (const std::byte b : RankMessages<D>().sample(static_cast<MessageKind>(kind))) bytes += static_cast<char>(b);
    put("rank_messages", "kind_" + std::to_string(kind) + "_" + std::to_string(D) + "d", bytes);
  }
}

}  // namespace
}  // namespace pgdr::test

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]), 2;
  pgdr::test::folder = argv[1];
  pgdr::test::put_inputs();
  pgdr::test::put_meshes<2>();
  pgdr::test::put_meshes<3>();
  pgdr::test::put_messages<2>();
  pgdr::test::put_messages<3>();
  pgdr::test::put_random("refine_2d", 24, 24);
  pgdr::test::put_random("refine_3d", 24, 32);
  pgdr::test::put_copies("rounded_2d", 24, 24);
  pgdr::test::put_copies("rounded_3d", 24, 32);
}

// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What the tests of reading and writing share: a folder of their own, the error that a call throws, and meshes and
// inputs with something of everything in them.
#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include "pgdr/error.hpp"
#include "pgdr/io.hpp"
#include "same_bytes.hpp"

namespace pgdr::test {

/// A new folder, removed with all that is in it.
class TempFolder {
 public:
  TempFolder() {
    std::random_device device;
    do {
      path_ = std::filesystem::temp_directory_path() / ("pgdr_io_" + std::to_string(device()));
    } while (!std::filesystem::create_directory(path_));
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  ~TempFolder() {
    std::error_code ec;
    std::filesystem::remove_all(path_, ec);
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::filesystem::path put(const std::string& name, const std::string& content) const {
    // Some file systems wait for the disk when a file is overwritten.
    std::filesystem::remove(path_ / name);
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }
  std::size_t files() const { return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {})); }

 private:
  std::filesystem::path path_;
};

/// Files cannot grow beyond `bytes` while this lives: what a full disk looks like to a program.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

inline std::string content(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// What `call` throws, which must be an E and nothing else.
template <class E, class Call>
Diagnostic error_of(Call call) {
  try {
    call();
  } catch (const E& e) {
    return e.diagnostic();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

template <int D>
void expect_same(const OutputMesh<D>& a, const OutputMesh<D>& b) {
  EXPECT_TRUE(same_bytes(a.points, b.points)) << "points";
  EXPECT_EQ(a.input_points, b.input_points);
  EXPECT_EQ(a.point_markers, b.point_markers);
  EXPECT_TRUE(same_bytes(a.point_attributes, b.point_attributes)) << "attributes";
  EXPECT_EQ(a.leaves, b.leaves);
  EXPECT_TRUE(same_bytes(a.cells, b.cells)) << "cells";
  EXPECT_TRUE(same_bytes(a.regions, b.regions)) << "regions";
  EXPECT_TRUE(same_bytes(a.subsegments, b.subsegments)) << "subsegments";
  EXPECT_TRUE(same_bytes(a.subfacets, b.subfacets)) << "subfacets";
}

/// What a .msh keeps of a mesh: not the markers of points that are none of the input's, where it is known which these are.
template <int D>
OutputMesh<D> as_msh(OutputMesh<D> mesh) {
  if (mesh.input_points != 0 && !mesh.point_markers.empty())
    std::fill(mesh.point_markers.begin() + static_cast<std::ptrdiff_t>(mesh.input_points), mesh.point_markers.end(), 0);
  return mesh;
}

/// Points of all magnitudes, among them -0, the smallest and the largest double; all labels in use. The cells are no
/// mesh: files do not care.
template <int D>
OutputMesh<D> some_mesh(std::uint64_t seed, std::size_t points = 40) {
  std::mt19937_64 random(seed);
  const auto vertex = [&] { return static_cast<std::uint32_t>(random() % points); };
  const auto marker = [&] { return static_cast<int>(random()); };
  OutputMesh<D> mesh;
  mesh.points.resize(points);
  for (auto& p : mesh.points) {
    for (int i = 0; i < D; ++i) {
      do {
        const std::uint64_t bits = random();
        std::memcpy(&p.x[static_cast<std::size_t>(i)], &bits, sizeof bits);
      } while (!(p[i] - p[i] == 0));
    }
  }
  mesh.points[0][0] = -0.0;
  mesh.points[1][1] = 5e-324;
  mesh.points[2][0] = -1.7976931348623157e308;
  mesh.points[3][1] = 0.1;
  mesh.input_points = points / 2;
  for (std::size_t i = 0; i < points; ++i) mesh.point_markers.push_back(marker());
  for (std::size_t i = 0; i < 2 * points; ++i) {
    auto& cell = mesh.cells.emplace_back();
    for (auto& v : cell) v = vertex();
    mesh.regions.push_back(static_cast<double>(random() % 5) - 2);
    mesh.subsegments.push_back({{vertex(), vertex()}, marker()});
    if constexpr (D == 3) mesh.subfacets.push_back({{vertex(), vertex(), vertex()}, marker()});
  }
  return mesh;
}

/// The bytes of a binary STL file: a header of 80 bytes, triangles of 9 floats.
inline std::string binary_stl(std::string header, const std::vector<std::array<float, 9>>& triangles) {
  header.resize(80, ' ');
  const auto append = [&header](const auto& value) { header.append(reinterpret_cast<const char*>(&value), sizeof value); };
  append(static_cast<std::uint32_t>(triangles.size()));
  for (const auto& t : triangles) {
    append(std::array<float, 3>{});
    append(t);
    append(std::uint16_t{0});
  }
  return header;
}

// One small valid input of each format, with all its optional parts.

inline const std::string triangle_poly =
    "# a square with a hole\n"
    "5 2 1 1\n"
    "1 0 0 7.5 10\n"
    "2 4 0 7.5 20  # attributes may be missing, markers too\n"
    "3 4 4\n"
    "4 0 4 1e3 40\n"
    "5 2 +2.5 0 -50\n"
    "\n"
    "4 1\n"
    "1 1 2 7\n"
    "2 2 3\n"
    "3 3 4 9\n"
    "4 4 1 -1\n"
    "1\n"
    "1 1.5 1.25\n"
    "2\n"
    "1 .5 .5 3 0.125\n"
    "2 3.5 3.5 4\n";

inline const std::string tetgen_poly =
    "# two facets\n"
    "8, 3, 0, 1\n"
    "0 0 0 0 1\n"
    "1 1 0 0 2\n"
    "2 1 1 0 3\n"
    "3 0 1 0 4\n"
    "4 .25 .25 0 5\n"
    "5 .75 .25 0 6\n"
    "6 .75 .75 0 7\n"
    "7 0 0 1 8\n"
    "2 1\n"
    "3 1 -5 # a polygon with a hole and an inner segment\n"
    "4 0 1\n"
    "  2\n"
    "  # over several lines\n"
    "  3\n"
    "3 4 5 6\n"
    "2 4 6\n"
    "1 .5 .5 0\n"
    "1\n"
    "3 0 1 7\n"
    "1\n"
    "1 0.5 0.25 0.125\n"
    "2\n"
    "1 .1 .2 .3 11 0.5\n"
    "2 .4 .5 .6 -2.5\n";

inline const std::string tetgen_smesh =
    "4 3 0 0\n"
    "1 0 0 0\n"
    "2 1 0 0\n"
    "3 0 1 0\n"
    "4 0 0 1\n"
    "4 1\n"
    "3 1 2 3 11\n"
    "3 1 2\n"
    "4 12\n"
    "3 1 3 4\n"
    "3 2 3 4 -14\n"
    "1\n"
    "1 .1 .1 .1\n"
    "1\n"
    "1 .2 .2 .2 5 0.01\n";

inline const std::string colour_off =
    "\n"
    "COFF # with colours\n"
    "5 3 0\n"
    "0 0 0 255 0 0 255\n"
    "1 0 0 255 0 0 255\n"
    "1 1 0 255 0 0 255\n"
    "0 1 0\n"
    "0 0 1 0.5 0.5 0.5\n"
    "4 0 1 2 3 0.9 0.9 0.9\n"
    "3 0 1 4\n"
    "3 1 2\n"
    "4 12\n";

inline const std::string wavefront_obj =
    "# with everything\n"
    "mtllib a.mtl\n"
    "v 0 0 0 1.0\n"
    "v 1 0 0 0.5 0.5 0.5\n"
    "vt 0 0\n"
    "vn 0 0 1\n"
    "g one two\n"
    "f 1 2/1 -1//1 4/1/1\n"
    "v 1 1 0\n"
    "v 0 1 \\\n"
    "0\n"
    "f 1 2 \\\n"
    "  4\n"
    "l 1 2\n";

inline const std::string ascii_stl =
    "solid first # of two\n"
    "  facet normal nan nan nan\n"
    "    outer loop\n"
    "      vertex 0 0 0\n"
    "      vertex 1e0 0 0\n"
    "      VERTEX 0 1 -0\n"
    "    endloop\n"
    "  endfacet\n"
    "endsolid first\n"
    "solid\n"
    "  facet normal 0 0 1\n"
    "    outer loop\n"
    "      vertex -0 0 0\n"
    "      vertex 0 1 0\n"
    "      vertex 0 0 1\n"
    "    end loop\n"
    "  end facet\n"
    "end solid\n";

}  // namespace pgdr::test

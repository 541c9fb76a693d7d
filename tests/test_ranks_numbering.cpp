// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers, pieces and files of a mesh that several ranks have: the same as of a single process. Each rank gets a mesh of its own
// cells, and some more, in a random order of slots and vertices.
#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <set>

#include "boundary/labeling.hpp"
#include "boundary/recovery.hpp"
#include "cavity/delaunay.hpp"
#include "compact/point_data.hpp"
#include "local_ranks.hpp"
#include "model_plcs.hpp"
#include "parallel_support.hpp"
#include "pgdr/mesh_maps.hpp"
#include "pgdr/ranks.hpp"
#include "planar_plcs.hpp"
#include "ranks/numbering.hpp"
#include "test_io_support.hpp"
#include "transport/collectives.hpp"

namespace pgdr::test::test_ranks_numbering {

/// What a run makes of an input, and what it knew before.
template <int D>
struct Made {
  Domain<D> domain;
  RefineResult<D> result;
  Mesh<D> unrefined;
  RegionTable regions;

  Made(const Plc<D>& plc, const RefineOptions<D>& options) : domain(plc) {
    auto outcome = refine_and_check<D>(plc, options);
    EXPECT_TRUE(outcome.report.findings.empty()) << findings(outcome.report);
    result = std::move(outcome.result);
    auto pools = unrefined.make_pools();
    Delaunay<D> delaunay(unrefined, pools);
    delaunay.build(domain.points());
    RecoveryCounts counts;
    recover_boundary<D>(unrefined, pools, delaunay, domain, options, std::chrono::steady_clock::now(), counts);
    std::vector<Diagnostic> warnings;
    regions = carve<D>(unrefined, pools, delaunay, domain, RegionMode::seeds, warnings);
  }
};

/// The part of the finished mesh that one rank has.
template <int D>
class Part {
 public:
  Part(const Made<D>& made, int rank, int ranks, std::uint64_t seed) : made_(made), random_(seed * 1000 + std::uint64_t(rank)) {
    const OutputMesh<D>& whole = made.result.mesh;
    find_homes();
    for (const auto& s : whole.subsegments) edges_[sorted(s.vertices)] = s.entity;
    for (const auto& s : whole.subfacets) faces_[sorted(s.vertices)] = s.entity;
    std::vector<std::uint32_t> held;
    for (std::uint32_t c = 0; c < whole.cells.size(); ++c)
      if (owner(c, ranks, seed) == rank || random_() % 8 == 0) held.push_back(c);
    std::shuffle(held.begin(), held.end(), random_);
    for (const std::uint32_t c : held) {
      const CellId id = add_cell(c);
      if (owner(c, ranks, seed) == rank) own_.insert(id);
    }
  }

  Mesh<D>& mesh() { return mesh_; }
  bool is_own(CellId c) const { return own_.count(c) > 0; }

 private:
  template <std::size_t N>
  static std::array<std::uint32_t, N> sorted(std::array<std::uint32_t, N> v) {
    std::sort(v.begin(), v.end());
    return v;
  }
  /// By place, or by lot: then many vertices are of many ranks.
  int owner(std::uint32_t c, int ranks, std::uint64_t seed) const {
    const OutputMesh<D>& whole = made_.result.mesh;
    if (seed % 2 == 0) return static_cast<int>(std::mt19937(c)() % static_cast<unsigned>(ranks));
    const double x = whole.points[whole.cells[c][0]][0] + whole.points[whole.cells[c][0]][1];
    return static_cast<int>(std::abs(x * 3.7)) % ranks;
  }
  void find_homes() {
    const OutputMesh<D>& whole = made_.result.mesh;
    homes_.assign(whole.points.size(), Home(EntityKind::volume, 0));
    for (const auto& s : whole.subfacets)
      for (const std::uint32_t v : s.vertices) homes_[v] = Home(EntityKind::facet, s.entity);
    for (const auto& s : whole.subsegments)
      for (const std::uint32_t v : s.vertices) homes_[v] = Home(EntityKind::segment, s.entity);
    for (std::uint32_t v = 0; v < whole.input_points; ++v) homes_[v] = Home(EntityKind::vertex, v);
  }
  VertexId vertex(std::uint32_t v) {
    const auto found = vertices_.find(v);
    if (found != vertices_.end()) return found->second;
    return vertices_[v] = mesh_.new_vertex(pools_, made_.result.mesh.points[v], homes_[v], 1);
  }
  CellId add_cell(std::uint32_t c) {
    const OutputMesh<D>& whole = made_.result.mesh;
    auto cell = whole.cells[c];
    for (auto turns = random_() % 3; turns > 0; --turns) std::rotate(cell.begin(), cell.begin() + 1, cell.begin() + 3);
    std::uint16_t region = 0;
    if (!whole.regions.empty())
      while (made_.regions.attribute.at(region) != whole.regions[c]) ++region;
    const CellId id = mesh_.new_cell(pools_, region);
    std::array<VertexId, D + 1> v;
    for (int j = 0; j <= D; ++j) v[j] = vertex(cell[j]);
    mesh_.set_vertices(id, v);
    for (int f = 0; f <= D; ++f) {
      const auto key = sorted(face_without(cell, f));
      const auto& among = [&]() -> const auto& {
        if constexpr (D == 3)
          return faces_;
        else
          return edges_;
      }
      ();
      if (const auto found = among.find(key); found != among.end()) mesh_.constrain_face(pools_, id, f, found->second);
    }
    if constexpr (D == 3)
      for (int e = 0; e < 6; ++e)
        if (const auto found = edges_.find(sorted(ends_of_edge(cell, e))); found != edges_.end())
          mesh_.constrain_edge(pools_, id, e, found->second);
    return id;
  }

  const Made<D>& made_;
  std::mt19937_64 random_;
  std::vector<Home> homes_;
  std::map<std::array<std::uint32_t, 2>, EntityId> edges_;
  std::map<std::array<std::uint32_t, 3>, EntityId> faces_;
  std::map<std::uint32_t, VertexId> vertices_;
  Mesh<D> mesh_;
  typename Mesh<D>::Pools pools_ = mesh_.make_pools();
  std::set<CellId> own_;
};

template <int D>
void expect_same_piece(const MeshPiece<D>& a, const MeshPiece<D>& b) {
  EXPECT_TRUE(a.total == b.total) << a.total.points << " " << b.total.points << ", " << a.total.cells << " " << b.total.cells;
  EXPECT_EQ(a.point_numbers, b.point_numbers);
  EXPECT_EQ(a.first_point, b.first_point);
  EXPECT_EQ(a.own_points, b.own_points);
  EXPECT_EQ(a.first_cell, b.first_cell);
  EXPECT_EQ(a.first_subfacet, b.first_subfacet);
  EXPECT_EQ(a.first_subsegment, b.first_subsegment);
  expect_same(a.mesh, b.mesh);
}

/// By the pieces themselves, which a single process can see all.
template <int D>
std::vector<std::set<int>> holders(const OutputMesh<D>& whole, int ranks) {
  std::vector<std::set<int>> of_point(whole.points.size());
  for (int r = 0; r < ranks; ++r)
    for (const auto p : piece_of<D>(whole, std::uint64_t(r), std::uint64_t(ranks)).point_numbers) of_point[p].insert(r);
  return of_point;
}

template <int D>
void expect_sharing(const SharingRanks& sharing, const MeshPiece<D>& piece, const std::vector<std::set<int>>& of_point,
                    int rank) {
  ASSERT_EQ(sharing.begin.size(), piece.point_numbers.size() + 1);
  for (std::size_t i = 0; i < piece.point_numbers.size(); ++i) {
    std::set<int> others = of_point[piece.point_numbers[i]];
    others.erase(rank);
    const std::vector<int> found(sharing.ranks.begin() + static_cast<std::ptrdiff_t>(sharing.begin[i]),
                                 sharing.ranks.begin() + static_cast<std::ptrdiff_t>(sharing.begin[i + 1]));
    ASSERT_EQ(found, std::vector<int>(others.begin(), others.end()));
  }
}

template <int D>
void expect_pieces(const Plc<D>& plc, const RefineOptions<D>& options) {
  const Made<D> made(plc, options);
  EXPECT_EQ(made.result.mesh.cells.size() > 500, options.refine);
  const PointData<D> data(made.unrefined, made.domain);
  const std::span<const double> labels = made.regions.labelled ? std::span<const double>(made.regions.attribute)
                                                               : std::span<const double>();
  OutputMesh<D> dropped = made.result.mesh;
  drop_points<D>(dropped, unused_points(dropped));
  for (const int ranks : {1, 2, 3, 4, 7}) {
    const auto of_point = holders<D>(made.result.mesh, ranks);
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      SCOPED_TRACE(std::to_string(ranks) + " ranks, seed " + std::to_string(seed));
      run_on_local_ranks(ranks, seed, [&](Transport& transport) {
        const int rank = transport.rank();
        Part<D> part(made, rank, ranks, seed);
        detail::Collectives talk(transport);
        const auto is_own = [&](CellId c) { return part.is_own(c); };
        const std::uint64_t most_narrow = seed == 3 ? 0 : std::numeric_limits<std::uint32_t>::max();
        const bool drop = seed == 2;
        std::vector<std::uint32_t> unused;
        const MeshPiece<D> piece = detail::number_on_ranks<D>(talk, part.mesh(), is_own, made.domain, labels, data,
                                                              detail::OneByOne(), unused, drop, most_narrow);
        EXPECT_EQ(unused, unused_points(made.result.mesh));
        const OutputMesh<D>& whole = drop ? dropped : made.result.mesh;
        expect_same_piece<D>(piece, piece_of<D>(whole, std::uint64_t(rank), std::uint64_t(ranks)));
        if (!drop) expect_sharing<D>(detail::sharing_of<D>(talk, piece), piece, of_point, rank);
      });
    }
  }
}

template <int D>
RefineOptions<D> delaunay_of(double size) {
  RefineOptions<D> options;
  options.size = size;
  options.min_dihedral = 0;
  return options;
}

/// With attributes of points, of which one is not linear.
template <int D>
Plc<D> with_attributes(Plc<D> plc) {
  for (const Point<D>& p : plc.points) plc.point_attributes.insert(plc.point_attributes.end(), {p[0] * p[1], 1 + p[0]});
  return plc;
}

TEST(RankNumbering, OfRegions) { expect_pieces<3>(two_region_cube(), delaunay_of<3>(0.2)); }
TEST(RankNumbering, OfMarkers) { expect_pieces<3>(cube_with_marked_facet(), delaunay_of<3>(0.2)); }
TEST(RankNumbering, OfAttributes) { expect_pieces<3>(with_attributes(cube()), delaunay_of<3>(0.2)); }
TEST(RankNumbering, OfFewCells) {
  RefineOptions<3> options = delaunay_of<3>(1);
  options.refine = false;
  expect_pieces<3>(cube(), options);
}

TEST(RankNumbering, InThePlane) {
  Plc<2> plc;
  add_square(plc, 0, 1, 3);
  add_square(plc, 0.25, 0.75, 0);
  plc.regions = {{{{0.1, 0.1}}, 5, 0}, {{{0.5, 0.5}}, -2, 0}};
  expect_pieces<2>(with_attributes(plc), delaunay_of<2>(0.001));
  RefineOptions<2> bare = delaunay_of<2>(1);
  bare.refine = false;
  Plc<2> triangle;
  triangle.points = {{{0, 0}}, {{1, 0}}, {{0, 1}}};
  for (std::uint32_t i = 0; i < 3; ++i) add_segment(triangle, i, (i + 1) % 3, 4);
  expect_pieces<2>(triangle, bare);  // fewer cells than ranks
}

/// All files of a folder, by name.
std::map<std::string, std::string> contents(const std::filesystem::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) all[entry.path().filename()] = content(entry.path());
  return all;
}

class WriteOnRanks : public testing::Test {
 protected:
  WriteOnRanks() {
    const auto outcome = refine_and_check<3>(two_region_cube(), delaunay_of<3>(0.2));
    EXPECT_TRUE(outcome.report.findings.empty()) << findings(outcome.report);
    mesh_ = outcome.result.mesh;
    for (auto& s : mesh_.subfacets) s.entity = no_entity;  // files have none
    for (auto& s : mesh_.subsegments) s.entity = no_entity;
  }
  DistributedResult<3> part(const Transport& transport) const {
    DistributedResult<3> result;
    result.piece = piece_of<3>(mesh_, std::uint64_t(transport.rank()), std::uint64_t(transport.size()));
    return result;
  }
  OutputMesh<3> mesh_;
};

TEST_F(WriteOnRanks, TheSameBytesAsOneProcess) {
  for (const std::string name : {"a.vtu", "a.msh", "a.mesh", "a.ele", "a.pvtu"}) {
    for (const std::uint32_t pieces : {1u, 3u, 5u, 60u}) {
      if (pieces != 1 && name != "a.pvtu") continue;
      const TempFolder single;
      write_mesh<3>(mesh_, single / name, {.pieces = pieces});
      const auto expected = contents(single / ".");
      for (const int ranks : {1, 2, 3, 7}) {
        SCOPED_TRACE(name + ", " + std::to_string(pieces) + " pieces, " + std::to_string(ranks) + " ranks");
        const TempFolder folder;
        run_on_local_ranks(ranks, 5, [&](Transport& transport) {
          write_mesh<3>(transport, (folder / name).string(), part(transport), {.pieces = pieces});
        });
        EXPECT_TRUE(contents(folder / ".") == expected);
      }
    }
  }
}

TEST_F(WriteOnRanks, APieceARankByDefault) {
  const TempFolder folder;
  run_on_local_ranks(3, 1, [&](Transport& transport) { write_mesh<3>(transport, folder / "a.pvtu", part(transport)); });
  EXPECT_EQ(folder.files(), 4u);
  expect_same(read_mesh<3>(folder / "a.pvtu"), mesh_);
}

TEST_F(WriteOnRanks, AnErrorOfOneIsOneOfAllAndLeavesNothing) {
  for (const std::string name : {"a.vtu", "a.pvtu", "a.msh", "a.unknown"}) {
    SCOPED_TRACE(name);
    const TempFolder folder;
    folder.put("a.vtu", "old");
    // In the place of a file of a later rank, and of the whole, is a folder.
    const std::string blocked = name == "a.pvtu" ? "a_2.vtu" : "b";
    std::filesystem::create_directory(folder / blocked);
    const FullDisk full(name == "a.vtu" ? 30000 : 100);
    const auto errors = errors_of_local_ranks(
        4, 1, [&](Transport& transport) { write_mesh<3>(transport, folder / name, part(transport)); });
    std::set<std::string> words;
    for (const auto& error : errors) {
      ASSERT_TRUE(error && !is_rank_failure(error));
      try {
        std::rethrow_exception(error);
      } catch (const Error& e) {
        words.insert(e.what());
        EXPECT_EQ(e.code(), name == "a.unknown" ? Errc::unknown_format : Errc::cannot_write) << e.what();
      }
    }
    EXPECT_EQ(words.size(), 1u);
    EXPECT_EQ(content(folder / "a.vtu"), "old");
    EXPECT_EQ(folder.files(), 2u);
  }
}

}  // namespace pgdr::test::test_ranks_numbering

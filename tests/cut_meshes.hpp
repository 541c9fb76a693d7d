// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Small carved meshes over a uniform tree whose nodes have owners: what ranks cut.
#pragma once

#include <algorithm>
#include <chrono>
#include <random>
#include <vector>

#include "boundary/labeling.hpp"
#include "boundary/recovery.hpp"
#include "cavity/delaunay.hpp"
#include "graded_trees.hpp"
#include "ranks/held_mesh.hpp"
#include "ranks/territory.hpp"
#include "scattered_models.hpp"

namespace pgdr::test {

/// A uniform tree over the unit square or cube, and owners of its leaves, successive on the Morton curve.
template <int D>
struct OwnedTree {
  Orthtree<D> tree;
  std::vector<typename Orthtree<D>::Node> nodes;
  std::vector<int> owners;
  int ranks;

  OwnedTree(int level, int count, std::uint64_t seed) : tree(trees::uniform<D>(level)), nodes(tree.leaves()), ranks(count) {
    std::mt19937_64 random(seed);
    for (std::size_t i = 0; i < nodes.size(); ++i) owners.push_back(static_cast<int>(random() % static_cast<unsigned>(ranks)));
    std::sort(owners.begin(), owners.end());
  }
  /// With all nodes split. Nodes of this one are the same in it.
  OwnedTree halved() const {
    OwnedTree finer = *this;
    finer.nodes.clear();
    finer.owners.clear();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto first = finer.tree.split(nodes[i]);
      for (unsigned k = 0; k < static_cast<unsigned>(Orthtree<D>::children); ++k) {
        finer.nodes.push_back(first + k);
        finer.owners.push_back(owners[i]);
      }
    }
    return finer;
  }
  detail::Territory<D> territory(int rank) const { return {tree, nodes, owners, ranks, rank}; }
};

/// The unit square or cube with pairs of points inside, in whole. Equal arguments make equal ids.
template <int D>
struct WholeMesh {
  Domain<D> domain;
  Mesh<D> mesh;
  typename Mesh<D>::Pools pools = mesh.make_pools();

  WholeMesh(int pairs, std::uint64_t seed) : domain(box_with_pairs<D>(pairs, 0.03, seed)) {
    Delaunay<D> delaunay(mesh, pools);
    delaunay.build(domain.points());
    RecoveryCounts counts;
    recover_boundary<D>(mesh, pools, delaunay, domain, {}, std::chrono::steady_clock::now(), counts);
    std::vector<Diagnostic> warnings;
    carve<D>(mesh, pools, delaunay, domain, RegionMode::seeds, warnings);
  }
};

template <int D>
std::vector<CellId> cells_of(const Mesh<D>& mesh) {
  std::vector<CellId> cells;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
    if (mesh.alive(CellId{i})) cells.push_back(CellId{i});
  return cells;
}

/// What one rank has of such a mesh after the cut.
template <int D>
struct CutMesh {
  detail::Territory<D> territory;
  WholeMesh<D> part;
  detail::HeldMesh<D> held{part.mesh, territory};

  CutMesh(const OwnedTree<D>& owned, int rank, int pairs, std::uint64_t seed)
      : territory(owned.territory(rank)), part(pairs, seed) {}
};

}  // namespace pgdr::test

// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <tuple>
#include <utility>

#include "output/face_groups.hpp"
#include "output/simplices.hpp"
#include "weld/joining.hpp"

namespace pgdr::detail {
namespace {

constexpr std::uint32_t no_mesh = 0xffffffffu;

/// A constraint as a mesh lists it; or, of no mesh, what has to be one.
template <std::size_t K>
struct Listed {
  std::array<std::uint32_t, K> key;  ///< vertices of the joined mesh, sorted
  std::uint32_t mesh;
  int marker;
};

using Counts = std::map<std::pair<std::array<std::uint32_t, 2>, std::array<int, 2>>, std::uint64_t>;

std::vector<SharedConstraints> list_of(const Counts& counts) {
  std::vector<SharedConstraints> list;
  for (const auto& [key, count] : counts) list.push_back({key.first, key.second, count});
  return list;
}

template <int D, std::size_t K, class Given>
void add_listed(const Joining<D>& j, std::uint32_t m, const std::vector<Given>& given, std::vector<Listed<K>>& all) {
  for (const auto& constraint : given) {
    Listed<K> one{constraint.vertices, m, constraint.marker};
    for (auto& v : one.key) v = j.out.vertices[m][v];
    std::ranges::sort(one.key);
    all.push_back(one);
  }
}

/// Calls visit(group) for those of one key each, mesh by mesh.
template <std::size_t K, class Visit>
void each_key(std::vector<Listed<K>>& all, const Visit& visit) {
  std::ranges::stable_sort(all, [](const auto& a, const auto& b) { return std::tie(a.key, a.mesh) < std::tie(b.key, b.mesh); });
  for (std::size_t i = 0, k; i < all.size(); i = k) {
    for (k = i + 1; k < all.size() && all[k].key == all[i].key;) ++k;
    visit(std::span<const Listed<K>>(all).subspan(i, k - i));
  }
}

template <class Constraint>
bool by_vertices(const Constraint& a, const Constraint& b) {
  return a.vertices < b.vertices;
}

template <int D>
class WallJoiner {
 public:
  explicit WallJoiner(Joining<D>& joining) : j_(joining) {}

  void run() {
    for (std::uint32_t m = 0; m < j_.meshes.size(); ++m) add_listed<D, D>(j_, m, walls(*j_.meshes[m]), all_);
    for (const OuterFace<D>& f : j_.outer) all_.push_back({f.vertices, no_mesh, 0});
    add_between_labels();
    auto& made = made_walls();
    each_key(all_, [&](std::span<const Listed<D>> group) { made.push_back(joined(group)); });
    std::ranges::sort(made, by_vertices<typename std::remove_reference_t<decltype(made)>::value_type>);
    j_.out.interfaces = list_of(interfaces_);
  }

 private:
  auto& made_walls() {
    if constexpr (D == 2)
      return j_.out.mesh.subsegments;
    else
      return j_.out.mesh.subfacets;
  }

  void add_between_labels() {
    bool have_labels = false;
    for (const OutputMesh<D>* mesh : j_.meshes) have_labels = have_labels || !mesh->regions.empty();
    if (!have_labels) return;
    const auto label = [&](std::uint32_t c) {
      const std::uint32_t m = j_.mesh_of(c);
      return j_.label(m, c - j_.out.first_cell[m]);
    };
    each_face_group<D>(j_.out.mesh, [&](std::uint32_t least, std::span<const CellFace<D>> group) {
      if (group.size() != 2 || label(group[0].cell()) == label(group[1].cell())) return;
      Listed<D> one{{least}, no_mesh, 0};
      std::ranges::copy(group[0].others, one.key.begin() + 1);
      all_.push_back(one);
    });
  }

  /// Outer faces come in the order of their vertices, as the groups do.
  typename OutputMesh<D>::template Constraint<D> joined(std::span<const Listed<D>> group) {
    while (next_ < j_.outer.size() && j_.outer[next_].vertices < group[0].key) ++next_;
    const bool is_outer = next_ < j_.outer.size() && j_.outer[next_].vertices == group[0].key;
    typename OutputMesh<D>::template Constraint<D> wall{group[0].key, group[0].marker, no_entity};
    if (group[0].mesh == no_mesh) ++j_.out.added_walls;
    if (!is_outer) return wall;
    const OuterFace<D>& f = j_.outer[next_];
    if (f.is_shared) {
      count(f, j_.outer[next_ + 1], group);
    } else {
      wall.vertices = outward_face<D>(j_.out.mesh.cells[f.cell()], f.place % (D + 1));
      if (D == 3) std::rotate(wall.vertices.begin(), std::ranges::min_element(wall.vertices), wall.vertices.end());
    }
    return wall;
  }

  void count(const OuterFace<D>& a, const OuterFace<D>& b, std::span<const Listed<D>> group) {
    const auto marker = [&](std::uint32_t mesh) {
      const auto at = std::ranges::find(group, mesh, &Listed<D>::mesh);
      return at == group.end() ? 0 : at->marker;
    };
    const std::array<std::uint32_t, 2> meshes{std::min(a.mesh, b.mesh), std::max(a.mesh, b.mesh)};
    ++interfaces_[{meshes, {marker(meshes[0]), marker(meshes[1])}}];
  }

  Joining<D>& j_;
  std::vector<Listed<D>> all_;
  std::size_t next_ = 0;
  Counts interfaces_;
};

void join_segments(Joining<3>& j) {
  std::vector<Listed<2>> all;
  for (std::uint32_t m = 0; m < j.meshes.size(); ++m) add_listed<3, 2>(j, m, j.meshes[m]->subsegments, all);
  Counts shared;
  auto& made = j.out.mesh.subsegments;
  each_key(all, [&](std::span<const Listed<2>> group) {
    made.push_back({group[0].key, group[0].marker, no_entity});
    for (std::size_t i = 1; i < group.size(); ++i)
      if (group[i].mesh != group[i - 1].mesh) ++shared[{{group[0].mesh, group[i].mesh}, {group[0].marker, group[i].marker}}];
  });
  j.out.shared_segments = list_of(shared);
}

}  // namespace

template <int D>
void join_constraints(Joining<D>& joining) {
  WallJoiner<D>(joining).run();
  if constexpr (D == 3) join_segments(joining);
}

template void join_constraints<2>(Joining<2>&);
template void join_constraints<3>(Joining<3>&);

}  // namespace pgdr::detail

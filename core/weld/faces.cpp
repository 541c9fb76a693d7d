// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "input/words.hpp"
#include "output/face_groups.hpp"
#include "weld/joining.hpp"

namespace pgdr::detail {
namespace {

/// Whether the vertices of the face run one way or the other, seen from its cell: unlike for cells on its two sides.
template <int D>
bool is_odd(const std::array<std::uint32_t, D>& face) {
  bool odd = false;
  for (std::size_t i = 0; i < D; ++i)
    for (std::size_t k = i + 1; k < D; ++k) odd ^= face[i] > face[k];
  return odd;
}

template <int D>
class FaceJoiner {
 public:
  explicit FaceJoiner(Joining<D>& joining) : j_(joining) {}

  void run() {
    each_face_group<D>(j_.out.mesh, [&](std::uint32_t least, std::span<const CellFace<D>> group) {
      if (least != last_) j_.heed_stop();
      last_ = least;
      take(least, group);
    });
    j_.refusals.throw_any();
  }

 private:
  void take(std::uint32_t least, std::span<const CellFace<D>> group) {
    std::array<std::uint32_t, D> face{least};
    std::ranges::copy(group[0].others, face.begin() + 1);
    if (group.size() > 2) return refuse(face, group);
    if (group.size() == 2 && side(group[0]) == side(group[1])) return refuse(face, group);
    const std::uint32_t m = j_.mesh_of(group[0].cell()), n = j_.mesh_of(group.back().cell());
    if (group.size() == 2 && m == n) return;
    j_.outer.push_back({face, group[0].place, m, group.size() == 2});
    if (m != n) j_.outer.push_back({face, group[1].place, n, true});
  }

  bool side(const CellFace<D>& f) const { return is_odd<D>(outward_face<D>(j_.out.mesh.cells[f.cell()], f.corner())); }

  /// Of three cells two are on one side. Those of two meshes are named if there are such, since a mesh by itself should be sound.
  void refuse(const std::array<std::uint32_t, D>& face, std::span<const CellFace<D>> group) {
    std::array<std::uint32_t, 2> pair{};
    bool is_one_mesh = true;
    for (std::size_t i = 0; i < group.size() && is_one_mesh; ++i)
      for (std::size_t k = i + 1; k < group.size() && is_one_mesh; ++k) {
        if (side(group[i]) != side(group[k])) continue;
        pair = {group[i].cell(), group[k].cell()};
        is_one_mesh = j_.mesh_of(pair[0]) == j_.mesh_of(pair[1]);
      }
    const Errc code = is_one_mesh ? Errc::inconsistent_orientation : Errc::bodies_overlap;
    j_.refusals.add(code, [&] {
      Diagnostic d{.code = code};
      const std::uint32_t m = j_.mesh_of(pair[0]);
      std::string vertices;
      for (const std::uint32_t v : face) {
        vertices += (vertices.empty() ? "" : ", ") + std::to_string(j_.number_in(m, v));
        d.points.push_back(in_space(j_.out.mesh.points[v]));
      }
      for (const std::uint32_t c : pair) d.ids.push_back(static_cast<std::int64_t>(c - j_.out.first_cell[j_.mesh_of(c)]));
      const auto cell = [&](std::size_t i) { return "cell " + std::to_string(d.ids[i]) + " of " + j_.name(j_.mesh_of(pair[i])); };
      d.message = cell(0) + " and " + cell(1) + " are on the same side of the " + (D == 2 ? "edge" : "face") +
                  " with the vertices " + vertices + " of " + j_.name(m) + ", at " + to_text(j_.out.mesh.points[face[0]]);
      return d;
    });
  }

  Joining<D>& j_;
  std::uint32_t last_ = 0;
};

}  // namespace

template <int D>
void join_faces(Joining<D>& joining) {
  FaceJoiner<D>(joining).run();
}

template void join_faces<2>(Joining<2>&);
template void join_faces<3>(Joining<3>&);

}  // namespace pgdr::detail

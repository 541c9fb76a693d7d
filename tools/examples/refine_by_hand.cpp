// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Example: the method by itself, in the plane and on one thread. Delaunay refinement (Ruppert 1995, "A Delaunay refinement
// algorithm for quality 2-dimensional mesh generation"; Chernikov's dissertation, chapter 2) takes the constrained Delaunay
// triangulation of the input, and
//
//   (1) splits in the middle each subsegment with a point inside of its diametral circle (it is *encroached*);
//   (2) inserts the circumcentre of each triangle whose circumradius is over `bound` times its shortest edge; or, where that
//   would
//       encroach upon subsegments, splits these instead.
//
// A bound of sqrt(2) or more ends where no two segments meet at less than 60 degrees. What the library adds to this is a rule
// that ends it for any angles (core/rule/insertion_rule.hpp), the third dimension, regions that are refined at once, and the
// optimiser. This is for who wants to read how it works: it is made of the library's private parts. Programs call refine()
// instead.
//
//   example_refine_by_hand [BOUND]     a plate with a square hole, checked; exit code 0 if all is as it should be
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <exception>
#include <limits>
#include <optional>
#include <vector>

#include "boundary/labeling.hpp"
#include "boundary/recovery.hpp"
#include "cavity/cavity.hpp"
#include "cavity/delaunay.hpp"
#include "compact/compact.hpp"
#include "pgdr/pgdr.hpp"

namespace {

using namespace pgdr;

/// A cell as it was when it was listed; it may be gone when its turn comes.
struct Listed {
  CellId cell;
  std::uint16_t birth;
};

/// The mesh, and what waits in it.
class Refinement : Cavity<2>::FaceWatch {
 public:
  Refinement(Mesh<2>& mesh, Mesh<2>::Pools& pools, const Domain<2>& domain, double bound)
      : mesh_(&mesh), pools_(&pools), cavity_(mesh, &domain), bound_(bound) {
    for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
      if (mesh.alive(CellId{i})) list(CellId{i});
  }

  void run() {
    while (!subsegments_.empty() || !triangles_.empty()) {
      std::deque<Listed>& from = subsegments_.empty() ? triangles_ : subsegments_;
      const Listed next = from.front();
      from.pop_front();
      if (!mesh_->alive(next.cell) || mesh_->birth(next.cell) != next.birth) continue;
      if (const std::optional<int> face = encroached_face(next.cell)) {
        split(next.cell, *face);
      } else if (is_poor(next.cell)) {
        insert_center(next);
      }
    }
  }

 private:
  std::array<Point<2>, 2> ends(CellId c, int face) const {
    const auto p = mesh_->simplex(c);
    return {p[(face + 1) % 3], p[(face + 2) % 3]};
  }

  /// A subsegment of the triangle with the triangle's corner inside of its diametral circle.
  std::optional<int> encroached_face(CellId c) const {
    for (int face = 0; face < 3; ++face) {
      if (!mesh_->constrained(c, face)) continue;
      const auto [a, b] = ends(c, face);
      if (in_diametral_ball<2>(a, b, mesh_->simplex(c)[face])) return face;
    }
    return std::nullopt;
  }

  bool is_poor(CellId c) const {
    double shortest = std::numeric_limits<double>::infinity();
    for (int face = 0; face < 3; ++face) {
      const auto [a, b] = ends(c, face);
      shortest = std::min(shortest, squared_distance(a, b));
    }
    return mesh_->sphere(c).radius2 > bound_ * bound_ * shortest;
  }

  void list(CellId c) {
    if (encroached_face(c)) {
      subsegments_.push_back({c, mesh_->birth(c)});
    } else if (is_poor(c)) {
      triangles_.push_back({c, mesh_->birth(c)});
    }
  }

  /// Cavities are cut back to what the point sees, and may not lose a vertex; then new triangles join the point to their
  /// boundary.
  void insert(Cavity<2>::Status collected, Home home) {
    const bool fits = collected == Cavity<2>::Status::ok && cavity_.make_star_shaped() == Cavity<2>::Status::ok &&
                      cavity_.keep_entities() == Cavity<2>::Status::ok;
    if (!fits) return cavity_.release();
    cavity_.commit(*pools_, home, std::numeric_limits<float>::infinity());
    for (const CellId c : cavity_.new_cells()) list(c);
  }

  void split(CellId c, int face) {
    const EntityRef segment = mesh_->entity_of_face(c, face);
    const auto [a, b] = ends(c, face);
    insert(cavity_.collect_on_face(diametral_ball<2>(a, b).center, c, face), Home(segment.kind, segment.id));
  }

  /// The cavity stops at the first subsegment that its point encroaches upon (stops_at): that is split, and the triangle, if it
  /// is still there, waits again.
  void insert_center(Listed triangle) {
    center_ = mesh_->center(triangle.cell);
    const Cavity<2>::Status status = cavity_.collect(center_, triangle.cell, this);
    if (status != Cavity<2>::Status::stopped) return insert(status, Home(EntityKind::volume, 0));
    cavity_.release();
    split(blocked_by_.cell, blocked_by_.face);
    triangles_.push_back(triangle);
  }

  bool stops_at(CellId c, int face) override {
    const auto [a, b] = ends(c, face);
    if (!in_diametral_ball<2>(a, b, center_)) return false;
    blocked_by_ = {c, face};
    return true;
  }

  Mesh<2>* mesh_;
  Mesh<2>::Pools* pools_;
  Cavity<2> cavity_;
  double bound_;
  Point<2> center_{};                           ///< what insert_center() would put in
  Cavity<2>::BoundaryFace blocked_by_{};        ///< what it encroaches upon
  std::deque<Listed> subsegments_, triangles_;  ///< encroached, of a triangle; poor
};

/// 4 by 3, with a square hole of 0.2.
Plc<2> plate() {
  Plc<2> plc;
  plc.points = {{{0, 0}}, {{4, 0}}, {{4, 3}}, {{0, 3}}, {{1, 1}}, {{1.2, 1}}, {{1.2, 1.2}}, {{1, 1.2}}};
  for (std::uint32_t i = 0; i < 8; ++i) plc.segments.push_back({{i, i / 4 * 4 + (i + 1) % 4}, 1});
  plc.holes = {{{1.1, 1.1}}};
  return plc;
}

int refine_by_hand(double bound) {
  const Plc<2> plc = plate();
  const Domain<2> domain(plc);
  Mesh<2> mesh;
  auto pools = mesh.make_pools();
  Delaunay<2> delaunay(mesh, pools);
  delaunay.build(domain.points());
  RecoveryCounts counts;
  recover_boundary<2>(mesh, pools, delaunay, domain, {}, std::chrono::steady_clock::now(), counts);
  std::vector<Diagnostic> warnings;
  carve<2>(mesh, pools, delaunay, domain, RegionMode::seeds, warnings);
  Refinement(mesh, pools, domain, bound).run();
  const OutputMesh<2> made = compact<2>(std::move(mesh), domain, {}, detail::OneByOne()).mesh;
  CheckOptions<2> options;
  options.input = &plc;
  options.radius_edge_bound = bound;
  options.delaunay = true;
  const CheckReport report = check(made, options);
  for (const CheckFinding& f : report.findings) std::printf("%s\n", f.message.c_str());
  std::printf("%zu triangles, none over %g\n", made.cells.size(), bound);
  return report.exit_code();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return refine_by_hand(argc > 1 ? std::atof(argv[1]) : std::sqrt(2.0));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "example_refine_by_hand: %s\n", e.what());
    return 2;
  }
}

// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "replace/height_proof.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "space/distances.hpp"

namespace pgdr::detail {
namespace {

constexpr bool has_bit(std::uint64_t bits, std::size_t i) { return (bits >> i & 1u) != 0; }

using Triangle = std::array<Point3, 3>;

Vector<3> normal_of(const Triangle& t) { return cross(difference(t[1], t[0]), difference(t[2], t[0])); }

/// The sum of the normals, whichever way round the triangles run: all as that of the largest one. Does not depend on their order.
Vector<3> direction_of(std::vector<Triangle> triangles) {
  std::sort(triangles.begin(), triangles.end(), triangle_less);
  std::vector<Vector<3>> normals;
  for (const Triangle& t : triangles) normals.push_back(normal_of(t));
  const Vector<3> largest = *std::max_element(normals.begin(), normals.end(),
                                              [](const auto& m, const auto& n) { return dot(m, m) < dot(n, n); });
  Vector<3> sum{};
  for (const Vector<3>& n : normals)
    for (std::size_t i = 0; i < 3; ++i) sum[i] += dot(n, largest) < 0 ? -n[i] : n[i];
  return sum;
}

}  // namespace

HeightProof::HeightProof(const ChangingSurface& s, const SurfaceChange& change, double e, std::span<const NearGiven> given,
                         const Box<3>& near)
    : s_(s), change_(change), view_(s.complex, &change), e_(e), near_given_(given), near_(near), given_(given.size()) {
  if (change.come.size() > most_faces) return;
  std::vector<Triangle> come;
  Box<3> box = near;
  for (const SurfaceFace& f : change.come) {
    come.push_back(triangle_after(s.complex, change, f));
    sort_corners(come.back());
    box.add(Box<3>::of(come.back()));
  }
  plane_.emplace(box.low, direction_of(std::move(come)), box.longest_side(), e);
  if (!plane_->is_one()) {
    plane_.reset();
    return;
  }
  for (std::size_t k = 0; k < change.come.size(); ++k) add_face(static_cast<std::uint32_t>(s.complex.faces.size() + k));
  edges_.resize(faces_.size() * given_.size());
}

void HeightProof::add_face(std::uint32_t number) {
  const SurfaceFace& face = view_.face(number);
  Face f{face.corners, face.klass, number, {}};
  std::sort(f.corners.begin(), f.corners.end(),
            [&](std::uint32_t a, std::uint32_t b) { return lex_less(view_.at(a), view_.at(b)); });
  f.raised = plane_->raised({view_.at(f.corners[0]), view_.at(f.corners[1]), view_.at(f.corners[2])});
  faces_.push_back(f);
}

std::vector<std::size_t> HeightProof::longest_first() const {
  std::vector<std::size_t> order(change_.come.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (plane_)
    std::stable_sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) {
      return faces_[a].raised.box.longest_side() > faces_[b].raised.box.longest_side();
    });
  return order;
}

const RaisedTriangle& HeightProof::raised(std::size_t place) {
  Given& g = given_[place];
  if (!g.is_raised) g.raised = plane_->raised(triangle(place).corners);
  g.is_raised = true;
  return g.raised;
}

bool HeightProof::shows_face(std::size_t k) {
  far_.reset();
  if (!plane_ || faces_[k].raised.way == 0) return false;
  const Face& face = faces_[k];
  struct Covering {
    std::size_t place;
    std::uint8_t edges;  // that meet the inside of the face
  };
  std::vector<Covering> covering;
  std::vector<std::uint32_t> left_out;
  covering.reserve(given_.size());
  double farthest = plane_->most_apart();
  std::array<double, 3> where{};
  const Box<3> reach = Box<3>::of(triangle_after(s_.complex, change_, change_.come[k])).widened(e_);
  for (std::size_t i = 0; i < given_.size(); ++i) {
    if (!near_given_[i].box.meets(reach) || triangle(i).klass != face.klass) continue;
    const RaisedTriangle& t = raised(i);
    if (!t.box.meets(face.raised.box)) continue;
    const Overlay o = t.way == 0 ? Overlay{.is_any = true, .is_clear = false} : overlay(face.raised, t);
    if (!o.is_any) continue;
    if (o.is_clear && o.apart <= plane_->most_apart()) {
      covering.push_back({i, o.edges_of_second});
      given_[i].faces |= std::uint64_t{1} << k;
      edges_of(static_cast<std::uint32_t>(k), i) = o.edges_of_first;
      continue;
    }
    left_out.push_back(near_given_[i].number);
    if (!o.is_clear || o.apart <= farthest) continue;
    farthest = o.apart;
    where = o.where;
  }
  if (farthest > plane_->most_apart()) {
    far_.emplace();
    for (std::size_t c = 0; c < 3; ++c)
      for (int i = 0; i < 3; ++i) (*far_)[i] += where[c] * view_.at(face.corners[c])[i];
  }
  const auto is_covered_beyond = [&](const Covering& c, std::size_t edge) {
    if (!is_closed(c.place, edge)) return false;
    const std::uint32_t other = triangle(c.place).beyond[edge];
    return std::find(left_out.begin(), left_out.end(), other) == left_out.end();
  };
  for (const Covering& c : covering)
    for (std::size_t j = 0; j < 3; ++j)
      if (has_bit(c.edges, j) && !is_covered_beyond(c, j)) return false;
  return !covering.empty();
}

bool HeightProof::is_closed(std::size_t place, std::size_t edge) {
  Given& given = given_[place];
  if (has_bit(given.closed, edge)) return true;
  if (has_bit(given.not_closed, edge)) return false;
  const GivenSurface::Triangle& t = triangle(place);
  bool is_one = false;
  if (const std::uint32_t other = t.beyond[edge]; other != no_index) {
    const Point3 &a = t.corners[edge], &b = t.corners[next_corner(edge)];
    for (const Point3& p : s_.given.triangles()[other].corners)
      if (!(p == a) && !(p == b))
        is_one = side_of(given.raised.at[edge], given.raised.at[next_corner(edge)], plane_->at(p)) == -given.raised.way;
  }
  std::uint8_t& bits = is_one ? given.closed : given.not_closed;
  bits = static_cast<std::uint8_t>(bits | (1u << edge));
  return is_one;
}

bool HeightProof::is_other_side(const Face& face, const Face& other, std::size_t edge) const {
  const std::uint32_t a = face.corners[edge], b = face.corners[next_corner(edge)];
  for (std::size_t i = 0; i < 3; ++i)
    if (other.corners[i] != a && other.corners[i] != b)
      return side_of(face.raised.at[edge], face.raised.at[next_corner(edge)], other.raised.at[i]) == -face.raised.way;
  return false;
}

std::uint32_t HeightProof::beyond(std::uint32_t face, std::size_t edge) {
  if (faces_[face].beyond[edge] == not_known) {
    const std::uint32_t other = find_beyond(face, edge);  // which may add one
    faces_[face].beyond[edge] = other;
  }
  return faces_[face].beyond[edge];
}

/// The one other face of its class at an edge, on the other side; no_index if there is none, or there are more.
std::uint32_t HeightProof::find_beyond(std::uint32_t face, std::size_t edge) {
  const std::uint32_t a = faces_[face].corners[edge], b = faces_[face].corners[next_corner(edge)];
  if (!Box<3>::of(std::array{view_.at(a), view_.at(b)}).meets(near_)) return no_index;
  const std::uint32_t number = view_.only_other(faces_[face].number, a, b);
  if (number == no_index || (!view_.is_new(number) && !s_.boxes[number].meets(near_))) return no_index;
  const std::uint32_t other = place_of(number);
  return faces_[other].raised.way != 0 && is_other_side(faces_[face], faces_[other], edge) ? other : no_index;
}

void HeightProof::find_rim() {
  if (has_rim_) return;
  has_rim_ = true;
  const SurfaceComplex& c = s_.complex;
  std::vector<std::uint32_t> around;
  for (std::size_t k = 0; k < change_.come.size(); ++k)
    for (const std::uint32_t v : faces_[k].corners)
      if (v < c.points.size()) around.insert(around.end(), c.faces_at[v].begin(), c.faces_at[v].end());
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  for (const std::uint32_t f : around)
    if (!change_.is_gone(f) && s_.boxes[f].meets(near_)) rim_.push_back(place_of(f));
}

std::uint32_t HeightProof::place_of(std::uint32_t number) {
  const auto known = std::find_if(faces_.begin(), faces_.end(), [number](const Face& f) { return f.number == number; });
  const auto place = static_cast<std::uint32_t>(known - faces_.begin());
  if (known == faces_.end()) add_face(number);
  return place;
}

bool HeightProof::may_be_near(std::size_t k, std::size_t place) {
  if (!plane_ || given_[place].faces != 0) return true;
  if (gone_.empty())
    for (const std::uint32_t f : change_.gone) gone_.push_back(plane_->raised(s_.complex.triangle(f)));
  return !are_apart(gone_[k], raised(place), plane_->least_apart());
}

/// Does what a given triangle has beyond the line of an edge come near the faces that go? Else nobody asks for it. A straight
/// line within the triangle that leaves what is covered there does not come back from beyond.
bool HeightProof::is_near_beyond(std::uint32_t face, std::size_t edge, std::size_t place) const {
  const RaisedTriangle &f = faces_[face].raised, &g = given_[place].raised;
  const auto& corners = triangle(place).corners;
  std::array<double, 3> beyond;  // of each corner, times the edge's length
  for (std::size_t i = 0; i < 3; ++i) {
    const Point2 &a = f.at[edge], &b = f.at[next_corner(edge)], &p = g.at[i];
    beyond[i] = -f.way * ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]));
  }
  Box<3> box = Box<3>::empty();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = next_corner(i);
    if (beyond[i] > 0) box.add(corners[i]);
    if ((beyond[i] > 0) != (beyond[j] > 0)) box.add(on_edge(corners[i], corners[j], beyond[i] / (beyond[i] - beyond[j])));
  }
  constexpr double rounding = 0x1p-12;
  return box.widened(rounding * e_).meets(near_);
}

bool HeightProof::shows_given(std::size_t place) {
  if (!plane_ || raised(place).way == 0) return false;
  Steps steps;
  for (std::uint64_t left = given_[place].faces; left != 0; left &= left - 1) {
    const auto k = static_cast<std::uint32_t>(std::countr_zero(left));
    if (!steps.add(k, edges_of(k, place))) return false;
  }
  if (steps.count > 0) return is_covered(place, steps);
  find_rim();
  const std::uint32_t klass = triangle(place).klass;
  return std::any_of(rim_.begin(), rim_.end(), [&](std::uint32_t face) {
    steps.count = 0;
    return faces_[face].klass == klass && add_staying(face, place, steps) && is_covered(place, steps);
  });
}

bool HeightProof::add_staying(std::uint32_t face, std::size_t place, Steps& steps) {
  if (faces_[face].raised.way == 0) return false;
  const Overlay o = overlay(faces_[face].raised, given_[place].raised);
  return o.is_any && o.is_clear && o.apart <= plane_->most_apart() && steps.add(face, o.edges_of_first);
}

/// Goes on from the faces that are known to be over a given triangle.
bool HeightProof::is_covered(std::size_t place, Steps& steps) {
  for (std::size_t k = 0; k < steps.count; ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      if (!has_bit(steps.all[k].edges, i)) continue;
      const std::uint32_t other = beyond(steps.all[k].face, i);
      if (other == no_index) {
        if (is_near_beyond(steps.all[k].face, i, place)) return false;
        continue;
      }
      if (!steps.has(other) && (other < change_.come.size() || !add_staying(other, place, steps))) return false;
    }
  return true;
}

}  // namespace pgdr::detail

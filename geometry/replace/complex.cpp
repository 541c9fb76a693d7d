// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "replace/complex.hpp"

namespace pgdr::detail {

std::vector<std::uint32_t> SurfaceComplex::neighbours(std::uint32_t v) const {
  std::vector<std::uint32_t> out;
  out.reserve(2 * faces_at[v].size() + kept_at[v].size());
  for (const std::uint32_t f : faces_at[v])
    for (const std::uint32_t w : faces[f].corners)
      if (w != v) out.push_back(w);
  for (const KeptEdge& e : kept_at[v]) out.push_back(e.other);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

void SurfaceComplex::release(std::uint32_t a, std::uint32_t b) {
  const auto drop = [this](std::uint32_t from, std::uint32_t to) {
    auto& list = kept_at[from];
    list.erase(std::remove_if(list.begin(), list.end(), [to](const KeptEdge& e) { return e.other == to; }), list.end());
  };
  drop(a, b);
  drop(b, a);
}

std::uint32_t SurfaceComplex::add_point(const Point3& p, VertexOrder o) {
  points.push_back(p);
  faces_at.emplace_back();
  kept_at.emplace_back();
  order.push_back(o);
  return static_cast<std::uint32_t>(points.size() - 1);
}

std::uint32_t SurfaceComplex::add_face(const SurfaceFace& face) {
  const auto f = static_cast<std::uint32_t>(faces.size());
  faces.push_back(face);
  faces.back().born = ++births_;
  for (const std::uint32_t v : face.corners) faces_at[v].push_back(f);
  return f;
}

void SurfaceComplex::remove_face(std::uint32_t f) {
  for (const std::uint32_t v : faces[f].corners) {
    auto& list = faces_at[v];
    list.erase(std::find(list.begin(), list.end(), f));
  }
  faces[f].alive = false;
}

void SurfaceComplex::put_back_face(std::uint32_t f) {
  faces[f].alive = true;
  for (const std::uint32_t v : faces[f].corners) faces_at[v].push_back(f);
}

void SurfaceComplex::drop_last_face() {
  remove_face(static_cast<std::uint32_t>(faces.size() - 1));
  faces.pop_back();
}

void SurfaceComplex::drop_last_point() {
  points.pop_back();
  faces_at.pop_back();
  kept_at.pop_back();
  order.pop_back();
}

bool triangle_less(std::array<Point3, 3> a, std::array<Point3, 3> b) {
  sort_corners(a);
  sort_corners(b);
  for (std::size_t i = 0; i < 3; ++i) {
    if (lex_less(a[i], b[i])) return true;
    if (lex_less(b[i], a[i])) return false;
  }
  return false;
}

}  // namespace pgdr::detail

// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "join/near_contacts.hpp"

#include <algorithm>

#include "input/edges.hpp"
#include "space/make_set.hpp"

namespace pgdr::detail {

bool NearContacts::add(std::vector<NearPoint> on_edges) {
  const std::size_t before = on_edges_.size();
  on_edges_.insert(on_edges_.end(), on_edges.begin(), on_edges.end());
  make_set(on_edges_);
  return on_edges_.size() > before;
}

std::span<const NearPoint> NearContacts::on_edge(std::uint64_t key) const {
  const auto begin = std::lower_bound(on_edges_.begin(), on_edges_.end(), NearPoint{key, 0, 0});
  auto end = begin;
  while (end != on_edges_.end() && end->key == key) ++end;
  return {begin, end};
}

std::span<const std::pair<std::uint32_t, std::uint32_t>> NearContacts::in_facet(std::uint32_t f) const {
  const auto begin = std::lower_bound(in_facets_.begin(), in_facets_.end(), std::pair{f, 0u});
  auto end = begin;
  while (end != in_facets_.end() && end->first == f) ++end;
  return {begin, end};
}

std::vector<std::uint32_t> NearContacts::chain(std::uint32_t a, std::uint32_t b) const {
  std::vector<std::uint32_t> chain{std::min(a, b)};
  for (const NearPoint& near : on_edge(edge_key(a, b))) chain.push_back(near.point);
  chain.push_back(std::max(a, b));
  if (b < a) std::reverse(chain.begin(), chain.end());
  return chain;
}

bool NearContacts::touches(std::uint32_t f, std::span<const std::uint32_t> polygon) const {
  if (!in_facet(f).empty()) return true;
  for (std::size_t k = 0; k < polygon.size(); ++k)
    if (!on_edge(edge_key(polygon[k], polygon[(k + 1) % polygon.size()])).empty()) return true;
  return false;
}

bool NearContacts::closes(std::span<const std::uint32_t> triangle) const {
  if (on_edges_.empty()) return false;
  for (std::size_t k = 0; k < 3; ++k)
    for (const NearPoint& near : on_edge(edge_key(triangle[(k + 1) % 3], triangle[(k + 2) % 3])))
      if (near.point == triangle[k]) return true;
  return false;
}

auto NearContacts::joined(std::uint32_t f, Polygons polygons) const -> Polygons {
  if (empty()) return polygons;
  Polygons out;
  for (const auto& polygon : polygons) {
    const std::size_t n = polygon.size();
    if (n < 3) {
      const auto points = n == 2 ? chain(polygon[0], polygon[1]) : polygon;
      if (n < 2) out.push_back(polygon);
      for (std::size_t k = 1; k < points.size(); ++k) out.push_back({points[k - 1], points[k]});
      continue;
    }
    auto& finer = out.emplace_back();
    for (std::size_t k = 0; k < n; ++k) {
      const auto points = chain(polygon[k], polygon[(k + 1) % n]);
      finer.insert(finer.end(), points.begin(), points.end() - 1);
    }
  }
  for (const auto& [same, v] : in_facet(f)) out.push_back({v});
  return out;
}

std::vector<std::pair<std::uint64_t, std::uint64_t>> NearContacts::pieces() const {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> pieces;
  for (std::size_t i = 0; i < on_edges_.size(); ++i) {
    const std::uint64_t key = on_edges_[i].key;
    if (i > 0 && on_edges_[i - 1].key == key) continue;
    const auto points = chain(edge_of(key)[0], edge_of(key)[1]);
    for (std::size_t k = 1; k < points.size(); ++k) pieces.emplace_back(edge_key(points[k - 1], points[k]), key);
  }
  make_set(pieces);
  return pieces;
}

void NearContacts::split(std::vector<OwnedEdge>& edges) const {
  std::vector<OwnedEdge> pieces;
  for (const auto& [e, owner] : edges) {
    const auto points = chain(e[0], e[1]);
    for (std::size_t k = 1; k < points.size(); ++k) pieces.push_back({{points[k - 1], points[k]}, owner});
  }
  edges = std::move(pieces);
}

template <int D>
void NearContacts::note(BuildReport<D>& report) const {
  for (const NearPoint& near : on_edges_) report.note_on_edge(near.point, edge_of(near.key)[0], edge_of(near.key)[1]);
  for (const auto& [f, v] : in_facets_) report.note_in_facet(v, f);
}

template void NearContacts::note<2>(BuildReport<2>&) const;
template void NearContacts::note<3>(BuildReport<3>&) const;

}  // namespace pgdr::detail

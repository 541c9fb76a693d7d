// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/wall_cells.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "compact/region_volumes.hpp"
#include "ranks/cell_message.hpp"
#include "transport/message.hpp"

namespace pgdr::detail {
namespace {

template <int D>
Bytes pack_wall_cells(const Mesh<D>& mesh, const IsOwnCell& is_own) {
  std::vector<CellId> at_walls;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
    const auto* k = mesh.constraints(CellId{i});
    if (k && k->faces != 0 && mesh.alive(CellId{i}) && is_own(CellId{i})) at_walls.push_back(CellId{i});
  }
  CellWriter<D> writer(mesh, at_walls.size());
  for (const CellId c : at_walls) writer.add_made(c);
  MessageWriter message;
  writer.take().put(message);
  return message.take();
}

/// The cells at the walls, linked across these. Vertices of different messages are different, though they may be at one place.
template <int D>
class WallMesh {
 public:
  using Face = std::array<Point<D>, D>;

  void add(const SentCells<D>& cells) {
    std::vector<VertexId> vertices;
    for (const SentVertex<D>& sent : cells.vertices) {
      Point<D> p;
      for (int k = 0; k < D; ++k) p[k] = sent.point[static_cast<std::size_t>(k)];
      Home home;
      home.code = sent.home;
      vertices.push_back(mesh_.new_vertex(pools_, p, home, sent.relaxed_radius));
    }
    auto constraints = cells.constraints.begin();
    for (const SentCell<D>& sent : cells.made) {
      const CellId c = mesh_.new_cell(pools_, sent.region);
      std::array<VertexId, D + 1> corners;
      for (std::size_t i = 0; i <= D; ++i) corners[i] = vertices[sent.vertices[i]];
      mesh_.set_vertices(c, corners);
      mesh_.cell(c).links.fill(Link());
      mesh_.ensure_constraints(pools_, c) = *constraints++;
      for (int f = 0; f <= D; ++f)
        if (mesh_.constrained(c, f)) faces_.emplace_back(face(c, f), Link(c, f));
    }
  }
  const Mesh<D>& linked() {
    std::sort(faces_.begin(), faces_.end(), [](const auto& a, const auto& b) { return is_less(a.first, b.first); });
    for (std::size_t i = 0; i + 1 < faces_.size(); ++i) {
      if (is_less(faces_[i].first, faces_[i + 1].first)) continue;
      const Link a = faces_[i].second, b = faces_[i + 1].second;
      mesh_.cell(a.cell()).links[static_cast<std::size_t>(a.face())] = b;
      mesh_.cell(b.cell()).links[static_cast<std::size_t>(b.face())] = a;
    }
    return mesh_;
  }

 private:
  static bool is_less(const Face& a, const Face& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), lex_less<D>);
  }
  Face face(CellId c, int f) const {
    Face points;
    for (int i = 0, k = 0; i <= D; ++i)
      if (i != f) points[static_cast<std::size_t>(k++)] = mesh_.point(mesh_.cell(c).vertices[static_cast<std::size_t>(i)]);
    std::sort(points.begin(), points.end(), lex_less<D>);
    return points;
  }

  Mesh<D> mesh_;
  typename Mesh<D>::Pools pools_ = mesh_.make_pools();
  std::vector<std::pair<Face, Link>> faces_;
};

Bytes pack(const std::vector<RegionVolume>& volumes) {
  MessageWriter message;
  message.put(static_cast<std::uint64_t>(volumes.size()));
  for (const RegionVolume& v : volumes)
    message.put(std::array<double, 4>{v.label, v.volume_meshed, v.volume_given ? 1.0 : 0.0, v.volume_given.value_or(0)});
  return message.take();
}

}  // namespace

template <int D>
std::vector<RegionVolume> region_volumes_on_ranks(Collectives& ranks, const Mesh<D>& mesh, const IsOwnCell& is_own,
                                                  const Domain<D>& domain, std::span<const double> region_attributes,
                                                  const Pieces& pieces) {
  const std::vector<Bytes> all = ranks.gather(0, ranks.together([&] { return pack_wall_cells<D>(mesh, is_own); }));
  Bytes answer = ranks.together([&]() -> Bytes {
    if (ranks.rank() != 0) return {};
    WallMesh<D> walls;
    for (const Bytes& bytes : all) {
      MessageReader message(bytes);
      walls.add(SentCells<D>::get(message));
    }
    return pack(region_volumes<D>(walls.linked(), domain, region_attributes, pieces));
  });
  answer = ranks.broadcast(0, std::move(answer));
  MessageReader message(answer);
  std::vector<RegionVolume> volumes;
  for (auto left = message.get<std::uint64_t>(); left > 0; --left) {
    const auto v = message.get<std::array<double, 4>>();
    volumes.push_back({v[0], v[1], v[2] != 0 ? std::optional(v[3]) : std::nullopt});
  }
  return volumes;
}

template std::vector<RegionVolume> region_volumes_on_ranks<2>(Collectives&, const Mesh<2>&, const IsOwnCell&, const Domain<2>&,
                                                              std::span<const double>, const Pieces&);
template std::vector<RegionVolume> region_volumes_on_ranks<3>(Collectives&, const Mesh<3>&, const IsOwnCell&, const Domain<3>&,
                                                              std::span<const double>, const Pieces&);

}  // namespace pgdr::detail

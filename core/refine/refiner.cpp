// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The lists of a visit and the order in which they are worked off.
#include "refine/refiner.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "mesh/surroundings.hpp"
#include "space/box.hpp"

namespace pgdr {
namespace {

constexpr std::uint64_t most_lost_work = 20'000'000;  // of rewrapping large regions in one visit: some seconds
constexpr std::uint64_t most_lost_inside = 50'000;  // likewise, once entities have been refused

}  // namespace

template <int D>
RefineContext<D>::RefineContext(Mesh<D>& m, const Domain<D>& d, const RefineOptions<D>& o, CellBounds<D> b,
                                std::uint64_t vertices_so_far, std::chrono::steady_clock::time_point start_time)
    : mesh(m),
      domain(d),
      options(o),
      bounds(std::move(b)),
      start(start_time),
      shells(d, D == 2),
      vertices(vertices_so_far),
      last_progress(start_time) {
  base_exponent = std::ilogb(detail::Box<D>::of(domain.points()).longest_side());
}

template <int D>
int RefineContext<D>::bucket_of(const FilterSphere<D>& sphere) const {
  const double r2 = sphere.radius2;
  if (!(r2 < std::numeric_limits<double>::infinity())) return 0;
  // floor(log2(side / r)) up to one: ilogb of r^2 halved, rounding down. Of a normal number ilogb is in its bits.
  const int biased = static_cast<int>(std::bit_cast<std::uint64_t>(r2) >> 52);
  const int e = biased > 0 ? biased - 1023 : std::ilogb(r2);
  return std::clamp(base_exponent - (e >> 1), 0, buckets - 1);
}

template <int D>
double RefineContext<D>::largest_radius(int bucket) const {
  return bucket == 0 ? std::numeric_limits<double>::infinity() : std::ldexp(1.0, base_exponent - bucket + 1);
}

template <int D>
bool RefineContext<D>::ended() {
  if (options.stop.stop_requested()) {
    stop = static_cast<int>(StopCause::cancelled);
  } else if (stop == 0 && options.time_limit && std::chrono::steady_clock::now() - start >= *options.time_limit) {
    stop = static_cast<int>(StopCause::time_limit);
  }
  return stop != 0;
}

template <int D>
Refiner<D>::Refiner(RefineContext<D>& context, Pools pools)
    : context_(&context),
      mesh_(&context.mesh),
      domain_(&context.domain),
      options_(&context.options),
      quick_bounds_(context.bounds),
      pools_(std::move(pools)),
      cavity_(context.mesh, &context.domain),
      flips_(context.mesh, context.domain),
      move_(context.mesh, context.domain) {
  cavity_.set_seen(&seen_);
  flips_.set_ended([this] { return context_->ended(); });
}

template <int D>
void Refiner<D>::list_poor(CellId c, int why, const FilterSphere<D>& sphere, std::uint32_t order) {
  assert(!visit_->area || visit_->area->owns(*mesh_, c));
  const Item e = make_entry(c, EntryKind::cell, why, context_->bucket_of(sphere), order);
  if (!visit_->area || visit_->area->is_home(sphere.center)) return visit_->list->push_poor(e);
  abroad_.push_back(e);
}

/// The shortest edge, shortest first, then the circumradius: smallest first, but largest first below the smallest proved
/// bound, where it makes the smaller meshes (docs/selectors.md). Of both squares the exponent and four bits of the mantissa.
template <int D>
std::uint32_t Refiner<D>::order_of(CellId c, const FilterSphere<D>& sphere) const {
  auto leading = [](double v) { return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(v) >> 48); };
  const std::uint32_t edge = leading(shortest_edge_squared<D>(mesh_->simplex(c))), radius = leading(sphere.radius2);
  const bool proved = options_->radius_edge_bound >= smallest_proved_bound<D>();
  return edge << 16 | (proved ? radius : 0xffffu - radius);
}

/// Is x close beside an end of pq, at a right angle from it, but for 4e-6 of it? Split next to an input vertex (twins.hpp), a
/// subsegment would else be split for it again and again where the rounded point is some ulps off its place.
template <int D>
bool is_beside_end(const Point<D>& p, const Point<D>& q, const Point<D>& x) {
  const double to_p = squared_distance(p, x), to_q = squared_distance(q, x);
  if (std::min(to_p, to_q) > beside * beside * std::max(to_p, to_q)) return false;
  double along = 0;
  for (int i = 0; i < D; ++i) along += (p[i] - x[i]) * (q[i] - x[i]);
  return along * along < 0x1p-36 * to_p * to_q;
}

template <int D>
void Refiner<D>::list_entities(CellId c, const ConstraintRecord<D>& k) {
  if (options_->keep_boundary) return;
  const auto& vertices = mesh_->cell(c).vertices;
  for (int f = 0; f <= D; ++f)
    if ((k.faces >> f & 1) && face_encroached_by(c, f, vertices[f]))
      visit_->list->push(make_entry(c, EntryKind::face, f));
  if constexpr (D == 3) {
    for (int e = 0; e < 6; ++e) {
      if (!(k.edges >> e & 1)) continue;
      const auto [a, b] = edge_ends[e];
      const EntityRef segment{EntityKind::segment, k.edge_entity[e]};
      for (int i = 0; i <= D; ++i) {
        if (i == a || i == b || lies_on<D>(*domain_, mesh_->vertex(vertices[i]).home, segment)) continue;
        const Point<D>&p = mesh_->point(vertices[a]), &q = mesh_->point(vertices[b]), &x = mesh_->point(vertices[i]);
        if (!in_diametral_ball<D>(p, q, x) || is_beside_end(p, q, x)) continue;
        visit_->list->push(make_entry(c, EntryKind::edge, e));
        break;
      }
    }
  }
}

template <int D>
void Refiner<D>::list_cell(CellId c) {
  if (const auto* k = mesh_->constraints(c)) list_entities(c, *k);
  list_if_poor(c);
}

template <int D>
void Refiner<D>::list_if_poor(CellId c) {
  const CellVerdict verdict = context_->bounds.test(*mesh_, c);
  if (!verdict) return;
  const FilterSphere<D> sphere = mesh_->sphere(c);
  if (verdict.over_size > 0) return list_poor(c, Item::over_size, sphere, verdict.over_size);
  list_poor(c, Item::over_radius_edge, sphere, order_of(c, sphere));
}

/// The same of the i-th cell that the last insertion has made, whose shape is known.
template <int D>
void Refiner<D>::list_new_if_poor(std::size_t i) {
  using Answer = typename QuickBounds<D>::Answer;
  const FilterSphere<D> sphere = cavity_.sphere_of_new(i);
  const CellShape shape = cavity_.shape_of_new(i, sphere);
  const Answer answer = quick_bounds_.look(shape);
  if (answer == Answer::within) return;
  const CellId c = cavity_.new_cells()[i];
  const bool too_big = answer == Answer::over_size;
  const std::uint32_t over_size = too_big ? quick_bounds_.over_size(shape) : context_->bounds.over_size(*mesh_, c, shape);
  if (over_size > 0) {
    list_poor(c, Item::over_size, sphere, over_size);
  } else if (context_->bounds.over_radius_edge(*mesh_, c, shape)) {
    list_poor(c, Item::over_radius_edge, sphere, order_of(c, sphere));
  }
}

template <int D>
void Refiner<D>::add_violations(CellId c, std::vector<Entry<D>>& to) const {
  for (int f = 0; f <= D; ++f)
    if (flips_.violates(c, f)) to.push_back(make_entry(c, EntryKind::flip, f));
}

template <int D>
void Refiner<D>::add_violations(CellId c, const SlotSet& looked_at, std::vector<Entry<D>>& to) const {
  for (int f = 0; f <= D; ++f) {
    const Link beyond = mesh_->cell(c).links[f];
    const bool both = beyond && looked_at[index(beyond.cell())];
    if ((both && beyond.cell() < c) || !flips_.violates(c, f)) continue;
    to.push_back(make_entry(c, EntryKind::flip, f));
    if (both) to.push_back(make_entry(beyond.cell(), EntryKind::flip, beyond.face()));
  }
}

/// Into the visit's list; as many as that were.
template <int D>
std::uint64_t Refiner<D>::list_violations(std::span<const CellId> cells) {
  found_.clear();
  for (const CellId c : cells) add_violations(c, found_);
  for (const Item& e : found_) visit_->list->flips.push(e);
  return found_.size();
}

template <int D>
void Refiner<D>::committed() {
  ++visit_->counts.committed;
  visit_->changed_mesh = true;
  const std::vector<CellId>& made = cavity_.new_cells();
  for (std::size_t i = 0; i < made.size(); ++i) {
    if (const auto* k = mesh_->constraints(made[i])) list_entities(made[i], *k);
    list_new_if_poor(i);
  }
  // A cavity that was not cut back keeps every face locally Delaunay, if all were.
  if (!cavity_.shrunk() && !visit_->violations_seen) return;
  const std::uint64_t found = list_violations(made);
  visit_->violations_seen = visit_->violations_seen || found > 0;
  flips_left_ += 16 * found;  // an allowance, so that flips that trade violations end
}

/// While no entity has been refused, and inside the volume, a constrained Delaunay triangulation should exist, if in a large
/// region. What is left there cuts back the cavities of points to come, so that it grows; small regions do for most of it.
template <int D>
auto Refiner<D>::rewrap_effort(const Item& e) const -> std::optional<LocalRewrap::Effort> {
  if constexpr (D == 2) return std::nullopt;
  constexpr int few = 2;
  const auto& vertices = mesh_->cell(e.cell).vertices;
  const auto inside = std::count_if(vertices.begin(), vertices.end(), [this](VertexId v) { return in_volume(v); });
  const bool refused = visit_->entities_refused;
  if ((!refused || inside == D + 1) && flips_.rewrap_pays(refused ? most_lost_inside : most_lost_work)) return LocalRewrap::Effort::wide;
  if (inside >= few) return LocalRewrap::Effort::quick;
  return std::nullopt;
}

template <int D>
void Refiner<D>::flip(const Item& e) {
  if (!flips_.violates(e.cell, e.which())) return;
  auto outcome = LocalFlips<D>::Outcome::stuck;
  auto still_stuck = [&] { return flips_left_ > 0 && outcome == LocalFlips<D>::Outcome::stuck; };
  if (still_stuck()) outcome = flips_.repair(pools_, e.cell, e.which());
  if (still_stuck())
    if (const auto effort = rewrap_effort(e)) outcome = flips_.rewrap(pools_, e.cell, e.which(), *effort);
  if (outcome == LocalFlips<D>::Outcome::not_owned) return visit_->set_aside.push_back(e);
  if (outcome == LocalFlips<D>::Outcome::stuck) return list_poor(e.cell, Item::not_delaunay, mesh_->sphere(e.cell), 0);
  --flips_left_;
  flipped();
}

/// Lists what the last flip, or rewrapping, has made.
template <int D>
void Refiner<D>::flipped() {
  visit_->changed_mesh = true;
  const std::vector<CellId> made = flips_.new_cells();
  for (const CellId c : made) list_cell(c);
  list_violations(made);
}

template <int D>
void Refiner<D>::look_at_budget() {
  const auto& counts = visit_->counts;
  if (options_->stop.stop_requested()) context_->stop = static_cast<int>(StopCause::cancelled);
  const std::uint64_t treated = counts.committed + counts.improved + counts.refused;
  if (treated < checked_at_) return;
  const std::uint64_t vertices = context_->vertices.fetch_add(counts.committed - reported_) + counts.committed - reported_;
  reported_ = counts.committed;
  const auto now = std::chrono::steady_clock::now();
  // Callbacks may be slow: the clock is looked at about every other millisecond.
  stride_ = now - checked_time_ > std::chrono::milliseconds(2) ? std::max<std::uint64_t>(stride_ / 4, 1)
                                                               : std::min<std::uint64_t>(stride_ * 2, 256);
  checked_at_ = treated + stride_;
  checked_time_ = now;
  context_->ended();
  if (!options_->progress) return;
  const std::unique_lock lock(context_->progress_mutex, std::try_to_lock);
  if (!lock || now - context_->last_progress < std::chrono::milliseconds(200)) return;
  context_->last_progress = now;
  options_->progress({vertices, visit_->list->size()});
}

template <int D>
bool Refiner<D>::may_go_on() {
  look_at_budget();
  return context_->stop.load(std::memory_order_relaxed) == 0 && visit_->counts.committed < visit_->most_insertions;
}

/// That it took to decide about e; a selector may look at others.
template <int D>
std::vector<CellId> Refiner<D>::cells_seen(const Item& e) {
  if (options_->selector) return {};
  seen_.push_back(e.cell);
  distinct_.reset(seen_.size());
  std::erase_if(seen_, [this](CellId c) { return !distinct_.insert(index(c)); });
  return {seen_.begin(), seen_.end()};
}

template <int D>
void Refiner<D>::record_refusal(const Item& e) {
  std::vector<CellId> seen = cells_seen(e);
  const std::uint64_t surroundings = surroundings_of<D>(*mesh_, seen).value_or(0);
  const std::uint64_t versions = context_->improvement ? versions_about<D>(*mesh_, e.cell) : 0;
  visit_->list->refused.push_back({e, last_refusal_, visit_->order, visit_->generation, std::move(seen), surroundings, versions});
  visit_->entities_refused = visit_->entities_refused || e.kind() != EntryKind::cell;
}

template <int D>
auto Refiner<D>::treat_poor(const Item& e) -> Outcome {
  if constexpr (D == 3)
    if (context_->improvement) return improve(e);
  return treat_cell(e);
}

/// One entry. Whether one that the visit does not own is still alive depends on timing: of those set aside, what is dead by
/// the end of the generation is left out (put_off), so that what remains does not.
template <int D>
void Refiner<D>::treat(const Item& e) {
  std::array<VertexId, D + 1> vertices;
  if (!mesh_->read_vertices(e.cell, e.birth, vertices)) return;
  if (visit_->area && !visit_->area->owns(*mesh_, vertices)) return visit_->set_aside.push_back(e);
  last_refusal_.reset();
  seen_.clear();
  Outcome outcome = Outcome::committed;
  switch (e.kind()) {
    case EntryKind::edge: outcome = split_edge(e, nullptr); break;
    case EntryKind::face: outcome = split_face(e, nullptr); break;
    case EntryKind::flip: return flip(e);
    case EntryKind::cell: outcome = treat_poor(e); break;
  }
  if (outcome == Outcome::refused && alive(e)) record_refusal(e);
  if (outcome == Outcome::not_owned) visit_->set_aside.push_back(e);
}

/// All that wait. False if the visit may not go on.
template <int D>
bool Refiner<D>::treat_entities() {
  WorkList<D>& list = *visit_->list;
  while (may_go_on()) {
    if (!list.edges.empty()) {
      treat(list.edges.pop());
    } else if (!list.faces.empty()) {
      treat(list.faces.pop());
    } else if (!list.flips.empty()) {
      treat(list.flips.pop());
    } else {
      return true;
    }
  }
  return false;
}

template <int D>
void Refiner<D>::begin(RegionVisit<D>& visit) {
  visit_ = &visit;
  abroad_.clear();
  seen_.clear();
  memo_.clear();
  cavity_.set_area(visit.area);
  cavity_.set_most_cells(context_->improvement ? most_cells_changed : std::numeric_limits<std::size_t>::max());
  flips_.set_area(visit.area);
  move_.set_area(visit.area);
  flips_left_ = 0;
  checked_at_ = reported_ = 0;
}

/// To the leaves that they belong to. Most do not live until the end of the visit, which owns their cells and so can tell.
template <int D>
void Refiner<D>::send_abroad() {
  auto& boxes = visit_->outboxes;
  assert(boxes.empty());
  std::erase_if(abroad_, [this](const Item& e) { return !alive(e); });
  letters_.clear();  // of each entry, its box
  box_sizes_.clear();
  for (const Item& e : abroad_) {
    const std::uint32_t leaf = visit_->area->leaf_of(mesh_->center(e.cell));
    std::size_t box = boxes.size();
    while (box > 0 && boxes[box - 1].leaf != leaf) --box;
    if (box == 0) {
      boxes.push_back({leaf, {}});
      box_sizes_.push_back(0);
      box = boxes.size();
    }
    letters_.push_back(static_cast<std::uint32_t>(box - 1));
    ++box_sizes_[box - 1];
  }
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i].entries.reserve(box_sizes_[i]);
  for (std::size_t i = 0; i < abroad_.size(); ++i) boxes[letters_[i]].entries.push_back(abroad_[i]);
  abroad_.clear();
}

template <int D>
void Refiner<D>::run(RegionVisit<D>& visit) {
  begin(visit);
  WorkList<D>& list = *visit.list;
  // An allowance for the faces that wait from before.
  flips_left_ += 16 * list.flips.size();
  for (const Item& e : visit.given) flips_left_ += e.kind() == EntryKind::flip ? 16 : 0;
  bool go_on = treat_entities();
  for (std::size_t i = 0; i < visit.given.size(); ++i) {
    if (go_on) {
      treat(visit.given[i]);
      go_on = treat_entities();
    } else {
      visit.set_aside.push_back(visit.given[i]);
    }
  }
  int last_bucket = std::numeric_limits<int>::max();
  if (list.poor() > 0 && visit.granularity < RefineContext<D>::buckets) last_bucket = list.first_bucket() + visit.granularity;
  while (visit.treat_list && list.poor() > 0 && go_on) {
    const int bucket = list.first_bucket();
    if (bucket > last_bucket) break;
    const bool crowded = list.is_crowded(visit.floor);
    if (crowded && context_->largest_radius(bucket) <= visit.small_radius) break;
    // The largest go first where the region is to be split, or where the visit is to end by size.
    const bool by_size = (crowded && visit.small_radius > 0) || last_bucket < std::numeric_limits<int>::max();
    const Item e = by_size ? list.pop_largest(*mesh_) : list.pop_poor(*mesh_);
    if (!alive(e)) continue;  // most
    treat(e);
    go_on = treat_entities();
  }
  context_->vertices += visit.counts.committed - reported_;
  send_abroad();
  visit_ = nullptr;
}

template struct RefineContext<2>;
template struct RefineContext<3>;
template class Refiner<2>;
template class Refiner<3>;

}  // namespace pgdr

// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Diagnosis: its order, its words, its errors.
#include "pgdr/diagnosis.hpp"

#include <algorithm>

#include "diagnose/diagnoser.hpp"
#include "diagnose/near_pieces.hpp"
#include "input/words.hpp"

namespace pgdr {

std::string_view name(Finding kind) {
  constexpr std::array<std::string_view, finding_kinds> names{
      "invalid_entities",  "facets_cross",           "facets_overlap",      "segments_cross_facets",
      "segments_cross",    "points_on_facets",       "points_on_segments",  "encloses_nothing",
      "duplicate_points",  "unreferenced_points",    "repeated_facets",     "open_boundaries",
      "near_points",       "non_manifold_edges",     "non_manifold_points", "inconsistent_orientation",
      "segments_below_60", "segment_facet_below_90", "facets_below_90"};
  return names[static_cast<std::size_t>(kind)];
}

namespace detail {

template <int D>
void Diagnoser<D>::run() {
  if (p_.empty()) return;
  stop_check_();
  collect_triangles();
  pieces_ = pieces_of(domain_, bulk_);
  stop_check_();
  find_meetings();
  if (!options_.errors_only) {
    find_repairs();
    find_unreferenced();
    if constexpr (D == 3) {
      find_non_manifold_edges();
      stop_check_();
      find_non_manifold_points();
      stop_check_();
      find_orientation();
    }
    find_angles();
  }
  stop_check_();
  find_open_boundary();
  if (!options_.errors_only) find_near_points();
  find_encloses_nothing();
}

template <int D>
std::string Diagnoser<D>::point_words(std::uint32_t v) const {
  return std::to_string(point_number(v)) + " " + to_text(p_[v]);
}

template <int D>
std::string Diagnoser<D>::segment_words(EntityId s) const {
  const DomainSegment& segment = domain_.segments()[s];
  if (segment.input_facet != no_entity)
    return "facet " + std::to_string(number(segment.input_facet)) + ", the segment " + edge_words(segment.points);
  if (segment.input == no_entity) return "the edge " + edge_words(segment.points);
  return "segment " + std::to_string(number(segment.input)) + " " + edge_words(segment.points);
}

template <int D>
PlcSource::Place Diagnoser<D>::segment_place(EntityId s) const {
  const std::uint32_t input = domain_.segments()[s].input, facet = domain_.segments()[s].input_facet;
  if (facet != no_entity) return facet_place(facet);
  return input == no_entity ? PlcSource::Place{domain_.source().file} : domain_.source().place(SourceItem::segment, input);
}

template <int D>
void Diagnoser<D>::list(Finding kind, Errc code, std::string message, PlcSource::Place place, Ids ids,
                        const std::vector<Point<D>>& where, double measure) {
  FindingList::Item item;
  item.what.code = code;
  item.what.message = std::move(message);
  item.what.file = std::move(place.file);
  item.what.line = place.line;
  item.what.ids = std::move(ids);
  for (const Point<D>& q : where) item.what.points.push_back(in_space(q));
  item.measure = measure;
  out_[kind].listed.push_back(std::move(item));
}

template <int D>
std::vector<Point<D>> Diagnoser<D>::points_of(std::span<const std::uint32_t> vertices) const {
  std::vector<Point<D>> out;
  for (const std::uint32_t v : vertices) out.push_back(p_[v]);
  return out;
}

template <int D>
void Diagnoser<D>::collect_triangles() {
  if constexpr (D == 3) {
    triangles_ = bulk_.gather<Triangle>(domain_.facets().size(), [this](std::size_t i, std::vector<Triangle>& found) {
      const auto f = static_cast<EntityId>(i);
      const auto triangles = domain_.triangles(f);
      const auto origins = domain_.triangle_origins(f);
      for (std::size_t k = 0; k < triangles.size(); ++k) found.push_back({triangles[k], f, origins[k]});
    });
    uses_.resize(3 * triangles_.size());
    bulk_.each(triangles_.size(), [this](std::size_t t) {
      const auto& corners = triangles_[t].corners;
      for (std::size_t i = 0; i < 3; ++i)
        uses_[3 * t + i] = {key(corners[i], corners[(i + 1) % 3]), static_cast<std::uint32_t>(t)};
    });
    stop_check_.sort(bulk_, uses_);
  }
}

template <int D>
auto Diagnoser<D>::uses_at(std::size_t begin) const -> std::span<const EdgeUse> {
  std::size_t end = begin + 1;
  while (end < uses_.size() && uses_[end].key == uses_[begin].key) ++end;
  return std::span(uses_).subspan(begin, end - begin);
}

#define PGDR_INSTANTIATE(D)                                                                                                  \
  template std::string Diagnoser<D>::point_words(std::uint32_t) const;                                                       \
  template std::string Diagnoser<D>::segment_words(EntityId) const;                                                          \
  template PlcSource::Place Diagnoser<D>::segment_place(EntityId) const;                                                     \
  template void Diagnoser<D>::list(Finding, Errc, std::string, PlcSource::Place, Ids, const std::vector<Point<D>>&, double); \
  template std::vector<Point<D>> Diagnoser<D>::points_of(std::span<const std::uint32_t>) const;                              \
  template auto Diagnoser<D>::uses_at(std::size_t) const->std::span<const EdgeUse>;
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace detail

template <int D>
std::uint64_t Diagnosis<D>::error_count() const {
  std::uint64_t sum = 0;
  for (std::size_t k = 0; k < finding_kinds; ++k)
    if (is_error(static_cast<Finding>(k))) sum += found[k].count;
  return sum;
}

template <int D>
std::vector<Diagnostic> Diagnosis<D>::errors() const {
  std::vector<Diagnostic> out;
  for (std::size_t k = 0; k < finding_kinds; ++k)
    if (is_error(static_cast<Finding>(k)))
      for (const FindingList::Item& item : found[k].listed) out.push_back(item.what);
  return out;
}

template <int D>
Diagnosis<D> diagnose(const Domain<D>& domain, const DiagnosisOptions& options) {
  Diagnosis<D> out;
  detail::Diagnoser<D>(domain, options, out).run();
  return out;
}

template <int D>
Diagnosis<D> diagnose(const Plc<D>& plc, const DiagnosisOptions& options) {
  std::optional<Domain<D>> prepared;
  return diagnose(plc, options, prepared);
}

template <int D>
Diagnosis<D> diagnose(const Plc<D>& plc, const DiagnosisOptions& options, std::optional<Domain<D>>& prepared) {
  Diagnosis<D> out;
  std::vector<Diagnostic> refused;
  const Domain<D>& domain = prepared.emplace(Domain<D>::without_invalid(plc, refused, options.stop));
  FindingList& invalid = out[Finding::invalid_entity];
  invalid.count = refused.size();
  for (std::size_t k = 0; k < refused.size() && k < options.most_listed; ++k)
    invalid.listed.push_back({std::move(refused[k]), 0});
  detail::Diagnoser<D>(domain, options, out).run();
  if (invalid.count > 0) prepared.reset();
  return out;
}

template <int D>
void require_no_errors(const Domain<D>& domain, const std::stop_token& stop, bool parallel) {
  const Diagnosis<D> diagnosis = diagnose(domain, {.errors_only = true, .stop = stop, .parallel = parallel});
  const std::uint64_t count = diagnosis.error_count();
  if (count == 0) return;
  std::vector<Diagnostic> all = diagnosis.errors();
  Diagnostic first = all.front();
  if (count > 1) first.message += " (the first of " + std::to_string(count) + " such errors)";
  throw DiagnosedError(std::move(first), std::move(all));
}

#define PGDR_INSTANTIATE(D)                                                                                      \
  template std::uint64_t Diagnosis<D>::error_count() const;                                                      \
  template std::vector<Diagnostic> Diagnosis<D>::errors() const;                                                 \
  template PGDR_API Diagnosis<D> diagnose<D>(const Domain<D>&, const DiagnosisOptions&);                         \
  template PGDR_API Diagnosis<D> diagnose<D>(const Plc<D>&, const DiagnosisOptions&);                            \
  template PGDR_API Diagnosis<D> diagnose<D>(const Plc<D>&, const DiagnosisOptions&, std::optional<Domain<D>>&); \
  template PGDR_API void require_no_errors<D>(const Domain<D>&, const std::stop_token&, bool);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr

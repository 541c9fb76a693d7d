// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "report.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "options.hpp"
#include "periodic.hpp"
#include "pgdr/output_files.hpp"
#include "text.hpp"

namespace pgdr::tool {
namespace {

JsonObject json_of_measure(const MeasureSummary& m) { return {{"min", m.least}, {"1%", m.one_percent}, {"mean", m.mean}}; }

void set_measures(JsonObject& o, const QualityMeasures& q) {
  const auto& [least, one, five] = q.smallest_angle_quantiles_deg;
  o.set("max_radius_edge", q.max_radius_edge);
  o.set("min_angle_deg", q.min_angle_deg);
  o.set("max_angle_deg", q.max_angle_deg);
  o.set("smallest_angles_deg", JsonObject{{"0.1%", least}, {"1%", one}, {"5%", five}});
  o.set("radius_ratio", json_of_measure(q.radius_ratio));
  o.set("scaled_jacobian", json_of_measure(q.scaled_jacobian));
  o.set("cells_by_smallest_angle", q.cells_by_smallest_angle);
  o.set("histogram", q.histogram);
}

JsonObject json_of_given(const GivenEntity& e) {
  JsonObject o{{"kind", name(e.kind)}};
  if (e.kind == EntityKind::segment) o.set("ends", e.ends);
  if (e.kind == EntityKind::facet && e.facet != no_entity) o.set("facet", e.facet);
  if (e.kind == EntityKind::facet && e.facet == no_entity) o.set("place", e.ends[0]);
  return o;
}

/// The value of a word among `names`, by its place. @throws std::invalid_argument
template <class Enum, std::size_t N>
Enum parse_name(const std::string& word, const std::array<const char*, N>& names) {
  for (std::size_t i = 0; i < N; ++i)
    if (word == names[i]) return static_cast<Enum>(i);
  throw std::invalid_argument("unknown word \"" + word + '"');
}

/// An unsigned number of 32 bits. @throws std::invalid_argument, nlohmann::json::exception
std::uint32_t parse_id(const nlohmann::json& j) {
  if (!j.is_number_unsigned() || j.get<std::uint64_t>() > 0xffffffffu)
    throw std::invalid_argument("\"" + j.dump() + "\" is not an id");
  return j.get<std::uint32_t>();
}

bool is_seed_of_report(const std::string& text) { return split_seed(text).has_value(); }

/// The texts of a flag that may be repeated. @throws std::invalid_argument, nlohmann::json::exception
std::vector<std::string> parse_texts(const nlohmann::json& report, const char* key, bool (*is_one)(const std::string&)) {
  const auto found = report.find(key);
  if (found == report.end()) return {};
  auto texts = found->get<std::vector<std::string>>();
  for (const std::string& text : texts)
    if (!is_one(text)) throw std::invalid_argument("\"" + text + "\" is none of " + key);
  return texts;
}

PoorReason parse_reason(const nlohmann::json& j) {
  PoorReason r;
  r.cell = parse_id(j.at("cell"));
  r.code = parse_name<PoorReason::Code>(j.at("code").get<std::string>(), code_names);
  const auto& entities = j.at("entities");
  if (!entities.is_array() || entities.size() != 2) throw std::invalid_argument("\"entities\" are two");
  for (std::size_t i = 0; i < 2; ++i) {
    GivenEntity& e = r.entities[i];
    e.kind = parse_name<EntityKind>(entities[i].at("kind").get<std::string>(), kind_names);
    if (e.kind == EntityKind::segment) e.ends = entities[i].at("ends").get<decltype(e.ends)>();
    if (e.kind != EntityKind::facet) continue;
    if (entities[i].contains("place"))
      e.ends[0] = e.ends[1] = entities[i].at("place").get<std::array<double, 3>>();
    else
      e.facet = parse_id(entities[i].at("facet"));
  }
  if (const auto& angle = j.at("angle"); !angle.is_null()) r.angle = angle.get<double>();
  return r;
}

}  // namespace

void Report::add_error(const Diagnostic& error) { errors_.push_back(error); }

void Report::write(const std::string& file) {
  set("errors", tool::to_json(errors_));
  write_file(file, [this](std::ostream& out) { out << pretty(); });
}

JsonObject to_json(const Diagnostic& d) {
  return {{"code", pgdr::name(d.code)}, {"message", d.message}, {"file", d.file}, {"line", d.line}, {"ids", d.ids},
          {"points", d.points}};
}

JsonObject to_json(const QualitySummary& q) {
  JsonObject all;
  set_measures(all, q);
  std::vector<Json> regions;
  for (const RegionQuality& r : q.regions) {
    JsonObject region{{"label", r.label}};
    set_measures(region, r);
    regions.push_back(std::move(region));
  }
  all.set("regions", regions);
  return all;
}

JsonObject to_json(const PoorReason& r) {
  return {{"cell", r.cell},
          {"code", name(r.code)},
          {"entities", std::array{json_of_given(r.entities[0]), json_of_given(r.entities[1])}},
          {"angle", r.angle}};
}

JsonObject to_json(const SurfaceCounts& counts) {
  return {{"components", counts.components},
          {"open_loops", counts.open_loops},
          {"handles", counts.handles ? Json(*counts.handles) : Json(nullptr)}};
}

JsonObject to_json(const RegionVolume& r) {
  return {{"label", r.label},
          {"volume_meshed", r.volume_meshed},
          {"volume_given", r.volume_given ? Json(*r.volume_given) : Json(nullptr)}};
}

JsonObject to_json(const PredicateCounts& c) {
  const std::uint64_t calls = c.filter + c.expansion + c.exact + c.perturbed;  // each call counts at one stage
  const auto share = [calls](std::uint64_t n) { return calls ? static_cast<double>(n) / static_cast<double>(calls) : 0.0; };
  return {{"filter", share(c.filter)},
          {"expansion", share(c.expansion)},
          {"exact", share(c.exact)},
          {"perturbed", share(c.perturbed)},
          {"calls", calls}};
}

JsonObject to_json(const SchedulerStatistics& s) {
  return {{"leaves", s.leaves},
          {"generations", s.generations},
          {"cycles", s.cycles},
          {"visits", s.visits},
          {"set_aside", s.set_aside},
          {"serial_seconds", s.serial_seconds},
          {"work_seconds", s.work_seconds},
          {"critical_path_seconds", s.critical_path_seconds},
          {"max_concurrent", s.max_concurrent},
          {"busy_seconds", s.busy_seconds}};
}

JsonObject to_json(const OptimizationStatistics& s, bool finished) {
  const auto when_finished = [finished](auto value) { return finished ? Json(value) : Json(nullptr); };
  return {{"target", s.target},
          {"claimed_cosine", when_finished(s.claimed_cosine)},
          {"moves", s.moves},
          {"edge_removals", s.edge_removals},
          {"reconnections", s.reconnections},
          {"inserted", s.inserted},
          {"removed", s.removed},
          {"evaluated", s.evaluated},
          {"left", when_finished(s.left)},
          {"unexplained", when_finished(s.unexplained)}};
}

JsonObject to_json(const StageTime& s) { return {{"name", s.name}, {"seconds", s.seconds}, {"work", s.work}, {"path", s.path}}; }

JsonObject to_json(const DistributedStatistics& s) {
  return {{"messages", s.messages},
          {"bytes_sent", s.bytes_sent},
          {"cut_generation", s.cut_generation},
          {"cut_cells", s.cut_cells},
          {"cells_applied", s.cells_applied},
          {"gathered", s.gathered},
          {"seconds", JsonObject{{"prologue", s.seconds_prologue},
                                 {"pack", s.seconds_pack},
                                 {"apply", s.seconds_apply},
                                 {"wait", s.seconds_wait},
                                 {"finish", s.seconds_finish}}},
          {"peak_rss_bytes", JsonObject{{"min", s.least_peak_rss}, {"max", s.largest_peak_rss}}}};
}

JsonObject to_json(const CheckFinding& f) { return {{"kind", pgdr::name(f.kind)}, {"message", f.message}, {"ids", f.ids}}; }

const char* name(RegionMode mode) {
  constexpr std::array names{"seeds", "auto", "all"};
  return names[static_cast<std::size_t>(mode)];
}

const char* name(SharedMarker rule) {
  constexpr std::array names{"smallest", "first", "last"};
  return names[static_cast<std::size_t>(rule)];
}

const char* name(BodyMode mode) {
  constexpr std::array names{"union", "fragments", "priority", "disjoint"};
  return names[static_cast<std::size_t>(mode)];
}

const char* stop_words(StopCause cause) {
  switch (cause) {
    case StopCause::max_vertices: return "at --max-vertices";
    case StopCause::min_edge: return "at --min-edge";
    case StopCause::time_limit: return "at --time-limit";
    case StopCause::cancelled: return "by a signal";
    case StopCause::finished: break;
  }
  return "";
}

template <int D>
std::string verdict(const RefineResult<D>& r) {
  std::string text = !r.size_met && r.poor_left == 0 ? "the size bound is not met everywhere"
                     : r.poor_left == 0              ? "every bound is met"
                                                     : count(r.poor_left, "element stays poor", "elements stay poor");
  if (r.reasons.size() > r.poor_left) text += ", " + count(r.reasons.size() - r.poor_left, "is", "are") + " not Delaunay";
  std::array<std::uint64_t, static_cast<std::size_t>(PoorReason::Code::budget) + 1> by_code{};
  for (const PoorReason& reason : r.reasons) ++by_code[static_cast<std::size_t>(reason.code)];
  const char* separator = ": ";
  for (std::size_t i = 0; i < by_code.size(); ++i) {
    if (by_code[i] == 0) continue;
    text += separator + std::to_string(by_code[i]) + ' ' + name(static_cast<PoorReason::Code>(i));
    separator = ", ";
  }
  if (r.poor_unavoidable > 0)
    text += "; " + std::to_string(r.poor_unavoidable) + " in corners of the input so sharp that every mesh has such there";
  return text;
}

template <int D>
bool has_needles(const RefineResult<D>& r) {
  const auto is_small = [](const PoorReason& reason) { return reason.code == PoorReason::Code::small_angle; };
  return static_cast<std::size_t>(std::ranges::count_if(r.reasons, is_small)) > r.poor_unavoidable;
}

template std::string verdict(const RefineResult<2>&);
template std::string verdict(const RefineResult<3>&);
template bool has_needles(const RefineResult<2>&);
template bool has_needles(const RefineResult<3>&);

ReportedBounds read_bounds(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file))
    throw FileError({.code = Errc::cannot_open, .message = "the report cannot be opened", .file = file});
  ReportedBounds read;
  try {
    const auto report = nlohmann::json::parse(in);
    const auto& bounds = report.at("bounds");
    for (const auto& j : bounds.at("reasons")) read.reasons.push_back(parse_reason(j));
    const auto bound = bounds.find("radius_edge");
    read.refined = report.value("refined", true) && report.value("stop", "finished") == "finished";
    if (bound != bounds.end() && bound->is_number() && read.refined) read.radius_edge = bound->get<double>();
    const auto tolerance = report.find("tolerance");
    if (tolerance != report.end() && tolerance->is_number() && *tolerance >= 0.0) read.tolerance = tolerance->get<double>();
    const auto holds = [&report](const char* key, const nlohmann::json& value) {
      const auto found = report.find(key);
      return found != report.end() && *found == value;
    };
    read.resolve_crossings = holds("resolve_crossings", true);
    read.close_openings = holds("close_planar_openings", true);
    for (const SharedMarker rule : {SharedMarker::smallest, SharedMarker::first, SharedMarker::last})
      if (holds("markers", name(rule))) read.markers = rule;
    read.convex_hull = holds("convex_hull", true);
    read.region_areas = holds("region_areas", true);
    read.seeds = parse_texts(report, "seeds", is_seed_of_report);
    read.holes = parse_texts(report, "holes", is_seed_of_report);
    read.periodic = parse_texts(report, "periodic_sides", is_periodic);
    read.remeshed = holds("remeshed", true);
    read.required = report.value("required", std::vector<std::string>{});
    read.delaunay = holds("delaunay", true);
    read.conforming_delaunay = read.refined && holds("conforming_delaunay", true);
    if (const nlohmann::json::json_pointer left("/quality/not_delaunay/refused"); report.contains(left))
      read.not_delaunay_left = report.at(left).get<std::uint64_t>();
    if (const auto o = report.find("optimization"); o != report.end() && o->is_object())
      if (const auto k = o->find("claimed_cosine"); k != o->end() && k->is_number()) read.largest_cosine = k->get<double>();
    for (const RegionMode mode : {RegionMode::automatic, RegionMode::all})
      if (holds("region_mode", name(mode))) read.regions = mode;
    for (const BodyMode mode : {BodyMode::united, BodyMode::fragments, BodyMode::priority, BodyMode::disjoint})
      if (holds("region_mode", name(mode))) read.bodies = mode;
    read.keep_boundary = holds("keep_boundary", true);
    read.kept_markers = report.value("kept_markers", std::vector<int>());
    if (const auto surface = report.find("surface_tolerance"); surface != report.end() && surface->is_object())
      if (const auto angle = surface->find("feature_angle"); angle != surface->end() && angle->is_number())
        read.feature_angle = angle->get<double>();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    throw InputError({.code = Errc::syntax,
                      .message = "not a report of pgdr mesh with bounds.reasons: " + std::string(e.what()),
                      .file = file});
  }
  return read;
}

}  // namespace pgdr::tool

// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// An embedding program that knows an installed pgdr and nothing else of it: arrays in and out, functors for sizes and for
// points, all fields, errors by type, cancellation; every mesh is checked. Exit code 0 if all is as it should be.
#include <pgdr/circumsphere.hpp>
#include <pgdr/pgdr.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

static_assert(PGDR_VERSION == PGDR_VERSION_MAJOR * 10000 + PGDR_VERSION_MINOR * 100 + PGDR_VERSION_PATCH);

namespace {

int failures = 0;

void expect(bool holds, const char* what) {
  if (holds) return;
  std::printf("FAILED: %s\n", what);
  ++failures;
}

pgdr::Plc<3> cube() {
  const std::vector<double> xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1};
  const std::vector<std::uint32_t> triangles = {0, 1, 3, 0, 3, 2, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                                2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 3, 7, 1, 7, 5};
  return pgdr::plc_from_arrays<3>(xyz, triangles);
}

pgdr::Plc<2> square() {
  const double xy[] = {0, 0, 1, 0, 1, 1, 0, 1};
  const std::uint32_t segments[] = {0, 1, 1, 2, 2, 3, 3, 0};
  return pgdr::plc_from_arrays<2>(xy, segments);
}

/// Refines and checks; the mesh.
template <int D>
pgdr::OutputMesh<D> mesh(const pgdr::Plc<D>& plc, const pgdr::RefineOptions<D>& options, const char* what) {
  const pgdr::Domain<D> domain(plc);
  pgdr::RefineResult<D> result = pgdr::refine(domain, options);
  pgdr::CheckOptions<D> check;
  check.input = &plc;
  check.radius_edge_bound = options.radius_edge_bound;
  check.size = options.size;
  check.region_sizes = options.region_sizes;
  check.largest_cosine = result.optimization.claimed_cosine;
  check.delaunay = result.delaunay;
  const pgdr::CheckReport report = pgdr::check(result.mesh, check);
  std::printf("%-28s %7zu cells, %llu poor, verdict %d\n", what, result.mesh.cells.size(),
              static_cast<unsigned long long>(result.poor_left), report.exit_code());
  expect(report.exit_code() == 0 && result.poor_left == 0 && !result.mesh.cells.empty(), what);
  return std::move(result.mesh);
}

/// Sizes and points by functors. Two close points make elements that a selector is asked about.
template <int D>
void functors(pgdr::Plc<D> plc) {
  for (const double x : {0.5, 0.501}) {
    pgdr::Point<D> p;
    p.x.fill(0.5);
    p[0] = x;
    plc.points.push_back(p);
  }
  pgdr::RefineOptions<D> options;
  options.radius_edge_bound = 4;
  mesh<D>(plc, options, "circumcentres");
  options.disk.type = pgdr::DiskType::type1;
  for (const auto& [name, selector] : {std::pair{"off-centres", pgdr::off_center<D>()},
                                       {"optimised points", pgdr::optimized<D>()},
                                       {"points that avoid slivers", pgdr::sliver_avoiding<D>()}}) {
    options.selector = selector;
    mesh<D>(plc, options, name);
  }
  options.disk.type = pgdr::DiskType::type2;
  options.size = [](const pgdr::Point<D>& p) { return 0.05 + 0.1 * p[0]; };
  int asked = 0;
  options.schedule.executor = pgdr::Executor::serial;  // so that the count needs no lock
  options.selector = [&asked](const pgdr::PoorElement<D>& e) {
    ++asked;
    pgdr::Point<D> p = e.disk.center;
    p[0] += e.disk.radius / 2;
    return p;
  };
  mesh<D>(plc, options, "size and point by functors");
  expect(asked > 0, "the selector is called");
}

template <int D>
void fields(const pgdr::Plc<D>& plc) {
  pgdr::RefineOptions<D> options;
  options.size = 0.3;
  const pgdr::OutputMesh<D> coarse = mesh<D>(plc, options, "constant size");
  const auto xyz = pgdr::flat_points(coarse);
  const auto copy = pgdr::mesh_from_arrays<D>(xyz, pgdr::flat_cells(coarse));
  const std::vector<std::array<std::uint32_t, D + 1>> neighbors = pgdr::neighbors_of_cells(copy);
  expect(neighbors.size() == copy.cells.size(), "neighbours");
  const pgdr::InputMap<D> map = pgdr::input_map(pgdr::Domain<D>(plc), coarse);
  expect(map.vertex_of_point.size() == plc.points.size(), "a map of points");
  expect((D == 2 ? map.subsegments_of_segment[0] : map.subfacets_of_facet[0]).size() > 0, "a map of the boundary");
  expect(copy.points == coarse.points && copy.cells == coarse.cells, "flat arrays there and back");
  std::vector<double> values(coarse.points.size(), 0.3);
  values[0] = 0.01;
  values = pgdr::limit_growth<D>(coarse, values, 0.3);
  const std::vector<pgdr::Point<D>> points = {coarse.points[1]};
  options.size = pgdr::smallest<D>(
      {0.2, pgdr::sizes_on_mesh<D>(coarse, values), pgdr::sizes_at_points<D>(points, std::vector<double>{0.02}, 0.3)});
  const pgdr::OutputMesh<D> fine = mesh<D>(plc, options, "fields combined");
  expect(fine.cells.size() > 2 * coarse.cells.size(), "sizes are met");
  options = {};
  options.region_sizes = {{0, 0.2}};
  expect(mesh<D>(plc, options, "size of a region").cells.size() > coarse.cells.size(), "sizes of regions are met");
  values = pgdr::sizes_of_regions<D>(coarse, options.region_sizes, 1);
  expect(values == std::vector<double>(coarse.points.size(), 0.2), "sizes of regions at the vertices");
  expect(pgdr::summarize_quality(fine).max_radius_edge <= options.radius_edge_bound * 1.0000001, "quality");
}

void errors() {
  pgdr::RefineOptions<3> options;
  const auto code_of = [](auto f) {
    try {
      f();
    } catch (const pgdr::UsageError& e) {
      return std::string(pgdr::name(e.code()));
    } catch (const pgdr::Error& e) {
      return "other: " + std::string(e.what());
    }
    return std::string("none");
  };
  options.size = -1;
  expect(code_of([&] { pgdr::refine(cube(), options); }) == "bad_option", "a bad option is a UsageError");
  options.size = [](const pgdr::Point3&) { return std::nan(""); };
  expect(code_of([&] { pgdr::refine(cube(), options); }) == "bad_size", "so is a bad size");
  options.size = [](const pgdr::Point3&) -> double { throw 42; };
  bool came_out = false;
  try {
    pgdr::refine(cube(), options);
  } catch (int number) {
    came_out = number == 42;
  }
  expect(came_out, "an exception of a callback comes out as it is");
  bool typed = false;
  try {
    pgdr::read_plc<3>("no such file.off");
  } catch (const pgdr::FileError&) {
    typed = true;
  }
  expect(typed, "a FileError");
  std::stop_source source;
  source.request_stop();
  options = {};
  options.stop = source.get_token();
  expect(pgdr::refine(cube(), options).stop == pgdr::StopCause::cancelled, "cancelled");
  bool cancelled = false;
  try {
    pgdr::Domain<3>(cube(), options.stop);
  } catch (const pgdr::CancelledError&) {
    cancelled = true;
  }
  expect(cancelled, "a CancelledError");
}

/// All other functions that pgdr.hpp declares for users, so that they link.
void the_rest() {
  const pgdr::Domain<3> domain(cube());
  expect(pgdr::diagnose(domain).error_count() == 0, "diagnosis");
  const pgdr::Simplex<3> s = {{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}};
  expect(pgdr::orient<3>(s) == pgdr::Sign::positive && pgdr::in_sphere<3>(s, {{0.1, 0.1, 0.1}}) == pgdr::Sign::positive,
         "predicates");
  pgdr::PoorElement<3> e{s, {{0.5, 0.5, 0.5}}, 1, 0.1, 4, {}, true};
  e.disk = pgdr::selection_disk<3>(e, {});
  expect(e.disk.radius == 0.5, "selection disk");
  const double length = 2;
  expect(pgdr::centroid<3>(s)[0] == 0.25 && pgdr::shortest_edge_squared<3>(s) < length, "simplices");
  expect(pgdr::point_on_segment<3>(domain, 0, 0.5) != domain.points()[0], "points of entities");
  expect(pgdr::angles_deg<3>(s)[0] > 50, "angles");
  expect(std::abs(pgdr::min_angle_degrees(30) - 1) < 1e-15, "smallest angles");
}

}  // namespace

int main() {
  functors<3>(cube());
  functors<2>(square());
  fields<3>(cube());
  fields<2>(square());
  errors();
  the_rest();
  return failures == 0 ? 0 : 1;
}

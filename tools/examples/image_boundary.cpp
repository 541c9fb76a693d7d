// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Example: a selector of one's own, for what selection disks were made for (Chernikov, dissertation, Fig. 1.1). An image
// shows two materials with a blurred boundary between them. Edges from one to the other should have their ends
// inside the boundary zone, so that no element lies in both; circumcentres know nothing of it. The selector looks for the
// zone in the disk in which the theory allows a point, and puts the point there if it can: the bound on the angles holds
// all the same, in parallel, and the mesh is the same for any number of threads. What crosses all the same is split. Draws
// the meshes before and after, with the edges that cross the zone in red.
//
//   example_image_boundary [PICTURE.ppm]     exit code 0 if all went as it should
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "pgdr/pgdr.hpp"

namespace {

using pgdr::Point2;

/// Grey values of square pixels on the unit square, 0 outside and 1 inside of the material, interpolated between the
/// centres of pixels.
class Image {
 public:
  static constexpr int side = 256;
  /// Within this of 1/2 is the boundary zone.
  static constexpr double zone = 0.3;

  /// A scan of something like a kidney; blurred, so that the boundary is some pixels wide.
  Image() : grey_(side * side) {
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const double x = (i + 0.5) / side - 0.5, y = (j + 0.5) / side - 0.5;
        const double angle = std::atan2(y, x), radius = std::sqrt(x * x + y * y);
        const double wall = 0.29 + 0.06 * std::sin(3 * angle + 1) + 0.03 * std::cos(5 * angle);
        grey_[j * side + i] = 1 / (1 + std::exp((radius - wall) / blur));
      }
  }
  double at(const Point2& p) const {
    const auto place = [](double c) { return std::clamp(c * side - 0.5, 0.0, side - 1.001); };
    const double x = place(p[0]), y = place(p[1]), u = x - std::floor(x), v = y - std::floor(y);
    const auto* g = &grey_[static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x)];
    return (1 - v) * ((1 - u) * g[0] + u * g[1]) + v * ((1 - u) * g[side] + u * g[side + 1]);
  }
  /// How far the grey value is from that of the boundary.
  double off_boundary(const Point2& p) const { return std::abs(at(p) - 0.5); }
  bool in_zone(const Point2& p) const { return off_boundary(p) < zone; }

 private:
  static constexpr double blur = 0.01;
  std::vector<double> grey_;
};

/// A point of the boundary zone in the element's disk, as near to the boundary as a search on rings about the centre finds
/// it; the centre if there is none. A function of its arguments alone, so that the mesh is reproducible.
Point2 choose(const pgdr::PoorElement<2>& element, const Image& image) {
  constexpr int rings = 12, angles = 32;
  Point2 best = element.disk.center;
  double least = Image::zone;
  for (int ring = 0; ring < rings && element.disk.radius > 0; ++ring)
    for (int k = 0; k < angles; ++k) {
      const double a = 2 * std::numbers::pi * k / angles, r = element.disk.radius * ring / rings;
      const Point2 p{{element.disk.center[0] + r * std::cos(a), element.disk.center[1] + r * std::sin(a)}};
      if (const double off = image.off_boundary(p); off < least && p[0] > 0 && p[0] < 1 && p[1] > 0 && p[1] < 1) {
        least = off;
        best = p;
      }
    }
  return best;
}

using Edge = std::array<std::uint32_t, 2>;

std::set<Edge> edges_of(const pgdr::OutputMesh<2>& mesh) {
  std::set<Edge> edges;
  for (const auto& t : mesh.cells)
    for (int i = 0; i < 3; ++i) edges.insert({std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])});
  return edges;
}

/// From one material to the other, without an end in the zone between.
bool crosses(const pgdr::OutputMesh<2>& mesh, const Image& image, const Edge& e) {
  const double a = image.at(mesh.points[e[0]]), b = image.at(mesh.points[e[1]]);
  return std::min(a, b) <= 0.5 - Image::zone && std::max(a, b) >= 0.5 + Image::zone;
}

struct Picture {
  static constexpr int side = 480, gap = 16, width = 2 * side + gap;
  std::vector<std::array<unsigned char, 3>> pixels{static_cast<std::size_t>(width) * side, {255, 255, 255}};

  void set(int x, int y, std::array<unsigned char, 3> colour) {
    if (x >= 0 && x < width && y >= 0 && y < side) pixels[static_cast<std::size_t>(y) * width + x] = colour;
  }
  void draw(const pgdr::OutputMesh<2>& mesh, const Image& image, int left) {
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const Point2 p{{(x + 0.5) / side, 1 - (y + 0.5) / side}};
        const auto grey = static_cast<unsigned char>(image.in_zone(p) ? 60 : 170 + 80 * image.at(p));
        set(left + x, y, {grey, grey, grey});
      }
    for (const bool red : {false, true})
      for (const Edge& e : edges_of(mesh)) {
        if (crosses(mesh, image, e) != red) continue;
        const Point2 &a = mesh.points[e[0]], &b = mesh.points[e[1]];
        for (int i = 0; i <= side; ++i) {
          const double t = double(i) / side, x = a[0] + t * (b[0] - a[0]), y = a[1] + t * (b[1] - a[1]);
          const auto pixel = [](double c) { return std::min(side - 1, static_cast<int>(c * side)); };
          set(left + pixel(x), pixel(1 - y),
              red ? std::array<unsigned char, 3>{230, 30, 30} : std::array<unsigned char, 3>{60, 110, 200});
        }
      }
  }
  void write(const std::string& file) const {
    std::ofstream out(file, std::ios::binary);
    out << "P6\n" << width << ' ' << side << "\n255\n";
    out.write(reinterpret_cast<const char*>(pixels.data()), static_cast<std::streamsize>(3 * pixels.size()));
  }
};

struct Outcome {
  pgdr::OutputMesh<2> mesh;
  std::vector<Edge> crossing;
  bool good = false;
};

/// Of the unit square, with a vertex at each of the points.
Outcome mesh(const Image& image, const std::vector<Point2>& points, bool with_selector, int threads = 0) {
  pgdr::Plc<2> plc;
  plc.points = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
  for (const std::uint32_t i : {0u, 1u, 2u, 3u}) plc.segments.push_back({{i, (i + 1) % 4}});
  plc.points.insert(plc.points.end(), points.begin(), points.end());
  pgdr::RefineOptions<2> options;
  options.disk.type = pgdr::DiskType::type1;
  options.selector = {};  // circumcentres
  if (with_selector) options.selector = [&image](const pgdr::PoorElement<2>& e) { return choose(e, image); };
  options.schedule.threads = threads;
  pgdr::RefineResult<2> result = pgdr::refine(plc, options);

  pgdr::CheckOptions<2> check;
  check.input = &plc;
  check.radius_edge_bound = options.radius_edge_bound;
  Outcome outcome;
  outcome.good = pgdr::check(result.mesh, check).exit_code() == 0 && result.statistics.selector_outside == 0;
  outcome.mesh = std::move(result.mesh);
  for (const Edge& e : edges_of(outcome.mesh))
    if (crosses(outcome.mesh, image, e)) outcome.crossing.push_back(e);
  return outcome;
}

/// Adds a point of the boundary on each edge that crosses, but not two next to each other.
void split(const Outcome& outcome, const Image& image, std::vector<Point2>& points) {
  std::vector<Point2> added;
  for (const Edge& e : outcome.crossing) {
    Point2 a = outcome.mesh.points[e[0]], b = outcome.mesh.points[e[1]];
    const double length2 = pgdr::squared_distance(a, b);
    if (image.at(a) > image.at(b)) std::swap(a, b);
    for (int i = 0; i < 20; ++i) {
      const Point2 middle{{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2}};
      (image.at(middle) < 0.5 ? a : b) = middle;
    }
    if (std::none_of(added.begin(), added.end(), [&](const Point2& p) { return pgdr::squared_distance(p, a) < length2 / 9; }))
      added.push_back(a);
  }
  points.insert(points.end(), added.begin(), added.end());
}

/// Until no edge crosses. Selectors are asked about elements with poor angles only; good ones that cross are split from
/// outside, by points that the next mesh has as vertices.
Outcome conforming(const Image& image, std::vector<Point2> points, bool with_selector) {
  Outcome outcome = mesh(image, points, with_selector);
  for (int round = 0; round < 10 && !outcome.crossing.empty(); ++round) {
    split(outcome, image, points);
    outcome = mesh(image, points, with_selector);
  }
  return outcome;
}

bool report(const char* what, const Outcome& o) {
  std::printf("%-40s %5zu triangles, smallest angle %.1f degrees, %3zu edges cross the zone, %s\n", what, o.mesh.cells.size(),
              pgdr::summarize_quality(o.mesh).min_angle_deg, o.crossing.size(), o.good ? "checked" : "NOT GOOD");
  return o.good;
}

}  // namespace

int main(int argc, char** argv) {
  const Image image;
  // Landmarks that the mesh must have as vertices, in either material.
  std::vector<Point2> landmarks;
  std::mt19937 random(7);
  while (landmarks.size() < 300) {
    const double x = random() / 4294967296.0, y = random() / 4294967296.0;
    if (!image.in_zone({{x, y}})) landmarks.push_back({{x, y}});
  }
  const Outcome before = mesh(image, landmarks, false);
  const Outcome after = mesh(image, landmarks, true), again = mesh(image, landmarks, true, 1);
  const Outcome split_before = conforming(image, landmarks, false), split_after = conforming(image, landmarks, true);
  bool good = report("circumcentres", before);
  good = report("selector", after) && good;
  good = report("circumcentres, crossing edges split", split_before) && good;
  good = report("selector, crossing edges split", split_after) && good;
  if (after.mesh.points != again.mesh.points || after.mesh.cells != again.mesh.cells) {
    std::printf("WRONG: the mesh depends on the number of threads\n");
    good = false;
  }
  Picture picture;
  picture.draw(before.mesh, image, 0);
  picture.draw(split_after.mesh, image, Picture::side + Picture::gap);
  picture.write(argc > 1 ? argv[1] : "image_boundary.ppm");
  return good && after.crossing.size() < before.crossing.size() && split_after.crossing.empty() ? 0 : 1;
}

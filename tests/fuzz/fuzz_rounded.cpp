// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Bytes as a small input that was turned, shifted and rounded, in PGDR_FUZZ_DIMENSION dimensions: its points are off the lines
// and planes that they are meant to be on. Four bytes say how, the rest is an input on a grid (grid_input.hpp). A mesh that comes
// of it passes the checker; what has none is refused by a typed error.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "grid_input.hpp"
#include "pgdr/diagnosis.hpp"
#include "sound.hpp"

namespace pgdr {
namespace {

constexpr int D = PGDR_FUZZ_DIMENSION;

/// How the copy is made, a byte each.
struct Copy {
  std::uint8_t turn;       ///< 0: not; else by so many of 255 parts of a turn, about an axis by its lowest bits
  std::uint8_t shift;      ///< modulo 9: 0: not; else by 10^(k-1) times the extent, in directions by the bits above
  std::uint8_t numbers;    ///< modulo 8: 0 to 3 doubles, 4 floats, 5 to 7 of 3, 6 and 12 digits
  std::uint8_t tolerance;  ///< modulo 8: 0 to 4 none given, 5 exactly 0, 6 of 1e-9, 7 of 1e-3
};

constexpr double extent = 3;

Point<D> turned(Point<D> p, std::uint8_t turn) {
  if (turn == 0) return p;
  const double angle = 2 * 3.14159265358979323846 * turn / 255, c = std::cos(angle), s = std::sin(angle);
  const int axis = D == 2 ? 2 : turn % 3, u = (axis + 1) % 3, w = (axis + 2) % 3;
  Point<D> q = p;
  q[u] = c * p[u] - s * p[w];
  q[w] = s * p[u] + c * p[w];
  return q;
}

Point<D> shifted(Point<D> p, std::uint8_t shift) {
  if (shift % 9 == 0) return p;
  const double by = std::pow(10, shift % 9 - 1) * extent;
  const std::array<double, 4> parts{0, 1, -0.7, 0.123456789};
  for (int i = 0; i < D; ++i) p[i] += by * parts[static_cast<std::size_t>(shift / 9 >> (2 * i) & 3)];
  return p;
}

Point<D> rounded(Point<D> p, std::uint8_t numbers) {
  const int how = numbers % 8;
  for (int i = 0; i < D; ++i) {
    if (how == 4) p[i] = static_cast<float>(p[i]);
    if (how < 5) continue;
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", how == 5 ? 3 : how == 6 ? 6 : 12, p[i]);
    p[i] = std::strtod(text, nullptr);
  }
  return p;
}

Plc<D> copy_of(Plc<D> plc, const Copy& how) {
  const auto copied = [&](const Point<D>& p) { return rounded(shifted(turned(p, how.turn), how.shift), how.numbers); };
  for (Point<D>& p : plc.points) p = copied(p);
  for (Point<D>& p : plc.holes) p = copied(p);
  for (auto& r : plc.regions) r.point = copied(r.point);
  plc.are_floats = how.numbers % 8 == 4;
  if (how.tolerance % 8 == 5) plc.tolerance = 0;
  if (how.tolerance % 8 == 6) plc.tolerance = 1e-9;
  if (how.tolerance % 8 == 7) plc.tolerance = 1e-3;
  return plc;
}

void mesh(const Plc<D>& plc, bool automatic) {
  try {
    const bool valid = diagnose(plc).error_count() == 0;
    const Domain<D> domain(plc);
    const RefineOptions<D> options = fuzz::small_run<D>(automatic);
    const auto result = refine<D>(domain, options);
    FUZZ_EXPECT(valid, "meshed, though the diagnosis has errors");
    fuzz::expect_sound(plc, options, result);
    fuzz::expect_same_shuffled(domain, options, result);
  } catch (const InputError& e) {
    FUZZ_EXPECT(!e.diagnostic().message.empty());
    FUZZ_EXPECT(e.code() != Errc::internal, e.what());
  } catch (const UsageError& e) {
    FUZZ_EXPECT(plc.tolerance.has_value(), e.what());  // more than a thousandth of what the rounding left of the input
  }
}

}  // namespace
}  // namespace pgdr

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 4) return 0;
  const auto input = pgdr::fuzz::grid_input<PGDR_FUZZ_DIMENSION>({data + 4, size - 4});
  pgdr::mesh(pgdr::copy_of(input.plc, {data[0], data[1], data[2], data[3]}), input.automatic);
  return 0;
}

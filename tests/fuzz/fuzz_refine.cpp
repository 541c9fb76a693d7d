// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Bytes as a small input with few coordinates (grid_input.hpp), in PGDR_FUZZ_DIMENSION dimensions. Brute force says whether
// there is a mesh of it (clipping_oracle.hpp): if so, one comes out that passes the checker; if not, a typed error.
#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "clipping_oracle.hpp"
#include "grid_input.hpp"
#include "pgdr/diagnosis.hpp"
#include "sound.hpp"

namespace pgdr {
namespace {

constexpr int D = PGDR_FUZZ_DIMENSION;

/// Facets as triangles (2D: segments). What has a side that nothing else has bounds nothing; without it, is anything left?
bool all_collapses(const Domain<D>& domain) {
  using Face = std::set<std::uint32_t>;
  std::set<Face> left;
  if constexpr (D == 3) {
    for (EntityId f = 0; f < domain.facets().size(); ++f)
      for (const auto& t : domain.triangles(f)) left.insert(Face(t.begin(), t.end()));
  } else {
    for (const auto& s : domain.segments()) left.insert(Face(s.points.begin(), s.points.end()));
  }
  for (std::size_t before = left.size() + 1; before != left.size();) {
    before = left.size();
    std::map<Face, int> uses;
    const auto sides = [](const Face& face, auto&& visit) {
      bool all = true;
      for (const std::uint32_t v : face) {
        Face side = face;
        side.erase(v);
        all = visit(side) && all;
      }
      return all;
    };
    for (const Face& face : left) sides(face, [&](const Face& side) { return ++uses[side] > 0; });
    std::erase_if(left, [&](const Face& face) { return !sides(face, [&](const Face& side) { return uses[side] > 1; }); });
  }
  return left.empty();
}

/// Whether there is a mesh, seeds aside.
bool has_mesh(const Plc<D>& plc) {
  std::vector<Diagnostic> refused;
  try {
    const Domain<D> domain = Domain<D>::without_invalid(plc, refused);
    return refused.empty() && clipping::Oracle<D>(domain).found() == clipping::Findings{} && !all_collapses(domain);
  } catch (const InputError&) {
    return false;
  }
}

void mesh(const fuzz::GridInput<D>& input) {
  const bool possible = has_mesh(input.plc);
  FUZZ_EXPECT((diagnose(input.plc).error_count() == 0) == possible);
  const bool seeds = !input.plc.holes.empty() || !input.plc.regions.empty();
  try {
    const Domain<D> domain(input.plc);
    const RefineOptions<D> options = fuzz::small_run<D>(input.automatic);
    const auto result = refine<D>(domain, options);
    FUZZ_EXPECT(possible);
    fuzz::expect_sound(input.plc, options, result);
    fuzz::expect_same_shuffled(domain, options, result);
  } catch (const InputError& e) {
    const bool about_seeds = e.code() == Errc::encloses_nothing
                                 ? !input.plc.holes.empty()  // nothing is left
                                 : seeds && (e.code() == Errc::seed_on_boundary || e.code() == Errc::conflicting_seeds);
    FUZZ_EXPECT(!possible || about_seeds, e.what());
    FUZZ_EXPECT(!e.diagnostic().message.empty());
  }
}

}  // namespace
}  // namespace pgdr

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pgdr::mesh(pgdr::fuzz::grid_input<PGDR_FUZZ_DIMENSION>({data, size}));
  return 0;
}

// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A finished mesh as Python holds it. Never changed once it is in the hands of Python, so that any number of threads may read it.
#pragma once

#include <cstdint>
#include <vector>

#include "pgdr/output_mesh.hpp"
#include "pgdr/periodic.hpp"
#include "pgdr/poor_reason.hpp"

namespace pgdr::python {

template <int D>
struct MeshData {
  OutputMesh<D> mesh;
  std::vector<PoorReason> reasons;
  std::vector<PeriodicPairs> periodic;
  std::vector<std::int64_t> point_of_input;  ///< vertex of each point of the input, -1: none; empty: unknown
};

}  // namespace pgdr::python

// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Meshes that are joined, and what check() says of the result.
#pragma once

#include <string>
#include <vector>

#include "pgdr/check.hpp"
#include "pgdr/mesh_join.hpp"

namespace pgdr::test {

template <int D>
JoinedMesh<D> joined(const std::vector<OutputMesh<D>>& meshes, const JoinOptions& options = {}) {
  std::vector<const OutputMesh<D>*> all;
  for (const OutputMesh<D>& mesh : meshes) all.push_back(&mesh);
  return join_meshes<D>(all, options);
}

template <int D>
std::string findings_alone(const OutputMesh<D>& mesh) {
  std::string text;
  for (const CheckFinding& f : check(mesh, CheckOptions<D>{}).findings) text += f.message + '\n';
  return text;
}

}  // namespace pgdr::test

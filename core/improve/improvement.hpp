// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The last stage of a run in 3D. It changes the mesh for elements that stay poor: it collapses and relocates vertices, flips
// faces and edges, and inserts points, wherever that leaves fewer poor elements, or better ones (change_judge.hpp).
#pragma once

#include <memory>

#include "reasons/poor_reasons.hpp"
#include "refine/element_stage.hpp"

namespace pgdr {

/// The stage. Threads: read by all visits at once, changed between them alone.
class Improvement final : public ElementStage<3> {
 public:
  Improvement(const Mesh<3>& mesh, const PoorReasons<3>& reasons) : mesh_(&mesh), reasons_(&reasons) {}  ///< both outlive it

  std::unique_ptr<ElementTreatment<3>> treatment(Workspace<3>& workspace, WorkLister<3>& lister,
                                                 DelaunayRepair<3>& repair) const override;
  std::uint64_t version(CellId c) const override;

  bool collapses_only = true;  ///< vertices are collapsed, and nothing else is done

 private:
  const Mesh<3>* mesh_;
  const PoorReasons<3>* reasons_;
};

}  // namespace pgdr

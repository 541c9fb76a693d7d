// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Inputs, results and pieces of meshes as messages. Each get_...() reads what the put_...() of its name wrote, and throws
// ResourceError internal where the message has no such thing.
#pragma once

#include "pgdr/mesh_piece.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/refine.hpp"
#include "transport/message.hpp"

namespace pgdr::detail {

template <int D>
void put_plc(MessageWriter& message, const Plc<D>& plc);
template <int D>
Plc<D> get_plc(MessageReader& message);

/// All but the mesh, the trace and the times of single stages.
template <int D>
void put_result(MessageWriter& message, const RefineResult<D>& result);
template <int D>
RefineResult<D> get_result(MessageReader& message);

template <int D>
void put_piece(MessageWriter& message, const MeshPiece<D>& piece);
template <int D>
MeshPiece<D> get_piece(MessageReader& message);

}  // namespace pgdr::detail

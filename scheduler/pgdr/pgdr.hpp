// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// All public headers.
#pragma once

#include "pgdr/check.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/diagnosis.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/error.hpp"
#include "pgdr/estimate.hpp"
#include "pgdr/export.hpp"
#include "pgdr/flat_arrays.hpp"
#include "pgdr/io.hpp"
#include "pgdr/mesh_maps.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/planar_plc.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/point_selector.hpp"
#include "pgdr/poor_reason.hpp"
#include "pgdr/predicates.hpp"
#include "pgdr/quality.hpp"
#include "pgdr/refine.hpp"
#include "pgdr/refine_options.hpp"
#include "pgdr/region_mode.hpp"
#include "pgdr/region_volume.hpp"
#include "pgdr/selectors.hpp"
#include "pgdr/size_fields.hpp"
#include "pgdr/sizing.hpp"
#include "pgdr/surface_counts.hpp"
#include "pgdr/types.hpp"
#include "pgdr/version.hpp"

// SPDX-License-Identifier: GPL-3.0-or-later
//
// What jobs are told of the meshes that they wait for.
#pragma once

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

/// All jobs that wait for the mesh hear it: phases and progress as events, operators as turns on
/// solver threads, an error as their end. Called by the catalogue, without the lock.
void hear(EngineCore& core, const meshes::MeshNews& news);

}  // namespace anticrack::jobs

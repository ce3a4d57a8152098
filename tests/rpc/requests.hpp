// SPDX-License-Identifier: GPL-3.0-or-later
//
// Requests about the membrane of section 8 of the paper.
#pragma once

#include <string>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/solve.pb.h"

namespace anticrack::testing {

/// The square (-1,1)^2 cut on y = 0, inclusion "fibre" on (-0.5, 0.5), all of it delaminated;
/// elements of `size`.
v1::CreateMeshRequest paper_mesh(double size = 0.2);

/// One load case "opening" (Example 3: f = 1 above the interface, -1 below) on the mesh.
v1::CreateJobRequest opening_job(const std::string& mesh);

/// A job that iterates until it is cancelled.
v1::CreateJobRequest endless_job(const std::string& mesh);

/// A .msh (2.2, ascii) of two triangles that is read, but is no cut membrane.
std::string small_msh();

}  // namespace anticrack::testing

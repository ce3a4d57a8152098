// SPDX-License-Identifier: GPL-3.0-or-later
//
// Requests about the membrane of section 8 of the paper.
#pragma once

#include <string>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "anticrack/v1/upload.pb.h"

namespace anticrack::testing {

/// The square (-1,1)^2 cut on y = 0, inclusion "fibre" on (-0.5, 0.5), all of it delaminated;
/// elements of `size`.
v1::CreateMeshRequest paper_mesh(double size = 0.2);

/// One load case "opening" (Example 3: f = 1 above the interface, -1 below) on the mesh.
v1::CreateJobRequest opening_job(const std::string& mesh);

/// The header of a file with this content.
v1::CreateUploadsRequest::Header upload_header(
    const std::string& content, v1::Upload::Kind kind = v1::Upload::KIND_UNSPECIFIED);

/// f64, little-endian, as they lie in memory.
std::string packed(const std::vector<double>& values);

/// A sweep over combinations of three load cases, a row after the other: "opening", "slope" (f = x)
/// and "push" (a force of 1 on the inclusion).
v1::CreateJobRequest sweep_job(const std::string& mesh, const std::vector<double>& coefficients);

/// A job that iterates until it is cancelled.
v1::CreateJobRequest endless_job(const std::string& mesh);

/// A .msh (2.2, ascii) of two triangles that can be read but is not a cut membrane.
std::string small_msh();

}  // namespace anticrack::testing

// SPDX-License-Identifier: GPL-3.0-or-later
//
// A result as ParaView reads it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/error.hpp"
#include "results/result.hpp"
#include "vtk/unstructured_grid.hpp"

namespace anticrack::vtk {

/// The membrane under a load: every subdomain with points of its own, so that both faces of cracks
/// and slits are there and a jump of u stays one. Point data u, node (index in the mesh); cell data
/// subdomain, tension. Needs load.fields.
UnstructuredGrid membrane(const results::Result& result, const results::Load& load);

/// The interfaces as lines. Point data u_minus, u_plus, jump, pressure, s (arc length), kind
/// (results::Kind), contact; cell data interface, inclusion (index into Mesh::inclusions, -1 none).
/// Needs load.traces.
UnstructuredGrid interfaces(const results::Result& result, const results::Load& load);

struct Exported {
  std::vector<std::filesystem::path> files;
  std::vector<std::string> notes;  ///< what was left out and why, for people
};

/// Writes into `folder` (made if missing) for every load with an answer LOAD.vtu (the membrane) and
/// LOAD-interfaces.vtu, and result.pvd, which shows load i at time i. LOAD is the load's name made
/// safe for a file name, and unique. Of a sweep the interfaces of the rows whose traces were kept:
/// it has no fields. Each file is written whole or not at all. Throws
/// results::Error where an answer has no fields (but of a sweep), where nothing is answered, and
/// where a file cannot be written; `source` names the result in it, the file it was read from.
Exported export_result(const results::Result& result, const std::string& source,
                       const std::filesystem::path& folder);

}  // namespace anticrack::vtk

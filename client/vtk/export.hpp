// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes a result in the form that ParaView reads.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/error.hpp"
#include "results/result.hpp"
#include "vtk/unstructured_grid.hpp"

namespace anticrack::vtk {

/// The membrane under a load. Subdomains share no points, which keeps both faces of cracks and
/// slits. Point data u, node (index in the mesh); cell data subdomain, tension and, if the load has
/// it, error_indicator. Needs load.fields.
UnstructuredGrid membrane(const results::Result& result, const results::Load& load);

/// The interfaces as lines. Point data u_minus, u_plus, jump, pressure, s (arc length), kind
/// (InterfaceKind), contact; cell data interface, inclusion (index into Mesh::inclusions, -1 none).
/// Needs load.traces.
UnstructuredGrid interfaces(const results::Result& result, const results::Load& load);

struct Exported {
  std::vector<std::filesystem::path> files;
  std::vector<std::string> notes;  ///< what was left out, and why
};

/// Writes into `folder` (created if missing), for every load with an answer, LOAD.vtu (the
/// membrane) and LOAD-interfaces.vtu, and result.pvd, which shows load i at time i. LOAD is the
/// load's name made safe for a file name, and unique. A sweep has no fields, so only interfaces of
/// kept rows are written. Each file is written completely or not at all. Throws results::Error for
/// an answer without fields (except in a sweep), for a result without answers, and for a file that
/// cannot be written. `source`: the name of the result in messages.
Exported export_result(const results::Result& result, const std::string& source,
                       const std::filesystem::path& folder);

}  // namespace anticrack::vtk

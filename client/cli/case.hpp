// SPDX-License-Identifier: GPL-3.0-or-later
//
// A case, read by the server: the client knows none of its keys.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "anticrack/v1/case.pb.h"
#include "anticrack/v1/job.pb.h"
#include "anticrack/v1/mesh.pb.h"
#include "cli/report.hpp"
#include "cli/session.hpp"

namespace anticrack::cli {

/// The f of a load in a file: a one-dimensional dataset of float64.
struct ForceFile {
  int load_case = 0;  ///< index into Case::job.load_cases
  std::filesystem::path path;
  std::string dataset;
};

struct Case {
  std::string text;                                ///< the TOML as run, with the overrides
  std::optional<std::filesystem::path> mesh_file;  ///< .msh to upload
  v1::CreateMeshRequest mesh;  ///< its source is set, unless there is a mesh_file
  v1::JobSpec spec;            ///< of the job: all but `mesh` and the uploads of `force_files`
  std::vector<ForceFile> force_files;
  std::vector<std::string> notes;               ///< warnings of what is allowed, but may be a slip
  std::map<std::string, v1::CasePlace> places;  ///< field of a request -> where it was written

  /// Where the value of a field, or of the nearest field around it, was written; null for a
  /// default.
  const v1::CasePlace* locate(const std::string& field) const;
};

/// A place as text: "case.toml:12: solver.theta", without the unknown parts.
std::string told(const v1::CasePlace& place);

/// Whether a case must have a [[load]].
enum class Loads { needed, optional };

/// Lets the server read a case with these overrides ("key=value"). `only`: names of the loads to
/// keep; empty: all. Throws CaseError.
Case read_case(Session& session, const std::filesystem::path& path,
               const std::vector<std::string>& overrides, Loads loads = Loads::needed,
               const std::vector<std::string>& only = {});

/// A case that is only a mesh, from a .msh file; the overrides are keys of [mesh],
/// "mesh.preset=...".
Case msh_case(Session& session, const std::filesystem::path& file, const std::string& title,
              const std::vector<std::string>& overrides);

}  // namespace anticrack::cli

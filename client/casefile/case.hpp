// SPDX-License-Identifier: GPL-3.0-or-later
//
// A case: a TOML file that describes a membrane, its mesh, its loads and how to solve them. Its
// keys are in client/README.md. Shapes and types are checked here, ranges and meaning by the
// server: Case::locate traces its complaints about fields of a request back to lines of the file.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "casefile/error.hpp"

namespace anticrack::casefile {

/// A load's f in a file: a one-dimensional dataset of float64.
struct ForceFile {
  int load_case = 0;  ///< index into Case::job.load_cases
  std::filesystem::path path;
  std::string dataset;
  bool per_triangle = false;  ///< else per node
};

struct Case {
  std::filesystem::path path;
  std::string text;                                ///< the TOML as run, with the overrides
  std::optional<std::filesystem::path> mesh_file;  ///< .msh to upload
  v1::CreateMeshRequest mesh;  ///< its source is set unless there is a mesh_file
  v1::Job job;                 ///< all but `mesh` and the uploads of `force_files`
  std::vector<ForceFile> force_files;
  std::vector<std::string> notes;     ///< what is allowed, but may be a slip
  std::map<std::string, Spot> spots;  ///< field of a request -> where its value was written

  /// Where the value of a field of CreateMeshRequest or CreateJobRequest was written, or the
  /// nearest enclosing table; empty for a default. Below "job" or "mesh", too.
  std::optional<Spot> locate(const std::string& field) const;
};

/// Whether a case must have a [[load]].
enum class Loads { needed, optional };

/// Reads a case and applies the overrides ("key=value") in order. `only`: names of the loads that
/// are kept; none: all. Throws Error.
Case read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides = {},
               Loads loads = Loads::needed, const std::vector<std::string>& only = {});

/// The same for a text; `path` names it in errors, and relative names of files refer to its folder.
Case parse_case(const std::string& text, const std::filesystem::path& path,
                const std::vector<std::string>& overrides = {}, Loads loads = Loads::needed,
                const std::vector<std::string>& only = {});

/// Only a mesh, from a .msh file; the overrides are keys of [mesh], "mesh.preset=...".
Case mesh_file_case(const std::filesystem::path& file, const std::string& title,
                    const std::vector<std::string>& overrides = {});

}  // namespace anticrack::casefile

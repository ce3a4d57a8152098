// SPDX-License-Identifier: GPL-3.0-or-later
//
// A case: a text that describes a membrane, its mesh, its loads and how to solve them, as TOML or
// as the same tables in JSON. Its keys are in client/README.md. Shapes and types are checked here;
// ranges and meaning are checked like those of requests, and Case::spots traces faults of a
// request's fields back to lines of the text.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "anticrack/v1/job.pb.h"
#include "anticrack/v1/mesh.pb.h"
#include "casefile/error.hpp"

namespace anticrack::casefile {

/// The f of a load in a file: a one-dimensional dataset of float64.
struct ForceFile {
  int load_case = 0;  ///< index into Case::spec.load_cases
  std::string path;
  std::string dataset;
};

struct Case {
  std::string text;                      ///< the case as TOML, with the overrides
  std::optional<std::string> mesh_file;  ///< .msh to upload, as the case names it
  v1::CreateMeshRequest mesh;            ///< its source is set, unless there is a mesh_file
  v1::JobSpec spec;  ///< of the job: all but `mesh` and the uploads of `force_files`
  std::vector<ForceFile> force_files;
  std::vector<std::string> notes;     ///< warnings of what is allowed, but may be a slip
  std::map<std::string, Spot> spots;  ///< field of a request -> where its value was written
};

/// Whether a case must have a [[load]].
enum class Loads { needed, optional };

/// Whether a text is TOML or JSON.
enum class Language { toml, json };

/// Reads a case, which errors call `source`, and applies the overrides ("key=value") in order.
/// `only`: names of the loads to keep; empty: all. Throws Error. Linear in the text.
Case parse_case(const std::string& text, const std::string& source,
                const std::vector<std::string>& overrides = {}, Loads loads = Loads::needed,
                const std::vector<std::string>& only = {}, Language language = Language::toml);

/// A case that is only a mesh, from a .msh file; the overrides are keys of [mesh],
/// "mesh.preset=...".
Case mesh_file_case(const std::string& file, const std::vector<std::string>& overrides = {});

}  // namespace anticrack::casefile

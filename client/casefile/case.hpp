// SPDX-License-Identifier: GPL-3.0-or-later
//
// A case: a TOML file that describes a membrane, its mesh, its loads and how to solve them.
//
//     title = "..."                     for people
//     [geometry]                        or mesh.file
//       boundary  = [[x, y], ...]       polygon
//       interface = [[x, y], ...]       one line; the plus side (Omega_2) is on its left
//       neumann   = [[from, to], ...]   parts of the boundary, or "all"
//     [[geometry.interface]]            instead of the one line: name; points = [[x, y], ...] |
//                                       arc = [from, through, to] | spline = [[x, y], ...]; closed
//     [[geometry.inclusion]]            name, from, to; delaminated = true | false | [[from, to],
//                                       ...]
//     [[geometry.crack]]                name, from, to
//     [[geometry.region]]               name, at = [x, y], tension
//     [mesh]                            preset = "graded" | "uniform" | "paper", size, tip_size,
//                                       grading, align = [[[x, y], ...], ...]; file = "x.msh"
//     [mesh.groups]                     curve.TAG = "crack:NAME", surface.TAG = "NAME"; of a file
//     [mesh.tension]                    NAME = number; of a file
//     [solver]                          method = "active-set": tolerance, max_steps;
//                                       method = "uzawa": theta = number | "auto", epsilon, p,
//                                       max_iterations, mass = "lumped" | "consistent",
//                                       kkt_tolerance
//     [[load]]                          name; f = number | "expression in x, y" | {region =
//                                       number} | {file = "f.h5", dataset = "/f", per = "triangle"
//                                       | "node"}; boundary_value, traction = "expression in x, y";
//                                       point_forces = [{at = [x, y], value = number}];
//                                       inclusion_forces = {inclusion = number}
//     [job]                             priority = "interactive" | "normal" | "bulk";
//                                       queue_timeout, run_timeout = seconds | "10min" | "2h"
//     [output]                          fields = true | false
//
// Shapes and types are checked here; what they mean, and every range, is the server's to judge: its
// complaints about fields of a request are traced back to lines of the file by Case::locate.
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

/// Values of a load's f that lie in a file: a one-dimensional dataset of float64.
struct ForceFile {
  int load_case = 0;  ///< index into Case::job.load_cases
  std::filesystem::path path;
  std::string dataset;
  bool per_triangle = false;  ///< else per node
};

struct Case {
  std::filesystem::path path;
  std::string text;  ///< the TOML as run: the file, or what it is with the overrides
  std::optional<std::filesystem::path> mesh_file;  ///< .msh to upload
  v1::CreateMeshRequest mesh;  ///< its source is set unless there is a mesh_file
  v1::Job job;                 ///< all but `mesh` and the uploads of `force_files`
  std::vector<ForceFile> force_files;
  std::map<std::string, Spot> spots;  ///< field of a request -> where its value was written

  /// Where the value of a field of CreateMeshRequest or CreateJobRequest was written, or the
  /// nearest thing around it; empty when the case has nothing of it (a default).
  std::optional<Spot> locate(const std::string& field) const;
};

/// Whether a case is nothing without a [[load]].
enum class Loads { needed, optional };

/// Reads a case and applies the overrides ("key=value") in order. Throws Error.
Case read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides = {},
               Loads loads = Loads::needed);

/// The same for a text; `path` names it in errors and is where the files it names are relative to.
Case parse_case(const std::string& text, const std::filesystem::path& path,
                const std::vector<std::string>& overrides = {}, Loads loads = Loads::needed);

/// A mesh from a .msh file and nothing else; the overrides are keys of [mesh], "mesh.preset=...".
Case mesh_file_case(const std::filesystem::path& file, const std::string& title,
                    const std::vector<std::string>& overrides = {});

}  // namespace anticrack::casefile

// SPDX-License-Identifier: GPL-3.0-or-later
//
// A case: a TOML file that describes a membrane, its mesh, its loads and how to solve them.
//
//     title = "..."                     for people
//     [geometry]                        or mesh.file
//       boundary  = [[x, y], ...]       polygon
//       interface = [[x, y], ...]       cuts it; the plus side (Omega_2) is on its left
//     [[geometry.inclusion]]            name, from, to; delaminated = true | false | [[from, to],
//     ...]
//     [[geometry.crack]]                name, from, to
//     [mesh]                            preset = "paper" | "uniform" | "graded", size; or file =
//     "x.msh" [solver]                          method = "uzawa" | "active-set"; theta = number |
//     "auto",
//                                       epsilon, p, max_iterations, mass = "lumped" | "consistent"
//     [[load]]                          name; f = number | "expression in x, y" | {region =
//     number};
//                                       boundary_value = "expression in x, y"
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

struct Case {
  std::filesystem::path path;
  std::string text;  ///< the TOML as run: the file, or what it is with the overrides
  std::optional<std::filesystem::path> mesh_file;  ///< .msh to upload
  v1::CreateMeshRequest mesh;         ///< its source is set unless there is a mesh_file
  v1::Job job;                        ///< all but `mesh`
  std::map<std::string, Spot> spots;  ///< field of a request -> where its value was written

  /// Where the value of a field of CreateMeshRequest or CreateJobRequest was written, or the
  /// nearest thing around it; empty when the case has nothing of it (a default).
  std::optional<Spot> locate(const std::string& field) const;
};

/// Reads a case and applies the overrides ("key=value") in order. Throws Error.
Case read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});

/// The same for a text; `path` names it in errors and is where mesh.file is relative to.
Case parse_case(const std::string& text, const std::filesystem::path& path,
                const std::vector<std::string>& overrides = {});

}  // namespace anticrack::casefile

// SPDX-License-Identifier: GPL-3.0-or-later
//
// Runs the helper process anticrack-mesher. Only this process links gmsh, because gmsh has global
// state (two threads in one process gave 21 bad meshes of 40), runs shell commands from any file
// that looks like a script, and may crash. The helper has limits of memory, time and descriptors
// and can open no files, start no programs and make no connections (restrict.hpp). The .msh file to
// import is opened here and handed over.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>

#include "mesh/codec.hpp"
#include "mesh/mesh.hpp"
#include "mesher/progress.hpp"

namespace anticrack::mesher {

struct HelperOptions {
  std::string executable;                   ///< path of anticrack-mesher
  std::chrono::seconds time_limit{600};     ///< wall time after which it is killed
  std::uint64_t memory_limit = 6ULL << 30;  ///< bytes of address space (RLIMIT_AS)
};

/// Called about every second with the progress of the helper.
using ProgressListener = std::function<void(const Progress&)>;

/// Sends the request to a new helper process and returns its mesh, validated. Blocks; `stop` kills
/// the helper. Thread-safe. Throws errors::Error: the helper's own errors; mesher_failed (crash,
/// forbidden system call, time or memory limit: the message says which); cancelled.
mesh::Mesh run(const HelperOptions& options, const mesh::MesherRequest& request,
               std::stop_token stop, const ProgressListener& listener = {});

/// Throws errors::Error (mesh_invalid) unless the beginning of the file is that of a format that
/// can be read (mesh_start.hpp).
void require_msh(const std::string& path);

/// A text that only the program anticrack-mesher of this version contains.
const char* mark() noexcept;

/// Whether a file is that program, or a script, which may start it. False if it cannot be read.
bool is_helper(const std::string& path);

/// Path of anticrack-mesher beside the running executable, or in ../libexec/anticrack.
std::string default_executable();

}  // namespace anticrack::mesher

// SPDX-License-Identifier: GPL-3.0-or-later
//
// Runs the helper process anticrack-mesher, the only place that sees gmsh: its state is global
// (two threads in one process gave 21 bad meshes of 40), it runs shell commands out of any file
// it takes for a script, and it may crash. This library does not link gmsh.
//
// The helper has limits of memory, time and descriptors (limits.hpp) and may then use only the
// system calls that computing takes (syscall_filter.hpp): no file can be opened, no program
// started, no connection made. The .msh to import is opened here and handed over.
#pragma once

#include <chrono>
#include <cstdint>
#include <stop_token>
#include <string>

#include "mesh/codec.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::mesher {

struct HelperOptions {
  std::string executable;                   ///< path of anticrack-mesher
  std::chrono::seconds time_limit{600};     ///< wall time, then it is killed
  std::uint64_t memory_limit = 6ULL << 30;  ///< bytes of address space (RLIMIT_AS)
};

/// Sends the request to a fresh helper process and returns its mesh, validated.
/// Blocks; `stop` kills the helper. Throws errors::Error: what the helper found wrong with the
/// request; mesher_failed (crash, forbidden system call, time or memory limit: says which);
/// cancelled.
/// Thread-safe: each call has its own process.
mesh::Mesh run(const HelperOptions& options, const mesh::MesherRequest& request,
               std::stop_token stop);

/// Throws errors::Error (mesh_invalid) unless the file's first token is $MeshFormat: anything else
/// must never reach gmsh, which would run it as a script. Also refuses an empty file.
void require_msh(const std::string& path);

/// Path of anticrack-mesher beside the running executable, or in ../libexec/anticrack.
std::string default_executable();

}  // namespace anticrack::mesher

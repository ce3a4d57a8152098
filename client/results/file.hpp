// SPDX-License-Identifier: GPL-3.0-or-later
//
// The result file, HDF5, format "anticrack-result/1":
//
//     /                        attributes format, title, case (the TOML), client_version,
//                              server_version, mesh, job, mesh_sha256, mesh_seconds,
//                              factorize_seconds, solve_seconds, total_seconds
//     /mesh                    nodes (n,2), triangles (m,3), subdomain (m), boundary (b,2),
//                              subdomain_names, tension, inclusions (names)
//     /interfaces/I            s, x, y, kind (k) of its nodes, edge_kind, edge_inclusion (k-1) of
//                              the edges between them; attribute name; of a closed one the first
//                              node is there again as the last
//     /loads/NAME              attributes index, status, reason, error, method, mass, epsilon, p,
//                              kkt_tolerance, tolerance, iterations (or steps), criterion, theta,
//                              theta_star, energy, kkt_*, kkt_relative_*, contact_length,
//                              weakly_active, solve_seconds; NaN or "" where a method has none
//     /loads/NAME/warnings     text (one entry a warning)
//     /loads/NAME/inclusions   name, A, resultant, contact_length (one entry an inclusion)
//     /loads/NAME/contact_intervals   interface, begin, end (one entry an interval)
//     /loads/NAME/traces/I     u_minus, u_plus, jump, pressure, contact (k)
//     /loads/NAME/history      iteration, criterion, energy, contact_count, kkt_*
//     /loads/NAME/fields/D     nodes, u (n_D), triangles (m_D,3) into nodes; attribute name (only
//                              when asked for)
//     /sweep                   of a sweep: attributes description, source, loads, inclusions,
//                              error, solve_seconds, converged, not_converged, failed; (rows)
//                              status, steps, energy, contact_length, kkt; displacement
//                              (rows,inclusions), contact (rows,contacts) uint8, contact_nodes
//                              (contacts,2), coefficients (rows,loads) where known; kept: rows
//                              whose traces are /loads/row-K
//
// I and D are indices in decimal (an interface, a subdomain); the attribute `name` has their names.
// Every dataset has the attribute `units` ("-": dimensionless), `kind`, `edge_kind`,
// `edge_inclusion` and those of /sweep also what their numbers mean (`meaning`). Needs HDF5 1.10 to
// read. Numbers are float64, int32 and uint8, little-endian; text is variable-length UTF-8.
//
// Files of earlier clients have no /mesh/inclusions and nothing of edges. They are still read: the
// conditions on edges are told from those at nodes, and which inclusion lies on an edge is known
// only where there is but one.
#pragma once

#include <filesystem>
#include <string_view>

#include "results/error.hpp"
#include "results/result.hpp"

namespace anticrack::results {

inline constexpr std::string_view format = "anticrack-result/1";

/// Writes the file whole or not at all: a temporary file in the same folder, fsync, rename. An
/// existing file is replaced; after an Error it is as it was and nothing else is left.
/// Needs memory for a copy of the file. Not from two threads at a time unless HDF5 is thread-safe.
void write(const std::filesystem::path& path, const Result& result);

/// Reads a file of `format`. Throws Error for what is no HDF5, truncated, foreign, of another
/// format version or inconsistent. Sizes are checked before memory is taken for them.
Result read(const std::filesystem::path& path);

/// Throws Error if `write` could not write here now: folder missing or read-only, path a folder, or
/// an existing file that is write-protected. Call it before hours of computation.
void check_writable(const std::filesystem::path& path);

}  // namespace anticrack::results

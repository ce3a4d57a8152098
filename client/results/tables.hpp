// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a result file holds beside the arrays of arrays/result_arrays.hpp, in the order of the file.
// The table of client/RESULT.md is made of these: see tests/client/results/result_table_test.cpp.
#pragma once

#include "arrays/result_arrays.hpp"
#include "results/result.hpp"

namespace anticrack::results::tables {

using arrays::array;
using arrays::explained;
using arrays::optional;
using arrays::scalar;
using arrays::within;

// Of the file: attributes of /.

inline constexpr auto result = std::tuple{
    scalar("title", &Result::title, "of the case"),
    scalar("case", &Result::case_text, "the TOML as it was run"),
    scalar("client_version", &Result::client_version, "that wrote the file"),
    scalar("server_version", &Result::server_version, "that solved the case"),
    scalar("mesh", &Result::mesh_name, ""),
    scalar("job", &Result::job_name, "names on the server"),
    scalar("mesh_sha256", &Result::mesh_sha256, "of the mesh's arrays"),
    scalar("not_reached", &Result::not_reached,
           "which accuracy of the job, what stopped it, and the cure"),
};
inline constexpr auto units = std::tuple{
    scalar("unit_length", &Units::length, ""),
    scalar("unit_force", &Units::force, "names of L and F below, if the case gives them"),
};
inline constexpr auto timings = std::tuple{
    scalar("mesh_seconds", &Timings::mesh_seconds, "meshing", "s"),
    scalar("factorize_seconds", &Timings::factorize_seconds, "factorising", "s"),
    scalar("solve_seconds", &Timings::solve_seconds, "all load cases", "s"),
    scalar("total_seconds", &Timings::total_seconds, "as the user waited", "s"),
};

// Of /mesh: what ReadMesh streams under the same names, and what the message Mesh says.

inline constexpr auto mesh = std::tuple{
    array("nodes", "n,2", &Mesh::xy, "coordinates", "L"),
    array("triangles", "m,3", &Mesh::triangles, "indices into nodes, counterclockwise"),
    array("subdomain", "m", &Mesh::subdomain, "of a triangle: index into subdomain_names"),
    array("boundary", "b,2", &Mesh::boundary, "edges where u is prescribed"),
};
inline constexpr auto mesh_names = std::tuple{
    array("subdomain_names", "d", &Mesh::subdomains, "in the order of the numbers above"),
    array("tension", "d", &Mesh::tension, "T of -div(T grad u) = f; of a law its mean", "F/L"),
    optional(
        array("tension_law", "d", &Mesh::tension_law,
              "expression, or along, across and angle [degrees]; empty: the number; none where "
              "no subdomain has one")),
    array("inclusions", "i", &Mesh::inclusions, "names"),
};

// Of /interfaces/I, behind arrays::interface_nodes: attribute, and arrays of the edges.

inline constexpr auto interface = std::tuple{
    scalar("name", &Interface::name, "of the interface"),
};
inline constexpr auto edges = std::tuple{
    explained("edge_kind", "k-1", &Edges::kind,
              "1 glue, 2 crack, 3 bonded inclusion, 4 delaminated inclusion, 5 free crack"),
    explained("edge_inclusion", "k-1", &Edges::inclusion, "index into /mesh/inclusions, -1 none"),
};

// Of /loads/NAME, beside the answer.

inline constexpr auto asked = std::tuple{
    scalar("method", &Asked::method, "active-set or uzawa"),
    scalar("mass", &Asked::mass, "lumped or consistent"),
    scalar("epsilon", &Asked::epsilon, "stopping criterion asked of Algorithm 2"),
    scalar("p", &Asked::p, "bound on the multipliers asked for"),
    scalar("kkt_tolerance", &Asked::kkt_tolerance, "asked for in place of epsilon"),
    scalar("tolerance", &Asked::tolerance, "asked of the active set"),
};
inline constexpr auto indicator = std::tuple{
    optional(explained("indicator", "m", &Load::indicator,
                       "part of each triangle in the square of error_bound; none where it was not "
                       "asked for or there are no bounds",
                       "F L")),
};

// Of /sweep, around the arrays of ReadResult.

inline constexpr auto sweep = std::tuple{
    scalar("source", &Sweep::source, "file of the coefficients or nodal forces"),
    scalar("loads", &Sweep::loads, "names"),
    scalar("inclusions", &Sweep::inclusions, "names"),
    scalar("error", &Sweep::error, "of the first row that failed"),
    scalar("solve_seconds", &Sweep::solve_seconds, "on the server's threads, added up", "s"),
};
inline constexpr auto sweep_kept = std::tuple{
    explained("kept", "kept", &Sweep::kept, "rows whose traces are in /loads/row-K"),
};
inline constexpr auto sweep_loads = std::tuple{
    optional(explained("coefficients", "rows,loads", &Sweep::coefficients,
                       "of each load, in the order of the attribute loads")),
};
/// All arrays of /sweep.
inline constexpr auto sweep_arrays =
    std::tuple_cat(arrays::sweep_rows<Sweep>, sweep_kept, arrays::sweep_contacts<Sweep>,
                   arrays::sweep_matrices<Sweep>, sweep_loads);

}  // namespace anticrack::results::tables

// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a result file holds beside the arrays of arrays/result_arrays.hpp, in the order of the file.
// client/RESULT.md has a table made of these: see tests/client/results/result_table_test.cpp.
#pragma once

#include "arrays/result_arrays.hpp"
#include "results/result.hpp"

namespace anticrack::results::tables {

using arrays::array;
using arrays::explained;
using arrays::optional;
using arrays::scalar;

// Attributes of the root group /.

inline constexpr auto result = std::tuple{
    scalar("title", &Result::title, "of the case"),
    scalar("case", &Result::case_text, "the TOML as it was run"),
    scalar("client_version", &Result::client_version, "that wrote the file"),
    scalar("server_version", &Result::server_version, "that solved the case"),
    scalar("job", &Result::job_name, "its name on the server"),
    scalar("not_reached", &Result::not_reached,
           "which accuracy of the job, what stopped it, and the cure"),
    scalar("total_seconds", &Result::total_seconds, "as the user waited", "s"),
};

// Datasets of /mesh, beside the message Mesh; ReadMesh streams them under the same names.

inline constexpr auto mesh = std::tuple{
    array("nodes", "n,2", &Mesh::xy, "coordinates", "L"),
    array("triangles", "m,3", &Mesh::triangles, "indices into nodes, counterclockwise"),
    array("subdomain", "m", &Mesh::subdomain, "of a triangle: index into subdomains"),
    array("boundary", "b,2", &Mesh::boundary, "edges where u is prescribed"),
};

// Datasets of /interfaces/I for the edges; they follow those of arrays::interface_nodes.

inline constexpr auto edges = std::tuple{
    explained("edge_kind", "k-1", &Interface::edge_kind,
              "1 glue, 2 crack, 3 bonded inclusion, 4 delaminated inclusion, 5 free crack"),
    explained("edge_inclusion", "k-1", &Interface::edge_inclusion,
              "index into /mesh/inclusions, -1 none"),
};

// The datasets of /loads/NAME, beside the answer.

inline constexpr auto of_load = std::tuple{
    optional(explained("indicator", "m", &Load::indicator,
                       "part of each triangle in the square of error_bound; none where it was not "
                       "asked for or there are no bounds",
                       "F L")),
    optional(
        explained("balanced_flux", "m,3", &Load::balanced_flux,
                  "outward flux through the side opposite to each corner of a triangle, of the "
                  "flux behind the bounds, which is in equilibrium: the three sum to minus the "
                  "load on it; where it was asked for",
                  "F")),
    optional(
        explained("membrane_rows", "k", &Load::membrane_rows,
                  "with growth and fields: rows of growth whose membranes are kept, the first, "
                  "the last, and those where fronts begin to run or stop")),
    optional(explained("membranes", "k*n", &Load::membranes,
                       "u of these rows under their loads, one row after another, each in the "
                       "nodes of all fields one after another",
                       "L")),
};

// Attributes and datasets of /sweep, beside the message SweepAnswer and the arrays of ReadResult.

inline constexpr auto sweep = std::tuple{
    scalar("source", &Sweep::source, "file of the coefficients or nodal forces"),
    scalar("loads", &Sweep::loads, "names"),
    scalar("inclusions", &Sweep::inclusions, "names"),
    scalar("error", &Sweep::error, "of the first row that failed"),
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

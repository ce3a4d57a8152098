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

// Of /loads/NAME: attributes, and what is in it. Those that LoadCaseAnswer has under the same name
// are copied by it.

inline constexpr auto load_end = std::tuple{
    scalar("status", &Load::status, "converged, not_converged, failed or cancelled"),
    scalar("reason", &Load::reason, "why it did not converge"),
    scalar("error", &Load::error, "why it failed"),
    scalar("solve_seconds", &Load::solve_seconds, "on the server", "s"),
};
inline constexpr auto load_solver = std::tuple{
    scalar("method", &Load::method, "active-set or uzawa"),
    scalar("mass", &Load::mass, "lumped or consistent"),
    scalar("epsilon", &Load::epsilon, "stopping criterion asked of Algorithm 2"),
    scalar("p", &Load::p, "bound on the multipliers asked for"),
    scalar("kkt_tolerance", &Load::kkt_tolerance, "asked for in place of epsilon"),
    scalar("tolerance", &Load::tolerance, "asked of the active set"),
    scalar("iterations", &Load::iterations, "or steps of the active set"),
    scalar("criterion", &Load::criterion, "of the last iteration"),
    scalar("theta", &Load::theta, "used by Algorithm 2"),
    scalar("theta_star", &Load::theta_star, "of Theorem 4"),
};
inline constexpr auto load_answer = std::tuple{
    scalar("energy", &Load::energy, "Pi(u)", "F L"),
    scalar("energy_lower", &Load::energy_lower, "", "F L"),
    scalar("energy_upper", &Load::energy_upper, "the membrane's own Pi lies between them", "F L"),
    scalar("error_bound", &Load::error_bound, "of u in the energy norm", "(F L)^(1/2)"),
    scalar("error_bound_relative", &Load::error_bound_relative, "the same over the norm of u"),
    scalar("no_bracket", &Load::no_bracket, "why there are no bounds"),
    scalar("contact_length", &Load::contact_length, "of all cracks and delaminated parts", "L"),
    scalar("weakly_active", &Load::weakly_active, "crack nodes with neither jump nor pressure"),
};
inline constexpr auto load_residuals = std::tuple{
    scalar("kkt_equilibrium", within(&Load::kkt, &Kkt::equilibrium), ""),
    scalar("kkt_gap", within(&Load::kkt, &Kkt::gap), ""),
    scalar("kkt_sign", within(&Load::kkt, &Kkt::sign), ""),
    scalar("kkt_complementarity", within(&Load::kkt, &Kkt::complementarity),
           "absolute residuals of the optimality conditions"),
    scalar("kkt_relative_equilibrium", within(&Load::kkt_relative, &Kkt::equilibrium), ""),
    scalar("kkt_relative_gap", within(&Load::kkt_relative, &Kkt::gap), ""),
    scalar("kkt_relative_sign", within(&Load::kkt_relative, &Kkt::sign), ""),
    scalar("kkt_relative_complementarity", within(&Load::kkt_relative, &Kkt::complementarity),
           "the same, relative"),
};
inline constexpr auto load = std::tuple_cat(load_end, load_solver, load_answer, load_residuals);
inline constexpr auto load_arrays = std::tuple{
    array("warnings", "w", &Load::warnings, "e.g. of a load not integrated as exactly as asked"),
};
inline constexpr auto indicator = std::tuple{
    optional(explained("indicator", "m", &Load::indicator,
                       "part of each triangle in the square of error_bound; none where it was not "
                       "asked for or there are no bounds",
                       "F L")),
};
/// Of a job with an accuracy.
inline constexpr auto stages = std::tuple{
    explained("triangles", "stages", &Stages::triangles, "of the stage's mesh, increasing"),
    array("energy", "stages", &Stages::energy, "Pi(u)", "F L"),
    array("energy_lower", "stages", &Stages::energy_lower, "", "F L"),
    array("energy_upper", "stages", &Stages::energy_upper,
          "the membrane's own Pi lies between them", "F L"),
    explained("error_bound_relative", "stages", &Stages::error_bound_relative,
              "of u in the energy norm, over the norm of u"),
    explained(
        "displacement_error", "stages", &Stages::displacement_error,
        "half the width of the bounds of A over the amount of A, the largest of all inclusions"),
    explained("seconds", "stages", &Stages::seconds,
              "from the start of the first stage to the end of this one", "s"),
};
inline constexpr auto inclusions = std::tuple{
    array("name", "i", &Inclusion::name, "of the inclusion"),
    array("A", "i", &Inclusion::displacement, "equation (5)", "L"),
    array("resultant", "i", &Inclusion::resultant, "the force on it, equation (6)", "F"),
    array("contact_length", "i", &Inclusion::contact_length, "of its delaminated part", "L"),
    array("Bx", "i", &Inclusion::slope_x, ""),
    array("By", "i", &Inclusion::slope_y,
          "u = A + Bx (x - x0) + By (y - y0) along it, (x0, y0) the middle of its "
          "bounding box; 0 unless it tilts"),
    array("Mx", "i", &Inclusion::moment_x, "", "F L"),
    array("My", "i", &Inclusion::moment_y, "the moment on it about (x0, y0)", "F L"),
    array("A_lower", "i", &Inclusion::displacement_lower, "", "L"),
    array("A_upper", "i", &Inclusion::displacement_upper, "the membrane's own A lies between them",
          "L"),
    array("A_estimated_error", "i", &Inclusion::displacement_estimated_error,
          "estimate of the membrane's own A minus A, no bound", "L"),
    array("Bx_lower", "i", &Inclusion::slope_x_lower, ""),
    array("Bx_upper", "i", &Inclusion::slope_x_upper, ""),
    array("By_lower", "i", &Inclusion::slope_y_lower, ""),
    array("By_upper", "i", &Inclusion::slope_y_upper,
          "bounds of the membrane's own slope, of one that tilts"),
};
inline constexpr auto contact_intervals = std::tuple{
    array("interface", "c", &ContactInterval::interface, "index into /interfaces"),
    array("begin", "c", &ContactInterval::begin, "arc length", "L"),
    array("end", "c", &ContactInterval::end, "arc length; begin: contact in a single node", "L"),
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

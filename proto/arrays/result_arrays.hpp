// SPDX-License-Identifier: GPL-3.0-or-later
//
// The arrays that ReadResult streams. The server's structs and the client's have members of these
// names, so a table serves both: with the client's it is that of the result file as well.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <tuple>

#include "arrays/table.hpp"

namespace anticrack::arrays {

/// Below interface_folder: an entry for each of the k nodes of an interface.
template <class Interface>
inline constexpr auto interface_nodes = std::tuple{
    array("s", "k", &Interface::s, "arc length from the interface's start", "L"),
    array("x", "k", &Interface::x, "", "L"),
    array("y", "k", &Interface::y, "coordinates", "L"),
    explained("kind", "k", &Interface::kind,
              "1 glue, 2 crack, 3 bonded inclusion, 4 delaminated inclusion, 5 free crack"),
};

/// Below load_traces or row_traces and the interface's index: an entry for each node.
template <class Trace>
inline constexpr auto trace = std::tuple{
    array("u_minus", "k", &Trace::u_minus, "u on the minus side", "L"),
    array("u_plus", "k", &Trace::u_plus, "u on the plus side", "L"),
    array("jump", "k", &Trace::jump, "u_plus - u_minus", "L"),
    array("pressure", "k", &Trace::pressure,
          "contact pressure, 0 on glue and bonded parts; singular at tips, so that its values in "
          "nodes near them depend on the mesh",
          "F/L"),
    array("flux", "k", &Trace::flux,
          "-T du/dn on glue and bonded parts, n from the minus to the plus side, 0 on cracks and "
          "delaminated parts; singular at tips as pressure",
          "F/L"),
    array("force", "k", &Trace::force,
          "nodal forces: pressure and flux times the length of the node, whose sums do not depend "
          "on how fine the mesh is at tips",
          "F"),
    array("contact", "k", &Trace::contact, "1 where a crack is closed under pressure, else 0"),
};

/// Below load_history: an entry for each of the n iterations kept. `Record` is one of them or all.
template <class Record>
inline constexpr auto history = std::tuple{
    array("iteration", "n", &Record::iteration, "from 1, increasing"),
    array("criterion", "n", &Record::criterion, "of step 3 of Algorithm 2; 1 in the first"),
    array("energy", "n", &Record::energy, "Pi(u)", "F L"),
    array("contact_count", "n", &Record::contact_count, "crack nodes with positive pressure"),
    array("kkt_equilibrium", "n", within(&Record::kkt, &decltype(Record::kkt)::equilibrium), ""),
    array("kkt_gap", "n", within(&Record::kkt, &decltype(Record::kkt)::gap), ""),
    array("kkt_sign", "n", within(&Record::kkt, &decltype(Record::kkt)::sign), ""),
    array("kkt_complementarity", "n", within(&Record::kkt, &decltype(Record::kkt)::complementarity),
          "absolute residuals of the optimality conditions"),
};

/// Below field_folder, for all loads.
template <class Subdomain>
inline constexpr auto subdomain = std::tuple{
    array("nodes", "n", &Subdomain::nodes, "indices into the mesh's nodes, a slit's twice"),
    array("triangles", "m,3", &Subdomain::triangles, "indices into nodes"),
    array("tension", "m,3", &Subdomain::tension,
          "means of Txx, Txy, Tyy over each triangle; T grad u is the flux", "F/L"),
};

/// Below load_fields the subdomain alone is the array: of one load.
template <class Field>
inline constexpr auto field = std::tuple{
    array("u", "n", &Field::u, "displacement in these nodes", "L"),
};

/// Below sweep_folder: an entry for each row of the sweep.
template <class Columns>
inline constexpr auto sweep_rows = std::tuple{
    explained(
        "status", "rows", &Columns::status,
        "3 converged, 4 not converged, 5 failed, 6 cancelled; no number of a row is right but "
        "where it converged"),
    explained("steps", "rows", &Columns::steps, "steps of the active set"),
    explained("energy", "rows", &Columns::energy,
              "Pi(u): the middle of its bounds, or else the mesh's", "F L"),
    optional(array("energy_lower", "rows", &Columns::energy_lower, "", "F L")),
    optional(array("energy_upper", "rows", &Columns::energy_upper,
                   "if asked for: the membrane's own Pi lies between them", "F L")),
    optional(array("energy_mesh", "rows", &Columns::energy_mesh,
                   "if bounds are asked for: Pi of u on the mesh", "F L")),
    explained("contact_length", "rows", &Columns::contact_length,
              "length in contact, of all cracks and delaminated inclusions", "L"),
    explained("kkt", "rows", &Columns::kkt,
              "largest relative residual of the optimality conditions"),
};

/// Below sweep_folder: what the columns of sweep_matrices belong to.
template <class Contacts>
inline constexpr auto sweep_contacts = std::tuple{
    explained("contact_nodes", "contacts,2", &Contacts::contact_nodes,
              "column of contact -> interface, and index of the node in its s, x, y"),
};

/// Below sweep_folder: a row for each row of the sweep. No array where it would have no column, and
/// no slope where no inclusion tilts, and bounds only where they are asked for.
template <class Columns>
inline constexpr auto sweep_matrices = std::tuple{
    explained("displacement", "rows,inclusions", &Columns::displacement,
              "A of each inclusion, in the order of the attribute inclusions: the middle of its "
              "bounds, or else the mesh's",
              "L"),
    optional(array("displacement_lower", "rows,inclusions", &Columns::displacement_lower, "", "L")),
    optional(array("displacement_upper", "rows,inclusions", &Columns::displacement_upper,
                   "if asked for: the membrane's own A lies between them", "L")),
    optional(array("displacement_mesh", "rows,inclusions", &Columns::displacement_mesh,
                   "if bounds are asked for: A of u on the mesh", "L")),
    optional(explained("slope", "rows,inclusions,2", &Columns::slope,
                       "Bx, By of each inclusion on the mesh; none where no inclusion tilts")),
    explained("contact", "rows,contacts", &Columns::contact,
              "1 where the node is closed under pressure"),
    optional(explained("intensity", "rows,tips", &Columns::intensity,
                       "if asked for: of each tip, as of a load case; NaN where it has none")),
    optional(array("energy_release_rate", "rows,tips", &Columns::energy_release_rate, "", "F")),
    optional(array("energy_release_rate_spread", "rows,tips", &Columns::energy_release_rate_spread,
                   "G of each tip and its spread, in the order of the mesh's tips", "F")),
};

// Where they are: folders end with a slash, all numbers are indices.

inline std::string interface_folder(std::size_t interface) {
  return "interfaces/" + std::to_string(interface) + "/";
}
inline std::string load_folder(std::size_t load) { return "loads/" + std::to_string(load) + "/"; }
inline std::string load_traces(std::size_t load) { return load_folder(load) + "traces/"; }
inline std::string row_traces(std::size_t row) { return "traces/" + std::to_string(row) + "/"; }
inline std::string load_history(std::size_t load) { return load_folder(load) + "history/"; }
inline std::string field_folder(std::size_t subdomain) {
  return "fields/" + std::to_string(subdomain) + "/";
}
inline std::string load_fields(std::size_t load) { return load_folder(load) + "fields/"; }
inline std::string sweep_folder() { return "sweep/"; }

}  // namespace anticrack::arrays

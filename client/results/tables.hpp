// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a result file holds beside the API's messages, in the order of the file. client/RESULT.md
// has a table made of these: see tests/client/results/result_table_test.cpp.
#pragma once

#include <array>
#include <tuple>

#include "arrays/result_arrays.hpp"
#include "results/result.hpp"

namespace anticrack::results::tables {

using arrays::array;
using arrays::explained;
using arrays::optional;
using arrays::scalar;

// Attributes of the root group / and of /sweep, there beside the message SweepAnswer.

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
inline constexpr auto sweep = std::tuple{
    scalar("source", &Sweep::source, "file of the coefficients or nodal forces"),
    scalar("loads", &Sweep::loads, "names"),
    scalar("inclusions", &Sweep::inclusions, "names"),
    scalar("error", &Sweep::error, "of the first row that failed"),
};

// Datasets.

/// What a file says of an array.
struct Row {
  std::string_view name, shape;  ///< as in arrays::Array
  ValueType type;
  std::string_view what, unit;
  bool explained, optional;

  /// Whether there may be no array: also if it had no columns, as HDF5 has no chunks without
  /// extent.
  constexpr bool may_be_missing() const {
    return optional || arrays::columns_of(shape) == arrays::named;
  }
};

/// The arrays of the mesh and of loads, for their types.
struct Columns {
  std::vector<double> xy, s, x, y, u_minus, u_plus, jump, pressure, flux, force, criterion, energy,
      tension, u, indicator, balanced_flux, membranes;
  std::vector<std::int32_t> nodes, triangles, subdomain, boundary, kind, edge_kind, edge_inclusion,
      contact, iteration, contact_count, membrane_rows;
  struct Residuals {
    std::vector<double> equilibrium, gap, sign, complementarity;
  } kkt;
};
/// Those of a sweep.
struct SweepColumns {
  std::vector<double> energy, energy_lower, energy_upper, energy_mesh, contact_length, kkt,
      displacement, displacement_lower, displacement_upper, displacement_mesh, slope, intensity,
      energy_release_rate, energy_release_rate_spread, coefficients;
  std::vector<std::int32_t> status, steps, contact_nodes, kept;
  std::vector<std::uint8_t> contact;
};

/// The rows of a table whose members are those of a Record.
template <class Record, class... Members>
constexpr auto rows_of(const std::tuple<arrays::Array<Members>...>& table) {
  return std::apply(
      [](const auto&... row) {
        return std::array{
            Row{row.name, row.shape,
                value_type<typename arrays::MemberOf<Record, decltype(row.member)>::value_type>,
                row.what, row.unit, row.explained, row.optional}...};
      },
      table);
}

/// Of /mesh, beside the message Mesh; ReadMesh streams them under the same names.
inline constexpr auto mesh = rows_of<Columns>(std::tuple{
    array("nodes", "n,2", &Columns::xy, "coordinates", "L"),
    array("triangles", "m,3", &Columns::triangles, "indices into nodes, counterclockwise"),
    array("subdomain", "m", &Columns::subdomain, "of a triangle: index into subdomains"),
    array("boundary", "b,2", &Columns::boundary, "edges where u is prescribed"),
});
/// Of /interfaces/I.
inline constexpr auto interface = rows_of<Columns>(std::tuple_cat(
    arrays::interface_nodes<Columns>,
    std::tuple{
        explained("edge_kind", "k-1", &Columns::edge_kind,
                  "1 glue, 2 crack, 3 bonded inclusion, 4 delaminated inclusion, 5 free crack"),
        explained("edge_inclusion", "k-1", &Columns::edge_inclusion,
                  "index into /mesh/inclusions, -1 none")}));
/// Of /loads/LOAD/traces/I, /loads/LOAD/history and, by parts, /loads/LOAD/fields/D.
inline constexpr auto trace = rows_of<Columns>(arrays::trace<Columns>);
inline constexpr auto history = rows_of<Columns>(arrays::history<Columns>);
inline constexpr auto subdomain = rows_of<Columns>(arrays::subdomain<Columns>);
inline constexpr auto field = rows_of<Columns>(arrays::field<Columns>);
/// Of /loads/LOAD, beside the answer.
inline constexpr auto load = rows_of<Columns>(std::tuple{
    optional(explained("indicator", "m", &Columns::indicator,
                       "part of each triangle in the square of error_bound; none where it was not "
                       "asked for or there are no bounds",
                       "F L")),
    optional(
        explained("balanced_flux", "m,3", &Columns::balanced_flux,
                  "outward flux through the side opposite to each corner of a triangle, of the "
                  "flux behind the bounds, which is in equilibrium: the three sum to minus the "
                  "load on it; where it was asked for",
                  "F")),
    optional(
        explained("membrane_rows", "k", &Columns::membrane_rows,
                  "with growth and fields: rows of growth whose membranes are kept, the first, "
                  "the last, and those where fronts begin to run or stop")),
    optional(explained("membranes", "k*n", &Columns::membranes,
                       "u of these rows under their loads, one row after another, each in the "
                       "nodes of all fields one after another",
                       "L")),
});
/// Of /sweep.
inline constexpr auto columns = rows_of<SweepColumns>(std::tuple_cat(
    arrays::sweep_rows<SweepColumns>,
    std::tuple{
        explained("kept", "kept", &SweepColumns::kept, "rows whose traces are in /loads/row-K")},
    arrays::sweep_contacts<SweepColumns>, arrays::sweep_matrices<SweepColumns>,
    std::tuple{optional(explained("coefficients", "rows,loads", &SweepColumns::coefficients,
                                  "of each load, in the order of the attribute loads"))}));

}  // namespace anticrack::results::tables

// SPDX-License-Identifier: GPL-3.0-or-later
//
// A result made up without a server: the paper's square, a structured mesh, and displacements with
// the features of a solution (jump like sqrt(1/4 - x^2), contact near a tip).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "results/tables.hpp"

namespace anticrack::testing {

/// u+ - u- at (x, 0): open over all of the crack, or closed for x < -0.2.
inline double sample_jump(double x, bool contact) {
  if (!contact) return 0.3 * std::sqrt(std::max(0.25 - x * x, 0.0));
  return x <= -0.2 ? 0.0 : 0.4 * (x + 0.2) * std::sqrt(std::max(0.5 - x, 0.0));
}

/// u at (x, y) on the given side.
inline double sample_u(double x, double y, bool plus, bool contact) {
  const double smooth = (contact ? 0.12 * std::sin(2.2 * x + 0.4) : 0.05) * (1 - x * x);
  const double side = plus ? 0.35 : -0.65;
  const double face = smooth + side * sample_jump(x, contact) * std::exp(-2 * std::abs(y));
  const double load = (plus ? 0.3 : -0.3) * (contact ? 0.4 : 1.0) * std::abs(y) * (1 - x * x);
  return (face + load) * (1 - std::abs(y));
}

using results::array_of;
using results::tables::Columns;

/// Adds the arrays of a table that the record has.
template <class Record, class Table>
void put(results::Arrays& into, const std::string& path, const Record& record, const Table& table) {
  arrays::for_each(
      [&](const auto& row) {
        const std::size_t columns = arrays::columns_of(row.shape);
        into[path + std::string(row.name)] =
            array_of(std::invoke(row.member, record),
                     columns == 0 ? results::Shape{} : results::Shape{columns});
      },
      table);
}

/// The values of an array, to be changed in place.
template <class T = double>
std::span<T> values_of(results::Arrays& all, const std::string& path) {
  const std::span<const T> values = all.at(path).as<T>();
  return {const_cast<T*>(values.data()), values.size()};
}

/// Grid of 2n x 2n squares, two triangles each, on (-1,1)^2.
inline Columns sample_grid(int n) {
  Columns grid;
  const int side = 2 * n + 1;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      grid.xy.push_back(-1 + static_cast<double>(i) / n);
      grid.xy.push_back(-1 + static_cast<double>(j) / n);
    }
  }
  for (int j = 0; j + 1 < side; ++j) {
    for (int i = 0; i + 1 < side; ++i) {
      const int a = j * side + i;
      for (const int node : {a, a + 1, a + side + 1, a, a + side + 1, a + side}) {
        grid.triangles.push_back(node);
      }
      grid.subdomain.insert(grid.subdomain.end(), 2, j < n ? 0 : 1);
    }
  }
  for (int i = 0; i + 1 < side; ++i) {
    const int top = side * (side - 1);
    for (const int node : {i, i + 1, top + i, top + i + 1, i * side, (i + 1) * side,
                           i * side + side - 1, (i + 1) * side + side - 1}) {
      grid.boundary.push_back(node);
    }
  }
  return grid;
}

/// What is said of that mesh; the interface is y = 0.
inline v1::Mesh sample_mesh(const Columns& grid) {
  v1::Mesh mesh;
  mesh.set_name("meshes/0123");
  mesh.set_sha256(std::string(64, 'a'));
  mesh.set_state(v1::Mesh::STATE_READY);
  mesh.mutable_create_time()->set_seconds(1'700'000'000);
  mesh.set_mesh_seconds(0.2);
  mesh.set_factorize_seconds(0.1);
  for (const char* name : {"lower", "upper"}) mesh.add_subdomains()->set_name(name);
  mesh.mutable_subdomains(0)->set_tension(1);
  mesh.mutable_subdomains(1)->set_tension(2);
  v1::Tension& law = *mesh.mutable_subdomains(1)->mutable_tension_law();
  law.set_along("2");
  law.set_across("1");
  law.set_angle(30);
  v1::InterfaceInfo& line = *mesh.add_interfaces();
  line.set_name("sigma");
  line.mutable_start()->set_x(-1);
  mesh.add_inclusions("fibre");
  mesh.set_node_count(grid.xy.size() / 2);
  mesh.set_triangle_count(grid.subdomain.size());
  return mesh;
}

inline Columns sample_interface(int n) {
  Columns interface;
  for (int i = 0; i <= 2 * n; ++i) {
    const double x = -1 + static_cast<double>(i) / n;
    interface.s.push_back(x + 1);
    interface.x.push_back(x);
    interface.y.push_back(0);
    const double beyond = std::abs(x) - 0.5;
    interface.kind.push_back(beyond < -1e-9  ? v1::INTERFACE_KIND_DELAMINATED
                             : beyond < 1e-9 ? v1::INTERFACE_KIND_INCLUSION
                                             : v1::INTERFACE_KIND_GLUE);
    if (i == 2 * n) break;
    const bool delaminated = std::abs(x + 0.5 / n) < 0.5;
    interface.edge_kind.push_back(delaminated ? v1::INTERFACE_KIND_DELAMINATED
                                              : v1::INTERFACE_KIND_GLUE);
    interface.edge_inclusion.push_back(delaminated ? 0 : -1);
  }
  return interface;
}

/// Adds a load with its arrays; the first one adds what subdomains have in common.
inline void add_load(results::Result& result, const std::string& name, const Columns& mesh,
                     const Columns& interface, bool contact) {
  results::Load& load = result.loads.emplace_back();
  const std::string path = results::load_path(name);
  v1::LoadCaseAnswer& answer = load.answer;
  answer.set_name(name);
  answer.set_status(v1::LoadCaseAnswer::STATUS_CONVERGED);
  answer.set_iterations(180);
  answer.set_criterion(8.7e-13);
  answer.set_theta(2);
  answer.set_theta_star(1.74);
  answer.set_energy(-0.031);
  v1::KktResiduals& kkt = *answer.mutable_kkt();
  kkt.set_equilibrium(1e-15);
  kkt.set_gap(2e-8);
  kkt.set_complementarity(3e-9);
  kkt.set_equilibrium_relative(2e-15);
  kkt.set_gap_relative(2e-7);
  kkt.set_complementarity_relative(3e-8);
  answer.set_weakly_active(3);
  answer.mutable_solve_time()->set_nanos(50'000'000);
  answer.add_warnings("f jumps along a curve that the mesh does not follow");
  v1::InclusionAnswer& inclusion = *answer.add_inclusions();
  inclusion.set_name("fibre");
  inclusion.set_displacement(0.0863);
  inclusion.set_resultant(1e-12);
  inclusion.set_contact_length(contact ? 0.3 : 0.0);
  inclusion.set_moment_x(0.01);
  inclusion.set_moment_y(-0.02);

  v1::Tip& tip = *answer.add_tips();
  tip.set_x(-0.5);
  tip.set_interface(result.mesh.interfaces(0).name());
  tip.set_kind(v1::TIP_KIND_DELAMINATED_END);
  tip.set_closed(contact);
  tip.set_exponent(0.25);
  tip.set_intensity(contact ? 0 : 0.3);

  v1::BoundaryAnswer& side = *answer.add_boundary();
  side.set_name("right");
  side.set_free(contact);
  side.set_resultant(-0.7);
  side.set_moment_x(0.02);
  side.set_x(1);

  Columns trace;
  for (std::size_t i = 0; i < interface.s.size(); ++i) {
    const double x = interface.x[i];
    const bool crack = interface.kind[i] == v1::INTERFACE_KIND_DELAMINATED;
    const bool closed = contact && crack && x <= -0.2 + 1e-9;
    trace.u_minus.push_back(sample_u(x, 0, false, contact));
    trace.u_plus.push_back(sample_u(x, 0, true, contact));
    trace.jump.push_back(trace.u_plus.back() - trace.u_minus.back());
    trace.pressure.push_back(closed ? -0.15 - x : 0.0);
    trace.flux.push_back(crack ? 0.0 : x);
    trace.force.push_back(0.1 * (trace.pressure.back() + trace.flux.back()));
    trace.contact.push_back(closed ? 1 : 0);
  }
  put(result.arrays, path + "traces/0/", trace, arrays::trace<Columns>);
  if (contact) {
    answer.set_contact_length(0.3);
    v1::ContactInterval& interval = *answer.add_contact_intervals();
    interval.set_interface(result.mesh.interfaces(0).name());
    interval.set_begin(0.5);
    interval.set_end(0.8);
  }

  Columns history;
  for (int k = 1; k <= answer.iterations(); ++k) {
    history.iteration.push_back(k);
    history.criterion.push_back(
        k == 1 ? 1.0 : 0.3 * std::exp(-0.148 * k) * (1 + 0.3 * std::sin(0.5 * k)));
    history.energy.push_back(answer.energy() * (1 + std::exp(-0.1 * k)));
    history.contact_count.push_back(contact ? 12 : 0);
    history.kkt.equilibrium.push_back(1e-15);
    history.kkt.gap.push_back(std::exp(-0.08 * k));
    history.kkt.sign.push_back(0);
    history.kkt.complementarity.push_back(0.1 * std::exp(-0.08 * k));
  }

  put(result.arrays, path + "history/", history, arrays::history<Columns>);

  for (const bool plus : {false, true}) {
    Columns field;
    for (std::size_t i = 0; 2 * i < mesh.xy.size(); ++i) {
      const double x = mesh.xy[2 * i];
      const double y = mesh.xy[2 * i + 1];
      if (plus ? y < -1e-12 : y > 1e-12) continue;
      field.nodes.push_back(static_cast<std::int32_t>(i));
      field.u.push_back(sample_u(x, y, plus, contact));
    }
    for (std::size_t corner = 0; corner < mesh.triangles.size(); ++corner) {
      if (mesh.subdomain[corner / 3] != (plus ? 1 : 0)) continue;
      field.tension.push_back(corner % 3 == 1 ? 0 : plus ? 2 : 1);
      const auto found =
          std::lower_bound(field.nodes.begin(), field.nodes.end(), mesh.triangles[corner]);
      field.triangles.push_back(static_cast<std::int32_t>(found - field.nodes.begin()));
    }
    const std::string below = plus ? "fields/1/" : "fields/0/";
    put(result.arrays, below, field, arrays::subdomain<Columns>);
    put(result.arrays, path + below, field, arrays::field<Columns>);
  }
}

inline v1::Units units_of(const std::string& length, const std::string& force) {
  v1::Units units;
  units.set_length(length);
  units.set_force(force);
  return units;
}

/// Two loads, "opening" and "partly closed"; 8 n^2 triangles.
inline results::Result sample_result(int n = 20) {
  results::Result result;
  result.title = "A made-up membrane";
  result.case_text = "title = \"A made-up membrane\"\n# \xC3\xA9\n";
  result.client_version = "0.1.0";
  result.server_version = "0.1.0";
  result.job_name = "jobs/4567";
  result.total_seconds = 0.6;
  result.solver.mutable_uzawa()->set_epsilon(1e-12);
  result.solver.mutable_uzawa()->set_mass(v1::MASS_LUMPED);
  const Columns grid = sample_grid(n), interface = sample_interface(n);
  result.mesh = sample_mesh(grid);
  result.arrays = {{"mesh/nodes", array_of(grid.xy, {2})},
                   {"mesh/triangles", array_of(grid.triangles, {3})},
                   {"mesh/subdomain", array_of(grid.subdomain)},
                   {"mesh/boundary", array_of(grid.boundary, {2})},
                   {"interfaces/0/edge_kind", array_of(interface.edge_kind)},
                   {"interfaces/0/edge_inclusion", array_of(interface.edge_inclusion)}};
  put(result.arrays, "interfaces/0/", interface, arrays::interface_nodes<Columns>);
  add_load(result, "opening", grid, interface, false);
  add_load(result, "partly closed", grid, interface, true);
  return result;
}

/// Five stages, the last on a mesh of so many triangles; the bracket closes in on -0.170034 like
/// 1 / triangles.
inline std::vector<v1::Stage> sample_stages(std::size_t triangles) {
  std::vector<v1::Stage> stages;
  for (int left = 4; left >= 0; --left) {
    const double count = std::round(static_cast<double>(triangles) * std::pow(0.55, left));
    v1::Stage& stage = stages.emplace_back();
    stage.set_triangles(static_cast<std::uint64_t>(count));
    stage.set_seconds(2e-5 * count);
    v1::StageAnswer& answer = *stage.add_answers();
    answer.set_energy_lower(-0.170034 - 12 / count);
    answer.set_energy_upper(-0.170034 + 7 / count);
    answer.set_energy(answer.energy_upper());
    answer.set_error_bound_relative(std::sqrt(110 / count));
    answer.set_displacement_error(3 / std::pow(count, 0.7));
  }
  return stages;
}

/// The same result of a job with an accuracy, which it did not reach.
inline results::Result with_stages(results::Result result) {
  result.not_reached = "energy to 0.0001: the mesh has max_triangles";
  const std::size_t triangles = result.mesh.triangle_count();
  for (results::Load& load : result.loads) {
    load.stages = sample_stages(triangles);
    Columns of_load;
    for (std::size_t t = 0; t < triangles; ++t) {
      of_load.indicator.push_back(1e-3 / static_cast<double>(t + 1));
      for (const double side : {1.0, 2.0, -3.0}) of_load.balanced_flux.push_back(side);
      of_load.membrane_rows.push_back(static_cast<std::int32_t>(t));
      of_load.membranes.push_back(0.5 * static_cast<double>(t));
    }
    const std::string path = results::load_path(load.name());
    result.arrays[path + "indicator"] = array_of(of_load.indicator);
    result.arrays[path + "balanced_flux"] = array_of(of_load.balanced_flux, {3});
    result.arrays[path + "membrane_rows"] = array_of(of_load.membrane_rows);
    result.arrays[path + "membranes"] = array_of(of_load.membranes);
  }
  return result;
}

}  // namespace anticrack::testing

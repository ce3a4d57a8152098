// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "results/file.hpp"
#include "results/file_image.hpp"
#include "results/hdf5.hpp"
#include "results/replace_file.hpp"
#include "results/sweep_file.hpp"

namespace anticrack::results {
namespace {

using hdf5::create_group;
using hdf5::Handle;
using hdf5::put;
using hdf5::put_array;

/// The API has no units: every quantity is in those of the case, as in section 8 of the paper.
const std::string dimensionless = "-";

void put_mesh(const Handle& root, const Mesh& mesh) {
  const Handle group = create_group(root, "mesh");
  put_array(group, "nodes", mesh.xy, dimensionless, 2);
  put_array(group, "triangles", mesh.triangles, dimensionless, 3);
  put_array(group, "subdomain", mesh.subdomain, dimensionless);
  put_array(group, "boundary", mesh.boundary, dimensionless, 2);
  put_array(group, "subdomain_names", mesh.subdomains);
  put_array(group, "tension", mesh.tension, dimensionless);
  put_array(group, "inclusions", mesh.inclusions);
}

void put_kinds(const Handle& group, const std::string& name, const std::vector<Kind>& kinds) {
  std::vector<std::int32_t> numbers;
  numbers.reserve(kinds.size());
  for (const Kind kind : kinds) numbers.push_back(static_cast<std::int32_t>(kind));
  const Handle dataset = put_array(group, name, numbers, dimensionless);
  put(dataset, "meaning", "1 glue, 2 crack, 3 bonded inclusion, 4 delaminated inclusion");
}

void put_interface(const Handle& parent, std::size_t index, const Interface& interface) {
  const Handle group = create_group(parent, std::to_string(index));
  put(group, "name", interface.name);
  put_array(group, "s", interface.s, dimensionless);
  put_array(group, "x", interface.x, dimensionless);
  put_array(group, "y", interface.y, dimensionless);
  put_kinds(group, "kind", interface.kind);
  put_kinds(group, "edge_kind", interface.edges.kind);
  const Handle inclusion =
      put_array(group, "edge_inclusion", interface.edges.inclusion, dimensionless);
  put(inclusion, "meaning", "index into /mesh/inclusions, -1 none");
}

void put_kkt(const Handle& group, const std::string& prefix, const Kkt& kkt) {
  put(group, prefix + "equilibrium", kkt.equilibrium);
  put(group, prefix + "gap", kkt.gap);
  put(group, prefix + "sign", kkt.sign);
  put(group, prefix + "complementarity", kkt.complementarity);
}

void put_inclusions(const Handle& load, const std::vector<Inclusion>& inclusions) {
  const Handle group = create_group(load, "inclusions");
  std::vector<std::string> names;
  std::vector<double> displacement, resultant, contact_length;
  for (const Inclusion& inclusion : inclusions) {
    names.push_back(inclusion.name);
    displacement.push_back(inclusion.displacement);
    resultant.push_back(inclusion.resultant);
    contact_length.push_back(inclusion.contact_length);
  }
  put_array(group, "name", names);
  put_array(group, "A", displacement, dimensionless);
  put_array(group, "resultant", resultant, dimensionless);
  put_array(group, "contact_length", contact_length, dimensionless);
}

void put_contact_intervals(const Handle& load, const std::vector<ContactInterval>& intervals) {
  const Handle group = create_group(load, "contact_intervals");
  std::vector<std::int32_t> interface;
  std::vector<double> begin, end;
  for (const ContactInterval& interval : intervals) {
    interface.push_back(static_cast<std::int32_t>(interval.interface));
    begin.push_back(interval.begin);
    end.push_back(interval.end);
  }
  put_array(group, "interface", interface, dimensionless);
  put_array(group, "begin", begin, dimensionless);
  put_array(group, "end", end, dimensionless);
}

void put_traces(const Handle& load, const std::vector<Trace>& traces) {
  const Handle parent = create_group(load, "traces");
  for (std::size_t i = 0; i < traces.size(); ++i) {
    const Handle group = create_group(parent, std::to_string(i));
    put_array(group, "u_minus", traces[i].u_minus, dimensionless);
    put_array(group, "u_plus", traces[i].u_plus, dimensionless);
    put_array(group, "jump", traces[i].jump, dimensionless);
    put_array(group, "pressure", traces[i].pressure, dimensionless);
    put_array(group, "contact", traces[i].contact, dimensionless);
  }
}

void put_history(const Handle& load, const History& history) {
  const Handle group = create_group(load, "history");
  put_array(group, "iteration", history.iteration, dimensionless);
  put_array(group, "criterion", history.criterion, dimensionless);
  put_array(group, "energy", history.energy, dimensionless);
  put_array(group, "contact_count", history.contact_count, dimensionless);
  put_array(group, "kkt_equilibrium", history.kkt_equilibrium, dimensionless);
  put_array(group, "kkt_gap", history.kkt_gap, dimensionless);
  put_array(group, "kkt_sign", history.kkt_sign, dimensionless);
  put_array(group, "kkt_complementarity", history.kkt_complementarity, dimensionless);
}

void put_fields(const Handle& load, const std::vector<Field>& fields,
                const std::vector<std::string>& subdomains) {
  if (fields.empty()) return;
  const Handle parent = create_group(load, "fields");
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Handle group = create_group(parent, std::to_string(i));
    put(group, "name", subdomains[i]);
    put_array(group, "nodes", fields[i].nodes, dimensionless);
    put_array(group, "triangles", fields[i].triangles, dimensionless, 3);
    put_array(group, "u", fields[i].u, dimensionless);
  }
}

void put_load(const Handle& parent, std::size_t index, const Load& load, const Mesh& mesh) {
  const Handle group = create_group(parent, load.name);
  put(group, "index", static_cast<std::int32_t>(index));
  put(group, "status", std::string(name(load.status)));
  put(group, "reason", load.reason);
  put(group, "error", load.error);
  put(group, "method", load.method);
  put(group, "mass", load.mass);
  put(group, "epsilon", load.epsilon);
  put(group, "p", load.p);
  put(group, "kkt_tolerance", load.kkt_tolerance);
  put(group, "tolerance", load.tolerance);
  put(group, "iterations", load.iterations);
  put(group, "criterion", load.criterion);
  put(group, "theta", load.theta);
  put(group, "theta_star", load.theta_star);
  put(group, "energy", load.energy);
  put_kkt(group, "kkt_", load.kkt);
  put_kkt(group, "kkt_relative_", load.kkt_relative);
  put(group, "contact_length", load.contact_length);
  put(group, "weakly_active", load.weakly_active);
  put(group, "solve_seconds", load.solve_seconds);
  put_array(group, "warnings", load.warnings);
  put_inclusions(group, load.inclusions);
  put_contact_intervals(group, load.contact_intervals);
  put_traces(group, load.traces);
  put_history(group, load.history);
  put_fields(group, load.fields, mesh.subdomains);
}

void put_root(const Handle& root, const Result& result) {
  put(root, "format", std::string(format));
  put(root, "title", result.title);
  put(root, "case", result.case_text);
  put(root, "client_version", result.client_version);
  put(root, "server_version", result.server_version);
  put(root, "mesh", result.mesh_name);
  put(root, "job", result.job_name);
  put(root, "mesh_sha256", result.mesh_sha256);
  put(root, "mesh_seconds", result.timings.mesh_seconds);
  put(root, "factorize_seconds", result.timings.factorize_seconds);
  put(root, "solve_seconds", result.timings.solve_seconds);
  put(root, "total_seconds", result.timings.total_seconds);
}

void put_all(const Handle& file, const Result& result) {
  const Handle root(H5Gopen2(file.get(), "/", H5P_DEFAULT), H5Gclose, "has no root group");
  put_root(root, result);
  put_mesh(root, result.mesh);
  const Handle interfaces = create_group(root, "interfaces");
  for (std::size_t i = 0; i < result.interfaces.size(); ++i) {
    put_interface(interfaces, i, result.interfaces[i]);
  }
  const Handle loads = create_group(root, "loads");
  for (std::size_t i = 0; i < result.loads.size(); ++i) {
    put_load(loads, i, result.loads[i], result.mesh);
  }
  if (result.sweep) put_sweep(root, *result.sweep);
}

}  // namespace

void write(const std::filesystem::path& path, const Result& result) {
  const std::string fault = first_fault(result);
  if (!fault.empty()) throw Error(path.string(), "the result is inconsistent: " + fault, "");
  const hdf5::Quiet quiet;
  std::vector<std::byte> bytes;
  try {
    bytes = hdf5::file_image([&](const Handle& file) { put_all(file, result); });
  } catch (const hdf5::Fault& error) {
    throw Error(path.string(), error.what(), "");
  }
  replace_file(path, bytes);
}

}  // namespace anticrack::results

// SPDX-License-Identifier: GPL-3.0-or-later
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "results/file.hpp"
#include "results/guess_edges.hpp"
#include "results/hdf5.hpp"
#include "results/open_file.hpp"
#include "results/sweep_file.hpp"

namespace anticrack::results {
namespace {

namespace fs = std::filesystem;
using hdf5::Handle;
using hdf5::open_group;

std::vector<double> doubles(const Handle& group, const char* name, std::uint64_t budget,
                            std::size_t columns = 0) {
  return hdf5::get_doubles(group, name, budget, columns);
}

std::vector<std::int32_t> ints(const Handle& group, const char* name, std::uint64_t budget,
                               std::size_t columns = 0) {
  return hdf5::get_ints(group, name, budget, columns);
}

/// Groups "0", "1", ... of a list: how many there are. Other names are a fault.
std::size_t count_of(const Handle& list, const char* what) {
  const std::size_t count = hdf5::names_in(list).size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!hdf5::has(list, std::to_string(i))) {
      throw hdf5::Fault(std::string(what) + " are not numbered from 0");
    }
  }
  return count;
}

Mesh get_mesh(const Handle& root, std::uint64_t budget) {
  const Handle group = open_group(root, "mesh");
  Mesh mesh;
  mesh.xy = doubles(group, "nodes", budget, 2);
  mesh.triangles = ints(group, "triangles", budget, 3);
  mesh.subdomain = ints(group, "subdomain", budget);
  mesh.boundary = ints(group, "boundary", budget, 2);
  mesh.subdomains = hdf5::get_texts(group, "subdomain_names", budget);
  if (hdf5::has(group, "inclusions")) {
    mesh.inclusions = hdf5::get_texts(group, "inclusions", budget);
  }
  mesh.tension = hdf5::has(group, "tension") ? doubles(group, "tension", budget)
                                             : std::vector<double>(mesh.subdomains.size(), 1.0);
  return mesh;
}

Interface get_interface(const Handle& list, std::size_t index, std::uint64_t budget,
                        bool with_edges) {
  const Handle group = open_group(list, std::to_string(index));
  Interface interface;
  interface.name = hdf5::get_text(group, "name");
  interface.s = doubles(group, "s", budget);
  interface.x = doubles(group, "x", budget);
  interface.y = doubles(group, "y", budget);
  interface.kind = kinds_of(ints(group, "kind", budget));
  if (with_edges) {
    interface.edges = {kinds_of(ints(group, "edge_kind", budget)),
                       ints(group, "edge_inclusion", budget)};
  }
  return interface;
}

Kkt get_kkt(const Handle& group, const std::string& prefix) {
  Kkt kkt;
  kkt.equilibrium = hdf5::get_double(group, prefix + "equilibrium");
  kkt.gap = hdf5::get_double(group, prefix + "gap");
  kkt.sign = hdf5::get_double(group, prefix + "sign");
  kkt.complementarity = hdf5::get_double(group, prefix + "complementarity");
  return kkt;
}

void require_same(const char* what, std::size_t a, std::size_t b) {
  if (a != b) throw hdf5::Fault(std::string(what) + " has datasets of different lengths");
}

std::vector<Inclusion> get_inclusions(const Handle& load, std::uint64_t budget) {
  const Handle group = open_group(load, "inclusions");
  const auto names = hdf5::get_texts(group, "name", budget);
  const auto displacement = doubles(group, "A", budget);
  const auto resultant = doubles(group, "resultant", budget);
  const auto contact_length = doubles(group, "contact_length", budget);
  require_same("inclusions", displacement.size(), names.size());
  require_same("inclusions", resultant.size(), names.size());
  require_same("inclusions", contact_length.size(), names.size());
  std::vector<Inclusion> inclusions;
  for (std::size_t i = 0; i < names.size(); ++i) {
    inclusions.push_back({names[i], displacement[i], resultant[i], contact_length[i]});
  }
  return inclusions;
}

std::vector<ContactInterval> get_contact_intervals(const Handle& load, std::uint64_t budget) {
  const Handle group = open_group(load, "contact_intervals");
  const auto interface = ints(group, "interface", budget);
  const auto begin = doubles(group, "begin", budget);
  const auto end = doubles(group, "end", budget);
  require_same("contact_intervals", begin.size(), interface.size());
  require_same("contact_intervals", end.size(), interface.size());
  std::vector<ContactInterval> intervals;
  for (std::size_t i = 0; i < interface.size(); ++i) {
    // A negative index becomes a huge one, which first_fault refuses.
    intervals.push_back({static_cast<std::size_t>(interface[i]), begin[i], end[i]});
  }
  return intervals;
}

std::vector<Trace> get_traces(const Handle& load, std::uint64_t budget) {
  const Handle list = open_group(load, "traces");
  std::vector<Trace> traces;
  const std::size_t count = count_of(list, "traces");
  for (std::size_t i = 0; i < count; ++i) {
    const Handle group = open_group(list, std::to_string(i));
    traces.push_back({doubles(group, "u_minus", budget), doubles(group, "u_plus", budget),
                      doubles(group, "jump", budget), doubles(group, "pressure", budget),
                      ints(group, "contact", budget)});
  }
  return traces;
}

History get_history(const Handle& load, std::uint64_t budget) {
  const Handle group = open_group(load, "history");
  History history;
  history.iteration = ints(group, "iteration", budget);
  history.criterion = doubles(group, "criterion", budget);
  history.energy = doubles(group, "energy", budget);
  history.contact_count = ints(group, "contact_count", budget);
  history.kkt_equilibrium = doubles(group, "kkt_equilibrium", budget);
  history.kkt_gap = doubles(group, "kkt_gap", budget);
  history.kkt_sign = doubles(group, "kkt_sign", budget);
  history.kkt_complementarity = doubles(group, "kkt_complementarity", budget);
  return history;
}

Field get_field(const Handle& list, std::size_t subdomain, const Mesh& mesh, std::uint64_t budget) {
  const Handle group = open_group(list, std::to_string(subdomain));
  Field field;
  field.nodes = ints(group, "nodes", budget);
  field.u = doubles(group, "u", budget);
  if (!hdf5::has(group, "triangles")) {
    if (auto triangles = triangles_of(mesh, subdomain, field.nodes)) {
      field.triangles = *std::move(triangles);
      return field;
    }
  }
  field.triangles = ints(group, "triangles", budget, 3);
  return field;
}

std::vector<Field> get_fields(const Handle& load, const Mesh& mesh, std::uint64_t budget) {
  std::vector<Field> fields;
  if (!hdf5::has(load, "fields")) return fields;
  const Handle list = open_group(load, "fields");
  const std::size_t count = count_of(list, "fields");
  for (std::size_t i = 0; i < count; ++i) {
    fields.push_back(get_field(list, i, mesh, budget));
  }
  return fields;
}

/// What files of earlier clients do not have: they knew one method, and no warnings.
void get_later_additions(const Handle& group, std::uint64_t budget, Load& load) {
  if (hdf5::has_attribute(group, "weakly_active")) {
    load.kkt_tolerance = hdf5::get_double(group, "kkt_tolerance");
    load.tolerance = hdf5::get_double(group, "tolerance");
    load.weakly_active = hdf5::get_int(group, "weakly_active");
    load.warnings = hdf5::get_texts(group, "warnings", budget);
  }
}

Load get_load(const Handle& group, const std::string& name, const Mesh& mesh,
              std::uint64_t budget) {
  Load load;
  load.name = name;
  const std::string status = hdf5::get_text(group, "status");
  const auto known = status_from(status);
  if (!known) throw hdf5::Fault("load \"" + name + "\" has the unknown status \"" + status + "\"");
  load.status = *known;
  load.reason = hdf5::get_text(group, "reason");
  load.error = hdf5::get_text(group, "error");
  load.method = hdf5::get_text(group, "method");
  load.mass = hdf5::get_text(group, "mass");
  load.epsilon = hdf5::get_double(group, "epsilon");
  load.p = hdf5::get_double(group, "p");
  load.iterations = hdf5::get_int(group, "iterations");
  load.criterion = hdf5::get_double(group, "criterion");
  load.theta = hdf5::get_double(group, "theta");
  load.theta_star = hdf5::get_double(group, "theta_star");
  load.energy = hdf5::get_double(group, "energy");
  load.kkt = get_kkt(group, "kkt_");
  load.kkt_relative = get_kkt(group, "kkt_relative_");
  load.contact_length = hdf5::get_double(group, "contact_length");
  load.solve_seconds = hdf5::get_double(group, "solve_seconds");
  load.inclusions = get_inclusions(group, budget);
  load.contact_intervals = get_contact_intervals(group, budget);
  load.traces = get_traces(group, budget);
  load.history = get_history(group, budget);
  load.fields = get_fields(group, mesh, budget);
  get_later_additions(group, budget, load);
  return load;
}

/// Loads in their order in the job; a group lists its members by name.
std::vector<Load> get_loads(const Handle& root, const Mesh& mesh, std::uint64_t budget) {
  const Handle list = open_group(root, "loads");
  const std::vector<std::string> names = hdf5::names_in(list);
  std::vector<Load> loads(names.size());
  std::vector<bool> filled(names.size(), false);
  for (const std::string& name : names) {
    const Handle group = open_group(list, name);
    const auto index = static_cast<std::size_t>(hdf5::get_int(group, "index"));
    if (index >= loads.size() || filled[index]) {
      throw hdf5::Fault("load \"" + name + "\" has the index of another or none");
    }
    filled[index] = true;
    loads[index] = get_load(group, name, mesh, budget);
  }
  return loads;
}

Result get_result(const Handle& root, std::uint64_t budget) {
  Result result;
  result.title = hdf5::get_text(root, "title");
  result.case_text = hdf5::get_text(root, "case");
  result.client_version = hdf5::get_text(root, "client_version");
  result.server_version = hdf5::get_text(root, "server_version");
  result.mesh_name = hdf5::get_text(root, "mesh");
  result.job_name = hdf5::get_text(root, "job");
  result.mesh_sha256 = hdf5::get_text(root, "mesh_sha256");
  result.timings.mesh_seconds = hdf5::get_double(root, "mesh_seconds");
  result.timings.factorize_seconds = hdf5::get_double(root, "factorize_seconds");
  result.timings.solve_seconds = hdf5::get_double(root, "solve_seconds");
  result.timings.total_seconds = hdf5::get_double(root, "total_seconds");
  result.mesh = get_mesh(root, budget);
  const std::string fault = first_mesh_fault(result.mesh);
  if (!fault.empty()) throw hdf5::Fault("is inconsistent: " + fault);
  const bool with_edges = hdf5::has(open_group(root, "mesh"), "inclusions");
  const Handle interfaces = open_group(root, "interfaces");
  const std::size_t count = count_of(interfaces, "interfaces");
  for (std::size_t i = 0; i < count; ++i) {
    result.interfaces.push_back(get_interface(interfaces, i, budget, with_edges));
  }
  result.loads = get_loads(root, result.mesh, budget);
  if (hdf5::has(root, "sweep")) result.sweep = get_sweep(root, budget);
  if (!with_edges) guess_edges(result);
  return result;
}

/// Throws Error unless the root says `format`.
void check_format(const fs::path& path, const Handle& root) {
  const char* cure = "name a file that `anticrack run -o` wrote";
  if (!hdf5::has_attribute(root, "format")) {
    throw Error(path.string(), "is HDF5, but no result of anticrack", cure);
  }
  const std::string found = hdf5::get_text(root, "format");
  if (found == format) return;

  const std::string_view family = format.substr(0, format.find('/') + 1);
  int version = 0;
  const char* end = found.data() + found.size();
  if (found.compare(0, family.size(), family) == 0 &&
      std::from_chars(found.data() + family.size(), end, version).ptr == end) {
    throw Error(path.string(),
                "has format \"" + found + "\", this client reads \"" + std::string(format) + "\"",
                version > 1 ? "use a newer anticrack" : "run the case again");
  }
  throw Error(path.string(), "has format \"" + found + "\", no result of anticrack", cure);
}

}  // namespace

Result read(const fs::path& path) {
  const hdf5::Quiet quiet;
  Result result;
  try {
    const Handle file =
        hdf5::open_file(path, "name a result file, as `anticrack run CASE.toml -o FILE` makes one");
    const Handle root(H5Gopen2(file.get(), "/", H5P_DEFAULT), H5Gclose, "has no root group");
    check_format(path, root);
    result = get_result(root, hdf5::memory_budget(path));
    const std::string fault = first_fault(result);
    if (!fault.empty()) throw hdf5::Fault("is inconsistent: " + fault);
  } catch (const hdf5::Fault& fault) {
    throw Error(path.string(), fault.what(), "copy it again from where it was made, or run again");
  }
  return result;
}

}  // namespace anticrack::results

// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/result.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

namespace anticrack::results {
namespace {

constexpr std::array<std::pair<Status, std::string_view>, 7> statuses{{
    {Status::unspecified, "unspecified"},
    {Status::pending, "pending"},
    {Status::running, "running"},
    {Status::converged, "converged"},
    {Status::not_converged, "not_converged"},
    {Status::failed, "failed"},
    {Status::cancelled, "cancelled"},
}};

/// Collects the first fault only: later ones often follow from it.
class Faults {
 public:
  bool any() const noexcept { return !_first.empty(); }
  const std::string& first() const noexcept { return _first; }

  void require(bool holds, const std::string& what) {
    if (!holds && _first.empty()) _first = what;
  }

  void length(const std::string& what, std::size_t have, std::size_t want, const char* of) {
    if (have != want && _first.empty()) {
      _first =
          what + " has " + std::to_string(have) + " entries for " + std::to_string(want) + " " + of;
    }
  }

  void in_range(const std::string& what, const std::vector<std::int32_t>& values,
                std::size_t count) {
    for (std::size_t i = 0; i < values.size() && _first.empty(); ++i) {
      if (values[i] < 0 || static_cast<std::size_t>(values[i]) >= count) {
        _first = what + "[" + std::to_string(i) + "] is " + std::to_string(values[i]) +
                 ", outside 0.." + std::to_string(count) + " (end excluded)";
      }
    }
  }

  void finite(const std::string& what, const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size() && _first.empty(); ++i) {
      if (!std::isfinite(values[i])) _first = what + "[" + std::to_string(i) + "] is not finite";
    }
  }

  template <typename T>
  void increasing(const std::string& what, const std::vector<T>& values) {
    for (std::size_t i = 1; i < values.size() && _first.empty(); ++i) {
      if (!(values[i - 1] < values[i])) {
        _first = what + " does not increase at entry " + std::to_string(i);
      }
    }
  }

 private:
  std::string _first;
};

std::string item(const std::string& list, std::size_t index) {
  return list + "[" + std::to_string(index) + "]";
}

void check_mesh(const Mesh& mesh, Faults& faults) {
  faults.require(mesh.xy.size() % 2 == 0, "mesh.nodes is not of shape (n,2)");
  faults.require(mesh.triangles.size() % 3 == 0, "mesh.triangles is not of shape (m,3)");
  faults.require(mesh.boundary.size() % 2 == 0, "mesh.boundary is not of shape (b,2)");
  faults.length("mesh.subdomain", mesh.subdomain.size(), mesh.triangle_count(), "triangles");
  faults.finite("mesh.nodes", mesh.xy);
  faults.in_range("mesh.triangles", mesh.triangles, mesh.node_count());
  faults.in_range("mesh.boundary", mesh.boundary, mesh.node_count());
  faults.in_range("mesh.subdomain", mesh.subdomain, mesh.subdomains.size());
  faults.length("mesh.tension", mesh.tension.size(), mesh.subdomains.size(), "subdomains");
  faults.finite("mesh.tension", mesh.tension);
}

void check_kinds(const std::string& at, const std::vector<Kind>& kinds, Faults& faults) {
  for (std::size_t i = 0; i < kinds.size() && !faults.any(); ++i) {
    const auto number = static_cast<std::int32_t>(kinds[i]);
    faults.require(number >= 1 && number <= 4,
                   item(at, i) + " is " + std::to_string(number) + ", not 1 to 4");
  }
}

void check_edges(const std::string& at, const Edges& edges, std::size_t nodes, const Mesh& mesh,
                 Faults& faults) {
  const std::size_t count = nodes == 0 ? 0 : nodes - 1;
  faults.length(at + ".edge_kind", edges.kind.size(), count, "edges");
  faults.length(at + ".edge_inclusion", edges.inclusion.size(), count, "edges");
  check_kinds(at + ".edge_kind", edges.kind, faults);
  const auto inclusions = static_cast<std::int64_t>(mesh.inclusions.size());
  for (std::size_t e = 0; e < count && !faults.any(); ++e) {
    const std::int32_t inclusion = edges.inclusion[e];
    const bool rigid = edges.kind[e] == Kind::inclusion || edges.kind[e] == Kind::delaminated;
    // A file of an earlier client may not say which one.
    faults.require(inclusion == -1 || (rigid && inclusion >= 0 && inclusion < inclusions),
                   item(at + ".edge_inclusion", e) + " is " + std::to_string(inclusion) +
                       (rigid ? ", there are " + std::to_string(inclusions) + " inclusions"
                              : ", but its edge_kind is that of no inclusion"));
  }
}

void check_interface(const std::string& at, const Interface& interface, const Mesh& mesh,
                     Faults& faults) {
  const std::size_t k = interface.node_count();
  faults.length(at + ".x", interface.x.size(), k, "nodes");
  faults.length(at + ".y", interface.y.size(), k, "nodes");
  faults.length(at + ".kind", interface.kind.size(), k, "nodes");
  faults.finite(at + ".s", interface.s);
  faults.finite(at + ".x", interface.x);
  faults.finite(at + ".y", interface.y);
  faults.increasing(at + ".s", interface.s);
  check_kinds(at + ".kind", interface.kind, faults);
  check_edges(at, interface.edges, k, mesh, faults);
}

void check_trace(const std::string& at, const Trace& trace, std::size_t k, Faults& faults) {
  faults.length(at + ".u_minus", trace.u_minus.size(), k, "nodes");
  faults.length(at + ".u_plus", trace.u_plus.size(), k, "nodes");
  faults.length(at + ".jump", trace.jump.size(), k, "nodes");
  faults.length(at + ".pressure", trace.pressure.size(), k, "nodes");
  faults.length(at + ".contact", trace.contact.size(), k, "nodes");
  faults.in_range(at + ".contact", trace.contact, 2);
}

void check_history(const std::string& at, const History& history, Faults& faults) {
  const std::size_t n = history.size();
  faults.length(at + ".criterion", history.criterion.size(), n, "iterations");
  faults.length(at + ".energy", history.energy.size(), n, "iterations");
  faults.length(at + ".contact_count", history.contact_count.size(), n, "iterations");
  faults.length(at + ".kkt_equilibrium", history.kkt_equilibrium.size(), n, "iterations");
  faults.length(at + ".kkt_gap", history.kkt_gap.size(), n, "iterations");
  faults.length(at + ".kkt_sign", history.kkt_sign.size(), n, "iterations");
  faults.length(at + ".kkt_complementarity", history.kkt_complementarity.size(), n, "iterations");
  faults.increasing(at + ".iteration", history.iteration);
}

void check_field(const std::string& at, const Field& field, const Mesh& mesh,
                 std::size_t triangle_count, Faults& faults) {
  faults.length(at + ".u", field.u.size(), field.nodes.size(), "nodes");
  faults.in_range(at + ".nodes", field.nodes, mesh.node_count());
  faults.length(at + ".triangles", field.triangles.size(), 3 * triangle_count,
                "corners of triangles");
  faults.in_range(at + ".triangles", field.triangles, field.nodes.size());
}

std::vector<std::size_t> triangles_by_subdomain(const Mesh& mesh) {
  std::vector<std::size_t> count(mesh.subdomains.size(), 0);
  for (const std::int32_t subdomain : mesh.subdomain) ++count[static_cast<std::size_t>(subdomain)];
  return count;
}

void check_load(const std::string& at, const Load& load, const Result& result, Faults& faults) {
  faults.require(is_load_name(load.name),
                 at + ".name is not of the form [A-Za-z0-9][A-Za-z0-9_. -]{0,63}");
  faults.require(!name(load.status).empty(), at + ".status is unknown");
  if (!load.traces.empty()) {
    faults.length(at + ".traces", load.traces.size(), result.interfaces.size(), "interfaces");
  }
  for (std::size_t i = 0; i < load.traces.size() && !faults.any(); ++i) {
    check_trace(item(at + ".traces", i), load.traces[i], result.interfaces[i].node_count(), faults);
  }
  check_history(at + ".history", load.history, faults);
  if (!load.fields.empty()) {
    faults.length(at + ".fields", load.fields.size(), result.mesh.subdomains.size(), "subdomains");
  }
  if (!load.fields.empty() && !faults.any()) {
    const std::vector<std::size_t> counts = triangles_by_subdomain(result.mesh);
    for (std::size_t i = 0; i < load.fields.size() && !faults.any(); ++i) {
      check_field(item(at + ".fields", i), load.fields[i], result.mesh, counts[i], faults);
    }
  }
  for (std::size_t i = 0; i < load.contact_intervals.size() && !faults.any(); ++i) {
    const ContactInterval& interval = load.contact_intervals[i];
    const std::string where = item(at + ".contact_intervals", i);
    faults.require(interval.interface < result.interfaces.size(),
                   where + ".interface is out of range");
    faults.require(interval.begin <= interval.end, where + " ends before it begins");
  }
}

void check_sweep(const Result& result, Faults& faults) {
  std::vector<std::size_t> nodes;
  for (const Interface& interface : result.interfaces) nodes.push_back(interface.node_count());
  const std::string fault = first_fault(*result.sweep, nodes);
  faults.require(fault.empty(), fault);
  faults.length("loads", result.loads.size(), result.sweep->kept.size(), "kept rows");
}

}  // namespace

std::vector<Kind> kinds_of(const std::vector<std::int32_t>& numbers) {
  std::vector<Kind> kinds;
  kinds.reserve(numbers.size());
  for (const std::int32_t number : numbers) kinds.push_back(static_cast<Kind>(number));
  return kinds;
}

double Kkt::largest() const noexcept {
  double result = 0;
  for (const double residual : {equilibrium, gap, sign, complementarity}) {
    if (std::isnan(residual)) return residual;
    result = std::max(result, residual);
  }
  return result;
}

std::string_view name(Status status) noexcept {
  for (const auto& [value, text] : statuses) {
    if (value == status) return text;
  }
  return {};
}

std::optional<Status> status_from(std::string_view name) noexcept {
  for (const auto& [value, text] : statuses) {
    if (text == name) return value;
  }
  return std::nullopt;
}

bool is_load_name(std::string_view name) noexcept {
  // Not std::isalnum: that depends on the locale.
  const auto alphanumeric = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
  };
  if (name.empty() || name.size() > 64 || !alphanumeric(name.front())) return false;
  for (const char c : name) {
    if (!alphanumeric(c) && c != '_' && c != '.' && c != ' ' && c != '-') return false;
  }
  return true;
}

std::optional<std::vector<std::int32_t>> triangles_of(const Mesh& mesh, std::size_t subdomain,
                                                      const std::vector<std::int32_t>& nodes) {
  std::vector<std::int32_t> local(mesh.node_count(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto node = static_cast<std::size_t>(nodes[i]);
    if (nodes[i] < 0 || node >= local.size() || local[node] >= 0) return std::nullopt;
    local[node] = static_cast<std::int32_t>(i);
  }
  std::vector<std::int32_t> triangles;
  triangles.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (static_cast<std::size_t>(mesh.subdomain[t]) != subdomain) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::int32_t corner = local[static_cast<std::size_t>(mesh.triangles[3 * t + c])];
      if (corner < 0) return std::nullopt;
      triangles.push_back(corner);
    }
  }
  return triangles;
}

std::string first_mesh_fault(const Mesh& mesh) {
  Faults faults;
  check_mesh(mesh, faults);
  return faults.first();
}

std::string first_edge_fault(const std::string& at, const Edges& edges, std::size_t nodes,
                             const Mesh& mesh) {
  Faults faults;
  check_edges(at, edges, nodes, mesh, faults);
  return faults.first();
}

std::string first_fault(const Result& result) {
  Faults faults;
  check_mesh(result.mesh, faults);
  for (std::size_t i = 0; i < result.interfaces.size() && !faults.any(); ++i) {
    check_interface(item("interfaces", i), result.interfaces[i], result.mesh, faults);
  }
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < result.loads.size() && !faults.any(); ++i) {
    const Load& load = result.loads[i];
    check_load(item("loads", i), load, result, faults);
    faults.require(names.insert(load.name).second,
                   item("loads", i) + ".name \"" + load.name + "\" is there twice");
  }
  if (result.sweep && !faults.any()) check_sweep(result, faults);
  return faults.first();
}

}  // namespace anticrack::results

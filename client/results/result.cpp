// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/result.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "results/tables.hpp"

namespace anticrack::results {
namespace {

/// Keeps the first fault only: later ones often follow from it.
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

  /// Every array of the tables has `want` entries.
  template <class Record, class... Tables>
  void lengths(const std::string& at, const Record& record, std::size_t want, const char* of,
               const Tables&... tables) {
    arrays::for_each(
        [&](const auto& row) {
          length(at + "." + std::string(row.name), std::invoke(row.member, record).size(), want,
                 of);
        },
        tables...);
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
    for (std::size_t i = 0; i < values.size() && _first.empty(); ++i)
      if (!std::isfinite(values[i])) _first = what + "[" + std::to_string(i) + "] is not finite";
  }

  template <typename T>
  void increasing(const std::string& what, const std::vector<T>& values) {
    for (std::size_t i = 1; i < values.size() && _first.empty(); ++i)
      if (!(values[i - 1] < values[i]))
        _first = what + " does not increase at entry " + std::to_string(i);
  }

 private:
  std::string _first;
};

std::string item(const std::string& list, std::size_t index) {
  return list + "[" + std::to_string(index) + "]";
}

void check_mesh(const Mesh& mesh, Faults& faults) {
  arrays::for_each(
      [&](const auto& row) {
        const std::size_t columns = std::max<std::size_t>(arrays::columns_of(row.shape), 1);
        faults.require(
            std::invoke(row.member, mesh).size() % columns == 0,
            "mesh." + std::string(row.name) + " is not of shape (" + std::string(row.shape) + ")");
      },
      tables::mesh);
  faults.length("mesh.subdomain", mesh.subdomain.size(), mesh.triangle_count(), "triangles");
  faults.finite("mesh.nodes", mesh.xy);
  faults.in_range("mesh.triangles", mesh.triangles, mesh.node_count());
  faults.in_range("mesh.boundary", mesh.boundary, mesh.node_count());
  faults.in_range("mesh.subdomain", mesh.subdomain, mesh.subdomains.size());
  faults.length("mesh.tension", mesh.tension.size(), mesh.subdomains.size(), "subdomains");
  faults.finite("mesh.tension", mesh.tension);
  if (!mesh.tension_law.empty())
    faults.length("mesh.tension_law", mesh.tension_law.size(), mesh.subdomains.size(),
                  "subdomains");
}

void check_kinds(const std::string& at, const std::vector<Kind>& kinds, Faults& faults) {
  for (std::size_t i = 0; i < kinds.size() && !faults.any(); ++i) {
    const auto number = static_cast<std::int32_t>(kinds[i]);
    faults.require(number >= 1 && number <= 5,
                   item(at, i) + " is " + std::to_string(number) + ", not 1 to 5");
  }
}

void check_edges(const std::string& at, const Edges& edges, std::size_t nodes, const Mesh& mesh,
                 Faults& faults) {
  const std::size_t count = nodes == 0 ? 0 : nodes - 1;
  faults.lengths(at, edges, count, "edges", tables::edges);
  check_kinds(at + ".edge_kind", edges.kind, faults);
  const auto inclusions = static_cast<std::int64_t>(mesh.inclusions.size());
  for (std::size_t e = 0; e < count && !faults.any(); ++e) {
    const std::int32_t inclusion = edges.inclusion[e];
    const bool rigid = edges.kind[e] == Kind::inclusion || edges.kind[e] == Kind::delaminated;
    faults.require(rigid ? inclusion >= 0 && inclusion < inclusions : inclusion == -1,
                   item(at + ".edge_inclusion", e) + " is " + std::to_string(inclusion) +
                       (rigid ? ", there are " + std::to_string(inclusions) + " inclusions"
                              : ", but its edge_kind is that of no inclusion"));
  }
}

void check_interface(const std::string& at, const Interface& interface, const Mesh& mesh,
                     Faults& faults) {
  const std::size_t k = interface.node_count();
  faults.lengths(at, interface, k, "nodes", arrays::interface_nodes<Interface>);
  faults.finite(at + ".s", interface.s);
  faults.finite(at + ".x", interface.x);
  faults.finite(at + ".y", interface.y);
  faults.increasing(at + ".s", interface.s);
  check_kinds(at + ".kind", interface.kind, faults);
  check_edges(at, interface.edges, k, mesh, faults);
}

void check_trace(const std::string& at, const Trace& trace, std::size_t k, Faults& faults) {
  faults.lengths(at, trace, k, "nodes", arrays::trace<Trace>);
  faults.in_range(at + ".contact", trace.contact, 2);
}

void check_history(const std::string& at, const History& history, Faults& faults) {
  faults.lengths(at, history, history.size(), "iterations", arrays::history<History>);
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

void check_load(const std::string& at, const Load& load, const Result& result,
                const std::set<std::string_view>& interfaces, Faults& faults) {
  faults.require(is_load_name(load.name()),
                 at + ".name is not of the form [A-Za-z0-9][A-Za-z0-9_. -]{0,63}");
  faults.require(!name(load.status()).empty(), at + ".status is unknown");
  if (!load.traces.empty())
    faults.length(at + ".traces", load.traces.size(), result.interfaces.size(), "interfaces");
  for (std::size_t i = 0; i < load.traces.size() && !faults.any(); ++i)
    check_trace(item(at + ".traces", i), load.traces[i], result.interfaces[i].node_count(), faults);
  check_history(at + ".history", load.history, faults);
  std::vector<std::uint64_t> triangles;
  for (const v1::Stage& stage : load.stages) {
    faults.require(stage.answers_size() == 1, at + ".stages has one without an answer");
    triangles.push_back(stage.triangles());
  }
  faults.increasing(at + ".stages.triangles", triangles);
  if (!load.indicator.empty())
    faults.lengths(at, load, result.mesh.triangle_count(), "triangles", tables::indicator);
  if (!load.fields.empty())
    faults.length(at + ".fields", load.fields.size(), result.mesh.subdomains.size(), "subdomains");
  if (!load.fields.empty() && !faults.any()) {
    const std::vector<std::size_t> counts = triangles_by_subdomain(result.mesh);
    for (std::size_t i = 0; i < load.fields.size() && !faults.any(); ++i)
      check_field(item(at + ".fields", i), load.fields[i], result.mesh, counts[i], faults);
  }
  for (int i = 0; i < load.answer.contact_intervals_size() && !faults.any(); ++i) {
    const v1::ContactInterval& interval = load.answer.contact_intervals(i);
    const std::string where = item(at + ".contact_intervals", static_cast<std::size_t>(i));
    faults.require(interfaces.contains(interval.interface()),
                   where + ".interface is \"" + interval.interface() + "\", no such interface");
    faults.require(interval.begin() <= interval.end(), where + " ends before it begins");
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

double largest(const v1::KktResiduals& kkt) noexcept {
  double result = 0;
  for (const double residual : {kkt.equilibrium_relative(), kkt.gap_relative(), kkt.sign_relative(),
                                kkt.complementarity_relative()}) {
    if (std::isnan(residual)) return residual;
    result = std::max(result, residual);
  }
  return result;
}

std::string fields_cure(const Result& result) {
  const std::string anew = "run the case again with --set output.fields=true";
  if (result.job_name.empty()) return anew;
  return "to have them: anticrack job fetch " + result.job_name +
         " --fields -o fields.h5, while the server keeps the job; else " + anew;
}

bool is_load_name(std::string_view name) noexcept {
  // Not std::isalnum: that depends on the locale.
  const auto alphanumeric = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
  };
  if (name.empty() || name.size() > 64 || !alphanumeric(name.front())) return false;
  for (const char c : name)
    if (!alphanumeric(c) && c != '_' && c != '.' && c != ' ' && c != '-') return false;
  return true;
}

std::string Units::of(std::string_view dimension) const {
  std::string unit;
  for (const char c : dimension) {
    const bool is_unit = c == 'F' || c == 'L';
    const std::string& name = c == 'F' ? force : length;
    if (is_unit && name.empty()) return "-";
    if (is_unit)
      unit += name;
    else
      unit += c;
  }
  return unit.empty() ? "-" : unit;
}

std::string Units::label(std::string_view dimension) const {
  const std::string unit = of(dimension);
  return unit == "-" ? "" : unit;
}

std::string labelled(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " [" + unit + "]";
}

std::string first_fault(const Result& result) {
  Faults faults;
  check_mesh(result.mesh, faults);
  for (std::size_t i = 0; i < result.interfaces.size() && !faults.any(); ++i)
    check_interface(item("interfaces", i), result.interfaces[i], result.mesh, faults);
  std::set<std::string_view> names, interfaces;
  for (const Interface& interface : result.interfaces) interfaces.insert(interface.name);
  for (std::size_t i = 0; i < result.loads.size() && !faults.any(); ++i) {
    const Load& load = result.loads[i];
    check_load(item("loads", i), load, result, interfaces, faults);
    faults.require(names.insert(load.name()).second,
                   item("loads", i) + ".name \"" + load.name() + "\" is there twice");
  }
  if (result.sweep && !faults.any()) check_sweep(result, faults);
  return faults.first();
}

}  // namespace anticrack::results

// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/result.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "results/entries.hpp"
#include "results/tables.hpp"

namespace anticrack::results {
namespace {

/// Keeps the first fault only, as later faults often follow from it.
class Faults {
 public:
  bool any() const noexcept { return !_first.empty(); }
  const std::string& first() const noexcept { return _first; }

  void require(bool holds, const std::string& what) {
    if (!holds && _first.empty()) _first = what;
  }

  void length(const std::string& what, std::size_t have, std::size_t want, const char* of) {
    if (have != want && _first.empty()) {
      _first = fmt::format("{} has {} entries for {} {}", what, have, want, of);
    }
  }

  /// Requires that every array of the tables has `want` entries.
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
        _first =
            fmt::format("{}[{}] is {}, outside 0..{} (end excluded)", what, i, values[i], count);
      }
    }
  }

  void finite(const std::string& what, const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size() && _first.empty(); ++i)
      if (!std::isfinite(values[i])) _first = fmt::format("{}[{}] is not finite", what, i);
  }

  template <typename T>
  void increasing(const std::string& what, const std::vector<T>& values) {
    for (std::size_t i = 1; i < values.size() && _first.empty(); ++i)
      if (!(values[i - 1] < values[i]))
        _first = fmt::format("{} does not increase at entry {}", what, i);
  }

 private:
  std::string _first;
};

std::string item(const std::string& list, std::size_t index) {
  return fmt::format("{}[{}]", list, index);
}

template <class Repeated>
std::size_t size_of(const Repeated& messages) {
  return static_cast<std::size_t>(messages.size());
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
  faults.in_range("mesh.subdomain", mesh.subdomain, size_of(mesh.info.subdomains()));
}

void check_kinds(const std::string& at, const std::vector<std::int32_t>& kinds, Faults& faults) {
  for (std::size_t i = 0; i < kinds.size() && !faults.any(); ++i)
    faults.require(kinds[i] >= v1::INTERFACE_KIND_GLUE && kinds[i] <= v1::INTERFACE_KIND_FREE,
                   fmt::format("{} is {}, not 1 to 5", item(at, i), kinds[i]));
}

void check_edges(const std::string& at, const Interface& interface, int inclusions,
                 Faults& faults) {
  const std::size_t count = std::max<std::size_t>(interface.node_count(), 1) - 1;
  faults.lengths(at, interface, count, "edges", tables::edges);
  check_kinds(at + ".edge_kind", interface.edge_kind, faults);
  for (std::size_t e = 0; e < count && !faults.any(); ++e) {
    const std::int32_t kind = interface.edge_kind[e], inclusion = interface.edge_inclusion[e];
    const bool rigid =
        kind == v1::INTERFACE_KIND_INCLUSION || kind == v1::INTERFACE_KIND_DELAMINATED;
    faults.require(rigid ? inclusion >= 0 && inclusion < inclusions : inclusion == -1,
                   fmt::format("{} is {}{}", item(at + ".edge_inclusion", e), inclusion,
                               rigid ? fmt::format(", there are {} inclusions", inclusions)
                                     : ", but its edge_kind is that of no inclusion"));
  }
}

void check_interface(const std::string& at, const Interface& interface, int inclusions,
                     Faults& faults) {
  faults.lengths(at, interface, interface.node_count(), "nodes",
                 arrays::interface_nodes<Interface>);
  faults.finite(at + ".s", interface.s);
  faults.finite(at + ".x", interface.x);
  faults.finite(at + ".y", interface.y);
  faults.increasing(at + ".s", interface.s);
  check_kinds(at + ".kind", interface.kind, faults);
  check_edges(at, interface, inclusions, faults);
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
  std::vector<std::size_t> count(size_of(mesh.info.subdomains()), 0);
  for (const std::int32_t subdomain : mesh.subdomain) ++count[static_cast<std::size_t>(subdomain)];
  return count;
}

void check_load(const std::string& at, const Load& load, const Result& result,
                const std::set<std::string_view>& interfaces, Faults& faults) {
  faults.require(is_load_name(load.name()),
                 at + ".name is not of the form [A-Za-z0-9][A-Za-z0-9_. -]{0,63}");
  faults.require(v1::LoadCaseAnswer::Status_IsValid(load.answer.status()),
                 at + ".status is unknown");
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
    faults.length(at + ".fields", load.fields.size(), size_of(result.mesh.info.subdomains()),
                  "subdomains");
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

std::string status_name(int status) {
  return name_in(*v1::LoadCaseAnswer::Status_descriptor(), status);
}

double largest_kkt(const v1::LoadCaseAnswer& answer) noexcept {
  if (!answer.has_kkt()) return unknown;
  const v1::KktResiduals& kkt = answer.kkt();
  double result = 0;
  for (const double residual : {kkt.equilibrium_relative(), kkt.gap_relative(), kkt.sign_relative(),
                                kkt.complementarity_relative()}) {
    if (std::isnan(residual)) return residual;
    result = std::max(result, residual);
  }
  return result;
}

double solve_seconds(const Result& result) {
  if (result.sweep) return number_in(result.sweep->answer, "solve_seconds");
  double seconds = 0;
  for (const Load& load : result.loads) seconds += number_in(load.answer, "solve_seconds");
  return seconds;
}

std::string method_of(const v1::Solver& solver) {
  return solver.has_uzawa() ? "uzawa" : "active-set";
}

std::string fields_cure(const Result& result) {
  const std::string anew = "run the case again with --set output.fields=true";
  if (result.job_name.empty()) return anew;
  return "to have them: anticrack job fetch " + result.job_name +
         " --fields -o fields.h5, while the server keeps the job; else " + anew;
}

bool is_load_name(std::string_view name) noexcept {
  // std::isalnum would depend on the locale.
  const auto alphanumeric = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
  };
  if (name.empty() || name.size() > 64 || !alphanumeric(name.front())) return false;
  for (const char c : name)
    if (!alphanumeric(c) && c != '_' && c != '.' && c != ' ' && c != '-') return false;
  return true;
}

std::string unit_of(const v1::Units& units, std::string_view dimension) {
  std::string unit;
  for (const char c : dimension) {
    const bool is_unit = c == 'F' || c == 'L';
    const std::string& name = c == 'F' ? units.force() : units.length();
    if (is_unit && name.empty()) return "-";
    if (is_unit)
      unit += name;
    else
      unit += c;
  }
  return unit.empty() ? "-" : unit;
}

std::string label_of(const v1::Units& units, std::string_view dimension) {
  const std::string unit = unit_of(units, dimension);
  return unit == "-" ? "" : unit;
}

std::string labelled(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " [" + unit + "]";
}

std::string first_fault(const Result& result) {
  const v1::Mesh& info = result.mesh.info;
  Faults faults;
  check_mesh(result.mesh, faults);
  faults.length("interfaces", result.interfaces.size(), size_of(info.interfaces()),
                "interfaces of the mesh");
  for (std::size_t i = 0; i < result.interfaces.size() && !faults.any(); ++i)
    check_interface(item("interfaces", i), result.interfaces[i], info.inclusions_size(), faults);
  std::set<std::string_view> names, interfaces;
  for (const v1::InterfaceInfo& interface : info.interfaces()) interfaces.insert(interface.name());
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

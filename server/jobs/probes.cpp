// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/probes.hpp"

#include <fmt/core.h>

#include <cmath>
#include <set>
#include <tuple>

#include "errors/errors.hpp"
#include "mesh/names.hpp"

namespace anticrack::jobs {
namespace {

using errors::Error;
using errors::Reason;
using records::Probe;

std::size_t count_of(const Probe& probe) {
  return probe.to ? static_cast<std::size_t>(probe.points) : 1;
}

std::string name_of(const std::vector<Probe>& probes, std::size_t i) {
  return probes[i].name.empty() ? fmt::format("probe-{}", i + 1) : probes[i].name;
}

/// The fault of a probe and the field that has it.
struct Fault {
  std::string problem;
  const char* field;
};

Fault fault_of(const Probe& probe) {
  const auto finite = [](const mesh::Point& p) { return std::isfinite(p[0] + p[1]); };
  if (!probe.name.empty() && !mesh::valid_name(probe.name))
    return {fmt::format("\"{}\" is not a name of a probe: write {}", probe.name.substr(0, 64),
                        mesh::name_rule),
            "name"};
  if (!finite(probe.from)) return {"the point is not finite: give two numbers", "from"};
  if (!probe.to && probe.points != 0)
    return {"a point has no `points`: leave them out, or give `to` for a line", "points"};
  if (!probe.to) return {};
  if (!finite(*probe.to)) return {"the point is not finite: give two numbers", "to"};
  if (*probe.to == probe.from)
    return {"the line ends where it begins: move an end, or give one point", "to"};
  if (probe.points < 2)
    return {fmt::format("a line of {} points: give at least 2, which are its ends", probe.points),
            "points"};
  return {};
}

}  // namespace

void check_probes(const std::vector<Probe>& probes) {
  std::set<std::string> names;
  std::size_t points = 0;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const std::string path = fmt::format("probes[{}]", i);
    if (const Fault fault = fault_of(probes[i]); !fault.problem.empty())
      throw Error(Reason::invalid_argument, fault.problem).at(path + "." + fault.field);
    if (!names.insert(name_of(probes, i)).second)
      throw Error(Reason::invalid_argument, "two probes are named \"{}\": give each its own name",
                  name_of(probes, i))
          .at(path + ".name");
    points += count_of(probes[i]);
    if (points > max_probe_points)
      throw Error(
          Reason::limit_exceeded,
          "{} points up to this probe: all probes of a job may have {}; take fewer, or keep "
          "the fields",
          points, max_probe_points)
          .at(path + ".points");
  }
}

std::uint64_t probe_bytes(const std::vector<Probe>& probes) {
  constexpr std::uint64_t a_point = 50;  // five numbers and tags
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < probes.size(); ++i)
    bytes += count_of(probes[i]) * (a_point + name_of(probes, i).size());
  return bytes;
}

PlacedProbes place_probes(const std::vector<Probe>& probes,
                          const operators::MeshOperator& mesh_operator) {
  PlacedProbes placed;
  std::vector<mesh::Point> points;
  std::vector<std::size_t> owner;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const mesh::Point &from = probes[i].from, to = probes[i].to.value_or(from);
    const std::size_t count = count_of(probes[i]);
    for (std::size_t k = 0; k < count; ++k) {
      const double t = count == 1 ? 0 : static_cast<double>(k) / static_cast<double>(count - 1);
      const mesh::Point at{std::lerp(from[0], to[0], t), std::lerp(from[1], to[1], t)};
      points.push_back(at);
      owner.push_back(i);
      placed.rows.push_back(
          {name_of(probes, i), std::hypot(at[0] - from[0], at[1] - from[1]), at[0], at[1]});
    }
  }
  if (!points.empty()) placed.places = mesh_operator.find_points(points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (placed.places[k].location.triangle >= 0) continue;
    throw Error(Reason::invalid_argument,
                "the point {} of the probe \"{}\" is outside the membrane, whose curves are chords "
                "here: move it inside",
                errors::shown(points[k][0], points[k][1]), placed.rows[k].name)
        .at(fmt::format("probes[{}]{}", owner[k], probes[owner[k]].to ? "" : ".from"));
  }
  return placed;
}

void fill_probes(const PlacedProbes& probes, const operators::MeshOperator& mesh_operator,
                 contact::Answer& answer) {
  answer.probes = probes.rows;
  for (std::size_t k = 0; k < probes.places.size(); ++k) {
    contact::ProbeAnswer& row = answer.probes[k];
    std::tie(row.u_minus, row.u_plus) =
        mesh_operator.u_at(probes.places[k], {row.x, row.y}, answer);
  }
}

}  // namespace anticrack::jobs

// SPDX-License-Identifier: GPL-3.0-or-later
#include "growth/held.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/at.hpp"
#include "expression/enclosure.hpp"
#include "expression/function.hpp"
#include "mesh/edges.hpp"

namespace anticrack::growth {
namespace {

using mesh::Kind;

/// Pieces of an edge over each of which Gc is enclosed.
constexpr int pieces = 64;

/// The chains of a line that are left without some of its edges.
std::vector<mesh::Interface> without(const mesh::Interface& line, const std::vector<char>& gone) {
  std::vector<mesh::Interface> chains;
  bool open = false;
  for (std::size_t e = 0; e < line.kind.size(); ++e) {
    if (gone[e] != 0) {
      open = false;
      continue;
    }
    if (!open) chains.push_back({line.name, {line.nodes[e]}, {}, {}});
    open = true;
    chains.back().nodes.push_back(line.nodes[e + 1]);
    chains.back().kind.push_back(line.kind[e]);
    chains.back().inclusion.push_back(line.inclusion[e]);
  }
  return chains;
}

/// Adds the edges from one node of a line to another.
void add(const mesh::Mesh& mesh, const mesh::Interface& line, std::size_t first, std::size_t last,
         expression::Enclosure& toughness, Opened& to) {
  using expression::Interval;
  for (std::size_t e = first; e < last; ++e) {
    const mesh::Point a = mesh::position(mesh, line.nodes[e]),
                      b = mesh::position(mesh, line.nodes[e + 1]);
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    to.length += length;
    for (int k = 0; k < pieces; ++k) {
      const auto along = [&](std::size_t i) {
        const auto part = [&](int n) { return a[i] + (b[i] - a[i]) * n / pieces; };
        const auto [low, high] = std::minmax({part(k), part(k + 1)});
        return low == high ? Interval{low, low} : expression::outward(low, high);
      };
      const Interval Gc = toughness(along(0), along(1), 0).value();
      to.cost_lower += std::max(Gc.low, 0.0) * length / pieces;
      to.cost_upper += Gc.high * length / pieces;
    }
  }
}

}  // namespace

std::optional<Held> held(const Stretch& stretch, const State& state) {
  const int any = stretch.forward >= 0 ? stretch.forward : stretch.backward;
  if (state.fate[at(any)] == Fate::snapped) return {};
  const auto passed = [&](int front) { return front < 0 ? 0 : state.at[at(front)]; };
  return Held{stretch.first + passed(stretch.forward), stretch.last - passed(stretch.backward)};
}

mesh::Mesh mesh_of(const mesh::Mesh& open, const Fronts& fronts, const State& state) {
  mesh::Mesh result = open;
  const mesh::EdgeTable edges(open.triangles);
  std::vector<std::vector<char>> gone;
  for (const mesh::Interface& line : open.interfaces) gone.emplace_back(line.kind.size(), 0);
  for (const Stretch& stretch : fronts.stretches) {
    const std::optional<Held> here = held(stretch, state);
    if (!here) continue;
    mesh::Interface& line = result.interfaces[stretch.interface];
    for (std::size_t e = here->first; e < here->last; ++e) {
      if (line.kind[e] == Kind::delaminated) {
        line.kind[e] = Kind::inclusion;
        continue;
      }
      const auto beside = edges.find(line.nodes[e], line.nodes[e + 1]);
      if (open.subdomain[at(beside[0].triangle)] != open.subdomain[at(beside[1].triangle)])
        line.kind[e] = Kind::glue;
      else
        gone[stretch.interface][e] = 1;
    }
  }
  std::vector<mesh::Interface> chains;
  for (std::size_t i = 0; i < gone.size(); ++i)
    for (mesh::Interface& chain : without(result.interfaces[i], gone[i]))
      chains.push_back(std::move(chain));
  result.interfaces = std::move(chains);
  return result;
}

Opened opened(const mesh::Mesh& open, const Fronts& fronts, std::span<const Path> paths,
              const State& from, const State& to) {
  Opened result;
  for (std::size_t i = 0; i < fronts.stretches.size(); ++i) {
    const Stretch& stretch = fronts.stretches[i];
    const std::optional<Held> before = held(stretch, from);
    if (!before) continue;
    const Held after = held(stretch, to).value_or(Held{before->last, before->last});
    const expression::Function toughness(paths[i].toughness, "toughness");
    expression::Enclosure enclosed(toughness.tape());
    const mesh::Interface& line = open.interfaces[stretch.interface];
    add(open, line, before->first, after.first, enclosed, result);
    add(open, line, after.last, before->last, enclosed, result);
  }
  return result;
}

MeanRelease mean_release(const Bracket& from, const Bracket& to, const Opened& between) {
  const double least = std::max(from.lower - to.upper, 0.0), most = from.upper - to.lower;
  MeanRelease mean{least / between.length, most / between.length, {}, {}};
  if (most > 0) mean.load_lower = std::sqrt(between.cost_lower / most);
  if (least > 0 && std::isfinite(between.cost_upper))
    mean.load_upper = std::sqrt(between.cost_upper / least);
  return mean;
}

}  // namespace anticrack::growth

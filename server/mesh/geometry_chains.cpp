// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdlib>
#include <utility>

#include "base/at.hpp"
#include "mesh/geometry_primitives.hpp"
#include "mesh/geometry_steps.hpp"

namespace anticrack::mesh {
namespace {

/// How all curves of a chain must be walked; they agree.
Walk walk_of(const std::vector<int>& chain, const std::vector<Walk>& walks) {
  for (const int curve : chain)
    if (walks[at(curve)] != Walk::either) return walks[at(curve)];
  return Walk::either;
}

bool agree(Walk a, Walk b) { return a == Walk::either || b == Walk::either || a == b; }

}  // namespace

void add_chains(const Network& network, const std::vector<std::string>& names,
                const std::vector<bool>& kept, const std::vector<Walk>& walks, Plan& plan) {
  std::vector<std::vector<std::vector<int>>> chains(names.size());
  Walk walk = Walk::either;  // of the present chain
  for (std::size_t e = 0; e < network.chords.size(); ++e) {
    const auto line = at(network.chords[e].line);
    if (network.lines[line].role != Role::interface || !kept[e]) continue;
    auto& own = chains[line - network.boundary];
    const bool goes_on =
        !own.empty() && own.back().back() + 1 == static_cast<int>(e) && agree(walk, walks[e]);
    if (!goes_on) {
      own.emplace_back();
      walk = Walk::either;
    }
    if (walk == Walk::either) walk = walks[e];
    own.back().push_back(static_cast<int>(e));
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    auto& own = chains[i];
    const NetworkLine& line = network.lines[network.boundary + i];
    if (own.empty()) {
      refuse(line.field, line.field,
             " separates nothing and carries nothing: the same subdomain lies on both of its "
             "sides; put a crack or an inclusion on it, extend it to the boundary or to another "
             "interface, or make it a line of options.align");
    }
    const auto joined = [&](const std::vector<int>& before, const std::vector<int>& after) {
      return plan.curves[at(before.back())].b == plan.curves[at(after.front())].a &&
             agree(walk_of(before, walks), walk_of(after, walks));
    };
    if (line.line.closed() && own.size() > 1 && joined(own.back(), own.front())) {
      own.back().insert(own.back().end(), own.front().begin(), own.front().end());
      own.erase(own.begin());
    }
    for (auto& chain : own) plan.interfaces.push_back({names[i], std::move(chain)});
  }
  // the first chain of an interface keeps its name; the others get unused ones
  std::vector<std::string> used = names;
  for (std::size_t i = 1; i < plan.interfaces.size(); ++i) {
    if (plan.interfaces[i].name != plan.interfaces[i - 1].name) continue;
    const std::string name = plan.interfaces[i].name;
    for (; i < plan.interfaces.size() && plan.interfaces[i].name == name; ++i)
      plan.interfaces[i].name = unused_name(name, used);
  }
}

void turn_chains(const std::vector<Walk>& walks, Plan& plan) {
  std::vector<bool> turned(plan.curves.size(), false);
  for (PlannedInterface& chain : plan.interfaces) {
    if (walk_of(chain.curves, walks) != Walk::reversed) continue;
    std::ranges::reverse(chain.curves);
    for (const int index : chain.curves) {
      PlannedCurve& curve = plan.curves[at(index)];
      std::swap(curve.a, curve.b);
      std::swap(curve.left, curve.right);
      std::swap(curve.from, curve.to);
      turned[at(index)] = true;
    }
  }
  const auto turn = [&](std::vector<int>& loop) {
    for (int& edge : loop)
      if (turned[at(std::abs(edge) - 1)]) edge = -edge;
  };
  for (PlannedFace& face : plan.faces) {
    turn(face.outer);
    std::ranges::for_each(face.holes, turn);
  }
}

}  // namespace anticrack::mesh

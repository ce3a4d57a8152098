// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/cut_steps.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "base/union_find.hpp"
#include "errors/errors.hpp"
#include "stop/stop.hpp"

namespace anticrack::ddm {
namespace {

base::UnionFind connected_parts(const Subdomain& subdomain) {
  base::UnionFind parts(subdomain.node.size());
  for (std::size_t t = 0; t < subdomain.part.triangle_count(); ++t) {
    stop::look_at_turn<stop::quick>(t, "looking for parts that nothing holds");
    const std::int32_t* corner = &subdomain.part.triangles[3 * t];
    parts.unite(corner[0], corner[1]);
    parts.unite(corner[1], corner[2]);
  }
  return parts;
}

std::string around(const Subdomain& subdomain, std::size_t node) {
  return fmt::format("the subdomain \"{}\" around {}", subdomain.name,
                     errors::shown(subdomain.part.xy[2 * node], subdomain.part.xy[2 * node + 1]));
}

constexpr const char* all_neumann =
    ": the whole boundary of the membrane is Neumann's, so it could move as a whole; make a part "
    "of "
    "the boundary Dirichlet's";

/// For each part, at the index of its representative node: whether it has a Dirichlet node, and its
/// first trace node, or -1.
struct PartNodes {
  std::vector<char> dirichlet;
  std::vector<std::int32_t> trace;
};

PartNodes nodes_of_parts(const Subdomain& subdomain, base::UnionFind& parts) {
  PartNodes result{std::vector<char>(subdomain.node.size(), 0),
                   std::vector<std::int32_t>(subdomain.node.size(), -1)};
  for (std::size_t i = subdomain.interior; i < subdomain.node.size(); ++i) {
    const std::size_t part = at(parts.find(static_cast<std::int32_t>(i)));
    if (i >= subdomain.free())
      result.dirichlet[part] = 1;
    else if (result.trace[part] < 0)
      result.trace[part] = static_cast<std::int32_t>(i - subdomain.interior);
  }
  return result;
}

/// Joins the unknowns of w that the parts of a subdomain connect. The ground is the last member.
void join(const Subdomain& subdomain, base::UnionFind& parts, const PartNodes& nodes,
          std::int32_t ground, base::UnionFind& held) {
  for (std::size_t i = 0; i < subdomain.trace; ++i) {
    const std::size_t part = at(parts.find(static_cast<std::int32_t>(subdomain.interior + i)));
    held.unite(subdomain.unknown[i],
               nodes.dirichlet[part] != 0 ? ground : subdomain.unknown[at(nodes.trace[part])]);
  }
}

}  // namespace

void find_floating_parts(Decomposition& decomposition, int threads) {
  const bool dirichlet =
      std::any_of(decomposition.subdomains.begin(), decomposition.subdomains.end(),
                  [](const Subdomain& subdomain) { return subdomain.dirichlet > 0; });
  const auto ground = static_cast<std::int32_t>(decomposition.skeleton.unknowns);
  const Skeleton& skeleton = decomposition.skeleton;
  base::UnionFind held(skeleton.unknowns + 1);
  // A body that tilts moves with the part along its edges, so all its motions count as held with A.
  for (std::size_t i = 0; i < skeleton.inclusion.size(); ++i)
    if (const std::int32_t j = skeleton.inclusion[i]; j >= 0)
      held.unite(static_cast<std::int32_t>(i), skeleton.motions[at(j)].displacement.front().index);
  for (const Held& one : skeleton.held)
    held.unite(skeleton.motions[at(one.inclusion)].displacement.front().index, ground);
  std::vector<base::UnionFind> connected(decomposition.subdomains.size(), base::UnionFind(0));
  base::at_once(connected.size(), threads, [&] {
    return [&](std::size_t s) { connected[s] = connected_parts(decomposition.subdomains[s]); };
  });
  for (std::size_t s = 0; s < connected.size(); ++s) {
    Subdomain& subdomain = decomposition.subdomains[s];
    base::UnionFind& parts = connected[s];
    const PartNodes nodes = nodes_of_parts(subdomain, parts);
    for (std::size_t i = 0; i < subdomain.node.size(); ++i) {
      if (parts.find(static_cast<std::int32_t>(i)) != static_cast<std::int32_t>(i) ||
          nodes.dirichlet[i] != 0)
        continue;
      if (nodes.trace[i] < 0) {
        throw errors::Error(errors::Reason::mesh_invalid, "nothing holds {}{}",
                            around(subdomain, i),
                            dirichlet ? ": it has no Dirichlet node and no interface; hold a "
                                        "part of its boundary, or glue it to a neighbour"
                                      : all_neumann)
            .with("subdomain", subdomain.name);
      }
      subdomain.floating.push_back(nodes.trace[i]);
    }
    join(subdomain, parts, nodes, ground, held);
  }
  const char* const holds =
      skeleton.contacts.empty() || !dirichlet ? "nothing holds " : "nothing but contact holds ";
  for (const Subdomain& subdomain : decomposition.subdomains) {
    for (const std::int32_t trace : subdomain.floating) {
      if (!held.same(subdomain.unknown[at(trace)], ground)) {
        throw errors::Error(errors::Reason::numerical, "{}{}{}", holds,
                            around(subdomain, subdomain.interior + at(trace)),
                            dirichlet ? ", so it could move as a whole: glue a part of its "
                                        "interface or hold its boundary"
                                      : all_neumann)
            .with("subdomain", subdomain.name);
      }
    }
  }
}

namespace {

/// A motion of the inclusion that Algorithm 2 does not allow, in words; empty if there is none.
std::string moves_otherwise(const Skeleton& skeleton, std::size_t inclusion) {
  const RigidMotion& motion = skeleton.motions[inclusion];
  const auto j = static_cast<std::int32_t>(inclusion);
  if (!motion.slope_x.empty()) return "tilts";
  const std::int32_t unknown = motion.displacement.front().index;
  const std::int32_t first = skeleton.inclusion[at(unknown)];
  if (first != j) return "shares nodes with another";
  if (std::ranges::any_of(skeleton.held, [&](const Held& held) { return held.inclusion == j; }))
    return "is held";
  return {};
}

}  // namespace

std::string uzawa_obstacle(const Decomposition& decomposition, const mesh::Mesh& mesh) {
  const std::string cure = "; use the method \"active-set\"";
  for (std::size_t j = 0; j < mesh.inclusions.size(); ++j) {
    const std::string otherwise = moves_otherwise(decomposition.skeleton, j);
    if (!otherwise.empty()) {
      return "the inclusion \"" + mesh.inclusions[j] + "\" " + otherwise +
             ", and Algorithm 2 knows only an unknown constant for each" + cure;
    }
  }
  std::vector<const Subdomain*> owner(mesh.inclusions.size(), nullptr);
  for (const Subdomain& subdomain : decomposition.subdomains) {
    if (!subdomain.floating.empty()) {
      return "the subdomain \"" + subdomain.name +
             "\" has a part without Dirichlet nodes, so Algorithm 2 cannot solve on it alone" +
             cure;
    }
    for (const std::int32_t inclusion : subdomain.rigid) {
      if (inclusion < 0) continue;
      const auto j = at(inclusion);
      if (owner[j] != nullptr && owner[j] != &subdomain) {
        return "the plus side of the inclusion \"" + mesh.inclusions[j] +
               "\" lies in two subdomains, \"" + owner[j]->name + "\" and \"" + subdomain.name +
               "\", and Algorithm 2 projects on one" + cure;
      }
      owner[j] = &subdomain;
    }
  }
  return {};
}

}  // namespace anticrack::ddm

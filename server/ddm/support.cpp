// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/support.hpp"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "errors/errors.hpp"
#include "mesh/at.hpp"
#include "mesh/union_find.hpp"

namespace anticrack::ddm {
namespace {

mesh::UnionFind connected_parts(const Subdomain& subdomain) {
  mesh::UnionFind parts(subdomain.node.size());
  for (std::size_t t = 0; t < subdomain.part.triangle_count(); ++t) {
    const std::int32_t* corner = &subdomain.part.triangles[3 * t];
    parts.unite(corner[0], corner[1]);
    parts.unite(corner[1], corner[2]);
  }
  return parts;
}

std::string around(const Subdomain& subdomain, std::size_t node) {
  std::ostringstream text;
  text << "the subdomain \"" << subdomain.name << "\" around (" << subdomain.part.xy[2 * node]
       << ", " << subdomain.part.xy[2 * node + 1] << ")";
  return text.str();
}

constexpr const char* all_neumann =
    ": the whole boundary of the membrane is Neumann's, so it could move as a whole; make a part "
    "of "
    "the boundary Dirichlet's";

/// Per part, by the node that stands for it: has a Dirichlet node; first trace number, or -1.
struct PartNodes {
  std::vector<char> dirichlet;
  std::vector<std::int32_t> trace;
};

PartNodes nodes_of_parts(const Subdomain& subdomain, mesh::UnionFind& parts) {
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

/// Joins what is tied: the unknowns of w, and the ground as the last member.
void join(const Subdomain& subdomain, mesh::UnionFind& parts, const PartNodes& nodes,
          std::int32_t ground, mesh::UnionFind& held) {
  for (std::size_t i = 0; i < subdomain.trace; ++i) {
    const std::size_t part = at(parts.find(static_cast<std::int32_t>(subdomain.interior + i)));
    held.unite(subdomain.unknown[i],
               nodes.dirichlet[part] != 0 ? ground : subdomain.unknown[at(nodes.trace[part])]);
  }
}

}  // namespace

void find_floating_parts(Decomposition& decomposition) {
  const bool dirichlet =
      std::any_of(decomposition.subdomains.begin(), decomposition.subdomains.end(),
                  [](const Subdomain& subdomain) { return subdomain.dirichlet > 0; });
  const auto ground = static_cast<std::int32_t>(decomposition.skeleton.unknowns);
  mesh::UnionFind held(decomposition.skeleton.unknowns + 1);
  for (Subdomain& subdomain : decomposition.subdomains) {
    mesh::UnionFind parts = connected_parts(subdomain);
    const PartNodes nodes = nodes_of_parts(subdomain, parts);
    for (std::size_t i = 0; i < subdomain.node.size(); ++i) {
      if (parts.find(static_cast<std::int32_t>(i)) != static_cast<std::int32_t>(i) ||
          nodes.dirichlet[i] != 0)
        continue;
      if (nodes.trace[i] < 0) {
        throw errors::Error(errors::Reason::mesh_invalid,
                            "nothing holds " + around(subdomain, i) +
                                (dirichlet ? ": it has no Dirichlet node and no interface; hold a "
                                             "part of its boundary, or glue it to a neighbour"
                                           : all_neumann))
            .with("subdomain", subdomain.name);
      }
      subdomain.floating.push_back(nodes.trace[i]);
    }
    join(subdomain, parts, nodes, ground, held);
  }
  const char* const holds = decomposition.skeleton.contacts.empty() || !dirichlet
                                ? "nothing holds "
                                : "nothing but contact holds ";
  for (const Subdomain& subdomain : decomposition.subdomains) {
    for (const std::int32_t trace : subdomain.floating) {
      if (!held.same(subdomain.unknown[at(trace)], ground)) {
        throw errors::Error(errors::Reason::numerical,
                            holds + around(subdomain, subdomain.interior + at(trace)) +
                                (dirichlet ? ", so it could move as a whole: glue a part of its "
                                             "interface or hold its boundary"
                                           : all_neumann))
            .with("subdomain", subdomain.name);
      }
    }
  }
}

}  // namespace anticrack::ddm

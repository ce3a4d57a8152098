// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/assumptions.hpp"

#include <string>

#include "mesher/edge_roles.hpp"

namespace anticrack::mesher {
namespace {

/// Continues "it lies ..." and "they lie ...".
std::string place(Assumed assumed) {
  switch (assumed) {
    case Assumed::dirichlet:
    case Assumed::neumann:
      return " on the boundary: taken for ";
    case Assumed::glue:
      return " between two subdomains: taken for ";
    case Assumed::welded:
      return " between two subdomains that were meshed separately: taken for ";
    case Assumed::joined:
      return " between parts of one subdomain that were meshed separately: taken for ";
    case Assumed::crack:
      return " on doubled nodes: taken for ";
    case Assumed::nothing:
      return " inside one subdomain: taken for ";
    case Assumed::left_out:
      break;
  }
  return " on no edge of a triangle: ";
}

std::string taken(Assumed assumed) {
  switch (assumed) {
    case Assumed::dirichlet:
      return "dirichlet";
    case Assumed::neumann:
      return "neumann";
    case Assumed::glue:
    case Assumed::welded:
      return "glue";
    case Assumed::crack:
      return "crack";
    case Assumed::joined:
      return "one piece";
    case Assumed::nothing:
      return "a line the mesh follows, no interface";
    case Assumed::left_out:
      break;
  }
  return "left out";
}

/// `it` is "it" or "them", `tag` what the map of the request would have to name.
std::string cure(Assumed assumed, bool physical, const std::string& it, const std::string& tag) {
  if (assumed == Assumed::left_out) return "";
  const bool boundary = assumed == Assumed::dirichlet || assumed == Assumed::neumann;
  return "; to choose, " +
         (physical ? "name " + it + " " : "put " + it + " in physical curves called ") +
         (boundary ? "dirichlet or neumann" : "glue, crack, inclusion:NAME or delaminated:NAME") +
         ", or give " + tag + " a meaning in the groups of the mesh options";
}

std::string edges(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " edge" : " edges");
}

}  // namespace

void Assumptions::add(const CurveGroup& group, Assumed assumed) {
  ++_by_group[{group.tag, assumed}];
}

void Assumptions::add(Assumed assumed, std::int32_t node) {
  Bare& bare = _bare.emplace(assumed, Bare{0, node}).first->second;
  ++bare.edges;
}

void Assumptions::tell(const CurveGroups& groups, mesh::Mesh& mesh) const {
  std::map<Assumed, std::vector<std::int32_t>> curves;
  for (const auto& [key, count] : _by_group) {
    const auto [tag, assumed] = key;
    if (!groups.physical) {
      curves[assumed].push_back(tag);
      continue;
    }
    mesh.warnings.push_back(groups.groups.at(tag).title + " lies" + place(assumed) +
                            taken(assumed) + " (" + edges(count) + ")" +
                            cure(assumed, true, "it", std::to_string(tag)));
  }
  for (const auto& [assumed, tags] : curves) {
    const bool one = tags.size() == 1;
    mesh.warnings.push_back((one ? "curve " : "curves ") + list_of(tags) +
                            (one ? " (in no group) lies" : " (in no group) lie") + place(assumed) +
                            taken(assumed) +
                            cure(assumed, false, one ? "it" : "them", one ? "it" : "them"));
  }
  for (const auto& [assumed, bare] : _bare) {
    const bool one = bare.edges == 1;
    mesh.warnings.push_back(edges(bare.edges) + " in no curve group, the first at " +
                            place_of(mesh, bare.node) + ", " + (one ? "lies" : "lie") +
                            place(assumed) + taken(assumed) + "; to choose, put " +
                            (one ? "it" : "them") + " in a physical curve");
  }
}

}  // namespace anticrack::mesher

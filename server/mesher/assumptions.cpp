// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/import_steps.hpp"

#include <array>
#include <string>

#include "mesher/messages.hpp"

namespace anticrack::mesher {
namespace {

/// Words that follow "it lies" and "they lie", in the order of Assumed.
constexpr std::array words{
    "on the boundary: taken for dirichlet",
    "on the boundary: taken for neumann",
    "between two subdomains: taken for glue",
    "between two subdomains that were meshed separately: taken for glue",
    "between parts of one subdomain that were meshed separately: taken for one piece",
    "on doubled nodes: taken for crack",
    "inside one subdomain: taken for a line the mesh follows, no interface",
    "on no edge of a triangle: left out"};

const char* words_of(Assumed assumed) { return words.at(static_cast<std::size_t>(assumed)); }

/// `name`: how to name the edges; `tag`: their key in the groups of the mesh options.
std::string cure(Assumed assumed, const std::string& name, const std::string& tag) {
  if (assumed == Assumed::left_out) return "";
  const bool boundary = assumed == Assumed::dirichlet || assumed == Assumed::neumann;
  return fmt::format(
      "; to choose, {} {}, or give {} a meaning in the groups of the mesh options", name,
      boundary ? "dirichlet or neumann" : "glue, crack, free, inclusion:NAME or delaminated:NAME",
      tag);
}

std::string edges(std::size_t count) {
  return fmt::format("{} edge{}", count, count == 1 ? "" : "s");
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
    mesh.warnings.push_back(fmt::format("{} lies {} ({}){}", groups.groups.at(tag).title,
                                        words_of(assumed), edges(count),
                                        cure(assumed, "name it", std::to_string(tag))));
  }
  for (const auto& [assumed, tags] : curves) {
    const bool one = tags.size() == 1;
    const std::string them = one ? "it" : "them";
    mesh.warnings.push_back(
        fmt::format("{} {} (in no group) {} {}{}", one ? "curve" : "curves", list_of(tags),
                    one ? "lies" : "lie", words_of(assumed),
                    cure(assumed, "put " + them + " in physical curves called", them)));
  }
  for (const auto& [assumed, bare] : _bare) {
    const bool one = bare.edges == 1;
    mesh.warnings.push_back(fmt::format(
        "{} in no curve group, the first at {}, {} {}; to choose, put {} in a physical curve",
        edges(bare.edges), place_of(mesh, bare.node), one ? "lies" : "lie", words_of(assumed),
        one ? "it" : "them"));
  }
}

}  // namespace anticrack::mesher

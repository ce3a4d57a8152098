// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/guess_edges.hpp"

namespace anticrack::results {
namespace {

/// A tip has the kind of its tied neighbour: an edge is a crack when one of its ends is, else
/// bonded only when both are.
Kind edge_kind(Kind a, Kind b) {
  for (const Kind open : {Kind::delaminated, Kind::crack}) {
    if (a == open || b == open) return open;
  }
  return a == Kind::inclusion && b == Kind::inclusion ? Kind::inclusion : Kind::glue;
}

/// Empty where no load was solved.
std::vector<std::string> inclusion_names(const Result& result) {
  std::vector<std::string> names;
  for (const Load& load : result.loads) {
    for (const Inclusion& inclusion : load.inclusions) names.push_back(inclusion.name);
    if (!names.empty()) break;
  }
  return names;
}

}  // namespace

void guess_edges(Result& result) {
  result.mesh.inclusions = result.sweep ? result.sweep->inclusions : inclusion_names(result);
  const std::int32_t only = result.mesh.inclusions.size() == 1 ? 0 : -1;
  for (Interface& interface : result.interfaces) {
    Edges& edges = interface.edges;
    for (std::size_t e = 0; e + 1 < interface.kind.size(); ++e) {
      edges.kind.push_back(edge_kind(interface.kind[e], interface.kind[e + 1]));
      const bool rigid = edges.kind[e] == Kind::inclusion || edges.kind[e] == Kind::delaminated;
      edges.inclusion.push_back(rigid ? only : -1);
    }
  }
}

}  // namespace anticrack::results

// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/decomposition.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "ddm/cut_steps.hpp"
#include "errors/errors.hpp"
#include "stop/stop.hpp"

namespace anticrack::ddm {
namespace {

using mesh::Kind;

constexpr const char* cutting = "cutting a mesh along its interfaces";

std::int32_t count_of(const std::vector<std::int32_t>& list) {
  return static_cast<std::int32_t>(list.size());
}

/// Sorts triangles by their smallest node, so that a loop over them finds nodes in the cache. O(m).
void sort_by_first_node(Subdomain& subdomain) {
  const std::size_t count = subdomain.triangle.size();
  const std::int32_t* corner = subdomain.part.triangles.data();
  std::vector<std::int32_t> first(count), end(subdomain.node.size(), 0);
  for (std::size_t k = 0; k < count; ++k) {
    stop::look_at_turn<stop::quick>(k, cutting);
    first[k] = std::min({corner[3 * k], corner[3 * k + 1], corner[3 * k + 2]});
    ++end[at(first[k])];
  }
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<std::int32_t> triangle(count), corners(3 * count);
  for (std::size_t k = count; k-- > 0;) {
    stop::look_at_turn<stop::quick>(k, cutting);
    const std::size_t place = at(--end[at(first[k])]);
    triangle[place] = subdomain.triangle[k];
    std::copy_n(corner + 3 * k, 3, &corners[3 * place]);
  }
  subdomain.triangle = std::move(triangle);
  subdomain.part.triangles = std::move(corners);
}

/// Numbers the nodes of the subdomains.
class Numbering {
 public:
  Numbering(const mesh::Mesh& mesh, const Sides& sides, int threads)
      : _mesh(mesh),
        _sides(sides),
        _side_trace(sides.sides.size()),
        _subdomains(mesh.subdomains.size()) {
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      stop::look_at_turn<stop::quick>(t, cutting);
      _subdomains[at(mesh.subdomain[t])].triangle.push_back(static_cast<std::int32_t>(t));
    }
    std::vector<std::vector<std::int32_t>> traces(_subdomains.size());
    for (std::size_t i = 0; i < sides.sides.size(); ++i) {
      std::vector<std::int32_t>& trace = traces[at(sides.sides[i].subdomain)];
      _side_trace[i] = count_of(trace);
      trace.push_back(static_cast<std::int32_t>(i));
    }
    base::at_once(_subdomains.size(), threads, [&] {
      return [&, local = Local(mesh.node_count(), -1)](std::size_t s) mutable {
        Subdomain& subdomain = _subdomains[s];
        subdomain.name = mesh.subdomains[s];
        subdomain.tension = mesh.tension.empty() ? 1.0 : mesh.tension[s];
        number(subdomain, traces[s], local);
      };
    });
  }

  void add_laws() {
    for (std::size_t s = 0; s < _mesh.tension_laws.size(); ++s) {
      if (_mesh.tension_laws[s].along.empty()) continue;
      Subdomain& subdomain = _subdomains[s];
      try {
        subdomain.tension = fem::tension(subdomain.part, _mesh.tension_laws[s], subdomain.name);
      } catch (errors::Error& error) {
        throw error.below("tension_law");
      }
    }
  }

  void add_unknowns(const Ties& ties) {
    for (Subdomain& subdomain : _subdomains) {
      subdomain.rigid.resize(subdomain.trace);
      subdomain.unknown.resize(subdomain.trace);
    }
    for (std::size_t i = 0; i < _side_trace.size(); ++i) {
      Subdomain& subdomain = _subdomains[at(_sides.sides[i].subdomain)];
      subdomain.rigid[at(_side_trace[i])] = ties.rigid[i];
      subdomain.unknown[at(_side_trace[i])] = ties.unknown[i];
    }
  }

  const std::vector<std::int32_t>& side_trace() const { return _side_trace; }
  std::vector<Subdomain> take_subdomains() { return std::move(_subdomains); }

 private:
  /// Of each node of the mesh: its number in the present subdomain, or -1.
  using Local = std::vector<std::int32_t>;

  void number(Subdomain& subdomain, const std::vector<std::int32_t>& trace, Local& local) {
    std::vector<std::int32_t> dirichlet;
    std::size_t turn = 0;
    for (const std::int32_t t : subdomain.triangle) {
      stop::look_at_turn<stop::quick>(turn++, cutting);
      for (std::size_t c = 3 * at(t); c < 3 * at(t) + 3; ++c) {
        const std::int32_t node = _mesh.triangles[c];
        if (_sides.corner[c] < 0 && local[at(node)] < 0) {
          local[at(node)] = 0;
          (_sides.on_dirichlet[at(node)] != 0 ? dirichlet : subdomain.node).push_back(node);
        }
      }
    }
    sort_along_curve(subdomain.node, _mesh.xy);
    std::sort(dirichlet.begin(), dirichlet.end());
    subdomain.interior = subdomain.node.size();
    subdomain.trace = trace.size();
    subdomain.dirichlet = dirichlet.size();
    subdomain.node.reserve(subdomain.interior + trace.size() + dirichlet.size());
    for (const std::int32_t side : trace) subdomain.node.push_back(_sides.sides[at(side)].node);
    subdomain.node.insert(subdomain.node.end(), dirichlet.begin(), dirichlet.end());
    number_triangles(subdomain, local);
  }

  void number_triangles(Subdomain& subdomain, Local& local) {
    subdomain.part.xy.reserve(2 * subdomain.node.size());
    for (std::size_t i = 0; i < subdomain.node.size(); ++i) {
      const std::size_t node = at(subdomain.node[i]);
      subdomain.part.xy.push_back(_mesh.xy[2 * node]);
      subdomain.part.xy.push_back(_mesh.xy[2 * node + 1]);
      local[node] = static_cast<std::int32_t>(i);
    }
    const auto first_trace = static_cast<std::int32_t>(subdomain.interior);
    subdomain.part.triangles.reserve(3 * subdomain.triangle.size());
    std::size_t turn = 0;
    for (const std::int32_t t : subdomain.triangle) {
      stop::look_at_turn<stop::quick>(turn++, cutting);
      for (std::size_t c = 3 * at(t); c < 3 * at(t) + 3; ++c) {
        const std::int32_t side = _sides.corner[c];
        subdomain.part.triangles.push_back(side >= 0 ? first_trace + _side_trace[at(side)]
                                                     : local[at(_mesh.triangles[c])]);
      }
    }
    stop::look(cutting);
    sort_by_first_node(subdomain);
    for (const std::int32_t node : subdomain.node)
      local[at(node)] = -1;  // a Dirichlet node may be in the next subdomain as well
  }

  const mesh::Mesh& _mesh;
  const Sides& _sides;
  std::vector<std::int32_t> _side_trace;  // trace index of each side in its subdomain
  std::vector<Subdomain> _subdomains;
};

std::vector<NodePair> place_pairs(const Sides& sides, const Ties& ties,
                                  const std::vector<std::int32_t>& side_trace) {
  std::vector<NodePair> pairs;
  pairs.reserve(ties.couples.size());
  for (const Couple& couple : ties.couples) {
    const Side &minus = sides.sides[at(couple.minus)], &plus = sides.sides[at(couple.plus)];
    NodePair pair{minus.node,
                  minus.subdomain,
                  side_trace[at(couple.minus)],
                  plus.subdomain,
                  side_trace[at(couple.plus)],
                  Kind::glue,
                  -1,
                  couple.contact};
    const std::int32_t above = ties.unknown[at(couple.plus)];
    const std::int32_t of_unknown = ties.skeleton.inclusion[at(above)];
    const std::int32_t own = ties.rigid[at(couple.plus)];
    pair.inclusion = of_unknown >= 0 && own >= 0 ? own : of_unknown;
    const bool rigid = pair.inclusion >= 0;
    if (above == ties.unknown[at(couple.minus)])
      pair.kind = rigid ? Kind::inclusion : Kind::glue;
    else
      pair.kind = rigid ? Kind::delaminated : Kind::crack;
    pairs.push_back(pair);
  }
  return pairs;
}

std::vector<fem::MassEdge> place_edges(const mesh::Mesh& mesh, const Sides& sides,
                                       const Ties& ties) {
  std::vector<fem::MassEdge> edges;
  edges.reserve(sides.edges.size());
  for (std::size_t e = 0; e < sides.edges.size(); ++e) {
    const std::size_t a = at(sides.edges[e].node[0]), b = at(sides.edges[e].node[1]);
    const bool free = sides.edges[e].kind == Kind::free;  // it carries no pressure
    edges.push_back(
        {free ? std::array{-1, -1} : ties.of_end[e],
         std::hypot(mesh.xy[2 * b] - mesh.xy[2 * a], mesh.xy[2 * b + 1] - mesh.xy[2 * a + 1])});
  }
  return edges;
}

/// The two sides at one end of an edge.
SidePair side_pair(const Decomposition& decomposition, const Sides& sides, const Ties& ties,
                   const std::vector<std::int32_t>& side_trace, std::size_t edge, std::size_t end) {
  SidePair result;
  const std::int32_t minus = sides.edges[edge].minus[end], plus = sides.edges[edge].plus[end];
  if (plus < 0) {
    result.kind = sides.edges[edge].inclusion >= 0 ? Kind::inclusion : Kind::glue;
    return result;
  }
  result.pair = ties.of_end[edge][end];
  result.minus = sides.sides[at(minus)].subdomain;
  result.minus_trace = side_trace[at(minus)];
  result.plus = sides.sides[at(plus)].subdomain;
  result.plus_trace = side_trace[at(plus)];
  if (result.pair >= 0)
    result.kind = decomposition.pairs[at(result.pair)].kind;
  else if (minus != plus)
    result.kind = Kind::free;
  else
    result.kind = ties.rigid[at(plus)] >= 0 ? Kind::inclusion : Kind::glue;
  return result;
}

std::vector<std::vector<SidePair>> place_sides(const mesh::Mesh& mesh,
                                               const Decomposition& decomposition,
                                               const Sides& sides, const Ties& ties,
                                               const std::vector<std::int32_t>& side_trace) {
  std::vector<std::vector<SidePair>> result(mesh.interfaces.size());
  for (std::size_t e = 0; e < sides.edges.size(); ++e) {
    std::vector<SidePair>& of_node = result[at(sides.edges[e].interface)];
    of_node.push_back(side_pair(decomposition, sides, ties, side_trace, e, 0));
    if (e + 1 == sides.edges.size() || sides.edges[e + 1].interface != sides.edges[e].interface)
      of_node.push_back(side_pair(decomposition, sides, ties, side_trace, e, 1));
  }
  return result;
}

/// Sets the subdomain and the index in which each held value of the Dirichlet boundary is found.
void place_held(const std::vector<Subdomain>& subdomains, std::vector<Held>& held) {
  for (Held& one : held) {
    for (std::size_t s = 0; s < subdomains.size() && one.node >= 0 && one.subdomain < 0; ++s) {
      const auto begin =
          subdomains[s].node.begin() + static_cast<std::ptrdiff_t>(subdomains[s].free());
      const auto found = std::lower_bound(begin, subdomains[s].node.end(), one.node);
      if (found == subdomains[s].node.end() || *found != one.node) continue;
      one.subdomain = static_cast<std::int32_t>(s);
      one.dirichlet = static_cast<std::int32_t>(found - begin);
    }
  }
}

}  // namespace

Decomposition cut(const mesh::Mesh& mesh, int threads) {
  const Sides sides = find_sides(mesh);
  Ties ties = tie(mesh, sides);
  Numbering numbering(mesh, sides, threads);
  numbering.add_unknowns(ties);
  numbering.add_laws();
  Decomposition result;
  result.subdomains = numbering.take_subdomains();
  result.pairs = place_pairs(sides, ties, numbering.side_trace());
  result.edges = place_edges(mesh, sides, ties);
  result.interface_sides = place_sides(mesh, result, sides, ties, numbering.side_trace());
  result.skeleton = std::move(ties.skeleton);
  place_held(result.subdomains, result.skeleton.held);
  find_floating_parts(result, threads);
  return result;
}

}  // namespace anticrack::ddm

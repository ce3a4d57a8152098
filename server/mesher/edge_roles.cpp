// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/import_steps.hpp"

#include <algorithm>
#include <functional>
#include <set>
#include <tuple>
#include <utility>

#include "mesh/names.hpp"
#include "mesher/messages.hpp"

namespace anticrack::mesher {
namespace {

using mesh::EdgeUse;
using mesh::Mesh;
using Uses = std::span<const EdgeUse>;

std::string edge_of(const Mesh& mesh, std::int32_t a, std::int32_t b) {
  return fmt::format("the edge {}-{}", place_of(mesh, a), place_of(mesh, b));
}

/// An edge and one of its groups.
struct Mark {
  std::int32_t low = 0;
  std::int32_t high = 0;
  const CurveGroup* group = nullptr;
};

std::vector<Mark> sorted_marks(std::span<const CurveEdge> lines) {
  std::vector<Mark> marks;
  marks.reserve(lines.size());
  for (const CurveEdge& line : lines) {
    if (line.group == nullptr) continue;
    marks.push_back({std::min(line.from, line.to), std::max(line.from, line.to), line.group});
  }
  const auto key = [](const Mark& m) { return std::tuple(m.low, m.high, m.group->tag); };
  std::sort(marks.begin(), marks.end(),
            [&](const Mark& a, const Mark& b) { return key(a) < key(b); });
  marks.erase(std::unique(marks.begin(), marks.end(),
                          [&](const Mark& a, const Mark& b) { return key(a) == key(b); }),
              marks.end());
  return marks;
}

/// The meaning that includes both, or null.
const CurveMeaning* agree(const CurveMeaning& a, const CurveMeaning& b) {
  if (a.role == b.role) {
    if (of_boundary(a.role) && b.name.empty()) return &a;
    if (of_boundary(a.role) && a.name.empty()) return &b;
    return !(is_rigid(a.role) || of_boundary(a.role)) || a.name == b.name ? &a : nullptr;
  }
  if (a.name != b.name) return nullptr;
  if (a.role == CurveRole::delaminated && b.role == CurveRole::inclusion) return &a;
  if (b.role == CurveRole::delaminated && a.role == CurveRole::inclusion) return &b;
  return nullptr;
}

/// The group that gives the edge its meaning, or null.
const CurveGroup* deciding(const Mesh& mesh, std::span<const Mark> marks) {
  const CurveGroup* found = nullptr;
  for (const Mark& mark : marks) {
    if (!mark.group->meaning) continue;
    if (found == nullptr) {
      found = mark.group;
      continue;
    }
    const CurveMeaning* both = agree(*found->meaning, *mark.group->meaning);
    if (both == nullptr) {
      refuse("{} is in {} and in {}, which do not go together; put it in one of them",
             edge_of(mesh, mark.low, mark.high), found->title, mark.group->title);
    }
    if (both != &*found->meaning) found = mark.group;
  }
  return found;
}

enum class Side { boundary, between, inside };

/// Decides edge by edge, in the order of the table.
class Reading {
 public:
  Reading(const CurveGroups& groups, const Welding& welding, Mesh& mesh)
      : _groups(groups), _welding(welding), _mesh(mesh) {}

  EdgeRoles read(const mesh::EdgeTable& edges, std::span<const CurveEdge> lines) {
    const std::vector<Mark> marks = sorted_marks(lines);
    check_marks(edges, marks);
    each(edges, marks, [&](Uses uses, std::span<const Mark> on) { look(uses, on); });
    each(edges, marks, [&](Uses uses, std::span<const Mark> on) { decide(uses, on); });
    if (_roles.dirichlet.empty()) {
      refuse(
          "no edge of the boundary is dirichlet, so nothing holds the membrane; put part of its "
          "boundary in a physical curve \"dirichlet\"");
    }
    _assumptions.tell(_groups, _mesh);
    return std::move(_roles);
  }

 private:
  void check_marks(const mesh::EdgeTable& edges, std::span<const Mark> marks) {
    for (const Mark& mark : marks) {
      if (!edges.find(mark.low, mark.high).empty()) continue;
      if (mark.group->meaning) {
        refuse(
            "{} of {} is the edge of no triangle; mesh surfaces and curves together, so that "
            "they share nodes",
            edge_of(_mesh, mark.low, mark.high), mark.group->title);
      }
      _assumptions.add(*mark.group, Assumed::left_out);
    }
  }

  /// visit(uses, marks) for each edge; both lists are sorted by (low, high).
  static void each(const mesh::EdgeTable& edges, std::span<const Mark> marks,
                   const std::function<void(Uses, std::span<const Mark>)>& visit) {
    std::size_t at = 0;
    edges.each([&](Uses uses) {
      const auto key = std::pair(uses[0].low(), uses[0].high());
      const auto mark_key = [&](std::size_t i) { return std::pair(marks[i].low, marks[i].high); };
      while (at < marks.size() && mark_key(at) < key) ++at;
      std::size_t end = at;
      while (end < marks.size() && mark_key(end) == key) ++end;
      visit(uses, marks.subspan(at, end - at));
      at = end;
    });
  }

  /// Collects the marks of all edges before any edge is decided.
  void look(Uses uses, std::span<const Mark> marks) {
    const CurveGroup* group = deciding(_mesh, marks);
    if (group != nullptr) _any_meaning = true;
    if (uses.size() != 1 || marks.empty()) return;
    if (group == nullptr || group->meaning->role == CurveRole::dirichlet) _any_dirichlet = true;
  }

  Side side_of(Uses uses) const {
    if (uses.size() == 1) return Side::boundary;
    const auto of = [&](std::size_t i) { return _mesh.subdomain[at(uses[i].triangle)]; };
    return of(0) == of(1) ? Side::inside : Side::between;
  }

  void decide(Uses uses, std::span<const Mark> marks) {
    const Side side = side_of(uses);
    const CurveGroup* group = deciding(_mesh, marks);
    if (group != nullptr) {
      check_place(uses, side, *group);
      take(uses, side, *group->meaning, marks);
      return;
    }
    const DoubledEdge* doubled = _welding.find(uses[0].low(), uses[0].high());
    // edges inside a subdomain need no warning
    if (side == Side::inside && doubled == nullptr && marks.empty()) return;
    const Assumed assumed = assume(side, doubled, marks.empty());
    const bool plain = assumed == Assumed::glue && marks.empty() && _any_meaning;
    if (!plain && marks.empty()) _assumptions.add(assumed, uses[0].low());
    for (const Mark& mark : marks) _assumptions.add(*mark.group, assumed);
    take(uses, side, meaning_of(assumed), marks);
  }

  Assumed assume(Side side, const DoubledEdge* doubled, bool bare) const {
    if (side == Side::boundary)
      return bare && _any_dirichlet ? Assumed::neumann : Assumed::dirichlet;
    if (doubled != nullptr && !doubled->apart) return Assumed::crack;
    if (side == Side::inside) return doubled != nullptr ? Assumed::joined : Assumed::nothing;
    return doubled != nullptr ? Assumed::welded : Assumed::glue;
  }

  static CurveMeaning meaning_of(Assumed assumed) {
    if (assumed == Assumed::dirichlet) return {CurveRole::dirichlet, ""};
    if (assumed == Assumed::neumann) return {CurveRole::neumann, ""};
    if (assumed == Assumed::crack) return {CurveRole::crack, ""};
    return {CurveRole::glue, ""};
  }

  void check_place(Uses uses, Side side, const CurveGroup& group) const {
    const CurveRole role = group.meaning->role;
    if (of_boundary(role) == (side == Side::boundary)) return;
    const std::string edge = edge_of(_mesh, uses[0].from, uses[0].to) + " of " + group.title;
    if (of_boundary(role)) {
      refuse(
          "{} lies inside the membrane, but its name is for the boundary (call it \"crack\", or "
          "\"free\" if its faces never touch)",
          edge);
    }
    refuse(
        "{} has a triangle on one side only and no other edge lies on it; only \"dirichlet\" and "
        "\"neumann\" may lie on the boundary{}",
        edge, role == CurveRole::free ? ": one that is free is \"neumann\"" : "");
  }

  /// The name of an edge of the boundary, empty for none.
  const std::string& part_of(const CurveMeaning& meaning, std::span<const Mark> marks) {
    const CurveGroup* first = nullptr;
    for (const auto& [low, high, group] : marks) {
      if (!meaning.name.empty() || group->part.empty()) continue;
      if (first == nullptr) first = group;
      if (group->part == first->part || !_shared.emplace(first->tag, group->tag).second) continue;
      _mesh.warnings.push_back(
          fmt::format("{} is in {} and in {}: answers count its force for {} alone",
                      edge_of(_mesh, low, high), first->title, group->title, first->part));
    }
    if (first == nullptr) return meaning.name;
    if (first->renamed && _shared.emplace(first->tag, first->tag).second)
      _mesh.warnings.push_back(fmt::format("{} is {} in answers: a name there is {}", first->title,
                                           first->part, mesh::name_rule));
    return first->part;
  }

  void take(Uses uses, Side side, const CurveMeaning& meaning, std::span<const Mark> marks) {
    const EdgeUse& use = uses[0];
    if (meaning.role == CurveRole::dirichlet) _roles.dirichlet.push_back({use.from, use.to});
    if (side == Side::boundary)
      if (const std::string& part = part_of(meaning, marks); !part.empty())
        _roles.named.push_back({use.from, use.to, part});
    // glue inside a subdomain changes nothing
    const bool nothing = side == Side::inside && meaning.role == CurveRole::glue;
    if (side == Side::boundary || nothing) return;
    // triangles are counterclockwise, so they lie to the left of their edges
    _roles.interfaces.push_back({use.from, use.to, _mesh.subdomain[at(use.triangle)],
                                 _mesh.subdomain[at(uses[1].triangle)], meaning});
  }

  const CurveGroups& _groups;
  const Welding& _welding;
  Mesh& _mesh;
  bool _any_meaning = false;
  bool _any_dirichlet = false;
  std::set<std::pair<std::int32_t, std::int32_t>> _shared;  ///< tags of groups with common edges
  EdgeRoles _roles;
  Assumptions _assumptions;
};

}  // namespace

EdgeRoles read_edges(const mesh::EdgeTable& edges, std::span<const CurveEdge> lines,
                     const CurveGroups& groups, const Welding& welding, Mesh& mesh) {
  return Reading(groups, welding, mesh).read(edges, lines);
}

}  // namespace anticrack::mesher

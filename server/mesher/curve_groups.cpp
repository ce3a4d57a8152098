// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/curve_groups.hpp"

#include <algorithm>
#include <sstream>
#include <tuple>

#include "errors/errors.hpp"
#include "mesh/names.hpp"
#include "mesher/msh_scanner.hpp"

namespace anticrack::mesher {
namespace {

[[noreturn]] void refuse(const std::string& message) {
  throw errors::Error(errors::Reason::mesh_invalid, message);
}

CurveGroup read_group(int tag, const std::string& full) {
  if (full == "dirichlet") return {CurveRole::dirichlet, "", full};
  if (full == "neumann") return {CurveRole::natural, "", full};
  if (full == "crack") return {CurveRole::crack, "", full};
  const std::size_t colon = full.find(':');
  const std::string role = full.substr(0, colon);
  const std::pair<const char*, CurveRole> roles[] = {{"crack", CurveRole::crack},
                                                     {"inclusion", CurveRole::inclusion},
                                                     {"delaminated", CurveRole::delaminated}};
  for (const auto& [known, meaning] : roles) {
    if (role != known) continue;
    const std::string name = colon == std::string::npos ? "" : full.substr(colon + 1);
    if (mesh::valid_name(name)) return {meaning, name, full};
    refuse("physical curve " + std::to_string(tag) + " \"" + printable(full) +
           "\" takes a name, \"" + known + ":NAME\": " + std::string(mesh::name_rule));
  }
  refuse("physical curve " + std::to_string(tag) + " is named \"" + printable(full) +
         "\", which means nothing here; a curve is dirichlet, neumann, crack, crack:NAME, "
         "inclusion:NAME, delaminated:NAME, or has no name");
}

bool on_boundary(CurveRole role) {
  return role == CurveRole::dirichlet || role == CurveRole::natural;
}

std::string describe(const mesh::Mesh& mesh, const CurveEdge& edge, const CurveGroup& group) {
  return "the edge " + place_of(mesh, edge.from) + "-" + place_of(mesh, edge.to) + " of curve \"" +
         group.full + "\"";
}

void check_place(const mesh::Mesh& mesh, const mesh::EdgeTable& edges, const CurveEdge& edge,
                 const CurveGroup& group) {
  const auto uses = edges.find(edge.from, edge.to);
  if (uses.empty()) {
    refuse(describe(mesh, edge, group) +
           " is the edge of no triangle; mesh surfaces and curves together, so that they share "
           "nodes");
  }
  if (on_boundary(group.role)) {
    if (uses.size() == 1) return;
    refuse(describe(mesh, edge, group) + " lies inside the membrane; \"" + group.full +
           "\" is for its boundary");
  }
  if (uses.size() == 1) {
    refuse(describe(mesh, edge, group) +
           " has a triangle on one side only; it must lie between two surfaces that share its "
           "nodes (let no plugin double them: that is done here)");
  }
  const auto side = [&](std::size_t i) {
    return mesh.subdomain[static_cast<std::size_t>(uses[i].triangle)];
  };
  if (side(0) == side(1)) {
    refuse(describe(mesh, edge, group) + " has surface \"" +
           mesh.subdomains[static_cast<std::size_t>(side(0))] +
           "\" on both sides; prolong the curve so that it cuts the membrane into two surfaces");
  }
}

}  // namespace

std::string place_of(const mesh::Mesh& mesh, std::int32_t node) {
  std::ostringstream text;
  const auto i = 2 * static_cast<std::size_t>(node);
  text << "(" << mesh.xy[i] << ", " << mesh.xy[i + 1] << ")";
  return text.str();
}

std::map<int, CurveGroup> read_curve_groups(const std::map<int, std::string>& names) {
  std::map<int, CurveGroup> groups;
  std::map<std::string, bool> is_crack;
  for (const auto& [tag, full] : names) {
    if (full.empty()) continue;
    CurveGroup group = read_group(tag, full);
    if (!group.name.empty()) {
      const bool crack = group.role == CurveRole::crack;
      if (is_crack.emplace(group.name, crack).first->second != crack) {
        refuse("\"" + group.name +
               "\" is the name of a crack and of an inclusion; give each its own");
      }
    }
    groups.emplace(tag, std::move(group));
  }
  return groups;
}

NamedEdges::NamedEdges(const mesh::Mesh& mesh, const mesh::EdgeTable& edges,
                       std::span<const CurveEdge> lines, const std::map<int, CurveGroup>& groups) {
  for (const CurveEdge& line : lines) {
    const auto group = groups.find(line.group);
    if (group == groups.end()) continue;
    check_place(mesh, edges, line, group->second);
    _entries.push_back(
        {std::min(line.from, line.to), std::max(line.from, line.to), &group->second});
  }
  const auto key = [](const Entry& e) { return std::tuple(e.low, e.high, e.group); };
  std::sort(_entries.begin(), _entries.end(),
            [&](const Entry& a, const Entry& b) { return key(a) < key(b); });
  for (std::size_t i = 1; i < _entries.size(); ++i) {
    const Entry& a = _entries[i - 1];
    const Entry& b = _entries[i];
    if (a.low == b.low && a.high == b.high && a.group != b.group) {
      refuse("the edge " + place_of(mesh, a.low) + "-" + place_of(mesh, a.high) +
             " belongs to two curves, \"" + a.group->full + "\" and \"" + b.group->full +
             "\"; put it in one");
    }
  }
}

const CurveGroup* NamedEdges::find(std::int32_t a, std::int32_t b) const {
  const auto key = std::pair(std::min(a, b), std::max(a, b));
  const auto found =
      std::lower_bound(_entries.begin(), _entries.end(), key,
                       [](const Entry& e, const auto& k) { return std::pair(e.low, e.high) < k; });
  const bool there = found != _entries.end() && std::pair(found->low, found->high) == key;
  return there ? found->group : nullptr;
}

}  // namespace anticrack::mesher

// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/at.hpp"
#include "errors/errors.hpp"
#include "mesh/joined_inclusions.hpp"

namespace anticrack::ddm {
namespace {

using mesh::Point;

/// How far the nodes of a straight body may lie off its line, relative to its length.
constexpr double straight = 1e-9;

struct Box {
  Point low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point high{-low[0], -low[1]};

  void add(const Point& p) {
    for (std::size_t i = 0; i < 2; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  Point centre() const { return {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2}; }
};

void hold(Body& body, const mesh::Motion& motion, const std::string& name) {
  if (!motion.fixed) return;
  if (body.fixed && *body.fixed != *motion.fixed) {
    throw errors::Error(errors::Reason::invalid_argument,
                        "the inclusion \"{}\" is fixed at {}, but shares nodes with one that is "
                        "fixed at {}: they are one body; fix them at one value, or leave an edge "
                        "between them",
                        name, *motion.fixed, *body.fixed);
  }
  body.fixed = motion.fixed;
}

/// Sets the axes of a body whose inclusions all tilt.
void let_tilt(Body& body, const std::vector<Point>& nodes) {
  const auto from_centre = [&](const Point& p) {
    return Point{p[0] - body.centre[0], p[1] - body.centre[1]};
  };
  const auto size = [](const Point& p) { return std::hypot(p[0], p[1]); };
  Point far{};
  for (const Point& node : nodes)
    if (const Point p = from_centre(node); size(p) > size(far)) far = p;
  const double half = size(far);
  const Point along{far[0] / half, far[1] / half};
  double off = 0;
  for (const Point& node : nodes) {
    const Point p = from_centre(node);
    off = std::max(off, std::abs(along[0] * p[1] - along[1] * p[0]));
  }
  if (off <= straight * half)
    body.axes = {{along[0] / half, along[1] / half}};
  else
    body.axes = {{1 / half, 0}, {0, 1 / half}};
}

}  // namespace

double lever(const Body& body, std::size_t axis, const Point& x) {
  return body.axes[axis][0] * (x[0] - body.centre[0]) +
         body.axes[axis][1] * (x[1] - body.centre[1]);
}

Bodies find_bodies(const mesh::Mesh& mesh, const Sides& sides) {
  const std::size_t count = mesh.inclusions.size();
  base::UnionFind joined = mesh::join_inclusions(mesh);
  std::vector<Box> box(count);
  std::vector<std::vector<Point>> nodes(count);  // by the first inclusion of the body
  std::vector<std::vector<std::int32_t>> on_dirichlet(count);
  for (const CutEdge& edge : sides.edges) {
    if (edge.inclusion < 0) continue;
    const std::size_t first = at(joined.find(edge.inclusion));
    for (const std::int32_t node : edge.node) {
      box[at(edge.inclusion)].add(mesh::position(mesh, node));
      nodes[first].push_back(mesh::position(mesh, node));
      if (sides.on_dirichlet[at(node)] != 0) on_dirichlet[first].push_back(node);
    }
  }
  Bodies result;
  result.of.resize(count);
  std::vector<std::int32_t> number(count, -1);
  for (std::size_t j = 0; j < count; ++j) {
    if (!std::isfinite(box[j].low[0])) {
      throw errors::Error(errors::Reason::mesh_invalid,
                          "the inclusion \"{}\" has no edge on any interface", mesh.inclusions[j]);
    }
    result.centre.push_back(box[j].centre());
    std::int32_t& body = number[at(joined.find(static_cast<std::int32_t>(j)))];
    if (body < 0) {
      body = static_cast<std::int32_t>(result.bodies.size());
      result.bodies.emplace_back();
    }
    result.of[j] = body;
    result.bodies[at(body)].inclusions.push_back(static_cast<std::int32_t>(j));
    if (!mesh.motions.empty()) hold(result.bodies[at(body)], mesh.motions[j], mesh.inclusions[j]);
  }
  for (Body& body : result.bodies) {
    const std::size_t first = at(body.inclusions.front());
    Box all;
    for (const Point& node : nodes[first]) all.add(node);
    body.centre = all.centre();
    body.on_dirichlet = std::move(on_dirichlet[first]);
    std::ranges::sort(body.on_dirichlet);
    body.on_dirichlet.erase(std::unique(body.on_dirichlet.begin(), body.on_dirichlet.end()),
                            body.on_dirichlet.end());
    const bool tilts = !body.fixed && !mesh.motions.empty() &&
                       std::ranges::all_of(body.inclusions, [&](std::int32_t j) {
                         return mesh.motions[at(j)].tilt;
                       });
    if (tilts) let_tilt(body, nodes[first]);
  }
  return result;
}

}  // namespace anticrack::ddm

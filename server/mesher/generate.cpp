// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/generate.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <numeric>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "errors/errors.hpp"
#include "mesher/size_field.hpp"

namespace anticrack::mesher {
namespace {

using mesh::Plan;
using mesh::PlannedCurve;
using mesh::Point;

constexpr int triangle_type = 2;
constexpr int frontal_delaunay = 6;

/// Frees gmsh's model also when meshing throws.
struct GmshSession {
  GmshSession() {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("General.NumThreads", 1);
  }
  ~GmshSession() { gmsh::finalize(); }
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;
};

/// To a box of about (-1,1)^2, where gmsh's absolute tolerances fit. The factor is a power of two,
/// so it rounds nothing; the square of the paper stays as it is.
class Frame {
 public:
  explicit Frame(const std::vector<Point>& points) {
    Point low = points.at(0);
    Point high = low;
    for (const Point& p : points) {
      for (std::size_t i = 0; i < 2; ++i) {
        low[i] = std::min(low[i], p[i]);
        high[i] = std::max(high[i], p[i]);
      }
    }
    for (std::size_t i = 0; i < 2; ++i) _centre[i] = low[i] + (high[i] - low[i]) / 2;
    const double extent = std::max(high[0] - low[0], high[1] - low[1]);
    _exponent = static_cast<int>(std::lround(std::log2(extent / 2)));
  }
  Point to_gmsh(const Point& p) const {
    return {std::ldexp(p[0] - _centre[0], -_exponent), std::ldexp(p[1] - _centre[1], -_exponent)};
  }
  Point from_gmsh(double x, double y) const {
    return {std::ldexp(x, _exponent) + _centre[0], std::ldexp(y, _exponent) + _centre[1]};
  }

 private:
  Point _centre{};
  int _exponent = 0;
};

/// gmsh's tags are indices + 1: points as in the plan; curves of the interface first, then the
/// outer ones of subdomain 0 and 1; surfaces as subdomains.
int first_outer_tag(const Plan& plan, std::size_t subdomain) {
  const std::size_t before = plan.interface.size() + (subdomain == 1 ? plan.outer[0].size() : 0);
  return static_cast<int>(before) + 1;
}

void build_model(const Plan& plan, const Frame& frame) {
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    const Point p = frame.to_gmsh(plan.points[i]);
    gmsh::model::geo::addPoint(p[0], p[1], 0, 0, static_cast<int>(i) + 1);
  }
  const auto add_line = [](const PlannedCurve& curve, int tag) {
    gmsh::model::geo::addLine(curve.a + 1, curve.b + 1, tag);
    gmsh::model::geo::mesh::setTransfiniteCurve(tag, curve.intervals + 1);
  };
  int tag = 1;
  for (const auto& curve : plan.interface) add_line(curve, tag++);
  for (const auto& outer : plan.outer) {
    for (const PlannedCurve& curve : outer) add_line(curve, tag++);
  }
  const auto interface_curves = static_cast<int>(plan.interface.size());
  for (std::size_t side = 0; side < 2; ++side) {
    std::vector<int> loop;
    // counterclockwise: the minus side has the interface backwards
    for (int i = 1; i <= interface_curves; ++i) {
      loop.push_back(side == 1 ? i : -(interface_curves + 1 - i));
    }
    const int first = first_outer_tag(plan, side);
    for (int i = 0; i < static_cast<int>(plan.outer[side].size()); ++i) loop.push_back(first + i);
    const int surface = static_cast<int>(side) + 1;
    gmsh::model::geo::addCurveLoop(loop, surface);
    gmsh::model::geo::addPlaneSurface({surface}, surface);
  }
  gmsh::model::geo::synchronize();
}

SizeField size_field(const Plan& plan, const Frame& frame) {
  std::vector<SizedCurve> curves;
  const auto add = [&](const PlannedCurve& planned) {
    const Point a = frame.to_gmsh(plan.points[static_cast<std::size_t>(planned.a)]);
    const Point b = frame.to_gmsh(plan.points[static_cast<std::size_t>(planned.b)]);
    curves.push_back({a, b, std::hypot(b[0] - a[0], b[1] - a[1]) / planned.intervals});
  };
  for (const auto& curve : plan.interface) add(curve);
  for (const auto& outer : plan.outer) {
    for (const PlannedCurve& curve : outer) add(curve);
  }
  return {std::move(curves), plan.growth};
}

void choose_options(const SizeField& size) {
  gmsh::option::setNumber("Mesh.Algorithm", frontal_delaunay);
  gmsh::option::setNumber("Mesh.MeshSizeFromPoints", 0);
  gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);
  gmsh::option::setNumber("Mesh.RandomSeed", 1);
  gmsh::model::mesh::setSizeCallback([size](int, int, double x, double y, double) {
    return size({x, y});
  });
}

/// Collects gmsh's nodes into a mesh, numbered in the order they are asked for.
class Nodes {
 public:
  Nodes(mesh::Mesh& mesh, const Frame& frame) : _mesh(mesh) {
    std::vector<double> parameters;
    gmsh::model::mesh::getNodes(_tags, _xyz, parameters);
    for (std::size_t i = 0; i < _tags.size(); ++i) _place.emplace(_tags[i], i);
    _index.assign(_tags.size(), -1);
    _frame = &frame;
  }
  std::int32_t operator()(std::size_t tag) {
    std::int32_t& index = _index[_place.at(tag)];
    if (index < 0) {
      const std::size_t i = 3 * _place.at(tag);
      index = put(_frame->from_gmsh(_xyz[i], _xyz[i + 1]));
    }
    return index;
  }
  /// The node a curve has at this place, which we know better than gmsh.
  std::int32_t at(std::size_t tag, const Point& p) {
    std::int32_t& index = _index[_place.at(tag)];
    if (index < 0) index = put(p);
    return index;
  }

 private:
  std::int32_t put(const Point& p) {
    _mesh.xy.push_back(p[0]);
    _mesh.xy.push_back(p[1]);
    return static_cast<std::int32_t>(_mesh.node_count()) - 1;
  }

  mesh::Mesh& _mesh;
  const Frame* _frame = nullptr;
  std::vector<std::size_t> _tags;
  std::vector<double> _xyz;
  std::unordered_map<std::size_t, std::size_t> _place;
  std::vector<std::int32_t> _index;
};

std::size_t point_tag(int point) {
  std::vector<std::size_t> tags;
  std::vector<double> xyz;
  std::vector<double> parameters;
  gmsh::model::mesh::getNodes(tags, xyz, parameters, 0, point + 1);
  if (tags.size() != 1) {
    throw errors::Error(errors::Reason::mesher_failed,
                        "gmsh made no node for vertex " + std::to_string(point));
  }
  return tags[0];
}

/// All nodes of a curve in order from a to b.
std::vector<std::int32_t> curve_nodes(const Plan& plan, const PlannedCurve& curve, int tag,
                                      Nodes& nodes) {
  std::vector<std::size_t> tags;
  std::vector<double> xyz;
  std::vector<double> parameters;
  gmsh::model::mesh::getNodes(tags, xyz, parameters, 1, tag);
  if (tags.size() + 1 != static_cast<std::size_t>(curve.intervals) ||
      parameters.size() != tags.size()) {
    throw errors::Error(errors::Reason::mesher_failed,
                        "gmsh cut a curve of " + std::to_string(curve.intervals) +
                            " intervals at " + std::to_string(tags.size()) + " places");
  }
  std::vector<std::size_t> order(tags.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return parameters[i] < parameters[j]; });
  const Point& a = plan.points[static_cast<std::size_t>(curve.a)];
  const Point& b = plan.points[static_cast<std::size_t>(curve.b)];
  std::vector<std::int32_t> chain{nodes.at(point_tag(curve.a), a)};
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto part = static_cast<double>(k + 1) / curve.intervals;
    chain.push_back(
        nodes.at(tags[order[k]], {a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part}));
  }
  chain.push_back(nodes.at(point_tag(curve.b), b));
  return chain;
}

mesh::Interface read_interface(const Plan& plan, Nodes& nodes) {
  mesh::Interface interface;
  interface.name = "interface";
  int tag = 1;
  for (const auto& curve : plan.interface) {
    const auto chain = curve_nodes(plan, curve, tag++, nodes);
    const auto first = chain.begin() + (interface.nodes.empty() ? 0 : 1);
    interface.nodes.insert(interface.nodes.end(), first, chain.end());
    const auto edges = static_cast<std::size_t>(curve.intervals);
    interface.kind.insert(interface.kind.end(), edges, curve.kind);
    interface.inclusion.insert(interface.inclusion.end(), edges, curve.inclusion);
  }
  return interface;
}

void read_triangles(mesh::Mesh& mesh, std::int32_t subdomain, Nodes& nodes) {
  std::vector<std::size_t> elements;
  std::vector<std::size_t> corners;
  gmsh::model::mesh::getElementsByType(triangle_type, elements, corners, subdomain + 1);
  for (const std::size_t tag : corners) mesh.triangles.push_back(nodes(tag));
  mesh.subdomain.insert(mesh.subdomain.end(), elements.size(), subdomain);
}

/// gmsh orients a plane surface by its own rules.
void orient(mesh::Mesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (mesh::area(mesh, t) < 0) std::swap(mesh.triangles[3 * t + 1], mesh.triangles[3 * t + 2]);
  }
}

mesh::Mesh read_mesh(const Plan& plan, const Frame& frame) {
  mesh::Mesh mesh;
  mesh.subdomains = {"minus", "plus"};
  mesh.inclusions = plan.inclusions;
  Nodes nodes(mesh, frame);
  mesh.interfaces.push_back(read_interface(plan, nodes));
  for (std::size_t side = 0; side < 2; ++side) {
    int tag = first_outer_tag(plan, side);
    for (const PlannedCurve& curve : plan.outer[side]) {
      const auto chain = curve_nodes(plan, curve, tag++, nodes);
      for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
        mesh.dirichlet.push_back({chain[i], chain[i + 1]});
      }
    }
  }
  for (std::int32_t side = 0; side < 2; ++side) read_triangles(mesh, side, nodes);
  orient(mesh);
  return mesh;
}

}  // namespace

mesh::Mesh generate(const mesh::GenerateRequest& request) {
  const GmshSession session;
  const Frame frame(request.plan.points);
  try {
    build_model(request.plan, frame);
    choose_options(size_field(request.plan, frame));
    gmsh::model::mesh::generate(2);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    throw errors::Error(errors::Reason::mesher_failed,
                        std::string("gmsh could not mesh this geometry: ") + e.what());
  }
  mesh::Mesh mesh = read_mesh(request.plan, frame);
  if (mesh.triangle_count() > request.max_triangles) {
    throw errors::Error(errors::Reason::limit_exceeded,
                        "the mesh has " + std::to_string(mesh.triangle_count()) +
                            " triangles; at most " + std::to_string(request.max_triangles) +
                            " are taken, so choose a coarser one")
        .at("options.size");
  }
  return mesh;
}

}  // namespace anticrack::mesher

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/generate.hpp"

#include <fmt/core.h>

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <numeric>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mesh/edges.hpp"
#include "mesh/geometry_steps.hpp"
#include "mesh/refine_uniform.hpp"
#include "mesher/coarsening.hpp"
#include "mesher/messages.hpp"
#include "mesher/restrict.hpp"
#include "mesher/size_field.hpp"
#include "stop/stop.hpp"

namespace anticrack::mesher {
namespace {

using mesh::Plan;
using mesh::PlannedCurve;
using mesh::Point;

constexpr int triangle_type = 2;
constexpr int delaunay = 5;
constexpr int frontal_delaunay = 6;

/// With so many intervals most triangles are small and near lines, and Delaunay makes triangles as
/// good in two thirds of the time.
constexpr int many_intervals = 8'000;

template <class... Values>
[[noreturn]] void fail(fmt::format_string<Values...> message, Values&&... values) {
  throw errors::Error(errors::Reason::mesher_failed,
                      fmt::format(message, std::forward<Values>(values)...));
}

[[noreturn]] void gave_up(const std::string& what) {
  fail(
      "gmsh could not mesh this geometry: {}; choose another options.size, or remove details far "
      "smaller than the rest",
      what);
}

/// Converts between the user's coordinates and gmsh's: scales to a box of about (-1,1)^2, for
/// gmsh's absolute tolerances. The factor is a power of two, so nothing is rounded; the paper's
/// square does not change.
class Frame {
 public:
  /// The frame of the bounding box of `points`, at least one.
  explicit Frame(const std::vector<mesh::Point>& points) {
    mesh::Point low = points.at(0);
    mesh::Point high = low;
    for (const mesh::Point& p : points) {
      for (std::size_t i = 0; i < 2; ++i) {
        low[i] = std::min(low[i], p[i]);
        high[i] = std::max(high[i], p[i]);
      }
    }
    for (std::size_t i = 0; i < 2; ++i) _centre[i] = low[i] + (high[i] - low[i]) / 2;
    const double extent = std::max(high[0] - low[0], high[1] - low[1]);
    _exponent = static_cast<int>(std::lround(std::log2(extent / 2)));
  }
  /// Converts from the user's coordinates.
  mesh::Point to_gmsh(const mesh::Point& p) const {
    return {std::ldexp(p[0] - _centre[0], -_exponent), std::ldexp(p[1] - _centre[1], -_exponent)};
  }
  /// Converts to the user's coordinates.
  mesh::Point from_gmsh(double x, double y) const {
    return {std::ldexp(x, _exponent) + _centre[0], std::ldexp(y, _exponent) + _centre[1]};
  }

 private:
  mesh::Point _centre{};
  int _exponent = 0;
};

/// The tag of a point, curve or face in gmsh: its index + 1.
int tag_of(std::size_t index) { return static_cast<int>(index) + 1; }

/// Makes the loop begin at its first interface. gmsh's mesh depends on where a loop begins; it must
/// not depend on which vertex of the boundary the user wrote first.
std::vector<int> begun_at_interface(const Plan& plan, std::vector<int> loop) {
  const auto on_interface = [&](int curve) {
    return plan.curves[at(std::abs(curve)) - 1].role == mesh::Role::interface;
  };
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (!on_interface(loop[i]) || on_interface(loop[(i + loop.size() - 1) % loop.size()])) continue;
    std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(i), loop.end());
    break;
  }
  return loop;
}

void add_face(const Plan& plan, const mesh::PlannedFace& face, int tag, int& loops) {
  std::vector<int> bounds;
  const auto add_loop = [&](const std::vector<int>& curves) {
    bounds.push_back(++loops);
    gmsh::model::geo::addCurveLoop(begun_at_interface(plan, curves), loops);
  };
  add_loop(face.outer);
  for (const auto& hole : face.holes) add_loop(hole);
  gmsh::model::geo::addPlaneSurface(bounds, tag);
}

void build_model(const Plan& plan, const Frame& frame) {
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    const Point p = frame.to_gmsh(plan.points[i]);
    gmsh::model::geo::addPoint(p[0], p[1], 0, 0, tag_of(i));
  }
  for (std::size_t i = 0; i < plan.curves.size(); ++i) {
    const PlannedCurve& curve = plan.curves[i];
    gmsh::model::geo::addLine(curve.a + 1, curve.b + 1, tag_of(i));
    gmsh::model::geo::mesh::setTransfiniteCurve(tag_of(i), curve.intervals + 1);
  }
  int loops = 0;
  for (std::size_t i = 0; i < plan.faces.size(); ++i)
    add_face(plan, plan.faces[i], tag_of(i), loops);
  gmsh::model::geo::synchronize();
  for (std::size_t i = 0; i < plan.faces.size(); ++i) {
    std::vector<int> embedded;
    embedded.reserve(plan.faces[i].embedded.size());
    for (const int curve : plan.faces[i].embedded) embedded.push_back(curve + 1);
    if (!embedded.empty()) gmsh::model::mesh::embed(1, embedded, 2, tag_of(i));
  }
}

std::vector<SizedCurve> sized_curves(const Plan& plan, const Frame& frame) {
  std::vector<SizedCurve> curves;
  curves.reserve(plan.curves.size());
  for (const PlannedCurve& curve : plan.curves) {
    const Point a = frame.to_gmsh(plan.points[at(curve.a)]);
    const Point b = frame.to_gmsh(plan.points[at(curve.b)]);
    curves.push_back({a, b, std::hypot(b[0] - a[0], b[1] - a[1]) / curve.intervals});
  }
  return curves;
}

/// For its first triangulation gmsh moves points at random by this fraction of the box. It must be
/// far below the shortest interval, or nodes on a straight line form triangles. Below 1e-13 gmsh
/// fails for points on a line.
double random_factor(const std::vector<SizedCurve>& curves) {
  constexpr double gmsh_default = 1e-9;
  double shortest = curves.front().size;
  for (const SizedCurve& curve : curves) shortest = std::min(shortest, curve.size);
  return std::clamp(1e-6 * shortest, 1e-13, gmsh_default);
}

int algorithm_of(const Plan& plan) {
  std::int64_t intervals = 0;
  for (const PlannedCurve& curve : plan.curves) intervals += curve.intervals;
  return intervals < many_intervals ? frontal_delaunay : delaunay;
}

void choose_options(int algorithm, std::vector<SizedCurve> curves, double growth) {
  gmsh::option::setNumber("Mesh.Algorithm", algorithm);
  gmsh::option::setNumber("Mesh.MeshSizeFromPoints", 0);
  gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);
  gmsh::option::setNumber("Mesh.RandomSeed", 1);
  gmsh::option::setNumber("Mesh.RandomFactor", random_factor(curves));
  const SizeField size(std::move(curves), growth);
  // Newer versions of gmsh give one more argument, the size they would have chosen.
  gmsh::model::mesh::setSizeCallback(
      [size, nodes = std::size_t{0}](int, int, double x, double y, auto...) mutable {
        // gmsh asks once for each node, and there are two triangles for each node.
        ++nodes;
        stop::look_at_turn<256>(nodes, "generating a mesh", 2 * nodes);
        return size({x, y});
      });
}

/// Numbers gmsh's nodes in the order of their first use and adds them to a mesh.
class Nodes {
 public:
  Nodes(mesh::Mesh& mesh, const Frame& frame) : _mesh(mesh), _frame(frame) {
    std::vector<double> parameters;
    gmsh::model::mesh::getNodes(_tags, _xyz, parameters);
    for (std::size_t i = 0; i < _tags.size(); ++i) _place.emplace(_tags[i], i);
    _index.assign(_tags.size(), -1);
  }
  std::int32_t operator()(std::size_t tag) {
    const std::size_t i = 3 * _place.at(tag);
    return with_place(tag, _frame.from_gmsh(_xyz[i], _xyz[i + 1]));
  }
  /// The same; a new node gets the exact place `p`.
  std::int32_t with_place(std::size_t tag, const Point& p) {
    std::int32_t& index = _index[_place.at(tag)];
    if (index < 0) {
      index = static_cast<std::int32_t>(_mesh.node_count());
      _mesh.xy.insert(_mesh.xy.end(), p.begin(), p.end());
    }
    return index;
  }

 private:
  mesh::Mesh& _mesh;
  const Frame& _frame;
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
  if (tags.size() != 1) fail("gmsh made no node for vertex {}", point);
  return tags[0];
}

/// All nodes of a curve in order from a to b.
std::vector<std::int32_t> curve_nodes(const Plan& plan, std::size_t index, Nodes& nodes) {
  const PlannedCurve& curve = plan.curves[index];
  std::vector<std::size_t> tags;
  std::vector<double> xyz;
  std::vector<double> parameters;
  gmsh::model::mesh::getNodes(tags, xyz, parameters, 1, tag_of(index));
  if (tags.size() + 1 != at(curve.intervals) || parameters.size() != tags.size())
    fail("gmsh cut a curve of {} intervals at {} places", curve.intervals, tags.size());
  std::vector<std::size_t> order(tags.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return parameters[i] < parameters[j]; });
  const Point& a = plan.points[at(curve.a)];
  const Point& b = plan.points[at(curve.b)];
  std::vector<std::int32_t> chain{nodes.with_place(point_tag(curve.a), a)};
  chain.reserve(order.size() + 2);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto part = static_cast<double>(k + 1) / curve.intervals;
    chain.push_back(nodes.with_place(tags[order[k]],
                                     {a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part}));
  }
  chain.push_back(nodes.with_place(point_tag(curve.b), b));
  return chain;
}

mesh::Interface read_interface(const Plan& plan, const mesh::PlannedInterface& planned,
                               const std::vector<std::vector<std::int32_t>>& chains) {
  mesh::Interface interface;
  interface.name = planned.name;
  for (const int index : planned.curves) {
    const PlannedCurve& curve = plan.curves[at(index)];
    const auto& chain = chains[at(index)];
    const auto first = chain.begin() + (interface.nodes.empty() ? 0 : 1);
    interface.nodes.insert(interface.nodes.end(), first, chain.end());
    const auto edges = at(curve.intervals);
    interface.kind.insert(interface.kind.end(), edges, curve.kind);
    interface.inclusion.insert(interface.inclusion.end(), edges, curve.inclusion);
  }
  return interface;
}

/// Adds the subdomains and returns that of each face; faces with the same name share one.
std::vector<std::int32_t> name_subdomains(const Plan& plan, mesh::Mesh& mesh) {
  std::vector<std::int32_t> subdomain_of;
  subdomain_of.reserve(plan.faces.size());
  for (const mesh::PlannedFace& face : plan.faces) {
    const auto known = std::find(mesh.subdomains.begin(), mesh.subdomains.end(), face.name);
    subdomain_of.push_back(static_cast<std::int32_t>(known - mesh.subdomains.begin()));
    if (known != mesh.subdomains.end()) continue;
    mesh.subdomains.push_back(face.name);
    mesh.tension.push_back(face.tension);
    mesh.tension_laws.push_back(face.law);
  }
  const auto none = [](const mesh::TensionLaw& law) { return law == mesh::TensionLaw(); };
  if (std::ranges::all_of(mesh.tension_laws, none)) mesh.tension_laws.clear();
  return subdomain_of;
}

void read_triangles(mesh::Mesh& mesh, int face_tag, std::int32_t subdomain, Nodes& nodes) {
  std::vector<std::size_t> elements;
  std::vector<std::size_t> corners;
  gmsh::model::mesh::getElementsByType(triangle_type, elements, corners, face_tag);
  mesh.triangles.reserve(mesh.triangles.size() + corners.size());
  for (const std::size_t tag : corners) mesh.triangles.push_back(nodes(tag));
  mesh.subdomain.insert(mesh.subdomain.end(), elements.size(), subdomain);
}

/// Makes all triangles counterclockwise: gmsh chooses the orientation of a plane surface.
void orient(mesh::Mesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    if (mesh::area(mesh, t) < 0) std::swap(mesh.triangles[3 * t + 1], mesh.triangles[3 * t + 2]);
}

/// gmsh may drop an embedded curve that it cannot recover, and only logs it.
void require_curves(const mesh::Mesh& mesh, const Plan& plan,
                    const std::vector<std::vector<std::int32_t>>& chains) {
  const mesh::EdgeTable edges(mesh.triangles);
  for (std::size_t i = 0; i < chains.size(); ++i) {
    const bool inside = plan.curves[i].left >= 0 && plan.curves[i].right >= 0;
    for (std::size_t k = 0; k + 1 < chains[i].size(); ++k) {
      if (edges.find(chains[i][k], chains[i][k + 1]).size() == (inside ? 2U : 1U)) continue;
      const Point& p = plan.points[at(plan.curves[i].a)];
      const Point& q = plan.points[at(plan.curves[i].b)];
      fail(
          "gmsh made no edges along the line from ({:g}, {:g}) to ({:g}, {:g}); choose a smaller "
          "options.size, or move what is close to it",
          p[0], p[1], q[0], q[1]);
    }
  }
}

/// Curves of one side follow each other.
void add_to_parts(const Plan& plan, std::size_t curve, const std::vector<std::int32_t>& chain,
                  std::vector<mesh::BoundaryPart>& parts) {
  const int side = plan.curves[curve].side;
  if (side < 0) return;
  if (curve > 0 && plan.curves[curve - 1].side == side)
    parts.back().last = chain.back();
  else
    parts.push_back({plan.sides[at(side)], chain.front(), chain.back()});
}

mesh::Mesh read_mesh(const Plan& plan, const Frame& frame) {
  mesh::Mesh mesh;
  mesh.inclusions = plan.inclusions;
  mesh.motions = plan.motions;
  mesh.warnings = plan.warnings;
  Nodes nodes(mesh, frame);
  std::vector<std::vector<std::int32_t>> chains;
  chains.reserve(plan.curves.size());
  for (std::size_t i = 0; i < plan.curves.size(); ++i) {
    chains.push_back(curve_nodes(plan, i, nodes));
    add_to_parts(plan, i, chains.back(), mesh.boundary_parts);
    if (plan.curves[i].role != mesh::Role::dirichlet) continue;
    for (std::size_t k = 0; k + 1 < chains[i].size(); ++k)
      mesh.dirichlet.push_back({chains[i][k], chains[i][k + 1]});
  }
  for (const mesh::PlannedInterface& planned : plan.interfaces)
    mesh.interfaces.push_back(read_interface(plan, planned, chains));
  mesh.bends = plan.bends;
  for (std::size_t i = 0; i < plan.curves.size(); ++i) {
    const PlannedCurve& curve = plan.curves[i];
    if (curve.bend < 0) continue;
    const bool whole = curve.bends() && curve.intervals == 1;
    const double chord = whole ? 0 : curve.chord > 0 ? curve.chord : mesh::length_of(plan, curve);
    const double turn = (curve.to - curve.from) / curve.intervals;
    for (int k = 0; k < curve.intervals; ++k)
      mesh.bent.push_back({chains[i][at(k)], chains[i][at(k + 1)], curve.bend,
                           curve.from + k * turn, curve.from + (k + 1) * turn, chord});
  }
  const std::vector<std::int32_t> subdomain_of = name_subdomains(plan, mesh);
  for (std::size_t i = 0; i < plan.faces.size(); ++i)
    read_triangles(mesh, tag_of(i), subdomain_of[i], nodes);
  orient(mesh);
  require_curves(mesh, plan, chains);
  return mesh;
}

}  // namespace

Gmsh::Gmsh() {
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.NumThreads", 1);
  // the progress meter makes a system call that the filter forbids
  gmsh::option::setNumber("General.ProgressMeterStep", 0);
}

Gmsh::~Gmsh() {
  // finalize() would remove files; the process ends anyway, but a sanitizer would report leaks
  if (sanitized) gmsh::finalize();
}

mesh::Mesh generate(const Gmsh& /*its presence is needed*/, const mesh::GenerateRequest& request) {
  const int halvings = mesher::halvings(request.plan);
  const Plan plan = coarsened(request.plan, halvings);
  const Frame frame(plan.points);
  try {
    stop::look("generating a mesh");  // gmsh may take long before it asks for the first size
    build_model(plan, frame);
    choose_options(algorithm_of(plan), sized_curves(plan, frame), plan.growth);
    gmsh::model::mesh::generate(2);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::string& what) {  // this is how gmsh reports errors
    gave_up(what);
  } catch (const std::exception& error) {
    gave_up(error.what());
  }
  mesh::Mesh mesh = read_mesh(plan, frame);
  const std::size_t triangles = mesh.triangle_count() << (2 * halvings);
  if (triangles > request.max_triangles) {
    throw errors::Error(errors::Reason::limit_exceeded,
                        "the mesh has {} triangles, at most {} are allowed; choose a "
                        "coarser one",
                        triangles, request.max_triangles)
        .at("options.size");
  }
  for (int i = 0; i < halvings; ++i) mesh = mesh::refine_uniform(mesh);
  for (const mesh::BentEdge& edge : mesh.bent)
    mesh.chords.push_back(mesh::chord_edge(edge, mesh.bends[at(edge.bend)],
                                           mesh::position(mesh, edge.a),
                                           mesh::position(mesh, edge.b)));
  return mesh;
}

}  // namespace anticrack::mesher

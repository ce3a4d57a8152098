// SPDX-License-Identifier: GPL-3.0-or-later
#include "growth/preview.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/at.hpp"
#include "contact/answer.hpp"
#include "contact/trace_problem.hpp"
#include "ddm/decomposition.hpp"
#include "errors/errors.hpp"
#include "growth/held.hpp"
#include "mesh/refine.hpp"
#include "stop/stop.hpp"
#include "tips/tips.hpp"

namespace anticrack::growth {
namespace {

using Eigen::VectorXd;
using errors::Error;
using errors::Reason;
using mesh::Point;

/// Two directions that differ by less are one.
constexpr double same_direction = 1e-6;

constexpr int most_steps = 1000;

double distance(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

}  // namespace

Preview::Preview(const contact::ContactProblem& problem, const mesh::Mesh& mesh, PreviewLoad load,
                 std::span<const Path> paths, const PreviewLoad* dead)
    : _problem(problem),
      _mesh(mesh),
      _decomposition(problem.traces().decomposition()),
      _load(std::move(load)),
      _dead(dead),
      _fronts(find_fronts(mesh, paths)),
      _edges(mesh.triangles),
      _ends(mesh::edge_ends(mesh, _edges)),
      _around(mesh, _edges, _ends),
      _laws(tips::laws_of(mesh)),
      _cells(tips::cells_of(mesh, _decomposition)),
      _live(loaded(_load)),
      _tied(_decomposition.skeleton.independent, 0) {
  std::vector<std::int32_t> held;
  for (const Stretch& stretch : _fronts.stretches) {
    const std::vector<std::int32_t>& nodes = line_of(stretch).nodes;
    if (stretch.holds_before) held.push_back(nodes[stretch.first]);
    if (stretch.holds_beyond) held.push_back(nodes[stretch.last]);
  }
  for (const std::int32_t node : mesh::tips(mesh))
    if (std::ranges::find(held, node) == held.end()) _tips.push_back(mesh::position(mesh, node));
  if (_dead != nullptr) {
    require_scalable();
    for (std::size_t s = 0; s < _load.loads.subdomains.size(); ++s)
      _products.push_back(
          ddm::products(std::array{&_dead->loads.subdomains[s], &_load.loads.subdomains[s]}));
    _dead_alone = loaded(*_dead);
    _both = together(1);
  }
  const State first = first_state();
  for (std::size_t i = 0; i < _fronts.fronts.size(); ++i) {
    const Place& here = place(i, 0);
    const double enough = least_radius * here.edge, found = room(i, first);
    if (found >= enough) continue;
    throw Error(
        Reason::invalid_argument,
        "the front at {} has {} only {} away, and G takes a radius of {}, ten edges: take a "
        "finer mesh along the path",
        errors::shown(here.course.tip[0], here.course.tip[1]),
        found < here.radius ? "another front or point force" : here.reason, errors::shown(found),
        errors::shown(enough))
        .at(fmt::format("paths[{}]", _fronts.fronts[i].stretch));
  }
}

Preview::Loaded Preview::loaded(const PreviewLoad& load) const {
  Loaded result;
  result.loads = load.loads;
  result.force = load.force;
  finish(result);
  return result;
}

/// Reduces it, its loads being set.
void Preview::finish(Loaded& load) const {
  const auto subdomains = load.loads.subdomains;
  load.reduced = _problem.reduce(subdomains, contact::held_values(_decomposition, subdomains));
  const contact::Work closed = _problem.work(subdomains, load.reduced);
  load.closed_energy = closed.u.dot(closed.internal) / 2 - closed.u.dot(closed.load);
  for (const ddm::CondensedLoad& one : subdomains) load.closed_energy += one.energy_constant;
}

std::vector<Track> Preview::tracks() const {
  std::vector<Track> tracks;
  for (const Front& front : _fronts.fronts) tracks.push_back(front.track);
  return tracks;
}

struct Preview::Solution {
  contact::LcpAnswer contact;
  contact::Answer answer;  ///< fields and the motions of inclusions
  double energy = 0;
};

std::vector<contact::TipAnswer> Preview::ends() {
  std::vector<contact::TipAnswer> ends(_fronts.fronts.size());
  if (std::ranges::none_of(_fronts.fronts, &Front::leaves)) return ends;
  if (_dead != nullptr) {
    for (contact::TipAnswer& end : ends)
      end.reason = "a dead load does not scale: where it opens the end, it starts the crack";
    return ends;
  }
  Fronts whole = _fronts;
  for (const Front& front : _fronts.fronts)
    if (front.leaves()) {
      Stretch& stretch = whole.stretches[front.stretch];
      (front.forward ? stretch.first : stretch.last) = at(front.end);
    }
  const State first = first_state();
  tie(whole.stretches, first);
  const tips::Tips tips(mesh_of(_mesh, whole, first), _decomposition);
  const tips::Solved solved{solve(_live).answer, _load.force, _load.point_forces};
  const std::vector<contact::TipAnswer> rows = tips.without_numbers({});
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const Front& front = _fronts.fronts[i];
    if (!front.leaves()) continue;
    const Point x =
        mesh::position(_mesh, line_of(_fronts.stretches[front.stretch]).nodes[at(front.end)]);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (rows[k].x != x[0] || rows[k].y != x[1]) continue;
      ends[i] = rows[k];
      ends[i].reason = tips.obstacle(k, _load.point_forces);
      if (ends[i].reason.empty()) ends[i] = tips.told(k, tips.integrals(k, solved), false);
    }
  }
  return ends;
}

/// Independent contacts of an interface node.
std::vector<std::int32_t> Preview::contacts_at(const Stretch& stretch, std::size_t node) const {
  const ddm::SidePair& sides = _decomposition.interface_sides[stretch.interface][node];
  if (sides.pair < 0) return {};
  const std::int32_t contact = _decomposition.pairs[at(sides.pair)].contact;
  if (contact < 0 || at(contact) >= _decomposition.skeleton.independent) return {};
  return {contact};
}

const Preview::Place& Preview::place(std::size_t front, std::size_t position) {
  const auto [found, added] = _places.try_emplace({front, position});
  if (added) found->second = find_place(_fronts.fronts[front], position);
  return found->second;
}

Preview::Place Preview::find_place(const Front& front, std::size_t position) const {
  const Stretch& stretch = _fronts.stretches[front.stretch];
  const mesh::Interface& line = line_of(stretch);
  const std::size_t here = front.node(stretch, position);
  const auto node = [&](std::size_t i) { return mesh::position(_mesh, line.nodes[i]); };
  const std::size_t behind = front.forward ? here - 1 : here + 1;
  Place result;
  result.course.tip = node(here);
  result.edge = distance(node(here), node(behind));
  const Point back = tips::minus(node(behind), node(here));
  result.course.ahead = {-back[0] / result.edge, -back[1] / result.edge};
  // The plus side is on the left of the interface.
  const Point& t = result.course.ahead;
  result.course.normal = front.forward ? Point{-t[1], t[0]} : Point{t[1], -t[0]};
  // Towards the end of a path that holds the mesh is graded: edges at the end are too short for G.
  const double shortest = result.edge;
  if (front.forward ? here == stretch.last && stretch.holds_beyond
                    : here == stretch.first && stretch.holds_before)
    for (std::size_t i = stretch.first; i < stretch.last; ++i) {
      const double edge = distance(node(i), node(i + 1));
      const double far = distance(node(front.forward ? i : i + 1), node(here));
      if (far <= radius * edge) result.edge = std::max(result.edge, edge);
    }
  const std::size_t own = std::min(here, behind);
  result.inclusion = line.inclusion[own];
  if (const auto contacts = contacts_at(stretch, behind); !contacts.empty())
    result.behind = contacts.front();

  tips::Place around;
  around.node = line.nodes[here];
  around.course = result.course;
  around.reach = radius * result.edge;
  for (const int way : {-1, 1}) {
    double gone = 0;
    const double sign = (way > 0) == front.forward ? 1 : -1;
    for (auto i = static_cast<std::ptrdiff_t>(here); gone < around.reach; i += way) {
      const std::ptrdiff_t next = i + way;
      if (next < 0 || at(next) >= line.nodes.size()) break;
      const Point to = tips::minus(node(at(next)), result.course.tip);
      const double far = std::hypot(to[0], to[1]);
      if (distance({sign * to[0] / far, sign * to[1] / far}, result.course.ahead) >
          same_direction) {
        around.reach = std::min(around.reach, gone);
        result.reason = "a bend of its path, as on a curve,";
        break;
      }
      const auto [low, high] = std::minmax(line.nodes[at(i)], line.nodes[at(next)]);
      around.edges.push_back({low, high});
      gone = far;
      if (next == static_cast<std::ptrdiff_t>(here)) break;  // round a closed line
    }
  }
  for (const Point& tip : _tips) {
    const double far = distance(tip, result.course.tip);
    if (far >= around.reach) continue;
    around.reach = far;
    result.reason = "a tip that does not move";
  }
  std::ranges::sort(around.edges);
  take_surroundings(result, std::move(around));
  result.edge = std::clamp(result.radius / radius, shortest, result.edge);
  return result;
}

/// Sets what the integral needs.
void Preview::take_surroundings(Place& place, tips::Place around) const {
  tips::Surroundings::Marks marks;
  const tips::Support support = _around.of(around, marks);
  if (support.radius < around.reach) place.reason = "a boundary or another line";
  place.radius = support.radius;
  for (const PreviewLoad* const load : {&_load, _dead}) {
    if (load == nullptr) continue;
    for (const Point& force : load->point_forces) {
      const double far = distance(force, place.course.tip);
      if (far >= place.radius) continue;
      place.radius = far;
      place.reason = "a point force";
    }
  }
  bool varies = false;
  for (const std::int32_t t : support.triangles) {
    const auto s = at(_mesh.subdomain[at(t)]);
    if (_laws[s].varies() && _laws[s].may_jump()) {
      throw Error(Reason::invalid_argument,
                  "the tension of \"{}\" may jump or bend near a path: write it without "
                  "conditions, abs, min, max and steps, or make regions of its parts",
                  _mesh.subdomains[s]);
    }
    varies = varies || _laws[s].varies();
    place.cells.push_back(_cells[at(t)]);
  }
  if (!varies) return;
  for (const tips::Cell& cell : place.cells) {
    const fem::Triangulation& part = _decomposition.subdomains[at(cell.subdomain)].part;
    std::array<Point, 3> x{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto n = at(part.triangles[3 * at(cell.triangle) + i]);
      x[i] = {part.xy[2 * n], part.xy[2 * n + 1]};
    }
    place.change.push_back(tips::change_of(_laws[at(cell.subdomain)], place.course,
                                           tips::corners_of(x), place.radius));
  }
}

/// The radius within which nothing but the front's own path is, other fronts included.
double Preview::room(std::size_t front, const State& state) {
  const Place& own = place(front, state.at[front]);
  double room = own.radius;
  for (std::size_t i = 0; i < _fronts.fronts.size(); ++i) {
    if (i == front || state.fate[i] == Fate::snapped) continue;
    room = std::min(room, distance(place(i, state.at[i]).course.tip, own.course.tip));
  }
  return room;
}

State Preview::first_state() const {
  return {std::vector<std::size_t>(_fronts.fronts.size(), 0),
          std::vector<Fate>(_fronts.fronts.size(), Fate::grows)};
}

/// Ties what holds on the paths.
void Preview::tie(std::span<const Stretch> stretches, const State& state) {
  std::ranges::fill(_tied, 0);
  for (const Stretch& stretch : stretches)
    if (const std::optional<Held> here = held(stretch, state))
      for (std::size_t i = here->first; i <= here->last; ++i)
        for (const std::int32_t contact : contacts_at(stretch, i)) _tied[at(contact)] = 1;
}

contact::Answer Preview::answer(const State& state, const contact::ActiveSetOptions& options,
                                contact::Observer& observer) {
  tie(_fronts.stretches, state);
  return contact::solve_active_set(_problem, _mesh, _dead == nullptr ? _live.loads : _both.loads,
                                   options, false, observer, {}, _tied);
}

/// Solves with what is tied.
contact::LcpAnswer Preview::solve_contact(const contact::Reduced& load) {
  contact::LcpOptions options;
  options.max_steps = most_steps;
  options.tied = _tied;
  contact::LcpAnswer solution = _problem.solve_contact(load, options, _closed, {});
  if (solution.status == contact::LcpStatus::unbounded)
    throw Error(Reason::numerical,
                "a part of the membrane that only the paths and contact hold slides off: hold it, "
                "or end a path earlier");
  if (solution.status != contact::LcpStatus::solved)
    throw Error(Reason::numerical,
                "contact did not settle in {} steps: take a coarser mesh along the paths",
                most_steps);
  _closed = solution.closed;
  return solution;
}

/// The fields and the motions of inclusions with given jumps.
contact::Answer Preview::answer_for(const Loaded& load, const VectorXd& d) const {
  const contact::Reduced& reduced = load.reduced;
  const VectorXd w = _problem.values(_problem.solve(reduced, d), d, reduced.p);
  contact::Answer answer;
  for (const VectorXd& trace : _problem.traces().scatter(w))
    answer.side_traces.emplace_back(trace.begin(), trace.end());
  const contact::SolvedCase solved{load.loads.subdomains, answer};
  _problem.recover_fields({&solved, 1});

  for (const ddm::RigidMotion& motion : _decomposition.skeleton.motions) {
    contact::InclusionAnswer& body = answer.inclusions.emplace_back();
    body.displacement_mesh = contact::sum_of(motion.displacement, w);
    body.slope_x_mesh = contact::sum_of(motion.slope_x, w);
    body.slope_y_mesh = contact::sum_of(motion.slope_y, w);
  }
  return answer;
}

Preview::Solution Preview::solve(const Loaded& load) {
  contact::LcpAnswer solution = solve_contact(load.reduced);
  const VectorXd d = solution.d.head(load.reduced.r.size());
  const double energy = load.closed_energy - load.reduced.r.dot(d) / 2;
  return {std::move(solution), answer_for(load, d), energy};
}

std::vector<contact::Field> Preview::fields(const State& state, double t) {
  tie(_fronts.stretches, state);
  if (_dead != nullptr) return solve(together(t)).answer.fields;
  std::vector<contact::Field> fields = solve(_live).answer.fields;
  for (contact::Field& field : fields)
    for (double& u : field.u) u *= t;
  return fields;
}

Measured Preview::measure(const State& state) { return measure(state, _live); }

Measured Preview::measure(const State& state, const Loaded& load) {
  stop::look("growing cracks and delaminations");
  tie(_fronts.stretches, state);
  const auto [solution, answer, energy] = solve(load);
  Measured measured;
  measured.energy = energy;
  for (const contact::InclusionAnswer& body : answer.inclusions)
    measured.displacement.push_back(body.displacement_mesh);
  for (std::size_t p = 0; p < _decomposition.pairs.size(); ++p) {
    const std::int32_t contact = _decomposition.pairs[p].contact;
    if (contact >= 0 && solution.pressed[at(contact)] != 0)
      measured.contact_length += _problem.traces().lumped_mass()[static_cast<Eigen::Index>(p)];
  }
  for (std::size_t i = 0; i < _fronts.fronts.size(); ++i) {
    measured.release.emplace_back();
    if (state.fate[i] != Fate::grows) continue;
    const Place& here = place(i, state.at[i]);
    const double outer = room(i, state);
    if (outer < least_radius * here.edge) continue;
    const bool closed = here.behind >= 0 && solution.closed[at(here.behind)] != 0;
    measured.release.back() = closed ? 0 : rate_of(rates(here, outer, load, answer));
  }
  return measured;
}

/// G by each radius.
std::array<double, tips::radii> Preview::rates(const Place& here, double outer, const Loaded& load,
                                               const contact::Answer& solved) const {
  Point slope{};
  if (here.inclusion >= 0) {
    const contact::InclusionAnswer& body = solved.inclusions[at(here.inclusion)];
    slope = {body.slope_x_mesh, body.slope_y_mesh};
  }
  const tips::Moved moved(here.course, outer,
                          std::max(least_radius * here.edge, least_radius / radius * outer));
  std::array<double, tips::radii> rates{};
  for (std::size_t k = 0; k < here.cells.size(); ++k) {
    const tips::Cell& cell = here.cells[k];
    const ddm::Subdomain& subdomain = _decomposition.subdomains[at(cell.subdomain)];
    std::array<Point, 3> x{};
    std::array<double, 3> u{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto n = at(subdomain.part.triangles[3 * at(cell.triangle) + i]);
      x[i] = {subdomain.part.xy[2 * n], subdomain.part.xy[2 * n + 1]};
      u[i] = solved.fields[at(cell.subdomain)].u[n];
    }
    const fem::Tension& tension = subdomain.tension;
    const tips::Tensor T = tension.of_triangle.empty() ? tips::Tensor{tension.mean, 0, tension.mean}
                                                       : tension.of_triangle[at(cell.triangle)];
    moved.add(tips::corners_of(x), u, T, &load.force[at(cell.subdomain)][3 * at(cell.triangle)],
              slope, here.change.empty() ? nullptr : &here.change[k], rates);
  }
  return rates;
}

}  // namespace anticrack::growth

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tips/tips.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "ddm/decomposition.hpp"
#include "errors/errors.hpp"
#include "mesh/edges.hpp"
#include "stop/stop.hpp"
#include "tips/support.hpp"

namespace anticrack::tips {
namespace {

using contact::TipAnswer;
using mesh::TipKind;

constexpr const char* measuring = "measuring tips";

/// With fewer triangles about the tip a number means nothing.
constexpr std::size_t fewest_triangles = 60;

}  // namespace

std::vector<Cell> cells_of(const mesh::Mesh& mesh, const ddm::Decomposition& decomposition) {
  std::vector<Cell> cells(mesh.triangle_count());
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const std::vector<std::int32_t>& of_mesh = decomposition.subdomains[s].triangle;
    for (std::size_t t = 0; t < of_mesh.size(); ++t)
      cells[at(of_mesh[t])] = {static_cast<std::int32_t>(s), static_cast<std::int32_t>(t)};
  }
  return cells;
}

Tips::Tips(const mesh::Mesh& mesh, const ddm::Decomposition& decomposition)
    : _decomposition(decomposition), _tilts(mesh.inclusions.size(), 0) {
  for (const mesh::Interface& line : mesh.interfaces) _interfaces.push_back(line.name);
  for (std::size_t j = 0; j < mesh.motions.size(); ++j) _tilts[j] = mesh.motions[j].tilt ? 1 : 0;
  const mesh::EdgeTable edges(mesh.triangles);
  const std::vector<mesh::EdgeEnd> ends = mesh::edge_ends(mesh, edges);
  const Surroundings around(mesh, edges, ends);
  const std::vector<Law> laws = laws_of(mesh);
  const std::vector<Cell> cells = cells_of(mesh, decomposition);
  for (Place& place : find_places(mesh, edges, ends))
    _tips.push_back(Tip{std::move(place), 0, 0, {}});
  const auto prepare_one = [&, marks = Surroundings::Marks()](std::size_t i) mutable {
    stop::look(measuring, i);
    Tip& tip = _tips[i];
    if (!tip.place.reason.empty()) return;
    try {
      tip.singular.emplace_back(singular_at(tip.place, laws));
      prepare(mesh, cells, around.of(tip.place, marks), laws, tip);
    } catch (const errors::Error& error) {
      if (error.reason() == errors::Reason::cancelled) throw;
      tip.place.reason = error.what();  // T is not finite a little off a triangle
    }
    if (!tip.place.reason.empty()) tip.cells = {};
  };
  base::at_once(_tips.size(), base::Threads::allowed(), [&] { return prepare_one; });
  _triangles.resize(decomposition.subdomains.size());
  for (const Tip& tip : _tips)
    for (const Cell& cell : tip.cells) _triangles[at(cell.subdomain)].push_back(cell.triangle);
  for (std::vector<std::int32_t>& some : _triangles) {
    std::ranges::sort(some);
    some.erase(std::unique(some.begin(), some.end()), some.end());
  }
}

void Tips::prepare(const mesh::Mesh& mesh, std::span<const Cell> local, const Support& support,
                   std::span<const Law> laws, Tip& tip) const {
  Place& place = tip.place;
  tip.radius = support.radius;
  tip.inner = support.inner;
  if (support.triangles.size() < fewest_triangles) {
    place.reason = fmt::format(
        "only {} triangles lie between it and the next bend, end, line or boundary, {:.3g} away; "
        "take a smaller mesh.size",
        support.triangles.size(), support.radius);
    return;
  }
  tip.cells.reserve(support.triangles.size());
  for (const std::int32_t t : support.triangles) {
    const auto s = at(mesh.subdomain[at(t)]);
    if (laws[s].varies() && laws[s].may_jump()) {
      place.reason = "the tension of \"" + mesh.subdomains[s] +
                     "\" may jump or bend near it: write it without conditions, abs, min, max "
                     "and steps, or make regions of its parts";
      return;
    }
    tip.cells.push_back(local[at(t)]);
  }
  std::ranges::sort(tip.cells, {},
                    [](const Cell& c) { return std::pair(c.subdomain, c.triangle); });

  std::vector<std::int32_t> behind = place.behind;
  std::ranges::sort(behind);
  const bool any_varies = std::ranges::any_of(
      tip.cells, [&](const Cell& cell) { return laws[at(cell.subdomain)].varies(); });
  Extraction& extraction =
      tip.extraction.emplace_back(place.course, tip.singular.front(), tensors_at(place, laws),
                                  support.radius, tip.cells.size());
  for (std::size_t k = 0; k < tip.cells.size(); ++k) {
    stop::look_at_turn<1024>(k, measuring);
    const Cell& cell = tip.cells[k];
    const ddm::Subdomain& subdomain = _decomposition.subdomains[at(cell.subdomain)];
    const Corners corner = corners(cell);
    double d = 0;
    for (const Point& x : corner.x) d += place.course.across(x);
    const std::size_t side = d > 0 ? 1 : 0;
    std::array<bool, 3> jumps{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t node =
          subdomain.node[at(subdomain.part.triangles[3 * at(cell.triangle) + i])];
      jumps[i] = side == 0 && std::ranges::binary_search(behind, node);
      if (node != place.node) continue;
      tip.tip_cell = k;
      tip.tip_corner = i;
    }
    extraction.add(corner, tension(cell), side, jumps);
    if (any_varies)
      tip.change.push_back(
          change_of(laws[at(cell.subdomain)], place.course, corner, support.radius));
  }
  const std::vector<std::int32_t>& chain = mesh.interfaces[at(place.interface)].nodes;
  tip.first_behind =
      static_cast<std::size_t>(std::ranges::find(chain, place.behind.front()) - chain.begin());
}

Corners Tips::corners(const Cell& cell) const {
  const fem::Triangulation& part = _decomposition.subdomains[at(cell.subdomain)].part;
  std::array<Point, 3> x{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t node = at(part.triangles[3 * at(cell.triangle) + i]);
    x[i] = {part.xy[2 * node], part.xy[2 * node + 1]};
  }
  return corners_of(x);
}

Tensor Tips::tension(const Cell& cell) const {
  return _decomposition.subdomains[at(cell.subdomain)].tension.matrix(at(cell.triangle));
}

TipAnswer Tips::row_of(const Tip& tip) const {
  TipAnswer row;
  row.x = tip.place.course.tip[0];
  row.y = tip.place.course.tip[1];
  row.interface = _interfaces[at(tip.place.interface)];
  row.kind = tip.place.kind;
  row.reason = tip.place.reason;
  if (!tip.singular.empty()) row.exponent = tip.singular.front().exponent();
  return row;
}

std::vector<TipAnswer> Tips::without_numbers(const std::string& reason) const {
  std::vector<TipAnswer> rows;
  for (const Tip& tip : _tips) {
    TipAnswer& row = rows.emplace_back(row_of(tip));
    if (row.reason.empty()) row.reason = reason;
  }
  return rows;
}

std::string Tips::reason_of(const Tip& tip, std::span<const Point> points) {
  if (!tip.place.reason.empty()) return tip.place.reason;
  for (const Point& force : points) {
    const Point from = minus(force, tip.place.course.tip);
    if (std::hypot(from[0], from[1]) <= tip.radius)
      return fmt::format("a point force acts within {:.3g} of it: spread it over a disc",
                         tip.radius);
  }
  return {};
}

std::string Tips::obstacle(std::size_t index, std::span<const Point> points) const {
  const Tip& tip = _tips[index];
  if (tip.place.inclusion >= 0 && _tilts[at(tip.place.inclusion)] != 0)
    return "its inclusion tilts, and rows have no numbers of such tips";
  return reason_of(tip, points);
}

std::vector<TipAnswer> Tips::of(const Solved& solved) const {
  std::vector<TipAnswer> rows(_tips.size());
  const auto measure = [&](std::size_t i) {
    stop::look(measuring, i);
    const Tip& tip = _tips[i];
    TipAnswer& row = rows[i] = row_of(tip);
    row.reason = reason_of(tip, solved.point_forces);
    if (!row.reason.empty()) return;
    const contact::Trace& trace = solved.answer.traces[at(tip.place.interface)];
    row = told(i, integrals(i, solved),
               trace.contact[tip.first_behind] != 0 || trace.jump[tip.first_behind] <= 0);
  };
  base::at_once(_tips.size(), base::Threads::allowed(), [&] { return measure; });
  return rows;
}

Integrals Tips::integrals(std::size_t index, const Solved& solved) const {
  const Tip& tip = _tips[index];
  const Place& place = tip.place;
  const Singular& singular = tip.singular.front();
  const Extraction& extraction = tip.extraction.front();
  Point slope{};
  if (place.inclusion >= 0 && _tilts[at(place.inclusion)] != 0) {
    const contact::InclusionAnswer& body = solved.answer.inclusions[at(place.inclusion)];
    slope = {body.slope_x_mesh, body.slope_y_mesh};
  }
  const auto corners_u = [&](const Cell& cell) {
    const fem::Triangulation& part = _decomposition.subdomains[at(cell.subdomain)].part;
    std::array<double, 3> u{};
    for (std::size_t i = 0; i < 3; ++i)
      u[i] =
          solved.answer.fields[at(cell.subdomain)].u[at(part.triangles[3 * at(cell.triangle) + i])];
    return u;
  };
  const double at_tip = corners_u(tip.cells[tip.tip_cell])[tip.tip_corner];
  const Moved moved(place.course, tip.radius, tip.inner);
  Integrals result;
  double sum = -extraction.part_of_slope(slope);
  for (std::size_t k = 0; k < tip.cells.size(); ++k) {
    const Cell& cell = tip.cells[k];
    std::array<double, 3> u = corners_u(cell);
    for (double& one : u) one -= at_tip;
    const double* force = &solved.force[at(cell.subdomain)][3 * at(cell.triangle)];
    sum += extraction.part(k, u, force);
    if (place.kind != TipKind::delaminated_end)
      moved.add(corners(cell), u, tension(cell), force, slope,
                tip.change.empty() ? nullptr : &tip.change[k], result.rates);
  }
  result.intensity = singular.sign() * sum / (2 * singular.exponent() * singular.norm());
  return result;
}

TipAnswer Tips::told(std::size_t index, const Integrals& integrals, bool touching) const {
  const Tip& tip = _tips[index];
  const TipKind kind = tip.place.kind;
  const Singular& singular = tip.singular.front();
  const auto& [rates, dual] = integrals;
  TipAnswer row = row_of(tip);
  row.closed = tip.place.unilateral && (touching || dual <= 0);
  const auto [least, most] = std::ranges::minmax(rates);
  if (kind == TipKind::front || kind == TipKind::crack_tip) {
    row.energy_release_rate = row.closed ? 0 : std::max(0.0, rates.back());
    row.energy_release_rate_spread = most - least;
  }
  if (row.closed)
    row.intensity = 0;
  else if (kind == TipKind::delaminated_end)
    row.intensity = dual;
  else
    row.intensity = std::copysign(singular.intensity_of(rates.back()), dual);
  if (kind == TipKind::crack_tip) row.k_iii = singular.k_iii(*row.intensity);
  if (kind == TipKind::delaminated_end)
    row.release_factor = singular.release_factor(*row.intensity);
  return row;
}

std::size_t Tips::bytes() const noexcept {
  std::size_t bytes = 0;
  for (const std::vector<std::int32_t>& some : _triangles)
    bytes += some.capacity() * sizeof(std::int32_t);
  for (const Tip& tip : _tips) {
    bytes += sizeof(Tip) + tip.cells.capacity() * sizeof(Cell) +
             tip.change.capacity() * sizeof(Tensor) +
             tip.place.edges.capacity() * sizeof(tip.place.edges[0]) +
             tip.place.behind.capacity() * sizeof(std::int32_t);
    for (const Extraction& one : tip.extraction) bytes += one.bytes();
  }
  return bytes;
}

}  // namespace anticrack::tips

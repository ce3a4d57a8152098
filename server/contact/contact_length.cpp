// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/contact_length.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/at.hpp"

namespace anticrack::contact {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// What a lattice adds to a contact zone at each end, over the nodal length; see the header.
constexpr double lattice_shift = 0.2;

/// What the shift leaves unknown, over the nodal length.
constexpr double unknown_shift = 0.1;

/// sqrt(det T) at each trace node: the mean over its triangles where T varies.
std::vector<double> tensions(const ddm::Subdomain& subdomain) {
  std::vector<double> sum(subdomain.trace, 0), count(subdomain.trace, 0);
  const std::vector<std::array<double, 3>>& law = subdomain.tension.of_triangle;
  for (std::size_t t = 0; t < law.size(); ++t) {
    const auto& [xx, xy, yy] = law[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = at(subdomain.part.triangles[3 * t + k]) - subdomain.interior;
      if (i >= subdomain.trace) continue;  // also interior nodes, which wrap around
      sum[i] += std::sqrt(xx * yy - xy * xy);
      count[i] += 1;
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i)
    sum[i] = count[i] > 0 ? sum[i] / count[i] : subdomain.tension.mean;
  return sum;
}

/// The distance beyond the node with value `last` at which a quantity that is linear along this
/// node and the one `spacing` before it, of value `before`, is 0; infinity if it does not fall.
double distance_to_zero(double last, double before, double spacing) {
  return last < before ? spacing * last / (before - last) : infinity;
}

double squared(double x) { return x * x; }

}  // namespace

ContactLength::ContactLength(const ddm::Decomposition& decomposition,
                             const Eigen::VectorXd& lumped_mass) {
  std::vector<std::vector<double>> tension;
  for (const ddm::Subdomain& subdomain : decomposition.subdomains)
    tension.push_back(tensions(subdomain));
  const auto compliance = [&](std::int32_t subdomain, std::int32_t trace) {
    return decomposition.subdomains[at(subdomain)].rigid[at(trace)] >= 0
               ? 0
               : 1 / tension[at(subdomain)][at(trace)];
  };
  std::map<std::int32_t, int> pairs_at;
  for (const ddm::NodePair& pair : decomposition.pairs) ++pairs_at[pair.node];
  std::size_t next_edge = 0;
  for (const std::vector<ddm::SidePair>& sides : decomposition.interface_sides) {
    for (std::size_t i = 0; i < sides.size(); ++i) {
      Node& node = _nodes.emplace_back();
      if (sides[i].pair >= 0) {
        const ddm::NodePair& pair = decomposition.pairs[at(sides[i].pair)];
        node = {sides[i].pair,
                pair.inclusion,
                pair.unilateral(),
                pairs_at[pair.node] > 1,
                lumped_mass[sides[i].pair],
                compliance(pair.minus, pair.minus_trace) + compliance(pair.plus, pair.plus_trace)};
      }
      if (i == 0) continue;
      const auto b = static_cast<std::int32_t>(_nodes.size() - 1);
      const double length = decomposition.edges[next_edge++].length;
      if (!_nodes[at(b)].may_open && !_nodes[at(b - 1)].may_open) continue;
      const auto own = static_cast<std::int32_t>(_edges.size());
      const bool joins = own > 0 && i > 1 && _edges.back().node[1] == b - 1;
      if (joins) _edges.back().next[1] = own;
      _edges.push_back({{b - 1, b}, {joins ? own - 1 : -1, -1}, length});
    }
  }
}

std::size_t ContactLength::bytes() const noexcept {
  return _nodes.capacity() * sizeof(Node) + _edges.capacity() * sizeof(Edge);
}

/// The node beyond an end of an edge that may open and has one pair; -1 if there is none.
std::int32_t ContactLength::beyond(const Edge& edge, int end) const noexcept {
  const std::int32_t next = edge.next[at(end)];
  if (next < 0) return -1;
  const std::int32_t found = _edges[at(next)].node[at(end)];
  return node(found).may_open && !node(found).meeting ? found : -1;
}

/// Whether the node exists and is in contact, or open, as asked.
bool ContactLength::known(std::int32_t i, Values values, bool pressed) const noexcept {
  return i >= 0 && values[at(i)].pressed == pressed;
}

/// x of the header, for an edge with one end in contact.
double ContactLength::part(const Edge& edge, int pressed_end, Values values) const noexcept {
  const std::int32_t a = edge.node[at(pressed_end)], b = edge.node[at(1 - pressed_end)];
  if (node(a).meeting || node(b).meeting) return 0.5;
  const double force = node(a).mass * values[at(a)].pressure *
                       (node(a).compliance + node(b).compliance) / 2,
               jump = std::max(values[at(b)].jump, 0.0);
  return force > 0 ? force / (force + jump) : 0;
}

/// The contact on the edge between node `end`, which may open, and a tied one.
double ContactLength::at_tip(const Edge& edge, int end, Values values) const noexcept {
  const std::int32_t last = edge.node[at(end)], before = beyond(edge, end);
  if (!values[at(last)].pressed) return 0;
  if (before < 0 || node(last).meeting) return edge.length;
  const Edge& next = _edges[at(edge.next[at(end)])];
  if (!values[at(before)].pressed) return edge.length * part(next, 1 - end, values);
  return std::min(edge.length, distance_to_zero(squared(values[at(last)].pressure),
                                                squared(values[at(before)].pressure), next.length));
}

/// The contact on an edge before the shift of its ends.
double ContactLength::in_contact(const Edge& edge, Values values) const noexcept {
  const auto [a, b] = edge.node;
  if (!node(a).may_open) return at_tip(edge, 1, values);
  if (!node(b).may_open) return at_tip(edge, 0, values);
  if (values[at(a)].pressed == values[at(b)].pressed)
    return values[at(a)].pressed ? edge.length : 0;
  return edge.length * part(edge, values[at(a)].pressed ? 0 : 1, values);
}

/// The length of the zone, in contact or open, from within the edge over its `end`, or `most`.
double ContactLength::room(const Edge& edge, int end, bool contact, double most,
                           Values values) const noexcept {
  double sum = 0;
  for (const Edge* one = &edge;; one = &_edges[at(one->next[at(end)])]) {
    const double closed = in_contact(*one, values),
                 of_zone = contact ? closed : one->length - closed;
    sum += of_zone;
    const bool through = one == &edge || of_zone == one->length;
    if (sum >= most || !through || one->next[at(end)] < 0) return std::min(sum, most);
  }
}

/// How far beyond the node at `end` the pressure, or the jump, is 0; the edge where it is unknown.
double ContactLength::reach(const Edge& edge, int end, bool contact, Values values) const noexcept {
  const std::int32_t last = edge.node[at(end)], before = beyond(edge, end);
  if (!known(before, values, contact)) return edge.length;
  const double spacing = _edges[at(edge.next[at(end)])].length;
  const Value &near = values[at(last)], &far = values[at(before)];
  return contact ? distance_to_zero(squared(near.pressure), squared(far.pressure), spacing)
                 : distance_to_zero(std::cbrt(squared(near.jump)), std::cbrt(squared(far.jump)),
                                    spacing);
}

/// The contact on an edge in which it ends, and the estimate.
Measured ContactLength::end_in(const Edge& edge, int pressed_end, Values values) const noexcept {
  const Node &a = node(edge.node[at(pressed_end)]), &b = node(edge.node[at(1 - pressed_end)]);
  const double x = part(edge, pressed_end, values);
  if (a.meeting || b.meeting) return {x * edge.length, edge.length / 2};
  const double mass = (1 - x) * a.mass + x * b.mass,
               shift = lattice_shift * std::min(room(edge, pressed_end, true, mass, values),
                                                room(edge, 1 - pressed_end, false, mass, values)),
               differs = reach(edge, pressed_end, true, values) +
                         reach(edge, 1 - pressed_end, false, values) - edge.length;
  return {x * edge.length - shift,
          std::min(edge.length, unknown_shift * mass + 0.5 * std::abs(differs))};
}

Measured ContactLength::measure(const Edge& edge, Values values) const noexcept {
  const auto [a, b] = edge.node;
  const bool tip = !node(a).may_open || !node(b).may_open;
  if (!tip && values[at(a)].pressed != values[at(b)].pressed)
    return end_in(edge, values[at(a)].pressed ? 0 : 1, values);
  const double length = in_contact(edge, values);
  return {length, std::min(length, edge.length - length)};
}

Measured ContactLength::measure(Values values, std::span<double> of_inclusion) const {
  Measured sum;
  for (const Edge& edge : _edges) {
    const Measured one = measure(edge, values);
    sum.length += one.length;
    sum.error += one.error;
    if (of_inclusion.empty()) continue;
    const Node& own = node(edge.node[node(edge.node[0]).may_open ? 0 : 1]);
    if (own.inclusion >= 0) of_inclusion[at(own.inclusion)] += one.length;
  }
  return sum;
}

}  // namespace anticrack::contact

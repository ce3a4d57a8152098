// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/face_pressures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "base/at.hpp"

namespace anticrack::operators {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Per copy, its entry of the skeleton's w; -1 off the interfaces.
std::vector<std::int32_t> unknown_at(const MeshOperator::Parts& parts,
                                     const estimate::CutMesh& cut) {
  std::vector<std::int32_t> unknown(cut.at.size(), -1);
  for (std::size_t s = 0; s < parts.decomposition.subdomains.size(); ++s) {
    const ddm::Subdomain& of = parts.decomposition.subdomains[s];
    std::ranges::copy(
        of.unknown, unknown.begin() + cut.first_copy[s] + static_cast<std::ptrdiff_t>(of.interior));
  }
  return unknown;
}

/// The contacts whose jumps sum up to w[plus] - w[minus]: one, or a chain of them. None: there is
/// no such chain.
std::optional<std::vector<std::int32_t>> chain(const std::vector<ddm::Contact>& contacts,
                                               std::int32_t plus, std::int32_t minus) {
  std::map<std::int32_t, std::vector<std::int32_t>> way{{minus, {}}};
  std::vector<std::int32_t> reached{minus};
  for (std::size_t k = 0; k < reached.size() && !way.contains(plus); ++k) {
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      if (contacts[i].minus != reached[k] || way.contains(contacts[i].plus)) continue;
      std::vector<std::int32_t> longer = way[reached[k]];
      longer.push_back(static_cast<std::int32_t>(i));
      way[contacts[i].plus] = std::move(longer);
      reached.push_back(contacts[i].plus);
    }
  }
  const auto found = way.find(plus);
  if (found == way.end()) return std::nullopt;
  return found->second;
}

/// Finds the jumps at the ends, and divides the force of each contact by the lengths of its faces.
/// An end that has no contact of its own, as a tip, has the pressure of the other end. False if a
/// jump is not known.
bool divide(const MeshOperator::Parts& parts, const estimate::CutMesh& cut, FacePressures& of) {
  const std::vector<ddm::Contact>& contacts = parts.decomposition.skeleton.contacts;
  const std::vector<std::int32_t> contact = contact_at_ends(parts, cut),
                                  unknown = unknown_at(parts, cut);
  std::vector<double> length, beside(contacts.size(), 0);
  for (const std::int32_t f : of.faces) {
    const auto ends = cut.ends(cut.faces[at(f)]);
    const estimate::Vector &p = cut.at[at(ends[0])], &q = cut.at[at(ends[1])];
    length.push_back(std::hypot(q[0] - p[0], q[1] - p[1]));
    for (const std::int32_t end : {2 * f, 2 * f + 1})
      if (contact[at(end)] >= 0) beside[at(contact[at(end)])] += length.back();
  }
  for (std::size_t i = 0; i < of.faces.size(); ++i) {
    const estimate::Face& face = cut.faces[at(of.faces[i])];
    const auto ends = cut.ends(face), others = cut.ends(cut.faces[at(face.other)]);
    for (const std::size_t k : {0, 1}) {
      const std::size_t end = 2 * at(of.faces[i]) + k;
      const std::int32_t own = contact[end], force = own >= 0 ? own : contact[end ^ 1];
      const auto first = static_cast<std::int32_t>(of.jumps.size());
      if (own >= 0) {
        of.jumps.push_back(own);
      } else {
        const auto sum = chain(contacts, unknown[at(others[1 - k])], unknown[at(ends[k])]);
        if (!sum) return false;
        of.jumps.insert(of.jumps.end(), sum->begin(), sum->end());
      }
      of.ends.push_back({first, static_cast<std::int32_t>(of.jumps.size()), force,
                         force >= 0 ? length[i] / beside[at(force)] : 0});
    }
  }
  return true;
}

void find_turns(const estimate::CutMesh& cut, FacePressures& of) {
  std::vector<std::int32_t> place(cut.faces.size(), -1);
  for (std::size_t i = 0; i < of.faces.size(); ++i)
    place[at(of.faces[i])] = static_cast<std::int32_t>(i);
  for (std::size_t fan = 0; fan < cut.fan_count(); ++fan) {
    FacePressures::Turn turn{fan};
    std::size_t count = 0;
    bool possible = true;
    std::vector<double> on(cut.ways.bodies.size(), 0);
    for (std::int32_t n = cut.first_stop[fan]; n < cut.first_stop[fan + 1]; ++n) {
      const estimate::Stop& stop = cut.stops[at(n)];
      const estimate::Face& face = cut.faces[at(stop.face)];
      possible = possible && face.condition != estimate::Condition::given;
      if (face.inclusion >= 0) {
        possible = possible && cut.tilts[at(face.inclusion)] == 0;
        on[at(cut.ways.of[at(face.inclusion)])] += stop.sign();
      }
      if (place[at(stop.face)] < 0) continue;
      possible = possible && count < 2;
      if (count < 2) {
        turn.end[count] = 2 * place[at(stop.face)] + stop.end;
        turn.sign[count] = -stop.sign();
      }
      ++count;
    }
    for (std::size_t b = 0; b < on.size(); ++b)
      possible = possible && (on[b] == 0 || cut.ways.bodies[b].held);
    if (count == 2)
      possible = possible && of.ends[at(turn.end[0])].force == of.ends[at(turn.end[1])].force;
    if (count > 0 && possible) of.turns.push_back(turn);
  }
}

}  // namespace

std::vector<std::int32_t> contact_at_ends(const MeshOperator::Parts& parts,
                                          const estimate::CutMesh& cut) {
  const std::vector<std::int32_t> unknown = unknown_at(parts, cut);
  const std::vector<ddm::Contact>& contacts = parts.decomposition.skeleton.contacts;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> between;
  for (std::size_t i = 0; i < contacts.size(); ++i)
    between[{contacts[i].plus, contacts[i].minus}] = static_cast<std::int32_t>(i);
  std::vector<std::int32_t> contact(2 * cut.faces.size(), -1);
  for (std::size_t f = 0; f < cut.faces.size(); ++f) {
    const estimate::Face& face = cut.faces[f];
    if (!estimate::presses(face.condition)) continue;
    const auto ends = cut.ends(face), others = cut.ends(cut.faces[at(face.other)]);
    for (const std::size_t end : {0, 1}) {
      const auto found = between.find({unknown[at(others[1 - end])], unknown[at(ends[end])]});
      if (found != between.end()) contact[2 * f + end] = found->second;
    }
  }
  return contact;
}

FacePressures face_pressures(const MeshOperator::Parts& parts, const estimate::CutMesh& cut) {
  FacePressures of;
  for (std::size_t f = 0; f < cut.faces.size(); ++f)
    if (estimate::presses(cut.faces[f].condition)) of.faces.push_back(static_cast<std::int32_t>(f));
  if (!divide(parts, cut, of)) return {};
  find_turns(cut, of);
  return of;
}

FacePressures::Turned FacePressures::divided(const VectorXd& forces) const {
  VectorXd pressure(static_cast<Index>(ends.size()));
  for (Index e = 0; e < pressure.size(); ++e) {
    const End& end = ends[at(e)];
    pressure[e] = end.force >= 0 ? end.part * forces[end.force] : 0;
  }
  return {std::move(pressure), VectorXd::Zero(static_cast<Index>(turns.size()))};
}

std::vector<double> FacePressures::through(std::size_t all_faces, const VectorXd& pressure) const {
  std::vector<double> flux(2 * all_faces, 0);
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (const std::size_t end : {0, 1})
      flux[2 * at(faces[i]) + end] = -pressure[static_cast<Index>(2 * i + end)];
  return flux;
}

double FacePressures::work(const VectorXd& pressure, const Eigen::Ref<const VectorXd>& d) const {
  double sum = 0;
  for (Index e = 0; e < pressure.size(); ++e)
    for (const std::int32_t i : jumps_at(e)) sum += 0.5 * (pressure[e] + pressure[e ^ 1]) * d[i];
  return sum;
}

VectorXd FacePressures::slopes_of_work(const Eigen::Ref<const VectorXd>& d) const {
  VectorXd slopes = VectorXd::Zero(static_cast<Index>(turns.size()));
  for (Index k = 0; k < slopes.size(); ++k) {
    const Turn& turn = turns[at(k)];
    for (const std::size_t one : {0, 1}) {
      if (turn.end[one] < 0) continue;
      for (const std::int32_t end : {turn.end[one], turn.end[one] ^ 1})
        for (const std::int32_t i : jumps_at(end)) slopes[k] += 0.5 * turn.sign[one] * d[i];
    }
  }
  return slopes;
}

void FacePressures::turn(const VectorXd& slope, const VectorXd& least, const VectorXd& most,
                         Turned& turned) const {
  constexpr int sweeps = 3;
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (Index k = 0; k < slope.size(); ++k) {
      const Turn& turn = turns[at(k)];
      double low = -unlimited, high = unlimited;
      for (const std::size_t one : {0, 1}) {
        if (turn.end[one] < 0) continue;
        const Index end = turn.end[one];
        const double down = least[end] - turned.ends[end], up = most[end] - turned.ends[end];
        low = std::max(low, turn.sign[one] > 0 ? down : -up);
        high = std::min(high, turn.sign[one] > 0 ? up : -down);
      }
      low = std::min(low, 0.0);
      high = std::max(high, 0.0);
      if (low == high) continue;
      double now = slope[k], softness = 0;
      for (Eigen::SparseMatrix<double>::InnerIterator one(overlap, k); one; ++one) {
        now += one.value() * turned.by[one.row()];
        if (one.row() == k) softness = one.value();
      }
      const double step = std::clamp(-now / softness, low, high);
      turned.by[k] += step;
      for (const std::size_t one : {0, 1})
        if (turn.end[one] >= 0) turned.ends[turn.end[one]] += turn.sign[one] * step;
    }
  }
}

bool FacePressures::closed_at(Index end, const std::vector<char>& closed) const {
  const std::span<const std::int32_t> own = jumps_at(end);
  return !own.empty() &&
         std::ranges::all_of(own, [&](std::int32_t i) { return closed[at(i)] != 0; });
}

std::size_t FacePressures::bytes() const noexcept {
  return faces.capacity() * sizeof(faces[0]) + ends.capacity() * sizeof(ends[0]) +
         turns.capacity() * sizeof(turns[0]) + jumps.capacity() * sizeof(jumps[0]) +
         at(overlap.nonZeros()) * (sizeof(double) + sizeof(int)) +
         at(overlap.outerSize()) * sizeof(int);
}

}  // namespace anticrack::operators

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "contact/adjoint.hpp"
#include "estimate/interval.hpp"
#include "operators/aims.hpp"
#include "operators/displacement_bounds.hpp"

namespace anticrack::operators {

/// An answer with the adjoints of its displacements.
struct Adjoints {
  const Bounded& of;
  contact::Adjoint adjoint;
  contact::Adjoint::Room room;
};

/// One displacement of an answer: the k-th of all goals.
struct Target {
  Adjoints& adjoints;
  std::span<const Aim> goals;
  std::size_t k;
  std::vector<estimate::ForceOn> unit;
  contact::Adjoint::Goal goal;
  const Aim& aim() const { return goals[k]; }
};

/// The room of an answer for c = 1: per condition w times the jump, and the force k p of sigma; 0
/// if it is open. `closed`: Answer::closed; `weight`: null: 1; `stiff`: estimate::ConeSize::stiff.
/// O(faces log contacts).
contact::Adjoint::Room room_of(const MeshOperator::Parts& parts, const estimate::Primal& primal,
                               const std::vector<char>& closed,
                               const estimate::Weight* weight = nullptr, double stiff = 1);

/// Searches for the best bound from one side. Tries the c that promises most, another if it did not
/// keep that, then weights about the ends of contact zones, if bounds are to be close.
class Search {
 public:
  Search(const MeshOperator::Parts& parts, Target& target, estimate::Side side);

  const Target& target() const { return _target; }
  bool done() const { return _done || stopped(); }
  bool stopped() const { return _target.adjoints.of.stop.stop_requested(); }

  /// What the present try solves: the loads of z' and the jumps of z.
  Eigen::VectorXd load() const;
  Eigen::VectorXd reactions() const;  ///< the load without that of the unit force
  Eigen::VectorXd jumps() const;
  /// Whether z or z' differs from z_0. If not, all three are one field, to rounding.
  bool clips() const;
  estimate::Aimed aimed(std::span<const double> z, std::span<const double> reacting) const;
  void take(const estimate::Bound& one);
  void give_up() { _done = true; }

  /// The best bound so far; not finite: none.
  const estimate::Bound& best() const { return _best; }

 private:
  double sign() const { return _side == estimate::Side::upper ? 1 : -1; }
  contact::Adjoint::Room room() const;           ///< for the present c
  double off(const estimate::Bound& one) const;  ///< from the middle
  void choose_cone();
  bool take_next(const estimate::Bound& one);    ///< whether another cone is worth it
  bool take_wanted(const estimate::Bound& one);  ///< whether another cone of both parts is worth it
  void weigh();

  const MeshOperator::Parts& _parts;
  Target& _target;
  const estimate::Side _side;
  contact::Adjoint::Room _room;           // for c = 1 and the present weight
  std::vector<estimate::Clipped> _known;  // what cones clip; empty: nothing, or S^ is not formed
  estimate::Clipped _cone;                // of the present try
  double _stiff = 1;                      // estimate::ConeSize
  estimate::Bound _best;
  std::optional<std::vector<estimate::ContactEnd>> _ends;  // found with the first weight
  std::optional<estimate::Weight> _weight;
  double _inner = 1;  // of the weight
  double _unloaded = 0;
  int _tries = 0;
  bool _done = false;
};

}  // namespace anticrack::operators

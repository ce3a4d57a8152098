// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "base/at.hpp"
#include "contact/answer.hpp"
#include "contact/solve.hpp"
#include "contact/uzawa.hpp"

namespace anticrack::contact {

/// Detects an iteration that oscillates without converging. Above theta* the map of Algorithm 2
/// need not contract: a mode with 1 - theta lambda < -1 grows, changing sign in every iteration,
/// until the projection bounds it, and the criterion stagnates. A convergent iteration approaches
/// from one side (no turns) or turns while the criterion falls. Criterion: in two successive
/// windows of 40 iterations mu turns in most of them and the smallest criterion falls by less than
/// one part in 1000 (a contraction of 0.99999 an iteration). Used for theta > theta* only; below,
/// Theorem 4 guarantees convergence.
class StagnationMonitor {
 public:
  static constexpr int window = 40;

  /// Records an iteration; true once it is clear that the iteration cannot converge.
  bool add(double criterion, bool turned) {
    ++_count;
    _turns += turned ? 1 : 0;
    _smallest = std::min(_smallest, criterion);
    if (_count < window) return false;
    const bool stagnant =
        _smallest > rounding && _smallest >= progress * _previous_smallest && 2 * _turns > window;
    _count = _turns = 0;
    _previous_smallest = _smallest;
    _smallest = std::numeric_limits<double>::infinity();
    _stagnant_windows = stagnant ? _stagnant_windows + 1 : 0;
    return _stagnant_windows >= 2;
  }

 private:
  static constexpr double progress = 0.999;
  static constexpr double rounding = 1e-20;  // below it a criterion is noise, not oscillation

  int _count = 0;
  int _turns = 0;
  int _stagnant_windows = 0;
  double _smallest = std::numeric_limits<double>::infinity();
  double _previous_smallest = std::numeric_limits<double>::infinity();
};

/// Load cases that iterate Algorithm 2 together, a column of Uzawa each, with their own theta, p,
/// stopping rule and observer; they join and leave between two iterations. A column iterates from
/// mu_0 = 0 until the criterion of step 3 is below epsilon (with kkt_tolerance: all relative
/// residuals are below that), it is clear that it cannot converge, `max_iterations`, or the
/// observer stops it. Converged only where the relative residuals are at most solution_residual and
/// no multiplier is held at its bound p. Samples measure `equilibrium`, which costs as much as an
/// iteration and is zero to rounding, in the first, every 64th and the last iteration (with
/// kkt_tolerance also where the other residuals are small) and repeat it in between. One object
/// belongs to one thread. Deterministic: the same columns joined at the same iterations give the
/// same bits.
class UzawaBlock {
 public:
  /// Keeps references to problem and the mesh that was cut; ddm::uzawa_obstacle must be empty.
  /// Allocates everything that step() needs, and has theta* computed where it is not known yet:
  /// throws errors::Error as TraceProblem::theta_star does.
  UzawaBlock(const TraceProblem& problem, const mesh::Mesh& mesh, Mass mass, int capacity);

  /// The number of load cases that iterate now, and of those that may at once.
  int columns() const noexcept { return _running; }
  int capacity() const noexcept { return static_cast<int>(_cases.size()); }

  /// Adds a load case, which starts with mu_0 = 0. Returns its place, below capacity(), which it
  /// keeps until its answer is taken; what `loads` refers to and the observer must live until then.
  /// Throws errors::Error (internal) if `options.mass` is not the block's or no place is free.
  int add(const CaseLoads& loads, const UzawaOptions& options, bool fields, Observer& observer);

  /// Iterates every column once and calls the observer of each. Columns that end stay, without
  /// further iterations, until they are taken. O(n_G^2 columns), no allocation.
  void step();

  struct Ended {
    int place = 0;
    Answer answer;
  };
  /// Takes the answers of the cases that have ended, in the order of their places. Throws
  /// errors::Error (limit_exceeded) if there is no memory for fields; nothing is taken then.
  std::vector<Ended> take_ended();

 private:
  enum class End { running, converged, unsolved, overflow, oscillation, limit, cancelled };
  struct Case {
    int place = 0;
    CaseLoads loads;
    UzawaOptions options;
    bool fields = false;
    Observer* observer = nullptr;
    double theta = 0;
    StagnationMonitor monitor;
    Sample sample;
    End end = End::running;
  };

  Case& column(int c) { return _cases[at(c)]; }
  void exchange(int a, int b);
  void observe(int c);
  End judge(int c);
  bool within_tolerance(int c, const Scales& scales, double tolerance);
  bool solved(int c);
  Answer answer(int c);

  const TraceProblem& _problem;
  const mesh::Mesh& _mesh;
  const Mass _mass;
  const double _theta_star;
  Uzawa _uzawa;
  // The cases in the columns of _uzawa: first those that iterate, then those that have ended, then
  // free places.
  std::vector<Case> _cases;
  int _running = 0;
  int _ended = 0;
};

}  // namespace anticrack::contact

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "contact/solve.hpp"
#include "contact/stagnation.hpp"
#include "contact/uzawa.hpp"
#include "mesh/at.hpp"

namespace anticrack::contact {

/// Load cases that iterate Algorithm 2 together, a column of Uzawa each, with their own theta, p,
/// stopping rule and observer; they join and leave between two iterations. solve_uzawa is a block
/// of one. One object belongs to one thread. Deterministic: the same columns joined at the same
/// iterations give the same bits.
class UzawaBlock {
 public:
  /// Keeps references to problem and mesh. Allocates everything that step() needs, and has theta*
  /// computed where it is not known yet: throws errors::Error as TraceProblem::theta_star does.
  UzawaBlock(const TraceProblem& problem, const mesh::Mesh& mesh, Mass mass, int capacity);

  /// Load cases that iterate, and how many may at once.
  int columns() const noexcept { return _running; }
  int capacity() const noexcept { return static_cast<int>(_cases.size()); }

  /// Joins with mu_0 = 0. The place, below capacity(), is the case's until its answer was taken.
  /// What `loads` refers to and the observer outlive that. `options.mass` must be the block's.
  /// Throws errors::Error (internal) for another mass and without a free place.
  int add(const CaseLoads& loads, const UzawaOptions& options, bool fields, Observer& observer);

  /// One iteration of every column; each observer hears of its own. Columns that end stay, without
  /// further iterations, until they are taken. O(n_G^2 columns), no allocation.
  void step();

  struct Ended {
    int place = 0;
    Answer answer;
  };
  /// What has ended, in the order of the places. Throws errors::Error (limit_exceeded) without
  /// memory for fields; nothing is taken then.
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
  // Columns of _uzawa and their cases: those under way, those that have ended, free ones.
  std::vector<Case> _cases;
  int _running = 0;
  int _ended = 0;
};

}  // namespace anticrack::contact

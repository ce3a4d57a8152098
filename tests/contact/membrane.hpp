// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "contact/condensed_problem.hpp"
#include "contact/solve.hpp"
#include "contact/uzawa_block.hpp"
#include "support/structured_mesh.hpp"
#include "support/trace_space.hpp"

namespace anticrack::contact {

class Recorder : public Observer {
 public:
  explicit Recorder(int stop_after = 1 << 30) : _stop_after(stop_after) {}
  bool on_iteration(const Sample& sample) override {
    samples.push_back(sample);
    return sample.iteration < _stop_after;
  }
  std::vector<Sample> samples;

 private:
  int _stop_after;
};

/// A block of one column.
inline Answer solve_uzawa(const TraceProblem& problem, const mesh::Mesh& mesh,
                          const CaseLoads& loads, const UzawaOptions& options, bool fields,
                          Observer& observer) {
  UzawaBlock block(problem, mesh, options.mass, 1);
  block.add(loads, options, fields, observer);
  while (block.columns() > 0) block.step();
  return std::move(block.take_ended().front().answer);
}

/// A mesh with all that solving on it takes.
struct Membrane {
  explicit Membrane(mesh::Mesh cut_mesh)
      : mesh(std::move(cut_mesh)),
        space(mesh),
        problem(space.decomposition, space.operators,
                ddm::uzawa_obstacle(space.decomposition, mesh).empty()),
        condensed(problem) {}

  Answer solve(const fem::Force& force, const UzawaOptions& options, Observer& observer,
               const char* boundary = "") const {
    const auto loads = space.condense(force, boundary);
    return solve_uzawa(problem, mesh, {loads}, options, false, observer);
  }
  Answer solve(const char* force, const UzawaOptions& options, Observer& observer,
               const char* boundary = "") const {
    return solve(fem::Expression{force}, options, observer, boundary);
  }

  /// By the active set.
  Answer exact(const fem::Force& force, const char* boundary = "",
               const std::vector<char>& start = {}) const {
    Recorder recorder;
    const auto loads = space.condense(force, boundary);
    return solve_active_set(condensed, mesh, {loads}, {}, true, recorder, start);
  }

  mesh::Mesh mesh;
  testing::TraceSpace space;
  TraceProblem problem;
  CondensedProblem condensed;
};

/// A crack between two inclusions, one bonded, one half delaminated: all kinds at once.
inline mesh::Mesh several_inclusions_and_a_crack() {
  using mesh::Kind;
  const auto kind = [](double x) {
    if (x > -0.875 && x < -0.5) return Kind::inclusion;
    if (x > -0.25 && x < 0.125) return Kind::crack;
    if (x > 0.25 && x < 0.5) return Kind::delaminated;
    if (x > 0.5 && x < 0.75) return Kind::inclusion;
    return Kind::glue;
  };
  const auto inclusion = [](double x) { return x < 0 ? 0 : 1; };
  return testing::structured_mesh({64, 16, kind, inclusion, {"bonded", "half"}});
}

/// As near to the fixed point as rounding lets it come.
inline UzawaOptions tight() {
  UzawaOptions options;
  options.theta.reset();
  options.epsilon = 1e-28;
  options.max_iterations = 200000;
  return options;
}

}  // namespace anticrack::contact

// SPDX-License-Identifier: GPL-3.0-or-later
//
// The numbers of one position of the fronts after another, on one mesh with one factorisation. What
// still holds on a path is contacts that are tied: d = 0, whatever pulls. So a position costs an
// active set that begins with that of the position before, and one backward solve for u. Beside a
// dead load it costs as much for every change of the contact set on the way to its t (drive.hpp).
//
// A. M. Khludnev, K. Ohtsuka, J. Sokolowski, On derivative of energy functional for elastic bodies
// with cracks and unilateral conditions, Quart. Appl. Math. 60 (2002).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "contact/contact_problem.hpp"
#include "ddm/subdomain_operator.hpp"
#include "growth/drive.hpp"
#include "growth/evolution.hpp"
#include "growth/fronts.hpp"
#include "mesh/edge_ends.hpp"
#include "mesh/edges.hpp"
#include "tips/release.hpp"
#include "tips/support.hpp"
#include "tips/tensor.hpp"

namespace anticrack::contact {
struct Field;
struct TipAnswer;
}  // namespace anticrack::contact

namespace anticrack::growth {

/// A load on the mesh, and its parts on triangles.
struct PreviewLoad {
  contact::CaseLoads loads;
  /// Per subdomain (m,3): int f hat_i for the corners i of each triangle.
  std::vector<std::span<const double>> force;
  std::span<const mesh::Point> point_forces;
};

/// Keeps references to its arguments. For one thread.
class Preview {
 public:
  /// `dead`: what acts besides and is not scaled; null: nothing. Throws errors::Error: that of
  /// find_fronts; invalid_argument at "paths[i]" where a front is too near to something, or on a
  /// curve, for G to be computed at first, and at "dead" where cracks cross. O(m log m).
  Preview(const contact::ContactProblem& problem, const mesh::Mesh& mesh, PreviewLoad load,
          std::span<const Path> paths, const PreviewLoad* dead = nullptr);

  std::vector<Track> tracks() const;
  const Fronts& fronts() const noexcept { return _fronts; }
  /// The whole answer in a state, for t = 1 with the dead load, without fields; what holds on the
  /// paths counts as glue or bonded. Throws as measure().
  contact::Answer answer(const State& state, const contact::ActiveSetOptions& options,
                         contact::Observer& observer);
  /// u in a state, with the dead load. Cost as measure().
  std::vector<contact::Field> fields(const State& state, double t);
  /// For each front that leaves an open delaminated end, that end before anything leaves it, with a
  /// reason where it has no numbers, as beside a dead load. Costs a state.
  std::vector<contact::TipAnswer> ends();
  /// Solves a state. O(c^3) a step of the active set with c open contacts, and O(N). Throws
  /// errors::Error: numerical where a part of the membrane slides off or the steps do not end;
  /// cancelled.
  Measured measure(const State& state);
  /// The same beside a dead load: a solution for every change of contact between the loads of two
  /// rows.
  Measured measure(const State& state, const Sought& sought);

 private:
  struct Place {
    tips::Course course;
    double radius = 0;                 ///< no tip that does not move, bend or boundary is nearer
    double edge = 0;                   ///< length of an edge at the front
    std::string reason;                ///< what is nearest
    std::vector<tips::Cell> cells;     ///< nearer than the radius
    std::vector<tips::Tensor> change;  ///< (cells) derivative of T; empty: 0
    std::int32_t behind = -1;          ///< contact right behind the front; -1: none
    std::int32_t inclusion = -1;
  };

  struct Solution;
  /// A load for which all can be solved. What it does not own it refers to.
  struct Loaded {
    std::vector<ddm::CondensedLoad> subdomains;
    std::vector<contact::InclusionForce> inclusion_forces;
    contact::CaseLoads loads;
    std::vector<std::vector<double>> own_force;
    std::vector<std::span<const double>> force;
    contact::Reduced reduced;
    double closed_energy = 0;
  };

  void require_scalable() const;
  Loaded loaded(const PreviewLoad& load) const;
  Loaded together(double t) const;
  void finish(Loaded& load) const;
  contact::Answer answer_for(const Loaded& load, const Eigen::VectorXd& d) const;
  Piece piece(const std::vector<double>& rooms, const State& state, double t, int way,
              double& step);

  const Place& place(std::size_t front, std::size_t position);
  Place find_place(const Front& front, std::size_t position) const;
  void take_surroundings(Place& place, tips::Place around) const;
  double room(std::size_t front, const State& state);
  std::array<double, tips::radii> rates(const Place& here, double outer, const Loaded& load,
                                        const contact::Answer& solved) const;
  State first_state() const;
  void tie(std::span<const Stretch> stretches, const State& state);
  contact::LcpAnswer solve_contact(const contact::Reduced& load);
  Solution solve(const Loaded& load);
  Measured measure(const State& state, const Loaded& load);
  std::vector<std::int32_t> contacts_at(const Stretch& stretch, std::size_t node) const;
  const mesh::Interface& line_of(const Stretch& stretch) const {
    return _mesh.interfaces[stretch.interface];
  }

  const contact::ContactProblem& _problem;
  const mesh::Mesh& _mesh;
  const ddm::Decomposition& _decomposition;
  const PreviewLoad _load;
  const PreviewLoad* const _dead;
  const Fronts _fronts;
  const mesh::EdgeTable _edges;
  const std::vector<mesh::EdgeEnd> _ends;
  const tips::Surroundings _around;
  const std::vector<tips::Law> _laws;
  const std::vector<tips::Cell> _cells;      // (m)
  std::vector<mesh::Point> _tips;            // those that do not move
  std::vector<ddm::LoadProducts> _products;  // of the dead and the live load, per subdomain
  Loaded _live, _dead_alone, _both;          // t = 1, 0 and 1; the last two with a dead load
  std::vector<char> _tied, _closed, _closed_alone;
  std::map<std::pair<std::size_t, std::size_t>, Place> _places;
};

}  // namespace anticrack::growth

// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sweeps of a MeshOperator: bases of loads, and rows that are combinations of them.
#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "base/at.hpp"
#include "contact/sweep_solver.hpp"
#include "errors/errors.hpp"
#include "operators/mesh_parts.hpp"
#include "operators/row_bounds.hpp"
#include "operators/row_tips.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

void require_memory(std::size_t loads, const ddm::Decomposition& decomposition, bool bounds) {
  std::size_t nodes = 0, numbers = 0;
  for (const ddm::Subdomain& subdomain : decomposition.subdomains) {
    nodes += subdomain.node.size();
    // Bounds also need the force on each corner, and the oscillation.
    numbers += subdomain.node.size() + (bounds ? 4 * subdomain.part.triangle_count() : 0);
  }
  if (numbers > 0 && loads > max_basis_bytes / sizeof(double) / numbers) {
    throw errors::Error(errors::Reason::limit_exceeded,
                        "{} loads on {} nodes are more than {} MiB{}: combine fewer loads, or take "
                        "a coarser mesh (larger size or tip_size)",
                        loads, nodes, max_basis_bytes >> 20U, bounds ? " with bounds" : "");
  }
}

/// The loads, if none has an error; else throws the first error with the number of its load.
std::vector<LoadOnTraces> sound(std::vector<CondensedOutcome> outcomes) {
  std::vector<LoadOnTraces> loads;
  loads.reserve(outcomes.size());
  for (std::size_t j = 0; j < outcomes.size(); ++j) {
    if (auto* error = std::get_if<errors::Error>(&outcomes[j]))
      throw errors::Error(error->below(fmt::format("load_cases[{}]", j)));
    loads.push_back(std::get<LoadOnTraces>(std::move(outcomes[j])));
  }
  return loads;
}

/// The loads on one subdomain.
std::vector<const ddm::CondensedLoad*> on_subdomain(const std::vector<LoadOnTraces>& loads,
                                                    std::size_t subdomain) {
  std::vector<const ddm::CondensedLoad*> result;
  result.reserve(loads.size());
  for (const LoadOnTraces& load : loads) result.push_back(&load.subdomains[subdomain]);
  return result;
}

/// Computes the products of loads that the energy needs, then frees the interiors if nothing needs
/// them any more.
CondensedBasis basis_of(std::vector<LoadOnTraces> loads, std::vector<BalancedLoad> balanced,
                        const MeshOperator::Parts& parts) {
  CondensedBasis result;
  result.balanced = std::move(balanced);
  const auto m = static_cast<Index>(loads.size());
  const bool condensed = parts.contact->condensed();
  MatrixXd constants = MatrixXd::Zero(m, m);
  for (std::size_t s = 0; s < parts.decomposition.subdomains.size(); ++s) {
    result.products.push_back(ddm::products(on_subdomain(loads, s), condensed));
    constants += result.products.back().energy;
  }
  std::vector<contact::CaseLoads> cases;
  for (LoadOnTraces& load : loads) {
    load.parts = {};
    for (ddm::CondensedLoad& part : load.subdomains) {
      if (condensed && result.balanced.empty()) part.z_interior.resize(0);
      part.z_boundary.resize(0);
    }
    cases.push_back({load.subdomains, load.inclusion_forces});
    for (const std::string& warning : load.warnings)
      if (std::find(result.warnings.begin(), result.warnings.end(), warning) ==
          result.warnings.end())
        result.warnings.push_back(warning);
  }
  result.reduced = contact::reduce(*parts.contact, cases, constants);
  result.reduced.responses = std::make_shared<contact::OpenResponses>(result.reduced.r);
  result.loads = std::move(loads);
  return result;
}

}  // namespace

std::size_t LoadBasis::size() const noexcept { return _data->basis->loads.size(); }

std::size_t LoadBasis::bytes() const noexcept { return _data->basis->bytes(); }

const std::vector<std::string>& LoadBasis::warnings() const noexcept {
  return _data->basis->warnings;
}

std::shared_ptr<const LoadBasis> MeshOperator::basis(std::span<const fem::Load* const> loads,
                                                     const std::stop_token& stop, bool bounds,
                                                     std::uint64_t rows, bool tips) const {
  if (loads.empty()) {
    throw errors::Error(errors::Reason::invalid_argument, "a sweep combines at least one load")
        .at("load_cases");
  }
  const stop::Scope scope(stop);
  const bool interiors = bounds || tips;
  require_memory(loads.size(), _parts->decomposition, interiors);
  const Bounds kind = !bounds                             ? Bounds::none
                      : shares_bounds(loads.size(), rows) ? Bounds::shared
                                                          : Bounds::own;
  const std::optional<std::string> key = key_of(loads, kind, tips);
  const auto make = [&]() -> BasisCache::Basis {
    std::vector<LoadOnTraces> condensed =
        sound(condense_loads(loads, *_parts->mesh, _parts->decomposition, _parts->condense(),
                             _parts->neumann, interiors));
    std::shared_ptr<const RowTips> of_tips;
    if (tips) of_tips = std::make_shared<const RowTips>(row_tips(*_parts, condensed));
    std::vector<BalancedLoad> of_bounds;
    if (bounds)
      of_bounds = balanced(loads, condensed, _parts->decomposition.subdomains, _parts->cut_mesh());
    CondensedBasis made = basis_of(std::move(condensed), std::move(of_bounds), *_parts);
    if (of_tips) {
      made.warnings.insert(made.warnings.end(), of_tips->warnings.begin(), of_tips->warnings.end());
      made.tips = std::move(of_tips);
    }
    if (kind == Bounds::shared)
      made.shared = shared_bounds(*_parts, made.loads, made.balanced, made.reduced);
    made.counted =
        std::make_unique<const Working>(_parts->at_work, made.bytes() + (key ? key->size() : 0));
    return std::make_shared<const CondensedBasis>(std::move(made));
  };
  return std::make_shared<const LoadBasis>(std::make_shared<const LoadBasis::Data>(
      LoadBasis::Data{shared_from_this(), key ? _parts->bases.get(*key, stop, make) : make()}));
}

template <class SolveRow>
bool MeshOperator::sweep_rows(const contact::ActiveSetOptions& options, contact::SweepColumns& rows,
                              std::vector<char>& start, const std::stop_token& stop,
                              std::span<const std::size_t> order, contact::OpenResponses* responses,
                              const SolveRow& solve_row) const {
  const auto contacts = _parts->decomposition.skeleton.contacts.size();
  if (rows.inclusions != _parts->mesh->inclusions.size() ||
      rows.contacts != contact_nodes().size() || (!start.empty() && start.size() != contacts))
    throw errors::Error(errors::Reason::internal, "rows of a sweep on another mesh");
  const stop::Scope scope(stop);
  contact::SweepSolver solver(*_parts->contact, _parts->sweep_geometry, options, start, responses);
  std::size_t solved = 0;
  try {
    for (; solved < rows.rows() && !stop.stop_requested(); ++solved)
      solve_row(solver, order.empty() ? solved : order[solved]);
  } catch (const errors::Error& error) {
    if (error.reason() != errors::Reason::cancelled || !stop.stop_requested()) throw;
  }
  start = solver.closed();
  return solved == rows.rows();
}

bool MeshOperator::sweep(const LoadBasis& basis, std::span<const double> coefficients,
                         const contact::ActiveSetOptions& options, contact::SweepColumns& rows,
                         std::vector<char>& start, const std::stop_token& stop) const {
  const std::size_t m = basis.size();
  if (basis._data->mesh_operator.get() != this || coefficients.size() != rows.rows() * m)
    throw errors::Error(errors::Reason::internal, "coefficients of another basis");
  const contact::SweepLoads& loads = basis._data->basis->reduced;
  const SharedBounds* shared = basis._data->basis->shared.get();
  const RowTips* tips = rows.tips > 0 ? basis._data->basis->tips.get() : nullptr;
  std::optional<RowBounds> bounds;
  if (shared != nullptr && !rows.energy_lower.empty()) bounds.emplace(*_parts, *shared, loads);
  return sweep_rows(options, rows, start, stop,
                    contact::solving_order(loads, coefficients, rows.rows()), loads.responses.get(),
                    [&](contact::SweepSolver& solver, std::size_t row) {
                      const auto c = coefficients.subspan(row * m, m);
                      solver.solve(loads, c, row, rows);
                      if (rows.status[row] != contact::Status::converged) return;
                      if (bounds) bounds->find(c, solver.answer(), row, rows);
                      if (tips != nullptr)
                        find_row_tips(*_parts, *tips, c, solver.answer(), row, rows);
                    });
}

bool MeshOperator::shares_bounds(std::size_t loads, std::uint64_t rows) const {
  return operators::shares_bounds(*_parts, loads, rows);
}

bool MeshOperator::sweep(std::span<const PreparedLoad> loads,
                         const contact::ActiveSetOptions& options, contact::SweepColumns& rows,
                         std::vector<char>& start, const std::stop_token& stop) const {
  if (loads.size() != rows.rows())
    throw errors::Error(errors::Reason::internal, "as many rows as loads");
  constexpr double once[] = {1.0};
  const auto solve_row = [&](contact::SweepSolver& solver, std::size_t row) {
    require_prepared(loads[row], false);
    const contact::CaseLoads parts[] = {loads[row]._data->loads()};
    MatrixXd constant = MatrixXd::Zero(1, 1);
    for (const ddm::CondensedLoad& part : parts[0].subdomains)
      constant(0, 0) += part.energy_constant;
    solver.solve(contact::reduce(*_parts->contact, parts, constant), once, row, rows);
  };
  return sweep_rows(options, rows, start, stop, {}, nullptr, solve_row);
}

PreparedLoad MeshOperator::combine(const LoadBasis& basis,
                                   std::span<const double> coefficients) const {
  if (basis._data->mesh_operator.get() != this || coefficients.size() != basis.size())
    throw errors::Error(errors::Reason::internal, "coefficients of another basis");
  const CondensedBasis& condensed = *basis._data->basis;
  const Eigen::Map<const Eigen::VectorXd> c(coefficients.data(),
                                            static_cast<Index>(coefficients.size()));
  auto data = std::make_shared<PreparedLoad::Data>();
  data->mesh_operator = shared_from_this();
  data->has_interior = !condensed.balanced.empty();
  if (data->has_interior) {
    data->balanced = operators::combine(condensed.balanced, coefficients);
    data->condensed.parts.obstacle = data->balanced->obstacle;
    data->parts_energy = condensed.reduced.parts_energy(coefficients);
  }
  data->condensed.warnings = condensed.warnings;
  for (std::size_t s = 0; s < condensed.products.size(); ++s) {
    data->condensed.subdomains.push_back(
        ddm::combine(on_subdomain(condensed.loads, s), condensed.products[s], c));
  }
  data->condensed.inclusion_forces.resize(_parts->mesh->inclusions.size());
  for (std::size_t j = 0; j < coefficients.size(); ++j) {
    const std::vector<contact::InclusionForce>& forces = condensed.loads[j].inclusion_forces;
    for (std::size_t i = 0; i < forces.size(); ++i) {
      add(data->condensed.inclusion_forces[i].on_nodes, forces[i].on_nodes, coefficients[j]);
      add(data->condensed.inclusion_forces[i].on_holders, forces[i].on_holders, coefficients[j]);
    }
  }
  return PreparedLoad(std::move(data));
}

const std::vector<std::array<std::int32_t, 2>>& MeshOperator::contact_nodes() const noexcept {
  return _parts->sweep_geometry.nodes;
}

}  // namespace anticrack::operators

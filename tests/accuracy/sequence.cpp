// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/sequence.hpp"
#include "support/silent_observer.hpp"
#include "support/solve.hpp"

#include <stdexcept>

namespace anticrack::accuracy {
namespace {

using anticrack::testing::Silent;

}  // namespace

contact::Answer solve(const operators::MeshOperator& op, const fem::Load& load, bool fields) {
  Silent silent;
  contact::Answer answer = testing::solve(op, load, contact::ActiveSetOptions{}, fields, silent);
  if (answer.status != contact::Status::converged) {
    throw std::runtime_error("not converged: " + answer.reason);
  }
  return answer;
}

contact::Answer solve(const operators::MeshOperator& op, const fem::Force& force,
                      const std::string& boundary, bool fields) {
  fem::Load load;
  load.name = "case";
  load.force = force;
  load.boundary_value = boundary;
  return solve(op, load, fields);
}

contact::Answer solve_bounded(const operators::MeshOperator& op, const fem::Load& load) {
  const fem::Load* const one[] = {&load};
  const auto prepared = std::get<operators::PreparedLoad>(std::move(op.prepare(one).front()));
  Silent silent;
  contact::Answer answer = op.solve(prepared, {}, true, silent);
  op.estimate(prepared, answer);
  return answer;
}

std::shared_ptr<const operators::MeshOperator> factorise(mesh::Mesh mesh,
                                                         std::size_t condensed_up_to) {
  return operators::MeshOperator::factorise(std::make_shared<const mesh::Mesh>(std::move(mesh)), 2,
                                            {}, condensed_up_to);
}

}  // namespace anticrack::accuracy

// SPDX-License-Identifier: GPL-3.0-or-later
//
// One load case from its load to its answer, as a job solves it.
#pragma once

#include <memory>
#include <utility>
#include <variant>

#include "operators/uzawa_block.hpp"

namespace anticrack::testing {

/// Algorithm 2 runs as a block of one column.
inline contact::Answer solve(const operators::MeshOperator& op, const operators::PreparedLoad& load,
                             const contact::SolverOptions& options, bool fields,
                             contact::Observer& observer) {
  if (const auto* exact = std::get_if<contact::ActiveSetOptions>(&options))
    return op.solve(load, *exact, fields, observer);
  const auto& uzawa = std::get<contact::UzawaOptions>(options);
  operators::UzawaBlock block(op.shared_from_this(), uzawa.mass, 1);
  block.add(load, uzawa, fields, observer);
  while (block.columns() > 0) block.step();
  return std::move(block.take_ended().front().answer);
}

/// Throws the error of a load that cannot be prepared.
inline contact::Answer solve(const operators::MeshOperator& op, const fem::Load& load,
                             const contact::SolverOptions& options, bool fields,
                             contact::Observer& observer) {
  const fem::Load* const one[] = {&load};
  const auto prepared = std::move(op.prepare(one).front());
  if (const auto* error = std::get_if<errors::Error>(&prepared)) throw errors::Error(*error);
  return solve(op, std::get<operators::PreparedLoad>(prepared), options, fields, observer);
}

}  // namespace anticrack::testing

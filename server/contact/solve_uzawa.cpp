// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "contact/solve.hpp"
#include "contact/uzawa_block.hpp"

namespace anticrack::contact {

Answer solve_uzawa(const TraceProblem& problem, const mesh::Mesh& mesh, const CaseLoads& loads,
                   const UzawaOptions& options, bool fields, Observer& observer) {
  UzawaBlock block(problem, mesh, options.mass, 1);
  block.add(loads, options, fields, observer);
  while (block.columns() > 0) {
    block.step();
  }
  return std::move(block.take_ended().front().answer);
}

}  // namespace anticrack::contact

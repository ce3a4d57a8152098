// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "contact/block_lcp.hpp"
#include "contact/contact_blocks.hpp"
#include "contact/joined_membrane.hpp"
#include "contact/solve.hpp"
#include "contact/sweep_solver.hpp"
#include "contact/trace_problem.hpp"

namespace anticrack::contact {

/// Whether the interfaces are too long for the dense matrices of SkeletonProblem.
bool is_long(const ddm::Decomposition& decomposition, std::size_t most);

/// The contact problem of a membrane whose interfaces are too long for SkeletonProblem: the same
/// answers to 1e-10. Immutable, thread-safe; keeps a reference to the traces.
class JoinedProblem {
 public:
  /// As JoinedMembrane and ContactBlocks.
  JoinedProblem(const TraceProblem& traces, int threads);

  const JoinedMembrane& membrane() const noexcept { return _membrane; }
  const BlockLcp& lcp() const noexcept { return _lcp; }
  const TraceProblem& traces() const noexcept { return _traces; }

  /// As contact::recover_fields: two solves for each case.
  void recover_fields(std::span<const SolvedCase> cases) const;
  std::size_t bytes() const noexcept { return _membrane.bytes() + _blocks.bytes(); }

 private:
  const TraceProblem& _traces;
  JoinedMembrane _membrane;
  ContactBlocks _blocks;
  BlockLcp _lcp;
};

/// As on a skeleton, to 1e-10. `loads`: of JoinedMembrane::loads.
Answer solve_active_set(const JoinedProblem& problem, const mesh::Mesh& mesh,
                        const CaseLoads& loads, const ActiveSetOptions& options, bool fields,
                        Observer& observer, std::span<const char> start = {});

}  // namespace anticrack::contact

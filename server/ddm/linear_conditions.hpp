// SPDX-License-Identifier: GPL-3.0-or-later
//
// Linear conditions between unknowns, solved one after another for one unknown each.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace anticrack::ddm {

/// A factor times an entry of a vector.
struct Term {
  std::int32_t index = 0;
  double factor = 0;
};
using Terms = std::vector<Term>;

/// An unknown in terms of what is left: entries of q (free unknowns), of d (jumps) and of p (held
/// values).
struct Row {
  Terms free, jumps, held;  ///< each ascending in its index
};

/// Starts with all unknowns free. Each condition is solved for the last of its unknowns or, where
/// only motions are left, for the one with the largest factor; O(terms) each where, as on meshes,
/// conditions stay within a node.
class LinearConditions {
 public:
  /// Unknowns 0..motions-1 are rigid motions: others are eliminated before them.
  LinearConditions(std::size_t unknowns, std::size_t motions);

  /// x_unknown = sum of `of`, whose unknowns are free. To be called before the conditions.
  void follow(std::int32_t unknown, const Terms& of);
  /// sum of `of` = p_k. Returns the row over p that must vanish where the motions have no say any
  /// more; empty where they had.
  Terms hold(const Terms& of, std::int32_t k);
  /// x_plus - x_minus = d_k. Where earlier conditions determine it already the unknowns stay, and
  /// it returns the difference as terms of d.
  std::optional<Terms> part(std::int32_t plus, std::int32_t minus, std::int32_t k);

  /// Of each unknown, and the number of free unknowns, which are numbered ascending.
  std::vector<Row> rows(std::size_t& free);

 private:
  Row reduced(const Row& row);
  bool solve(Row condition);

  std::size_t _motions;
  std::vector<std::optional<Row>> _solved;  // entries of `free` are unknowns until rows()
};

}  // namespace anticrack::ddm

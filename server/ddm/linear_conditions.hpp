// SPDX-License-Identifier: GPL-3.0-or-later
//
// Linear conditions between unknowns. They are solved one after another, each for one unknown.
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

/// An unknown as a sum over entries of q (free unknowns), of d (jumps) and of p (held values).
struct Row {
  Terms free, jumps, held;  ///< each ascending in its index
};

/// Starts with all unknowns free. Each condition is solved for the last of its unknowns or, if only
/// motions are left in it, for the one with the largest factor. O(terms) each if conditions stay
/// within a node, as they do on meshes.
class LinearConditions {
 public:
  /// Unknowns 0..motions-1 are rigid motions; other unknowns are eliminated before them.
  LinearConditions(std::size_t unknowns, std::size_t motions);

  /// Sets x_unknown = sum of `of`, whose unknowns must be free. Call it before hold(), part().
  void follow(std::int32_t unknown, const Terms& of);
  /// Adds the condition: sum of `of` = p_k. If earlier conditions determine the sum already,
  /// returns the sum over p that must vanish for them to agree; otherwise returns nothing.
  Terms hold(const Terms& of, std::int32_t k);
  /// Adds the condition x_plus - x_minus = d_k. If earlier conditions determine the difference
  /// already, changes nothing and returns it as terms of d.
  std::optional<Terms> part(std::int32_t plus, std::int32_t minus, std::int32_t k);

  /// The row of each unknown. Sets the number of free unknowns, which keep their order in q.
  std::vector<Row> rows(std::size_t& free);

 private:
  Row reduced(const Row& row);
  bool solve(Row condition);

  std::size_t _motions;
  std::vector<std::optional<Row>> _solved;  // entries of `free` are unknowns until rows()
};

}  // namespace anticrack::ddm

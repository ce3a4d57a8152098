// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <stop_token>
#include <vector>

#include "contact/answer.hpp"
#include "contact/options.hpp"
#include "operators/mesh_operator.hpp"

namespace anticrack::contact {
class Observer;
}  // namespace anticrack::contact

namespace anticrack::operators {

/// Load cases of one mesh that iterate Algorithm 2 together, one column each: matrix products
/// instead of matrix-vector products. Columns join and leave between iterations, each with its own
/// theta, p, stopping rule and observer. The results of a column depend on the other columns by
/// rounding only (1e-12 of a converged answer). For one thread.
class UzawaBlock {
 public:
  /// Throws errors::Error (not_implemented) where Algorithm 2 does not apply to the mesh.
  UzawaBlock(std::shared_ptr<const MeshOperator> mesh_operator, contact::Mass mass, int capacity);
  ~UzawaBlock();
  UzawaBlock(const UzawaBlock&) = delete;
  UzawaBlock& operator=(const UzawaBlock&) = delete;

  int columns() const noexcept;   ///< columns that iterate
  int capacity() const noexcept;  ///< most columns that may iterate at once

  /// Adds a column and returns its place, below capacity(), which it keeps until its answer is
  /// taken. `options.mass` must be the block's; the observer must outlive the column. After a
  /// `stop` its forces and tips are not measured.
  int add(PreparedLoad load, const contact::UzawaOptions& options, bool fields,
          contact::Observer& observer, std::stop_token stop = {});
  /// Iterates every column once. O(n_G^2 columns), no allocation. An observer that returns false
  /// cancels its column.
  void step();

  struct Ended {
    int place = 0;
    contact::Answer answer;
  };
  /// Takes the columns that have ended, in the order of their places, and frees the places. Each
  /// takes a backward solve, for its fields, forces and tips.
  std::vector<Ended> take_ended();

 private:
  struct State;
  void measure(const PreparedLoad& load, contact::Answer& answer,
               const std::stop_token& stop) const;
  std::unique_ptr<State> _state;
};

}  // namespace anticrack::operators

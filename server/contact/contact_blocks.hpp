// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "contact/dense_lcp.hpp"
#include "contact/joined_membrane.hpp"
#include "contact/pair_forces.hpp"

namespace anticrack::contact {

/// Most contacts of a block; a crack with more is cut into several blocks.
constexpr std::size_t most_of_a_block = 400;

/// Contacts of one crack, or of a part of a long crack, with their own S^ in the membrane around
/// them: nodes further away than a fraction of the block's length are held, other cracks stay
/// closed, and the rigid motions of their inclusion are free.
struct ContactBlock {
  std::vector<std::int32_t> contacts;    ///< of d, ascending
  std::vector<std::int32_t> conditions;  ///< the contacts, then the dependent ones made of them
  DenseLcp lcp;
};

/// S^ of all contacts by blocks, as a preconditioner and as small contact problems. A crack of many
/// blocks has hat functions as well, each over two blocks, on which S^ is exact: they carry what is
/// smooth along the crack. Immutable.
class ContactBlocks {
 public:
  /// Costs O(c m^2) with blocks of m contacts, and a solve for each hat.
  ContactBlocks(const JoinedMembrane& membrane, const PairForces& forces, int threads);

  const std::vector<ContactBlock>& blocks() const noexcept { return _blocks; }
  /// Hats as columns, shape (d, hats), and P'S^ P; no columns without long cracks.
  const Eigen::SparseMatrix<double>& hats() const noexcept { return _hats; }
  const std::optional<DenseLcp>& coarse() const noexcept { return _coarse; }
  const Eigen::MatrixXd& coarse_matrix() const noexcept { return _coarse_matrix; }
  std::size_t bytes() const noexcept;

 private:
  std::vector<ContactBlock> _blocks;
  Eigen::SparseMatrix<double> _hats;
  Eigen::MatrixXd _coarse_matrix;
  std::optional<DenseLcp> _coarse;
};

}  // namespace anticrack::contact

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <shared_mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "contact/dense.hpp"

namespace anticrack::contact {

/// For loads r = R c that combine a few: with d = 0 on the closed nodes and lambda = 0 on the open
/// ones, d and S d - r are linear in c,
///
///   d = D c,   S d - r = F c,   D_open = S_open^-1 R_open,   F = S D - R.
///
/// D and F are kept for each set of closed nodes that was met, so that a step of a row whose set is
/// known costs a product with a few columns. As many sets as fit into bytes() are kept; then all
/// are forgotten. The bits of D and F depend on the set alone. Thread-safe.
class OpenResponses {
 public:
  struct Response {
    bool regular = false;  ///< whether S is, on the open nodes; if not, there is neither D nor F
    Eigen::MatrixXd d, force;
  };

  /// `loads`: R, (contacts, loads).
  explicit OpenResponses(Eigen::MatrixXd loads);

  /// Whether responses to so many loads cost less than a factor of S.
  bool pay() const noexcept { return _loads.cols() <= _loads.rows() / 8; }
  /// The most memory that is kept.
  std::size_t bytes() const noexcept;

  /// Of S with `scale` on both sides to R with it. `factor`: work space. O(c^3) for a set that is
  /// not known.
  std::shared_ptr<const Response> of(const std::vector<char>& closed, const Eigen::MatrixXd& scaled,
                                     const Eigen::VectorXd& scale, OpenFactor& factor);

 private:
  struct Hash : std::hash<std::string_view> {
    using is_transparent = void;
  };
  std::size_t bytes_of_one() const noexcept;

  const Eigen::MatrixXd _loads;
  std::shared_mutex _mutex;
  std::unordered_map<std::string, std::shared_ptr<const Response>, Hash, std::equal_to<>> _known;
};

}  // namespace anticrack::contact

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
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
/// known costs a product with a few columns. As many sets as fit into some MiB are kept; then all
/// are forgotten. The bits of D and F depend on the set alone. For one thread; keeps references.
class OpenResponses {
 public:
  struct Response {
    bool regular = false;  ///< whether S is, on the open nodes; if not, there is neither D nor F
    Eigen::MatrixXd d, force;
  };

  /// Whether responses to so many loads cost less than a factor of S.
  static bool pay(Eigen::Index contacts, Eigen::Index loads);

  /// `matrix`: S, (c,c) with unit diagonal; `loads`: R, (c,loads), scaled likewise.
  OpenResponses(const Eigen::MatrixXd& matrix, Eigen::MatrixXd loads);

  /// Valid until the next call. O(c^3) for a set that is not known.
  const Response& of(const std::vector<char>& closed);

 private:
  struct Hash : std::hash<std::string_view> {
    using is_transparent = void;
  };
  const Eigen::MatrixXd& _matrix;
  const Eigen::MatrixXd _loads;
  const std::size_t _most;
  OpenFactor _factor;
  std::unordered_map<std::string, Response, Hash, std::equal_to<>> _known;
};

}  // namespace anticrack::contact

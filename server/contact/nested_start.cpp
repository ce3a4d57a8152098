// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/nested_start.hpp"

#include <utility>

#include "base/at.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Prolongation = Eigen::SparseMatrix<double>;
using Chains = std::vector<std::vector<std::int32_t>>;

/// With fewer contacts a coarse problem saves nothing over a start with all contacts closed.
constexpr Index fewest_contacts = 32;
/// A coarse problem that takes more steps is no help.
constexpr int most_steps = 20;

/// Keeps every second contact of each chain, and numbers them anew. Beyond the ends the jump is 0,
/// as at a tip.
Prolongation coarsen(Index contacts, Chains& chains) {
  std::vector<Eigen::Triplet<double>> entries;
  std::int32_t count = 0;
  for (std::vector<std::int32_t>& chain : chains) {
    std::vector<std::int32_t> kept;
    for (std::size_t i = 1; i < chain.size(); i += 2) {
      entries.emplace_back(chain[i], count, 1.0);
      entries.emplace_back(chain[i - 1], count, 0.5);
      if (i + 1 < chain.size()) entries.emplace_back(chain[i + 1], count, 0.5);
      kept.push_back(count++);
    }
    chain = std::move(kept);
  }
  Prolongation result(contacts, count);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace

NestedStart::NestedStart(const MatrixXd& matrix, Chains chains) {
  MatrixXd coarse;
  for (const MatrixXd* fine = &matrix; fine->rows() > fewest_contacts;) {
    const Prolongation prolongation = coarsen(fine->rows(), chains);
    if (prolongation.cols() == 0) return;
    const MatrixXd half = *fine * prolongation;
    coarse = prolongation.transpose() * half;
    fine = &coarse;
    _levels.push_back({prolongation, DenseLcp(coarse)});
  }
}

std::vector<char> NestedStart::closed(const VectorXd& r, const VectorXd& magnitude) const {
  std::vector<std::pair<VectorXd, VectorXd>> loads;  // per level
  for (const Level& level : _levels) {
    const VectorXd& fine = loads.empty() ? r : loads.back().first;
    const VectorXd& fine_magnitude = loads.empty() ? magnitude : loads.back().second;
    loads.emplace_back(level.prolongation.transpose() * fine,
                       level.prolongation.transpose() * fine_magnitude);
  }
  std::vector<char> start;
  for (std::size_t k = _levels.size(); k-- > 0;) {
    const Level& level = _levels[k];
    LcpOptions options;
    options.max_steps = most_steps;
    const LcpAnswer answer = level.lcp.solve(loads[k].first, loads[k].second, options, start);
    if (answer.status != LcpStatus::solved) return {};
    const VectorXd jump = level.prolongation * answer.d;
    start.resize(at(jump.size()));
    for (Index i = 0; i < jump.size(); ++i) start[at(i)] = jump[i] > 0 ? 0 : 1;
  }
  return start;
}

std::size_t NestedStart::bytes() const noexcept {
  std::size_t bytes = 0;
  for (const Level& level : _levels)
    bytes += level.lcp.bytes() + at(level.prolongation.nonZeros()) * (sizeof(double) + sizeof(int));
  return bytes;
}

}  // namespace anticrack::contact

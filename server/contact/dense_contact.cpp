// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/dense_contact.hpp"

#include <utility>

#include "base/at.hpp"
#include "contact/dense.hpp"
#include "stop/stop.hpp"

namespace anticrack::contact {

using Eigen::MatrixXd;
using Eigen::VectorXd;

DenseContact::DenseContact(MatrixXd matrix, const TraceProblem& traces)
    : _nested_start(matrix, traces.chains()),
      _lcp(std::move(matrix), traces.decomposition().skeleton.dependent,
           traces.pair_forces().contact_mass().cwiseInverse()) {}

LcpAnswer DenseContact::solve(const Reduced& load, const LcpOptions& options,
                              std::span<const char> start, const OnStep& on_step) const {
  if (!start.empty() || !options.tied.empty())
    return _lcp.solve(load.r, load.magnitude, options, start, on_step);
  return _lcp.solve(load.r, load.magnitude, options, _nested_start.closed(load.r, load.magnitude),
                    on_step);
}

std::vector<Opened> DenseContact::solve_open(const std::vector<char>& closed,
                                             std::span<const VectorXd> r) const {
  OpenFactor own;
  if (!closed.empty()) own.factorise(_lcp.scaled_matrix(), _lcp.scaled_conditions().rows(), closed);
  const OpenFactor& factor = closed.empty() ? all_open() : own;
  std::vector<Opened> result;
  for (const VectorXd& one : r) {
    stop::look("solving for contact");
    if (factor.regular()) {
      const VectorXd d = _lcp.solve_open(factor, one);
      result.push_back({d, one - _lcp.apply(d)});
    } else {
      result.push_back({VectorXd::Zero(one.size()), one, false});
    }
  }
  return result;
}

VectorXd DenseContact::apart(const MatrixXd& d, const MatrixXd& r) const {
  const OpenFactor& factor = all_open();
  if (!factor.regular()) return {};
  const auto scale = _lcp.scale().head(_lcp.size());
  MatrixXd off = -(scale.asDiagonal() * r);
  for (Eigen::Index k = 0; k < d.cols(); ++k) {
    stop::look("solving for contact");
    for (Eigen::Index j = 0; j < d.rows(); ++j)
      if (d(j, k) != 0) off.col(k) += d(j, k) / scale[j] * _lcp.scaled_matrix().col(j);
  }
  return factor.squares(off);
}

namespace {

class DenseRows final : public RowContact {
 public:
  DenseRows(const DenseLcp& lcp, const LcpOptions& options, std::span<const char> start,
            const NestedStart& nested, MatrixXd motions, OpenResponses* responses)
      : _contact(lcp, options, start, &nested, responses), _motions(std::move(motions)) {}

  void solve(const VectorXd& r, const VectorXd& magnitude, const VectorXd& coefficients) override {
    _contact.solve(r, magnitude, {}, coefficients);
  }
  const LcpAnswer& answer() const override { return _contact.answer(); }
  void motion(VectorXd& of_jumps) const override {
    multiply(_motions, answer().d.head(_motions.cols()), of_jumps);
  }

 private:
  LcpSequence _contact;
  MatrixXd _motions;  // (motions, d)
};

}  // namespace

std::unique_ptr<RowContact> DenseContact::rows(const LcpOptions& options,
                                               std::span<const char> start, MatrixXd motions,
                                               OpenResponses* responses) const {
  return std::make_unique<DenseRows>(_lcp, options, start, _nested_start, std::move(motions),
                                     responses);
}

const OpenFactor& DenseContact::all_open() const {
  return _all_open.get([this] {
    OpenFactor factor;
    factor.factorise(_lcp.scaled_matrix(), _lcp.scaled_conditions().rows(),
                     std::vector<char>(at(_lcp.conditions()), 0));
    return factor;
  });
}

std::size_t DenseContact::bytes() const noexcept {
  const auto all_open = _all_open.known() == nullptr ? 0 : _lcp.size() * _lcp.size();
  return sizeof(double) * at(all_open) + _nested_start.bytes() + _lcp.bytes();
}

}  // namespace anticrack::contact

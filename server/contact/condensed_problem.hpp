// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "contact/contact_problem.hpp"
#include "contact/dense_contact.hpp"

namespace anticrack::contact {

/// All subdomains are joined at their traces and condensed to the cracks. With K = sum_i S_i over
/// the skeleton's unknowns w = Z q - P d + O p (Maps), load h = sum_i g_i - K O p, x is q and
///
///   H = Z'K Z,  C = Z'K P,  D = P'K P,  S^ = D - C'H^-1 C,  r = C'H^-1 Z'h - P'h
///   q = H^-1 (Z'h + C d)
///
/// Construction O(n^3) with n unknowns.
class CondensedProblem final : public ContactProblem {
 public:
  /// Throws errors::Error (numerical) when H is not positive definite.
  explicit CondensedProblem(const TraceProblem& traces);

  std::vector<ddm::CondensedLoad> loads(
      std::size_t subdomain, const Eigen::Ref<const Eigen::MatrixXd>& of_nodes,
      const Eigen::Ref<const Eigen::MatrixXd>& dirichlet) const override;
  Eigen::VectorXd solve(const Reduced& load, const Eigen::VectorXd& d) const override;
  Work work(std::span<const ddm::CondensedLoad> loads, const Reduced& reduced) const override;
  void fill(std::span<const ddm::CondensedLoad> loads, const Eigen::VectorXd& x,
            const Eigen::VectorXd& w, TraceState& state) const override;
  void refine(std::span<const ddm::CondensedLoad> loads, const TraceState& state,
              const LcpAnswer& solution, Position& position) const override;
  LcpAnswer solve_contact(const Reduced& load, const LcpOptions& options,
                          std::span<const char> start, const OnStep& on_step) const override;
  std::vector<Opened> solve_open(const std::vector<char>& closed,
                                 std::span<const Eigen::VectorXd> r,
                                 double tolerance) const override;
  Eigen::VectorXd apart(const Eigen::MatrixXd& d, const Eigen::MatrixXd& r) const override {
    return _contact.apart(d, r);
  }
  std::unique_ptr<RowContact> rows(const LcpOptions& options, std::span<const char> start,
                                   std::vector<ddm::Terms> motions,
                                   OpenResponses* responses) const override;
  void recover_fields(std::span<const SolvedCase> cases) const override;
  std::vector<std::vector<double>> fields_of(std::span<const Displaced> displaced) const override;
  std::size_t bytes() const noexcept override;

  const DenseLcp& lcp() const noexcept { return _contact.lcp(); }

 protected:
  Reduced eliminate(const Eigen::VectorXd& h, std::span<const ddm::CondensedLoad> loads,
                    const Eigen::VectorXd& p, bool refined) const override;

 private:
  struct Blocks;
  CondensedProblem(const TraceProblem& traces, Blocks blocks);

  /// K w. O(n_G^2).
  Eigen::VectorXd apply(const Eigen::VectorXd& w) const;
  /// How much a unit jump of each contact changes a sum of unknowns. O(c) a term.
  Eigen::VectorXd response(const ddm::Terms& terms) const;

  Eigen::MatrixXd _h;               // Cholesky factor of H, lower triangle
  Eigen::MatrixXd _closed_to_open;  // W = H^-1 C
  DenseContact _contact;
};

}  // namespace anticrack::contact

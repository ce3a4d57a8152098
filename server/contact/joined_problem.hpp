// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "contact/block_lcp.hpp"
#include "contact/contact_blocks.hpp"
#include "contact/contact_problem.hpp"
#include "contact/dense_contact.hpp"
#include "contact/joined_membrane.hpp"

namespace anticrack::contact {

/// Whether a membrane is joined: interfaces of more than `condensed_up_to` values are too long for
/// the dense matrices of CondensedProblem.
bool is_joined(const ddm::Decomposition& decomposition, std::size_t condensed_up_to);

/// Contacts of a joined membrane up to which S^ is dense: it has 290 MB then, and takes a few times
/// that with its factors. Where each crack fits in a ContactBlock, blocks alone are nearly exact,
/// and the limit is 1000.
constexpr std::size_t most_dense_contacts = 6000;
constexpr std::size_t dense_contacts(bool long_cracks) noexcept {
  return long_cracks ? most_dense_contacts : most_dense_contacts / 6;
}
std::size_t dense_contacts(const TraceProblem& traces);

/// The contact problem of a JoinedMembrane; its answers agree with those of a CondensedProblem to
/// 1e-10. Its steps report criterion, energy, gap and complementarity from jumps and multipliers
/// alone, since traces would cost a solve. With more than `most_dense` contacts S^ is not formed,
/// and conjugate gradients solve for the jumps.
class JoinedProblem final : public ContactProblem {
 public:
  /// Costs and errors are those of JoinedMembrane and ContactBlocks.
  JoinedProblem(const TraceProblem& traces, int threads, std::size_t most_dense);

  std::vector<ddm::CondensedLoad> loads(
      std::size_t subdomain, const Eigen::Ref<const Eigen::MatrixXd>& of_nodes,
      const Eigen::Ref<const Eigen::MatrixXd>& dirichlet) const override;
  std::vector<double> compliances(std::span<const ddm::Terms* const> sums) const override {
    return _membrane.compliances(sums);
  }
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
    return _dense ? _dense->apart(d, r) : Eigen::VectorXd();
  }
  std::unique_ptr<RowContact> rows(const LcpOptions& options, std::span<const char> start,
                                   std::vector<ddm::Terms> motions,
                                   OpenResponses* responses) const override;
  void recover_fields(std::span<const SolvedCase> cases) const override;
  std::vector<std::vector<double>> fields_of(std::span<const Displaced> displaced) const override;
  std::unique_ptr<const OpenMembrane> open_membrane() const override;
  std::size_t bytes() const noexcept override;

  const JoinedMembrane& membrane() const noexcept { return _membrane; }
  /// Only if S^ is not formed.
  const BlockLcp& by_blocks() const { return _by_blocks.value().lcp; }

 protected:
  Reduced eliminate(const Eigen::VectorXd& h, std::span<const ddm::CondensedLoad> loads,
                    const Eigen::VectorXd& p, bool refined) const override;

 private:
  struct ByBlocks {
    ByBlocks(const JoinedMembrane& membrane, const Conditions& conditions, int threads);
    ContactBlocks blocks;
    BlockLcp lcp;
  };

  JoinedMembrane _membrane;
  std::optional<DenseContact> _dense;  // or else:
  std::optional<ByBlocks> _by_blocks;
};

}  // namespace anticrack::contact

// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/basis_fields.hpp"

#include <algorithm>
#include <utility>

#include "contact/answer.hpp"
#include "operators/displacement_bounds.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {

void basis_fields(const MeshOperator::Parts& parts, std::span<const LoadOnTraces> loads,
                  std::span<const ddm::Terms* const> forces,
                  const std::function<void(std::vector<double>)>& take) {
  constexpr const char* finding = "finding what rows share";
  const auto contacts = static_cast<Eigen::Index>(parts.decomposition.skeleton.independent);
  for (const LoadOnTraces& load : loads) {
    stop::look(finding);
    const contact::Reduced closed = parts.contact->reduce(
        load.subdomains, contact::held_values(parts.decomposition, load.subdomains), true);
    contact::Answer answer;
    for (const Eigen::VectorXd& trace : parts.problem.scatter(
             parts.contact->values(closed.x, Eigen::VectorXd::Zero(contacts), closed.p)))
      answer.side_traces.emplace_back(trace.begin(), trace.end());
    const contact::SolvedCase one{load.subdomains, answer};
    parts.contact->recover_fields({&one, 1});
    take(of_copies(answer.fields));
  }
  const ddm::Terms none;
  std::vector<contact::Displaced> displaced;
  for (Eigen::Index i = 0; i < contacts; ++i)
    displaced.push_back({&none, Eigen::VectorXd::Unit(contacts, i)});
  for (const ddm::Terms* force : forces)
    displaced.push_back({force, Eigen::VectorXd::Zero(contacts)});
  constexpr std::size_t together = 8;
  for (std::size_t done = 0; done < displaced.size(); done += together) {
    stop::look(finding);
    const std::span some =
        std::span(displaced).subspan(done, std::min(together, displaced.size() - done));
    for (auto& one : parts.contact->fields_of(some)) take(std::move(one));
  }
}

}  // namespace anticrack::operators

// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/forest.hpp"

#include <cstddef>

#include "errors/errors.hpp"
#include "mesh/at.hpp"

namespace anticrack::contact {

Forest::Forest(const ddm::Skeleton& skeleton)
    : _root(skeleton.unknowns, -1),
      _hung(skeleton.contacts.size(), -1),
      _sign(static_cast<Eigen::Index>(skeleton.contacts.size())) {
  std::vector<std::vector<std::size_t>> contacts_of(skeleton.unknowns);
  for (std::size_t c = 0; c < skeleton.contacts.size(); ++c) {
    contacts_of[at(skeleton.contacts[c].plus)].push_back(c);
    contacts_of[at(skeleton.contacts[c].minus)].push_back(c);
  }
  for (std::size_t root = 0; root < skeleton.unknowns; ++root) {
    if (_root[root] >= 0) continue;
    _root[root] = static_cast<std::int32_t>(root);
    _roots.push_back(static_cast<Eigen::Index>(root));
    std::vector<std::size_t> reached = {root};
    while (!reached.empty()) {
      const std::size_t above = reached.back();
      reached.pop_back();
      for (const std::size_t c : contacts_of[above]) {
        if (_hung[c] >= 0) continue;
        const auto plus = at(skeleton.contacts[c].plus), minus = at(skeleton.contacts[c].minus);
        const std::size_t below = plus == above ? minus : plus;
        if (_root[below] >= 0) {
          throw errors::Error(errors::Reason::internal,
                              "the contact conditions of the skeleton depend on each other");
        }
        _root[below] = static_cast<std::int32_t>(root);
        _hung[c] = static_cast<Eigen::Index>(below);
        _sign[static_cast<Eigen::Index>(c)] = below == minus ? 1 : -1;
        _downwards.push_back({static_cast<Eigen::Index>(below), static_cast<Eigen::Index>(above),
                              static_cast<Eigen::Index>(c)});
        reached.push_back(below);
      }
    }
  }
}

Eigen::VectorXd Forest::expand(const Eigen::VectorXd& q, const Eigen::VectorXd& d) const {
  Eigen::VectorXd w(unknowns());
  for (Eigen::Index k = 0; k < free_count(); ++k) w[_roots[at(k)]] = q[k];
  for (const Hanging& hanging : _downwards)
    w[hanging.unknown] = w[hanging.above] - _sign[hanging.contact] * d[hanging.contact];
  return w;
}

void Forest::accumulate(Eigen::Ref<Eigen::MatrixXd> y) const {
  for (auto hanging = _downwards.rbegin(); hanging != _downwards.rend(); ++hanging)
    y.row(hanging->above) += y.row(hanging->unknown);
}

}  // namespace anticrack::contact

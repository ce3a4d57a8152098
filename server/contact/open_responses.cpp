// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/open_responses.hpp"

#include <algorithm>
#include <mutex>
#include <utility>

#include "base/at.hpp"
#include "stop/stop.hpp"

namespace anticrack::contact {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

OpenResponses::OpenResponses(MatrixXd loads) : _loads(std::move(loads)) {}

std::size_t OpenResponses::bytes_of_one() const noexcept {
  constexpr std::size_t around = 256;  // of the allocator, the table and the keys
  return 2 * sizeof(double) * at(_loads.size()) + at(_loads.rows()) + around;
}

std::size_t OpenResponses::bytes() const noexcept {
  constexpr std::size_t most = std::size_t{64} << 20U, sets = 16384;
  return pay() ? std::min(most, sets * bytes_of_one()) : 0;
}

std::shared_ptr<const OpenResponses::Response> OpenResponses::of(const std::vector<char>& closed,
                                                                 const MatrixXd& scaled,
                                                                 const VectorXd& scale,
                                                                 OpenFactor& factor) {
  const std::string_view key(closed.data(), closed.size());
  {
    const std::shared_lock lock(_mutex);
    if (const auto known = _known.find(key); known != _known.end()) return known->second;
  }
  stop::look("solving for contact");
  auto made = std::make_shared<Response>();
  made->regular = factor.factorise(scaled, {}, closed);
  if (made->regular) {
    made->force = -(scale.asDiagonal() * _loads);
    made->d.resize(_loads.rows(), _loads.cols());
    for (Index j = 0; j < _loads.cols(); ++j) factor.solve(-made->force.col(j), made->d.col(j));
    if (!factor.empty()) made->force += scaled * made->d;
  }
  const std::unique_lock lock(_mutex);
  if ((_known.size() + 1) * bytes_of_one() > bytes()) _known.clear();
  return _known.try_emplace(std::string(key), std::move(made)).first->second;
}

}  // namespace anticrack::contact

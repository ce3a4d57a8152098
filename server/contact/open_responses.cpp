// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/open_responses.hpp"

#include <algorithm>
#include <utility>

#include "base/at.hpp"
#include "stop/stop.hpp"

namespace anticrack::contact {

using Eigen::Index;
using Eigen::MatrixXd;

bool OpenResponses::pay(Index contacts, Index loads) { return loads <= contacts / 8; }

OpenResponses::OpenResponses(const MatrixXd& matrix, MatrixXd loads)
    : _matrix(matrix),
      _loads(std::move(loads)),
      _most((std::size_t{16} << 20U) /
            (2 * sizeof(double) * at(std::max<Index>(1, _loads.size())))) {
  _factor.reserve(_matrix.rows());
}

const OpenResponses::Response& OpenResponses::of(const std::vector<char>& closed) {
  const std::string_view key(closed.data(), closed.size());
  if (const auto known = _known.find(key); known != _known.end()) return known->second;
  if (_known.size() > _most) _known.clear();
  stop::look("solving for contact");
  Response& made = _known[std::string(key)];
  made.regular = _factor.factorise(_matrix, {}, closed);
  if (!made.regular) return made;
  made.d.resize(_loads.rows(), _loads.cols());
  for (Index j = 0; j < _loads.cols(); ++j) _factor.solve(_loads.col(j), made.d.col(j));
  made.force = -_loads;
  if (!_factor.empty()) made.force += _matrix * made.d;
  return made;
}

}  // namespace anticrack::contact

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <stop_token>
#include <utility>

#include "errors/errors.hpp"

namespace anticrack::fem {

/// A function of the plane that may be expensive, may jump, and is known by its values only. Finite
/// wherever it is asked: it throws where it is not.
using ScalarField = std::function<double(double x, double y)>;

/// Evaluates a field, counts, and knows when to stop. `exhausted` is a request to the integrators,
/// which finish what they began: the count may pass a limit by the points of a few rules.
class CountedField {
 public:
  CountedField(const ScalarField& field, std::size_t limit, std::stop_token stop = {})
      : _field(field), _limit(limit), _stop(std::move(stop)) {}

  /// Throws errors::Error (cancelled) soon after a stop was requested.
  double operator()(double x, double y) {
    constexpr std::size_t evaluations_between_looks = 1024;
    if (++_count % evaluations_between_looks == 0 && _stop.stop_requested()) {
      throw errors::Error(errors::Reason::cancelled, "stopped while integrating a load");
    }
    const double value = _field(x, y);
    _peak = std::max(_peak, std::abs(value));
    return value;
  }

  /// Allows `evaluations` more until the next call, within the limit of the whole field.
  void allow(std::size_t evaluations) noexcept {
    _allowed = evaluations > _limit - std::min(_count, _limit) ? _limit : _count + evaluations;
    _peak = 0;
  }

  /// Greatest |f| since the last `allow`.
  double peak() const noexcept { return _peak; }
  bool exhausted() const noexcept { return _count >= _allowed; }
  bool spent() const noexcept { return _count >= _limit; }
  std::size_t count() const noexcept { return _count; }

 private:
  const ScalarField& _field;
  std::size_t _limit;
  std::stop_token _stop;
  std::size_t _allowed = std::numeric_limits<std::size_t>::max();
  std::size_t _count = 0;
  double _peak = 0;
};

}  // namespace anticrack::fem

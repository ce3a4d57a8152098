// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <sstream>

#include "errors/errors.hpp"

namespace anticrack::fem {

/// A function of the plane that may be expensive, may jump, and is known by its values only.
using ScalarField = std::function<double(double x, double y)>;

/// Evaluates a field, counts, and knows when to stop. `exhausted` is a request to the integrators,
/// which finish what they began: the count may pass a limit by the points of a few rules.
class CountedField {
 public:
  CountedField(const ScalarField& field, std::size_t limit) : _field(field), _limit(limit) {}

  /// Throws errors::Error (expression_invalid at "force.expression") when the value is not finite.
  double operator()(double x, double y) {
    ++_count;
    const double value = _field(x, y);
    if (!std::isfinite(value)) {
      std::ostringstream message;
      message.precision(17);
      message << "the load has the value " << value << " at (x, y) = (" << x << ", " << y
              << "); it must be finite wherever the membrane is";
      throw errors::Error(errors::Reason::expression_invalid, message.str()).at("force.expression");
    }
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
  std::size_t _allowed = std::numeric_limits<std::size_t>::max();
  std::size_t _count = 0;
  double _peak = 0;
};

}  // namespace anticrack::fem

// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/sampler.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "errors/errors.hpp"

namespace anticrack::fem {

using expression::Code;

namespace {

/// Orders of magnitude, base e, below its peak at which an exponential is nothing.
constexpr double negligible = 40;

}  // namespace

void look_at(const std::stop_token& stop) {
  if (stop.stop_requested()) {
    throw errors::Error(errors::Reason::cancelled, "stopped while integrating a load");
  }
}

Sampler::Sampler(const expression::Function& function, std::stop_token stop)
    : Sampler(function, std::move(stop), roots(function.tape())) {}

Sampler::Sampler(const expression::Function& function, std::stop_token stop, Roots roots)
    : _function(function),
      _stop(std::move(stop)),
      _watches(std::move(roots.watches)),
      _evaluator(function.tape(), roots.refs) {}

Sampler::Roots Sampler::roots(const expression::Tape& tape) {
  Roots result{{tape.result()}, {}};
  const auto& operations = tape.operations();
  std::vector<char> needed(operations.size(), 0);
  needed[static_cast<std::size_t>(tape.result())] = 1;
  for (std::size_t i = operations.size(); i-- > 0;) {
    if (needed[i] == 0) continue;
    const expression::Operation& operation = operations[i];
    for (const expression::Ref of : operation.of) {
      if (of >= 0) needed[static_cast<std::size_t>(of)] = 1;
    }
    const auto watch = [&](std::size_t operand, Kind kind, double range) {
      const expression::Ref of = operation.of[operand];
      if (tape.degree(of) == 0) return;
      result.watches.push_back({result.refs.size(), kind, range});
      result.refs.push_back(of);
    };
    switch (operation.code) {
      case Code::exponential:
        watch(0, Kind::exponential, 2);
        break;
      case Code::sine:
      case Code::cosine:
      case Code::tangent:
        watch(0, Kind::turning, 2.5);
        break;
      case Code::divide:
        watch(1, Kind::ratio, 2);
        break;
      case Code::logarithm:
      case Code::logarithm2:
      case Code::logarithm10:
        watch(0, Kind::ratio, 8);
        break;
      case Code::power: {
        const auto& exponent = operations[static_cast<std::size_t>(operation.of[1])];
        const bool known = exponent.code == Code::constant;
        if (!known || exponent.value < 0) {  // others have no poles
          watch(0, Kind::ratio, known ? -2 / exponent.value : 2);
        }
        break;
      }
      case Code::hyperbolic_tangent:
        watch(0, Kind::saturating, 2);
        break;
      default:
        break;
    }
  }
  return result;
}

const double* Sampler::operator()(const double* x, const double* y, std::size_t n) {
  look_at(_stop);
  _count += n;
  _evaluator(x, y, n);
  return _evaluator.values(0);
}

void Sampler::note_peaks(std::size_t n) {
  for (Watch& watch : _watches) {
    if (watch.kind == Kind::exponential) {
      const double* u = _evaluator.values(watch.root);
      watch.peak = std::max(watch.peak, *std::max_element(u, u + n));
    }
  }
}

Trust Sampler::judge(const Watch& watch, double low, double high, double room) {
  const double range = high - low;
  // A smooth argument goes beyond its samples by less than half their range.
  const double least = low - 0.5 * range, greatest = high + 0.5 * range;
  const double nearest = least > 0 ? least : greatest < 0 ? -greatest : 0;
  switch (watch.kind) {
    case Kind::exponential:
      return range > watch.range * room && greatest > watch.peak - negligible ? Trust::spiking
                                                                              : Trust::sound;
    case Kind::turning:
      return range > watch.range * room ? Trust::oscillating : Trust::sound;
    case Kind::ratio:
      return range <= watch.range * room * nearest ? Trust::sound : Trust::singular;
    case Kind::saturating:
      return range > watch.range * room && nearest < negligible / 2 ? Trust::oscillating
                                                                    : Trust::sound;
  }
  return Trust::sound;
}

Trust Sampler::trust(std::size_t first, std::size_t count, double room) const {
  Trust result = Trust::sound;
  for (const Watch& watch : _watches) {
    const double* u = _evaluator.values(watch.root) + first;
    const auto [low, high] = std::minmax_element(u, u + count);
    result = std::max(result, judge(watch, *low, *high, room));
  }
  return result;
}

}  // namespace anticrack::fem

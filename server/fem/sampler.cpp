// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/sampler.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "stop/stop.hpp"

namespace anticrack::fem {

using expression::Code;

namespace {

/// An exponential is neglected if its argument is this far below the greatest one.
constexpr double negligible = 40;

/// The branch of a ? b : c if the tape's value depends on an operation through this branch only.
struct Branch {
  expression::Ref condition = -1;  ///< -1: the value depends on it elsewhere, too
  bool taken = true;               ///< whether the branch is b
  friend bool operator==(const Branch&, const Branch&) = default;
};

/// The branch of each operation, by number. Of nested branches the outermost counts.
std::vector<Branch> branches(const expression::Tape& tape) {
  const auto& operations = tape.operations();
  std::vector<std::optional<Branch>> found(operations.size());
  found[static_cast<std::size_t>(tape.result())] = Branch{};
  for (std::size_t i = operations.size(); i-- > 0;) {
    if (!found[i]) continue;
    for (std::size_t k = 0; k < operations[i].of.size() && operations[i].of[k] >= 0; ++k) {
      Branch branch = *found[i];
      if (branch.condition < 0 && operations[i].code == Code::select && k > 0)
        branch = {operations[i].of[0], k == 1};
      std::optional<Branch>& operand = found[static_cast<std::size_t>(operations[i].of[k])];
      operand = !operand || *operand == branch ? branch : Branch{};
    }
  }
  std::vector<Branch> result;
  for (const std::optional<Branch>& branch : found) result.push_back(branch.value_or(Branch{}));
  return result;
}

}  // namespace

Sampler::Sampler(const expression::Function& function, Jumps jumps)
    : Sampler(function, watches(function.tape(), jumps)) {}

Sampler::Sampler(const expression::Function& function, std::vector<Watch> watches)
    : _function(function),
      _watches(std::move(watches)),
      _evaluator(function.tape(), roots(function.tape(), _watches)) {}

std::vector<expression::Ref> Sampler::roots(const expression::Tape& tape,
                                            std::vector<Watch>& watches) {
  std::vector<expression::Ref> result{tape.result()};
  for (const Watch& watch : watches) result.push_back(watch.argument);
  for (Watch& watch : watches) {
    if (watch.guard < 0) continue;
    watch.guard_root = result.size();
    result.push_back(watch.guard);
  }
  return result;
}

std::vector<Sampler::Watch> Sampler::watches(const expression::Tape& tape, Jumps jumps) {
  std::vector<Watch> result;
  if (jumps == Jumps::watched)
    for (const expression::Switch& one : tape.switches())
      result.push_back({one.of, one.steps ? Kind::stepping : Kind::switching, 0});
  const auto& operations = tape.operations();
  const expression::Ref last = tape.result();
  const std::vector<bool> needed = tape.needed({&last, 1});
  const std::vector<Branch> branch = branches(tape);
  for (std::size_t i = 0; i < operations.size(); ++i) {
    if (!needed[i]) continue;
    const expression::Operation& operation = operations[i];
    const auto watch = [&](std::size_t operand, Kind kind, double range) {
      const expression::Ref of = operation.of[operand];
      if (tape.degree(of) > 0)
        result.push_back({of, kind, range, branch[i].condition, branch[i].taken});
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
        const expression::Operation& exponent = tape[operation.of[1]];
        const bool known = exponent.code == Code::constant;
        if (!known || exponent.value < 0)  // other powers have no poles
          watch(0, Kind::ratio, known ? -2 / exponent.value : 2);
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
  stop::look("integrating a load");
  _count += n;
  _evaluator(x, y, n);
  return _evaluator.values(0);
}

void Sampler::note_peaks(std::size_t n) {
  for (std::size_t w = 0; w < _watches.size(); ++w) {
    if (_watches[w].kind != Kind::exponential) continue;
    const double* u = _evaluator.values(w + 1);
    for (std::size_t i = 0; i < n; ++i)
      if (u[i] > _watches[w].peak && applies(_watches[w], i)) _watches[w].peak = u[i];
  }
}

Trust Sampler::judge(const Watch& watch, double low, double high, double room) {
  const double range = high - low;
  // A smooth argument goes beyond its samples by less than half their range.
  const double least = low - 0.5 * range, greatest = high + 0.5 * range;
  const double nearest = least > 0 ? least : greatest < 0 ? -greatest : 0;
  const bool wide = range > watch.range * room;
  switch (watch.kind) {
    case Kind::exponential:
      return wide && greatest > watch.peak - negligible ? Trust::spiking : Trust::sound;
    case Kind::turning:
      return wide ? Trust::unresolved : Trust::sound;
    case Kind::ratio:
      return range <= watch.range * room * nearest ? Trust::sound : Trust::singular;
    case Kind::saturating:
      return wide && nearest < negligible / 2 ? Trust::unresolved : Trust::sound;
    case Kind::switching:
      return least < 0 && greatest > 0 ? Trust::unresolved : Trust::sound;
    case Kind::stepping:
      return std::floor(least) < std::floor(greatest) ? Trust::unresolved : Trust::sound;
  }
  return Trust::sound;
}

Trust Sampler::trust(std::size_t first, std::size_t count, double room) const {
  Trust result = Trust::sound;
  for (std::size_t w = 0; w < _watches.size(); ++w) {
    const double* u = _evaluator.values(w + 1) + first;
    const auto [low, high] = std::minmax_element(u, u + count);
    raise(result, _watches[w], judge(_watches[w], *low, *high, room), first, count, 1);
  }
  return result;
}

}  // namespace anticrack::fem

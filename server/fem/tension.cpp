// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/tension.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numbers>

#include "errors/errors.hpp"
#include "fem/adaptive_load.hpp"
#include "fem/cell.hpp"
#include "fem/load.hpp"
#include "fem/load_parts.hpp"

namespace anticrack::fem {
namespace {

using expression::Evaluator;
using expression::Function;

[[noreturn]] void refuse(const std::string& field, const std::string& message) {
  throw errors::Error(errors::Reason::expression_invalid, message).at(field);
}

void require_positive(const std::string& field, const std::string& region, double x, double y,
                      double value) {
  if (value > 0 && std::isfinite(value)) return;
  refuse(field, fmt::format("the tension {}{} is {:.8g} at (x, y) = {}; it must be "
                            "finite and above 0 wherever the membrane is",
                            field, region.empty() ? "" : fmt::format(" of \"{}\"", region), value,
                            errors::shown(x, y)));
}

/// The variation that follows from the bounds of T on a triangle with the mean `mean`.
Variation variation(const Spread& spread, double mean, double unknown) {
  const auto& [least, most] = spread.values;
  Variation result{std::max(1.0, std::sqrt(mean / least)), std::max(1.0, std::sqrt(most / mean))};
  result.spread = std::min(result.most(), spread.deviation / std::sqrt(least * mean));
  result.unknown = unknown;
  return result;
}

/// Takes the larger of each member.
void widen(Variation& to, const Variation& by) {
  to.below = std::max(to.below, by.below);
  to.above = std::max(to.above, by.above);
  to.spread = std::max(to.spread, by.spread);
  to.unknown = std::max(to.unknown, by.unknown);
}

/// One expression of a law.
class Direction {
 public:
  Direction(const Triangulation& part, const std::string& text, std::string field,
            const std::string& region)
      : _part(part), _function(text, field), _field(std::move(field)), _region(region) {
    const expression::Tape& tape = _function.tape();
    if (tape.degree(tape.result()) == 0) {
      const Frame frame = frame_of(part.xy, part.triangles, 0);
      const double value = tape[tape.result()].value;
      require_positive(_field, region, frame.x, frame.y, value);
      mean.assign(part.triangle_count(), value);
    } else {
      integrate();
    }
  }

  /// Widens the variation of each triangle by that of this expression.
  void add_variation(std::vector<Variation>& to) const {
    if (_spread.empty()) return;
    to.resize(_part.triangle_count());
    for (std::size_t t = 0; t < to.size(); ++t)
      if (_spread[t].values.low > 0) widen(to[t], variation(_spread[t], mean[t], _unknown[t]));
  }

  std::vector<double> mean;  ///< (m)

 private:
  void integrate() {
    ForceParts parts;
    std::vector<double> load(_part.node_count());
    IntegrationLimits limits = limits_of(tension_tolerance, _part.triangle_count());
    // The energy has the relative error of T, and linear elements have one of about 1 / triangles.
    limits.proof_tolerance = 1e-2 / static_cast<double>(_part.triangle_count() + 100);
    const IntegrationReport report =
        integrate_load(_part.xy, _part.triangles, _function, load, limits, &parts, &_spread);
    mean.resize(_part.triangle_count());
    _unknown.resize(mean.size(), 0);
    for (std::size_t t = 0; t < mean.size(); ++t) {
      const Frame frame = frame_of(_part.xy, _part.triangles, t);
      if (!(frame.area > 0)) {  // area 0 to rounding: nothing is integrated
        mean[t] = _function(frame.x, frame.y);
        require_positive(_field, _region, frame.x, frame.y, mean[t]);
        continue;
      }
      const double* of = &parts.load[3 * t];
      mean[t] = (of[0] + of[1] + of[2]) / frame.area;
      if (!(_spread[t].values.low > 0) || !std::isfinite(_spread[t].values.high))
        refuse_near(t, report.proof);
      _unknown[t] = parts.unknown[t] / (frame.area * mean[t]);
    }
  }

  /// Refuses a law where T is proved not to be above 0, or cannot be proved to be.
  [[noreturn]] void refuse_near(std::size_t t, const Proof& proof) const {
    const Spread& spread = _spread[t];
    const double x = proof.lowest_x, y = proof.lowest_y;
    const expression::Ref root = _function.tape().result();
    std::array<double, expression::kernel_width> at_x{}, at_y{};
    at_x.fill(x);
    at_y.fill(y);
    Evaluator evaluator(_function.tape(), {&root, 1});
    evaluator(at_x.data(), at_y.data(), 1);
    require_positive(_field, _region, x, y, *evaluator.values(0));
    refuse(
        _field,
        fmt::format("the tension {} of \"{}\" is not proved to be finite and above 0 near (x, y) "
                    "= {}, where it lies between {:.8g} and {:.8g}; keep it away from 0 there",
                    _field, _region, errors::shown(x, y), spread.values.low, spread.values.high));
  }

  const Triangulation& _part;
  Function _function;
  std::string _field;
  const std::string& _region;
  std::vector<Spread> _spread;   ///< (m) empty: T is constant
  std::vector<double> _unknown;  ///< (m) relative errors of the means
};

/// The matrix T from its two eigenvalues.
std::array<double, 3> matrix(double along, double across, double cosine, double sine) {
  return {along * cosine * cosine + across * sine * sine, (along - across) * cosine * sine,
          along * sine * sine + across * cosine * cosine};
}

}  // namespace

Isotropic Tension::isotropic(std::size_t triangle) const {
  if (of_triangle.empty()) return {1, 0, 1, mean};
  const auto& [xx, xy, yy] = of_triangle[triangle];
  // A = sqrt(r) T^-1/2 with r^2 = det T, and sqrt(T) = (T + r) / sqrt(trace T + 2 r).
  const double root = std::sqrt(xx * yy - xy * xy);
  const double scale = 1 / std::sqrt(root * (xx + yy + 2 * root));
  return {scale * (yy + root), -scale * xy, scale * (xx + root), root};
}

std::size_t Tension::bytes() const noexcept {
  return of_triangle.capacity() * sizeof(of_triangle[0]) +
         variation.capacity() * sizeof(variation[0]);
}

Tension tension(const Triangulation& part, const mesh::TensionLaw& law, const std::string& region) {
  const Direction along(part, law.along, "along", region);
  Tension result;
  along.add_variation(result.variation);
  std::vector<double> second;
  if (!law.across.empty()) {
    Direction across(part, law.across, "across", region);
    across.add_variation(result.variation);
    second = std::move(across.mean);
  }
  const std::vector<double>& across = law.across.empty() ? along.mean : second;
  const double angle = law.angle * std::numbers::pi / 180;
  const double cosine = std::cos(angle), sine = std::sin(angle);
  result.of_triangle.reserve(along.mean.size());
  double sum = 0, area = 0;
  for (std::size_t t = 0; t < along.mean.size(); ++t) {
    result.of_triangle.push_back(matrix(along.mean[t], across[t], cosine, sine));
    const double own = std::max(0.0, frame_of(part.xy, part.triangles, t).area);
    sum += own * (along.mean[t] + across[t]) / 2;
    area += own;
  }
  result.mean = sum / area;
  return result;
}

void check(const mesh::TensionLaw& law, std::size_t max_expression_bytes,
           const std::array<double, 2>* point) {
  for (const auto& [field, text] :
       {std::pair<const char*, const std::string&>("along", law.along), {"across", law.across}}) {
    if (text.empty()) continue;
    require_length(text, field, max_expression_bytes);
    const Function function(text, field);
    const expression::Tape& tape = function.tape();
    const auto [x, y] = point != nullptr ? *point : std::array{0.0, 0.0};
    if (point != nullptr || tape.degree(tape.result()) == 0)
      require_positive(field, "", x, y, function(x, y));
  }
}

}  // namespace anticrack::fem

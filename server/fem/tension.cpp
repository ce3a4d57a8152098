// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/tension.hpp"

#include <algorithm>
#include <numbers>
#include <sstream>

#include "errors/errors.hpp"
#include "fem/adaptive_load.hpp"
#include "fem/cell.hpp"
#include "fem/load.hpp"
#include "fem/load_parts.hpp"
#include "fem/sampler.hpp"
#include "fem/triangle_rules.hpp"

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
  std::ostringstream message;
  message.precision(errors::shown_digits);
  message << "the tension " << field;
  if (!region.empty()) message << " of \"" << region << '"';
  message << " is " << value << " at (x, y) = (" << x << ", " << y
          << "); it must be finite and above 0 wherever the membrane is";
  refuse(field, message.str());
}

/// The points of rule_8 and, just inside, the corners: there linear functions are extreme, and of
/// two sides of a line that meshes follow each has its own value.
struct TensionSamples {
  static constexpr std::size_t size = rule_8.size + 3;
  std::array<double, size> b{}, c{};
  constexpr TensionSamples() {
    constexpr double inside = 1e-6;
    for (std::size_t p = 0; p < rule_8.size; ++p) {
      b[p] = rule_8.b[p];
      c[p] = rule_8.c[p];
    }
    for (std::size_t i = 0; i < 3; ++i) {
      b[rule_8.size + i] = i == 1 ? 1 - 2 * inside : inside;
      c[rule_8.size + i] = i == 2 ? 1 - 2 * inside : inside;
    }
  }
};
constexpr TensionSamples tension_samples;

Variation variation(const double* values, double mean, bool switches) {
  const auto [low, high] = std::minmax_element(values, values + TensionSamples::size);
  // Between samples it may go a little further.
  const double room = 0.1 * (*high - *low);
  const double least = std::max(*low - room, 0.5 * *low), most = *high + room;
  Variation result{std::max(1.0, std::sqrt(mean / least)), std::max(1.0, std::sqrt(most / mean))};
  double square = 0;
  for (std::size_t p = 0; p < rule_8.size; ++p) {
    const double off = values[p] - mean;
    square += rule_8.weight[p] * off * off / (values[p] * mean);
  }
  result.spread = switches ? result.most() : std::min(result.most(), 1.1 * std::sqrt(square));
  return result;
}

/// The larger of each.
void widen(Variation& to, const Variation& by) {
  to.below = std::max(to.below, by.below);
  to.above = std::max(to.above, by.above);
  to.spread = std::max(to.spread, by.spread);
}

/// One expression of a law.
class Direction {
 public:
  Direction(const Triangulation& part, const std::string& text, std::string field,
            const std::string& region, const std::stop_token& stop)
      : _part(part),
        _function(text, field),
        _field(std::move(field)),
        _region(region),
        _stop(stop) {
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

  /// Of each triangle, widened by this expression's; throws where it is not above 0.
  void add_variation(std::vector<Variation>& to) const {
    const expression::Tape& tape = _function.tape();
    if (tape.degree(tape.result()) == 0) return;
    to.resize(_part.triangle_count());
    constexpr std::size_t at_once = Evaluator::block / TensionSamples::size;
    const expression::Ref root = tape.result();
    Evaluator evaluator(tape, {&root, 1});
    std::array<double, Evaluator::block> x{}, y{};
    for (std::size_t first = 0; first < to.size(); first += at_once) {
      look_at(_stop);
      const std::size_t count = std::min(at_once, to.size() - first);
      for (std::size_t k = 0; k < count; ++k) {
        const Frame frame = frame_of(_part.xy, _part.triangles, first + k);
        for (std::size_t p = 0; p < TensionSamples::size; ++p) {
          const double b = tension_samples.b[p], c = tension_samples.c[p];
          x[k * TensionSamples::size + p] = frame.x + b * frame.bx + c * frame.cx;
          y[k * TensionSamples::size + p] = frame.y + b * frame.by + c * frame.cy;
        }
      }
      evaluator(x.data(), y.data(), count * TensionSamples::size);
      const double* values = evaluator.values(0);
      for (std::size_t i = 0; i < count * TensionSamples::size; ++i)
        require_positive(_field, _region, x[i], y[i], values[i]);
      for (std::size_t k = 0; k < count; ++k) {
        const double own = mean[first + k];
        require_positive(_field, _region, x[k * TensionSamples::size], y[k * TensionSamples::size],
                         own);
        widen(to[first + k],
              variation(values + k * TensionSamples::size, own, !tape.switches().empty()));
      }
    }
  }

  std::vector<double> mean;  ///< (m)
  double error = 0;          ///< estimated, relative

 private:
  void integrate() {
    ForceParts parts;
    std::vector<double> load(_part.node_count());
    error = integrate_load(_part.xy, _part.triangles, _function, load,
                           limits_of(tension_tolerance, _part.triangle_count()), _stop, &parts)
                .relative_error_estimate;
    mean.resize(_part.triangle_count());
    for (std::size_t t = 0; t < mean.size(); ++t) {
      const Frame frame = frame_of(_part.xy, _part.triangles, t);
      const double* of = &parts.load[3 * t];
      // Of a triangle without an area, to rounding, nothing is integrated.
      mean[t] = frame.area > 0 ? (of[0] + of[1] + of[2]) / frame.area : _function(frame.x, frame.y);
    }
  }

  const Triangulation& _part;
  Function _function;
  std::string _field;
  const std::string& _region;
  const std::stop_token& _stop;
};

/// T of two eigenvalues.
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

Tension tension(const Triangulation& part, const mesh::TensionLaw& law, const std::string& region,
                const std::stop_token& stop) {
  const Direction along(part, law.along, "along", region, stop);
  Tension result;
  along.add_variation(result.variation);
  double error = along.error;
  std::vector<double> second;
  if (!law.across.empty()) {
    Direction across(part, law.across, "across", region, stop);
    across.add_variation(result.variation);
    error = std::max(error, across.error);
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
  if (!(error <= 100 * tension_tolerance)) {
    result.obstacle = "the tension of \"" + region +
                      "\" jumps or varies too sharply to be integrated: let it vary less, make the "
                      "mesh finer, or let it jump along an interface";
  }
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

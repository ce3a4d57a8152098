// SPDX-License-Identifier: GPL-3.0-or-later
#include "expression/jet.hpp"

#include <cstdint>
#include <numbers>

namespace anticrack::expression {
namespace {

constexpr double ulps = 4;  // of the C library

constexpr std::size_t first_of(int degree) {
  return static_cast<std::size_t>(degree * (degree + 1) / 2);
}
constexpr std::size_t end_of(int degree) { return first_of(degree + 1); }

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Derivatives over an interval, the k-th over k!.
using Series = std::array<Interval, Jet::most + 1>;

/// A sum of products of intervals. Its rounding is allowed for once, at the end; without terms it
/// is exactly 0.
class Sum {
 public:
  void add(const Interval& a, const Interval& b) {
    const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
    const double low = std::min(std::min(p, q), std::min(r, s)),
                 high = std::max(std::max(p, q), std::max(r, s));
    _low += low;
    _high += high;
    _size += std::max(-low, high);
    ++_terms;
  }
  Interval result() const {
    if (_terms == 0) return {};
    constexpr double unit = std::numeric_limits<double>::epsilon(),
                     tiny = std::numeric_limits<double>::min();
    if (!(_size < infinite)) return everything;
    const double off = (_terms + 1) * (unit * _size + tiny);
    return {_low - off, _high + off};
  }

 private:
  double _low = 0, _high = 0, _size = 0;
  int _terms = 0;
};

/// The pairs of coefficients whose products add up to each coefficient of a product.
struct Pairs {
  struct Pair {
    std::uint8_t i, j;
  };
  std::array<Pair, 70> of{};
  std::array<std::size_t, Jet::size + 1> first{};
};

constexpr Pairs pairs = [] {
  Pairs result;
  std::size_t count = 0;
  for (int n = 0; n <= Jet::most; ++n) {
    for (int k = 0; k <= n; ++k) {
      result.first[first_of(n) + static_cast<std::size_t>(k)] = count;
      for (int d = 0; d <= n; ++d) {
        for (int i = std::max(0, k - n + d); i <= std::min(d, k); ++i)
          result.of[count++] = {
              static_cast<std::uint8_t>(first_of(d) + static_cast<std::size_t>(i)),
              static_cast<std::uint8_t>(first_of(n - d) + static_cast<std::size_t>(k - i))};
      }
    }
  }
  result.first[Jet::size] = count;
  return result;
}();

/// A bit for each coefficient that is not 0.
unsigned present(const Jet& a) {
  unsigned bits = 0;
  for (std::size_t k = 0; k < end_of(std::min(a.order, a.degree)); ++k)
    bits |= (a.of[k].is(0) ? 0U : 1U) << k;
  return bits;
}

/// f(c + u x + v y), by the binomial theorem.
Jet compose_linear(const Interval& u, const Interval& v, const Series& f, int known) {
  constexpr double binomial[][5] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}, {1, 4, 6, 4, 1}};
  Series of_u{Interval{1, 1}}, of_v{Interval{1, 1}};
  for (std::size_t k = 1; k < f.size(); ++k) {
    of_u[k] = of_u[k - 1] * u;
    of_v[k] = of_v[k - 1] * v;
  }
  Jet result;
  for (int k = 1; k <= known; ++k) {
    for (int j = 0; j <= k; ++j) {
      const auto degree = static_cast<std::size_t>(k), by_y = static_cast<std::size_t>(j);
      result.of[first_of(k) + by_y] =
          binomial[degree][by_y] * (of_u[degree - by_y] * of_v[by_y] * f[degree]);
    }
  }
  return result;
}

/// f(a) by Horner's rule in the varying part of a. This has no constant, so with k products to come
/// all terms above the degree known - k fall away.
Jet compose_any(const Jet& a, const Series& f, int known) {
  Jet vary = a;
  vary.of[0] = {};
  Jet result = constant_jet(f[static_cast<std::size_t>(known)]);
  for (int k = known; k-- > 0;) {
    vary.order = known - k;
    result = vary * result;
    result.of[0] = f[static_cast<std::size_t>(k)];
    result.order = Jet::most;
  }
  return result;
}

/// f(a) from the series of f over the values of a.
Jet compose(const Jet& a, const Series& f, int order) {
  const int wanted = std::min(a.order, order);
  int known = 0;
  while (known < wanted && f[static_cast<std::size_t>(known) + 1].finite()) ++known;
  Jet result;
  if (a.degree > 0) {
    result = a.degree == 1 ? compose_linear(a.of[1], a.of[2], f, known) : compose_any(a, f, known);
    result.degree = Jet::most;
  }
  result.of[0] = f[0];
  result.order = known;
  result.defined = a.defined;
  return result;
}

template <class Function>
Interval increasing(const Interval& a, const Function& function) {
  return outward(function(a.low), function(a.high), ulps);
}

Interval exp_of(const Interval& a) {
  const Interval result = increasing(a, [](double v) { return std::exp(v); });
  return {std::max(0.0, result.low), result.high};
}

Interval cosine(const Interval& a) {
  constexpr double pi = std::numbers::pi, farthest = 1e8;
  if (!(a.magnitude() < farthest)) return {-1, 1};
  // Extremes lie at multiples of pi, maxima at even ones; those just outside the interval count
  // too.
  const double near = 1e-15 * (1 + a.magnitude());
  const double first = std::ceil(a.low / pi - near), last = std::floor(a.high / pi + near);
  const double p = std::cos(a.low), q = std::cos(a.high);
  Interval result{std::min(p, q) - 4e-16, std::max(p, q) + 4e-16};
  if (first <= last) {
    const bool even = last > first || std::fmod(first, 2) == 0;
    const bool odd = last > first || std::fmod(first, 2) != 0;
    if (even) result.high = 1;
    if (odd) result.low = -1;
  }
  return {std::max(-1.0, result.low), std::min(1.0, result.high)};
}

Interval sine(const Interval& a) {
  constexpr double quarter = std::numbers::pi / 2;
  return cosine(a - outward(quarter, quarter));
}

/// a^e for a >= 0.
Interval positive_power(const Interval& a, double e) {
  const double low = std::pow(a.low, e), high = std::pow(a.high, e);
  return e >= 0 ? outward(low, high, ulps) : outward(high, low, ulps);
}

/// a^e: for any a if e is a whole number, else for the part of a that is not negative.
Interval constant_power(const Interval& a, double e) {
  if (e == 0) return {1, 1};
  if (a.low >= 0) return positive_power(a, e);
  if (e != std::floor(e)) return positive_power({0, std::max(0.0, a.high)}, e);
  const bool even = std::fmod(e, 2) == 0;
  if (a.high <= 0) {
    const Interval result = positive_power(-a, e);
    return even ? result : -result;
  }
  if (e < 0) return even ? Interval{0, infinite} : everything;
  const Interval negative = positive_power({0, -a.low}, e),
                 positive = positive_power({0, a.high}, e);
  return even ? hull(negative, positive) : Interval{-negative.high, positive.high};
}

constexpr Interval unity{1, 1};
const Interval third = outward(1.0 / 3, 1.0 / 3), sixth = outward(1.0 / 6, 1.0 / 6),
               of_24 = outward(1.0 / 24, 1.0 / 24);

Series power_series(const Interval& a, double e) {
  Series result;
  double factor = 1;
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] = factor == 0 ? Interval{} : factor * constant_power(a, e - static_cast<double>(k));
    factor *= (e - static_cast<double>(k)) / static_cast<double>(k + 1);
  }
  return result;
}

Series logarithm_series(const Interval& a, double scale) {
  const Interval positive{std::max(0.0, a.low), std::max(0.0, a.high)}, r = reciprocal(positive);
  const Interval value = increasing(positive, [](double v) { return std::log(v); });
  const Interval by = outward(scale, scale);
  return {by * value, by * r, by * (-0.5 * square(r)), by * (third * (r * square(r))),
          by * (-0.25 * square(square(r)))};
}

Interval root(const Interval& a) {
  return outward(std::sqrt(std::max(0.0, a.low)), std::sqrt(std::max(0.0, a.high)));
}

Series arc_series(const Interval& u, const Interval& value, double sign) {
  // q = (1 - u^2)^(-1/2): q, u q^3 / 2, (1 + 2 u^2) q^5 / 6, u (3 + 2 u^2) q^7 / 8.
  const Interval q = reciprocal(root(unity - square(u))), q3 = q * square(q);
  return {value, sign * q, sign * 0.5 * (u * q3),
          sign * (sixth * ((unity + 2 * square(u)) * (q3 * square(q)))),
          sign * 0.125 * ((u * (Interval{3, 3} + 2 * square(u))) * (q * square(q3)))};
}

/// Series of the function whose derivative is w = 1 / (1 - s u^2): w, s u w^2, (s + 3 u^2) w^3 / 3,
/// u (1 + s u^2) w^4 with s = 1 or -1.
Series rational_series(const Interval& u, const Interval& value, double s) {
  const Interval w = reciprocal(unity - s * square(u));
  return {value, w, s * (u * square(w)),
          third * ((Interval{s, s} + 3 * square(u)) * (w * square(w))),
          (u * (unity + s * square(u))) * square(square(w))};
}

/// q = (u^2 + s)^(-1/2): q, -u q^3 / 2, (2 u^2 - s) q^5 / 6, u (3 s - 2 u^2) q^7 / 8 with s = 1
/// (asinh) or -1 (acosh).
Series area_series(const Interval& u, const Interval& value, double s) {
  const Interval q = reciprocal(root(square(u) + Interval{s, s})), q3 = q * square(q);
  return {value, q, -0.5 * (u * q3), sixth * ((2 * square(u) - Interval{s, s}) * (q3 * square(q))),
          0.125 * ((u * (Interval{3 * s, 3 * s} - 2 * square(u))) * (q * square(q3)))};
}

Interval clipped(const Interval& a, double low, double high) {
  return {std::clamp(a.low, low, high), std::clamp(a.high, low, high)};
}

Series series(Code code, const Interval& a) {
  switch (code) {
    case Code::square_root:
      return power_series({std::max(0.0, a.low), std::max(0.0, a.high)}, 0.5);
    case Code::exponential: {
      const Interval e = exp_of(a);
      return {e, e, 0.5 * e, sixth * e, of_24 * e};
    }
    case Code::logarithm:
      return logarithm_series(a, 1);
    case Code::logarithm2:
      return logarithm_series(a, 1 / std::numbers::ln2);
    case Code::logarithm10:
      return logarithm_series(a, 1 / std::numbers::ln10);
    case Code::sine:
    case Code::cosine: {
      const Interval s = sine(a), c = cosine(a);
      if (code == Code::sine) return {s, c, -0.5 * s, -(sixth * c), of_24 * s};
      return {c, -s, -0.5 * c, sixth * s, of_24 * c};
    }
    case Code::tangent: {
      // t, 1 + t^2 = d, t d, d (1 + 3 t^2) / 3, t d (2 + 3 t^2) / 3
      if (cosine(a).holds(0)) return {everything, everything, everything, everything, everything};
      const Interval t = increasing(a, [](double v) { return std::tan(v); });
      const Interval d = unity + square(t);
      return {t, d, t * d, third * (d * (unity + 3 * square(t))),
              third * ((t * d) * (Interval{2, 2} + 3 * square(t)))};
    }
    case Code::arc_sine: {
      const Interval u = clipped(a, -1, 1);
      return arc_series(u, increasing(u, [](double v) { return std::asin(v); }), 1);
    }
    case Code::arc_cosine: {
      const Interval u = clipped(a, -1, 1);
      return arc_series(u, outward(std::acos(u.high), std::acos(u.low), ulps), -1);
    }
    case Code::arc_tangent:
      return rational_series(a, increasing(a, [](double v) { return std::atan(v); }), -1);
    case Code::hyperbolic_sine:
    case Code::hyperbolic_cosine: {
      const Interval s = increasing(a, [](double v) { return std::sinh(v); });
      const double least = a.holds(0) ? 0 : std::min(std::abs(a.low), std::abs(a.high));
      const Interval c = outward(std::cosh(least), std::cosh(a.magnitude()), ulps);
      if (code == Code::hyperbolic_sine) return {s, c, 0.5 * s, sixth * c, of_24 * s};
      return {c, s, 0.5 * c, sixth * s, of_24 * c};
    }
    case Code::hyperbolic_tangent: {
      // t, 1 - t^2 = d, -t d, d (3 t^2 - 1) / 3, t d (2 - 3 t^2) / 3
      const Interval t = clipped(increasing(a, [](double v) { return std::tanh(v); }), -1, 1);
      const Interval d = unity - square(t);
      return {t, d, -(t * d), third * (d * (3 * square(t) - unity)),
              third * ((t * d) * (Interval{2, 2} - 3 * square(t)))};
    }
    case Code::area_sine:
      return area_series(a, increasing(a, [](double v) { return std::asinh(v); }), 1);
    case Code::area_cosine: {
      const Interval u{std::max(1.0, a.low), std::max(1.0, a.high)};
      return area_series(u, increasing(u, [](double v) { return std::acosh(v); }), -1);
    }
    case Code::area_tangent: {
      const Interval u = clipped(a, -1, 1);
      return rational_series(u, increasing(u, [](double v) { return std::atanh(v); }), 1);
    }
    default:
      return {everything, everything, everything, everything, everything};
  }
}

Interval domain(Code code) {
  switch (code) {
    case Code::square_root:
    case Code::logarithm:
    case Code::logarithm2:
    case Code::logarithm10:
      return {0, infinite};
    case Code::arc_sine:
    case Code::arc_cosine:
    case Code::area_tangent:
      return {-1, 1};
    case Code::area_cosine:
      return {1, infinite};
    default:
      return everything;
  }
}

}  // namespace

Jet constant_jet(const Interval& value) {
  Jet result;
  result.of[0] = value;
  return result;
}

Jet hull(const Jet& a, const Jet& b, int order) {
  Jet result;
  result.order = std::min({a.order, b.order, order});
  result.degree = std::max(a.degree, b.degree);
  result.defined = a.defined && b.defined;
  for (std::size_t i = 0; i < end_of(result.order); ++i) result.of[i] = hull(a.of[i], b.of[i]);
  return result;
}

Jet operator-(const Jet& a) {
  Jet result = a;
  for (Interval& coefficient : result.of) coefficient = -coefficient;
  return result;
}

Jet operator+(const Jet& a, const Jet& b) {
  if (b.degree > a.degree) return b + a;
  Jet result = a;
  result.order = std::min(a.order, b.order);
  result.defined = a.defined && b.defined;
  for (std::size_t i = 0; i < end_of(std::min(b.degree, result.order)); ++i)
    result.of[i] = a.of[i] + b.of[i];
  return result;
}

Jet operator-(const Jet& a, const Jet& b) { return a + -b; }

Jet operator*(const Jet& a, const Jet& b) {
  Jet result;
  result.order = std::min(a.order, b.order);
  result.degree = std::min(Jet::most, a.degree + b.degree);
  result.defined = a.defined && b.defined;
  const unsigned left = present(a), right = present(b);
  result.of[0] = a.of[0] * b.of[0];
  for (std::size_t k = 1; k < end_of(std::min(result.order, result.degree)); ++k) {
    Sum sum;
    for (std::size_t p = pairs.first[k]; p < pairs.first[k + 1]; ++p) {
      const auto [i, j] = pairs.of[p];
      if ((left >> i & right >> j & 1U) != 0) sum.add(a.of[i], b.of[j]);
    }
    result.of[k] = sum.result();
  }
  return result;
}

Jet square(const Jet& a) {
  Jet result = a * a;
  result.of[0] = square(a.of[0]);
  return result;
}

Jet elementary(Code code, const Jet& a, int order) {
  Jet result = compose(a, series(code, a.of[0]), order);
  result.defined =
      result.defined && domain(code).low <= a.of[0].low && a.of[0].high <= domain(code).high;
  return result;
}

Jet power(const Jet& base, const Jet& exponent, int order) {
  const Interval &a = base.of[0], &e = exponent.of[0];
  if (exponent.degree == 0 && e.low == e.high) {
    Jet result = compose(base, power_series(a, e.low), order);
    result.defined = result.defined && (a.low >= 0 || e.low == std::floor(e.low));
    return result;
  }
  if (a.low > 0)
    return elementary(Code::exponential, exponent * elementary(Code::logarithm, base, order),
                      order);
  Jet result;  // monotone in either operand, so extremes are at corners
  result.order = 0;
  result.degree = Jet::most;
  result.defined = base.defined && exponent.defined && a.low >= 0;
  const double zero = std::max(0.0, a.low), most = std::max(0.0, a.high);
  const double corners[] = {std::pow(zero, e.low), std::pow(zero, e.high), std::pow(most, e.low),
                            std::pow(most, e.high)};
  result.of[0] = outward(*std::min_element(corners, corners + 4),
                         *std::max_element(corners, corners + 4), ulps);
  return result;
}

}  // namespace anticrack::expression

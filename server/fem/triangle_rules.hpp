// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

namespace anticrack::fem {

/// Points inside a triangle in barycentric coordinates (the first is 1 - b - c) and their weights,
/// parts of the area.
template <std::size_t N>
struct TriangleRule {
  static constexpr std::size_t size = N;
  std::array<double, N> b;
  std::array<double, N> c;
  std::array<double, N> weight;
};

namespace rules {

/// Fills a symmetric rule orbit by orbit.
template <std::size_t N>
class Orbits {
 public:
  constexpr Orbits& centre(double weight) { return put(1.0 / 3, 1.0 / 3, weight); }
  constexpr Orbits& three(double a, double weight) {
    return put(a, a, weight).put(a, 1 - 2 * a, weight).put(1 - 2 * a, a, weight);
  }
  constexpr Orbits& six(double a, double b, double weight) {
    const double c = 1 - a - b;
    put(a, b, weight).put(b, a, weight).put(a, c, weight);
    return put(c, a, weight).put(b, c, weight).put(c, b, weight);
  }
  constexpr TriangleRule<N> made() const { return _rule; }

 private:
  constexpr Orbits& put(double b, double c, double weight) {
    _rule.b[_count] = b;
    _rule.c[_count] = c;
    _rule.weight[_count++] = weight;
    return *this;
  }
  TriangleRule<N> _rule{};
  std::size_t _count = 0;
};

}  // namespace rules

/// Rule of degree 5 (J. Radon, 1948): exact for f phi_i with f of degree 4.
inline constexpr TriangleRule<7> rule_5 =
    rules::Orbits<7>()
        .centre(0.225)
        .three(0.101286507323456338800987, 0.125939180544827152595684)
        .three(0.470142064105115089770441, 0.132394152788506180737649)
        .made();

/// Rules of degrees 8 and 12: D. A. Dunavant, High degree efficient symmetrical Gaussian quadrature
/// rules for the triangle, IJNME 21 (1985), with the digits that he left out.
inline constexpr TriangleRule<16> rule_8 =
    rules::Orbits<16>()
        .centre(0.144315607677787168003)
        .three(0.459292588292723155934, 0.095091634267284624680)
        .three(0.170569307751760206715, 0.103217370534718250191)
        .three(0.050547228317030975518, 0.032458497623198080397)
        .six(0.263112829634638113871, 0.728492392955404280701, 0.027230314174434994358)
        .made();

inline constexpr TriangleRule<33> rule_12 =
    rules::Orbits<33>()
        .three(0.488217389773804882051, 0.025731066440455335721)
        .three(0.439724392294460272710, 0.043692544538038406653)
        .three(0.271210385012115922797, 0.062858224217885099643)
        .three(0.127576145541585915527, 0.034796112930708937040)
        .three(0.021317350453210371044, 0.006166261051559017589)
        .six(0.115343494534697999849, 0.275713269685514178567, 0.040371557766380931772)
        .six(0.022838332222257028635, 0.281325580989939551805, 0.022356773202303444975)
        .six(0.025734050548330226843, 0.116251915907597143110, 0.017316231108658891594)
        .made();

/// Gauss-Legendre rules on (0, 1), by ascending point.
template <std::size_t N>
struct LineRule {
  static constexpr std::size_t size = N;
  std::array<double, N> at;
  std::array<double, N> weight;
};

inline constexpr LineRule<4> line_4{
    {0.0694318442029737124, 0.3300094782075718676, 0.6699905217924281324, 0.9305681557970262876},
    {0.1739274225687269287, 0.3260725774312730713, 0.3260725774312730713, 0.1739274225687269287}};

inline constexpr LineRule<5> line_5{
    {0.0469100770306680036, 0.2307653449471584545, 0.5, 0.7692346550528415455,
     0.9530899229693319964},
    {0.1184634425280945438, 0.2393143352496832340, 0.2844444444444444444, 0.2393143352496832340,
     0.1184634425280945438}};

}  // namespace anticrack::fem

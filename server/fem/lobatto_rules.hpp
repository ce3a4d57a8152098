// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

namespace anticrack::fem {

/// Nested rules on (-1, 1), ends included: the Gauss-Lobatto rule of 4 points (degree 5) and its
/// Kronrod extensions to 7 (degree 9) and 13 points (degree 17). The nodes of a smaller rule are
/// among those of the larger ones: W. Gander, W. Gautschi, Adaptive quadrature - revisited,
/// BIT 40 (2000). Weights are those of the larger rule and, zero at its other nodes, the smaller.
template <std::size_t N>
struct LobattoPair {
  std::array<double, N> nodes;
  std::array<double, N> fine;
  std::array<double, N> coarse;
};

namespace lobatto {
inline constexpr double a = 0.81649658092772603273;  // sqrt(2/3)
inline constexpr double b = 0.44721359549995793928;  // sqrt(1/5)
inline constexpr double x = 0.94288241569547971906, y = 0.64185334234578130578,
                        z = 0.23638319966214988028;
inline constexpr double w1 = 77.0 / 1470, wa = 432.0 / 1470, wb = 625.0 / 1470, w0 = 672.0 / 1470;
inline constexpr double v1 = 0.01582719197348018309, vx = 0.09427384021885004553,
                        va = 0.15507198733658539625, vy = 0.18882157396018245442,
                        vb = 0.19977340522685852679, vz = 0.22492646533333952702,
                        v0 = 0.24261107190140773380;
}  // namespace lobatto

inline constexpr LobattoPair<7> lobatto_4_7{
    {-1, -lobatto::a, -lobatto::b, 0, lobatto::b, lobatto::a, 1},
    {lobatto::w1, lobatto::wa, lobatto::wb, lobatto::w0, lobatto::wb, lobatto::wa, lobatto::w1},
    {1.0 / 6, 0, 5.0 / 6, 0, 5.0 / 6, 0, 1.0 / 6}};

inline constexpr LobattoPair<13> lobatto_7_13{
    {-1, -lobatto::x, -lobatto::a, -lobatto::y, -lobatto::b, -lobatto::z, 0, lobatto::z, lobatto::b,
     lobatto::y, lobatto::a, lobatto::x, 1},
    {lobatto::v1, lobatto::vx, lobatto::va, lobatto::vy, lobatto::vb, lobatto::vz, lobatto::v0,
     lobatto::vz, lobatto::vb, lobatto::vy, lobatto::va, lobatto::vx, lobatto::v1},
    {lobatto::w1, 0, lobatto::wa, 0, lobatto::wb, 0, lobatto::w0, 0, lobatto::wb, 0, lobatto::wa, 0,
     lobatto::w1}};

}  // namespace anticrack::fem

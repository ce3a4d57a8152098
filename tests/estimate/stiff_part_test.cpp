// SPDX-License-Identifier: GPL-3.0-or-later
//
// The part of a membrane where T is larger by powers of ten. The bounds are those of the membrane
// itself, not of every finer mesh, on which a continuation may have another constant: C is several
// times the constant of any mesh, so that finer meshes may stand for the membrane here.
#include "estimate/stiff_part.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <optional>

#include "ddm/decomposition.hpp"
#include "estimate/interval.hpp"
#include "estimate/solved.hpp"
#include "support/grid_mesh.hpp"
#include "support/random_seed.hpp"

namespace anticrack::estimate {
namespace {

using Kind = mesh::Kind;

std::optional<StiffPart> part_of(const mesh::Mesh& mesh) {
  const ddm::Decomposition decomposition = ddm::cut(mesh);
  return stiff_part(mesh, decomposition, cut_mesh(mesh, decomposition));
}

/// A column of `above` rows on one of `below` rows, of tensions 1 and `ratio`.
testing::GridMesh column(int columns, int above, int below, double ratio) {
  testing::GridMesh grid(columns, above + below, {"below", "above"},
                         [below](int, int j) { return j < below ? 0 : 1; });
  grid.mesh.tension = {ratio, 1};
  return grid;
}
testing::GridMesh& glue(testing::GridMesh& grid, int columns, int y, Kind kind = Kind::glue) {
  std::vector<Kind> kinds(static_cast<std::size_t>(columns), Kind::glue);
  if (kind != Kind::glue) {
    grid.mesh.inclusions.push_back("inclusion");
    std::fill(kinds.begin() + 1, kinds.end() - 1, kind);
  }
  return grid.add({{0, y}, {columns, y}}, kinds, kind == Kind::glue ? -1 : 0);
}

/// The least continuation of cos(k x) sinh(k (a - y)) or of its sine has the energy of the function
/// times tanh(k a) / tanh(k b), a and b the heights of the stiff part and of the other.
TEST(StiffPart, ContinuesAtLeastAsMuchAsTheFunctionsOfAColumn) {
  for (const auto [columns, above, below, free] :
       {std::array{3, 40, 2, 1}, {3, 2, 40, 1}, {4, 4, 4, 1}, {30, 20, 1, 0}, {6, 12, 12, 0}}) {
    testing::GridMesh grid = column(columns, above, below, 1e-4);
    glue(grid, columns, below);
    if (free == 1)
      grid.release([width = columns](double x, double) { return x == 0 || x == width; });
    const std::optional<StiffPart> part = part_of(grid.mesh);
    ASSERT_TRUE(part);
    double most = free == 1 ? static_cast<double>(above) / below : 0;
    for (int n = 1; n < 8 * columns; ++n) {
      const double k = n * std::numbers::pi / columns;
      most = std::max(most, std::tanh(k * above) / std::tanh(k * below));
    }
    EXPECT_GT(part->continuation, std::sqrt(most));
    EXPECT_LT(part->continuation, 8 * std::sqrt(most) + 8);
    EXPECT_NEAR(part->coupling, part->continuation * 1e-2, 1e-8 * part->coupling);  // for rounding
    std::printf("[ figures  ] %d x %d on %d: C = %.2f, at least %.2f\n", columns, above, below,
                part->continuation, std::sqrt(most));
  }
}

/// The largest |m| on the stiff part for which R with eta_t = 1 alone is known.
double most_in_stiff(const std::array<PartNorms, 2>& of, double coupling) {
  double least = std::numeric_limits<double>::infinity();
  for (double stiff = 1e-6; stiff < 1e12; stiff *= 1.1)
    if (const auto half = half_of_parts(of, coupling, stiff)) least = std::min(least, (*half)(0));
  return least;
}

/// f = 1 on a soft column of height b below a stiff one of height a, both ends held. v = 0, and
/// sigma leads the load down: D = 0 on the stiff part, where all that m is comes through Gamma.
TEST(StiffPart, HasAnErrorThatIsNearlyAsLargeAsItsBound) {
  constexpr int a = 100, b = 1;
  for (const double ratio : {1e-8, 1e-4}) {
    testing::GridMesh grid = column(1, a, b, ratio);
    grid.release([](double x, double) { return x == 0 || x == 1; });
    glue(grid, 1, b);
    const std::optional<StiffPart> part = part_of(grid.mesh);
    ASSERT_TRUE(part);
    // u is quadratic in the soft part and linear above, with the flux F into the stiff part:
    // u_Gamma = a F = (b^2 / 2 - F b) / ratio
    const double flux = b * b / 2.0 / (a * ratio + b), middle = flux * std::sqrt(a);
    const double of_sigma = std::sqrt(b * b * b / (3 * ratio)) / 2;
    const std::array<PartNorms, 2> norms{PartNorms{of_sigma * of_sigma, 0, of_sigma},
                                         PartNorms{0, 1, 0}};
    const double bound = most_in_stiff(norms, part->coupling);
    EXPECT_GT(bound, middle);
    EXPECT_LT(bound, 2.5 * middle);
    // So C and the root are needed, and both parts of C hardly less.
    EXPECT_LT(most_in_stiff(norms, std::sqrt(ratio)), middle);
    EXPECT_LT(most_in_stiff(norms, part->continuation * ratio), middle);
    EXPECT_LT(most_in_stiff(norms, 0.4 * part->coupling), middle);
  }
}

/// R is the largest eta_t x + eta_s y + c_t (E_t - x^2) + c_s (E_s - y^2) + g (x + d_t) (y + d_s).
TEST(HalfWidthOfParts, IsTheWorstThatBothConesAllow) {
  const std::array<PartNorms, 2> norms{PartNorms{1.7, 0.4, 1.2}, PartNorms{0.3, 2.1, 0.5}};
  for (const double stiff : {0.1, 1.0, 4.0, 30.0}) {
    for (const double coupling : {0.0, 0.03, 0.2}) {
      const std::optional<HalfWidth> half = half_of_parts(norms, coupling, stiff);
      ASSERT_EQ(half.has_value(), 2 * std::sqrt(stiff) > coupling * std::abs(stiff - 1));
      if (!half) continue;
      for (const double c : {half->best(0), 2 * half->best(0)}) {
        const double g = coupling * c * std::abs(stiff - 1);
        const auto [rest, part] = norms;
        double worst = 0, x = 0, y = 0;
        for (int k = 0; k < 10'000; ++k) {  // one after the other; it is concave
          x = (part.flux + g * (y + rest.reach)) / (2 * stiff * c);
          y = (rest.flux + g * (x + part.reach)) / (2 * c);
        }
        worst = part.flux * x + rest.flux * y + stiff * c * (part.energy - x * x) +
                c * (rest.energy - y * y) + g * (x + part.reach) * (y + rest.reach);
        EXPECT_NEAR((*half)(c), worst, 1e-9 * worst);
      }
    }
  }
  const HalfWidth alone{2.0, 0, (0.4 * 0.4 + 2.1 * 2.1) / 4};
  EXPECT_DOUBLE_EQ((*half_of_parts(norms, 0.1, 1))(0.7), alone(0.7));
}

/// Where there is no C, or where it would say nothing, there is no part.
TEST(StiffPart, IsNoneWhereNothingContinues) {
  const auto with = [](double ratio, const auto& change) {
    testing::GridMesh grid = column(6, 4, 4, ratio);
    change(grid);
    return part_of(grid.mesh).has_value();
  };
  const auto nothing = [](auto& grid) { glue(grid, 6, 4); };
  EXPECT_TRUE(with(1e-3, nothing));
  EXPECT_TRUE(with(1e3, nothing));
  EXPECT_FALSE(with(0.1, nothing));
  // The end of Gamma on a free boundary above and on a held one below.
  EXPECT_FALSE(with(1e-3, [](auto& grid) {
    glue(grid, 6, 4).release([](double x, double y) { return x == 0 && y > 4; });
  }));
  EXPECT_TRUE(with(1e3, [](auto& grid) {
    glue(grid, 6, 4).release([](double x, double y) { return x == 0 && y > 4; });
  }));
  // The minus side of a delaminated inclusion is below; its plus side and bonded ones may be
  // anywhere.
  EXPECT_TRUE(with(1e-3, [](auto& grid) { glue(grid, 6, 4, Kind::delaminated); }));
  EXPECT_FALSE(with(1e3, [](auto& grid) { glue(grid, 6, 4, Kind::delaminated); }));
  EXPECT_TRUE(with(1e3, [](auto& grid) { glue(grid, 6, 4, Kind::inclusion); }));
  // Slits that end on Gamma.
  for (const bool above : {true, false}) {
    for (const Kind kind : {Kind::crack, Kind::inclusion}) {
      const auto slit = [&](auto& grid) {
        glue(grid, 6, 4);
        if (kind == Kind::inclusion) grid.mesh.inclusions.push_back("inclusion");
        grid.add({{3, 4}, {3, above ? 6 : 2}}, {kind, kind}, 0);
      };
      EXPECT_EQ(with(1e-3, slit), !above && kind == Kind::crack) << above;
    }
  }
  // A body in both parts.
  EXPECT_FALSE(with(1e-3, [](auto& grid) {
    glue(grid, 6, 4);
    grid.mesh.inclusions.push_back("inclusion");
    grid.add({{2, 6}, {4, 6}}, {Kind::inclusion, Kind::inclusion}, 0);
    grid.add({{2, 2}, {4, 2}}, {Kind::inclusion, Kind::inclusion}, 0);
  }));
}

struct Parted {
  const char* name;
  bool rich;
  double decades;
};
class Parts : public ::testing::TestWithParam<Parted> {};

/// x^2 <= d_t^2 + P_t + coupling (x + d_t) (y + d_s) and the same of the other part, without X >=
/// 0.
TEST_P(Parts, HaveErrorsThatHardlyReachTheOtherPart) {
  const unsigned first = testing::random_seed();
  int found = 0;
  double nearest = 0;
  for (unsigned seed = first; seed < first + 150; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Nested nested(seed, GetParam().rich, GetParam().decades);
    if (!nested.solved() || !nested.coarse->cut.obstacle.empty()) continue;
    const Solved& coarse = *nested.coarse;
    const std::optional<StiffPart> part =
        stiff_part(*coarse.mesh, coarse.parts.decomposition, coarse.cut);
    if (!part) continue;
    const EquilibratedFlux sigma(coarse.cut, coarse.balance());
    double middle[2] = {}, off[2] = {}, pressure[2] = {};
    integrate(nested, [&](std::size_t t, std::size_t in, const auto& place, double weight) {
      const double tension = nested.fine->tension(t);
      const Vector own = nested.fine->gradient(t, nested.fine->u),
                   before = coarse.gradient(in, coarse.u), of = sigma.difference(in, place);
      const std::size_t p = part->has[in] != 0 ? 1 : 0;
      for (std::size_t d = 0; d < 2; ++d) {
        middle[p] += weight * tension * std::pow(own[d] - before[d] - of[d] / tension / 2, 2);
        off[p] += weight * of[d] * of[d] / (4 * tension);
      }
    });
    const std::vector<double> work = sigma.work_of_pressure();
    for (std::size_t f = 0; f < work.size(); ++f)
      pressure[part->has_face(coarse.cut, coarse.cut.faces[f]) ? 1 : 0] += std::max(0.0, work[f]);
    const double most = part->coupling * (std::sqrt(middle[0]) + std::sqrt(off[0])) *
                        (std::sqrt(middle[1]) + std::sqrt(off[1]));
    const double rounding = 1e-11 * (std::abs(coarse.answer.energy) + sigma.norm_squared());
    for (const std::size_t p : {0U, 1U}) {
      EXPECT_LT(middle[p], off[p] + pressure[p] + most + rounding);
      if (most > rounding) nearest = std::max(nearest, (middle[p] - off[p] - pressure[p]) / most);
    }
    ++found;
  }
  std::printf("[ figures  ] seeds from %u: %d parts, nearest %.3f\n", first, found, nearest);
  EXPECT_GT(found, 20);
}

INSTANTIATE_TEST_SUITE_P(Random, Parts,
                         ::testing::Values(Parted{"Plain", false, 8}, Parted{"Rich", true, 8},
                                           Parted{"Far", true, 16}),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace anticrack::estimate

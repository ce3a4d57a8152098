// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/boundary_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "estimate/edge_polynomial.hpp"
#include "expression/function.hpp"
#include "mesh/refine_uniform.hpp"
#include "operators/mesh_operator.hpp"
#include "operators/mesh_parts.hpp"
#include "support/grid_mesh.hpp"
#include "support/silent_observer.hpp"
#include "support/solve.hpp"

namespace anticrack::estimate {
namespace {

mesh::Mesh square() {
  testing::GridMesh grid(4, 4, {"all"}, [](int, int) { return 0; });
  grid.add({{1, 2}, {3, 2}}, {mesh::Kind::crack, mesh::Kind::crack});
  return grid.mesh;
}

/// A peak, a kink, a ramp with two, or waves, of any width, somewhere.
std::string random_shape(std::mt19937& random) {
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  const std::string to = std::to_string(uniform(-1, 5)),
                    width = std::to_string(std::pow(10, uniform(-6, 0)));
  const std::string s = "(x + 0.7*y - " + to + ")", t = "(" + s + "/" + width + ")";
  switch (std::uniform_int_distribution<int>(0, 4)(random)) {
    case 0:
      return "exp(-" + t + "^2)";
    case 1:
      return "abs" + s;
    case 2:
      return "max(0, 1 - abs" + t + ")";
    case 3:
      return "sin(" + std::to_string(uniform(0, 6)) + "*x)*cos(y) + 0.1*" + t;
    default:
      return "1/(1 + " + t + "^2)";
  }
}

/// int (g' - p')^2 ds of a face, from differences of g.
double missed(const expression::Function& g, const Vector& p, const Vector& q,
              const double* samples) {
  constexpr int count = 300;
  double sum = 0;
  for (std::size_t half = 0; half < BoundarySamples::halves; ++half) {
    EdgePolynomial::Values values{};
    std::copy_n(samples + half * values.size(), values.size(), values.begin());
    const EdgePolynomial polynomial(values);
    const auto rest = [&](int i) {
      const double t = static_cast<double>(i) / count, s = 0.5 * (static_cast<double>(half) + t);
      return g(p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])) - polynomial(t - 0.5);
    };
    for (int i = 0; i < count; ++i) sum += 2.0 * count * std::pow(rest(i + 1) - rest(i), 2);
  }
  return sum;
}

TEST(BoundarySamples, SayWhatTheyMissOfAnyFunction) {
  const auto mesh = std::make_shared<const mesh::Mesh>(square());
  const operators::MeshOperator::Parts parts(mesh, 1, operators::default_condensed_up_to);
  const CutMesh cut = cut_mesh(*mesh, parts.decomposition);
  std::mt19937 random(7);
  int lost = 0;
  for (int i = 0; i < 60; ++i) {
    const std::string text = random_shape(random);
    SCOPED_TRACE(text);
    const expression::Function g(text, "g");
    const BoundarySamples samples = boundary_samples(cut, text);
    double size = 1;
    for (const double value : samples.values) size = std::max(size, std::abs(value));
    std::size_t k = 0;
    for (const Face& face : cut.faces) {
      if (!has_boundary_value(face)) continue;
      const auto corners = corners_of(face);
      const Vector &p = cut.at[at(cut.copy[corners[0]])], &q = cut.at[at(cut.copy[corners[1]])];
      const double known = std::pow(samples.unknown[k], 2),
                   truth = missed(g, p, q, &samples.values[10 * k]);
      EXPECT_LE(truth, known * (1 + 1e-9) + std::pow(1e-10 * size, 2));
      if (truth > 1) ++lost;
      ++k;
    }
    EXPECT_EQ(k, 16U);
  }
  EXPECT_GT(lost, 20);
}

TEST(BoundarySamples, KnowAlmostAllOfWhatIsSmoothOrHasItsKinksInNodes) {
  const auto mesh = std::make_shared<const mesh::Mesh>(square());
  const operators::MeshOperator::Parts parts(mesh, 1, operators::default_condensed_up_to);
  const CutMesh cut = cut_mesh(*mesh, parts.decomposition);
  for (const char* text :
       {"sin(x)*exp(y/4)", "x^2 - x*y", "abs(x - 1)", "max(x, 3)*y", "min(y, 2.5)"})
    for (const double one : boundary_samples(cut, text).unknown) EXPECT_LT(one, 4e-3) << text;
  const auto known = [&](const char* text) {
    return std::ranges::all_of(boundary_samples(cut, text).unknown,
                               [](double one) { return std::isfinite(one); });
  };
  for (const char* text :
       {"sqrt(x)", "x > 1.3 ? 1 : 0", "sqrt(abs(x - 0.3))", "x > 2 ? 1 : 0", "y >= 2 ? 1 : 0",
        "x == 2 ? 1 : 0", "x > 1.5 ? 1 : 0", "x >= 1.25 ? 1 : 0", "atan2(y - 2, x - 2)"})
    EXPECT_FALSE(known(text)) << text;
  // Both angles jump where the edges meet at (0, 2), and the sine of their mean does not.
  EXPECT_TRUE(known("sin(0.5*atan2(y - 2, x - 1) + 0.5*atan2(y - 2, x - 3))"));
  EXPECT_TRUE(known("x >= 2 ? x - 2 : 2 - x"));
}

/// Lowest and highest energy, if there are bounds.
std::optional<std::pair<double, double>> energies(const mesh::Mesh& mesh, const fem::Load& load) {
  const auto op = operators::MeshOperator::factorise(std::make_shared<const mesh::Mesh>(mesh), 1,
                                                     {}, operators::default_condensed_up_to);
  testing::Silent silent;
  const fem::Load* const one[] = {&load};
  const auto prepared = std::get<operators::PreparedLoad>(std::move(op->prepare(one).front()));
  contact::Answer answer = testing::solve(*op, prepared, contact::ActiveSetOptions{}, true, silent);
  op->estimate(prepared, answer);
  if (!answer.energy_lower) return std::nullopt;
  return std::pair(*answer.energy_lower, *answer.energy_upper);
}

TEST(BoundarySamples, WidenTheBoundsByWhatTheyMiss) {
  const mesh::Mesh coarse = square();
  mesh::Mesh fine = coarse;
  for (int i = 0; i < 4; ++i) fine = mesh::refine_uniform(fine);
  for (const char* text : {"exp(-((x - 1.38)/0.01)^2)", "3*max(0, 1 - abs(x - 2.88)/0.02)",
                           "abs(x - 1.3)", "0.2*sin(40*x)", "1/(1 + ((x + y - 2.1)/0.02)^2)"}) {
    fem::Load load;
    load.boundary_value = text;
    load.force = 0.5;
    const auto of_coarse = energies(coarse, load), of_fine = energies(fine, load);
    ASSERT_TRUE(of_coarse && of_fine) << text;
    EXPECT_LT(of_coarse->first, of_fine->second) << text;
    EXPECT_GT(of_coarse->second, of_fine->first) << text;
  }
}

}  // namespace
}  // namespace anticrack::estimate

// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tips in the rows of a sweep against those of the same loads given as they are.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "contact/sweep_columns.hpp"
#include "operators/mesh_operator.hpp"
#include "support/errors.hpp"
#include "tips/measured.hpp"

namespace anticrack::testing {
namespace {

using contact::SweepColumns;
using contact::TipAnswer;
using mesh::Kind;

struct Part {
  std::string force, boundary;
};
const std::vector<Part> parts{{"-6*(x>0.1)*(y>0) + 2", "0"},
                              {"3*sin(4*x + 2*y)", "0.5*y"},
                              {"0", "y + 0.25*x*y"},
                              {"2*(y<0)*x", "0"}};

fem::Load combined(const std::vector<double>& c) {
  std::string force = "0", boundary = "0";
  for (std::size_t j = 0; j < c.size(); ++j) {
    force += " + " + text_of(c[j]) + "*(" + parts[j].force + ")";
    boundary += " + " + text_of(c[j]) + "*(" + parts[j].boundary + ")";
  }
  fem::Load load = with_boundary(boundary);
  load.force = fem::Expression{force};
  return load;
}

std::shared_ptr<const operators::MeshOperator> factorised(mesh::Mesh mesh) {
  return operators::MeshOperator::factorise(std::make_shared<const mesh::Mesh>(std::move(mesh)), 2,
                                            {});
}

SweepColumns rows_of(const operators::MeshOperator& op, const std::vector<double>& coefficients,
                     bool tips = true) {
  std::vector<fem::Load> loads;
  for (std::size_t j = 0; j < parts.size(); ++j) {
    std::vector<double> unit(parts.size(), 0);
    unit[j] = 1;
    loads.push_back(combined(unit));
  }
  std::vector<const fem::Load*> pointers;
  for (const fem::Load& load : loads) pointers.push_back(&load);
  const auto basis = op.basis(pointers, {}, false, 0, tips);
  SweepColumns rows(coefficients.size() / parts.size(), op.mesh().inclusions.size(),
                    op.contact_nodes().size(), false, false, tips ? op.tip_count() : 0);
  std::vector<char> start;
  EXPECT_TRUE(op.sweep(*basis, std::span<const double>(coefficients.data(), coefficients.size()),
                       {}, rows, start));
  return rows;
}

/// Cracks, delaminated and bonded ends, and fronts; open, closed and closed in part.
TEST(TipsOfRows, AreThoseOfTheSameLoads) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> one(-1, 1);
  std::size_t closed = 0, open = 0, in_contact = 0;
  for (mesh::Mesh mesh :
       {cut_square(Kind::crack), cut_square(Kind::free), cut_square(Kind::delaminated),
        cut_square(Kind::delaminated, Kind::inclusion), cut_square(Kind::inclusion)}) {
    const auto op = factorised(fine(mesh));
    std::vector<double> coefficients(4 * parts.size());
    for (double& c : coefficients) c = one(random);
    coefficients[1] = coefficients[6] = 0;
    const SweepColumns rows = rows_of(*op, coefficients);
    ASSERT_EQ(rows.tips, 2U);
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      ASSERT_EQ(rows.status[row], contact::Status::converged);
      const std::vector<double> c(
          coefficients.begin() + static_cast<long>(row * parts.size()),
          coefficients.begin() + static_cast<long>((row + 1) * parts.size()));
      const contact::Answer answer = measure(op, combined(c)).answer;
      in_contact += answer.contact_length > 0.05 ? 1 : 0;
      for (std::size_t i = 0; i < rows.tips; ++i) {
        const TipAnswer& tip = answer.tips[i];
        const std::size_t at = row * rows.tips + i;
        // A load that jumps is integrated in other triangles as a sum than by itself.
        EXPECT_NEAR(rows.intensity[at], *tip.intensity, 1e-5);
        if (!tip.energy_release_rate) {
          EXPECT_TRUE(std::isnan(rows.energy_release_rate[at]));
          continue;
        }
        EXPECT_NEAR(rows.energy_release_rate[at], *tip.energy_release_rate, 1e-5);
        EXPECT_NEAR(rows.energy_release_rate_spread[at], *tip.energy_release_rate_spread, 1e-5);
        ++(tip.closed ? closed : open);
      }
    }
  }
  EXPECT_GT(closed, 3U);
  EXPECT_GT(open, 10U);
  EXPECT_GT(in_contact, 5U);
}

TEST(TipsOfRows, AreHomogeneous) {
  const auto op = factorised(fine(cut_square(Kind::crack)));
  const std::vector<double> c{0.4, -0.7, 0.5, 0.3};
  std::vector<double> coefficients(8, 0);
  for (std::size_t j = 0; j < 4; ++j) coefficients[4 + j] = 3 * c[j];
  coefficients.insert(coefficients.end(), c.begin(), c.end());
  const SweepColumns rows = rows_of(*op, coefficients);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(rows.energy_release_rate[i], 0);  // of no load
    EXPECT_EQ(rows.intensity[i], 0);
    EXPECT_NEAR(rows.energy_release_rate[2 + i], 9 * rows.energy_release_rate[4 + i], 1e-10);
    EXPECT_NEAR(rows.intensity[2 + i], 3 * rows.intensity[4 + i], 1e-10);
  }
}

TEST(TipsOfRows, AreAbsentWhereTheyAreNotAskedForOrCannotBe) {
  const auto op = factorised(tilting(fine(cut_square(Kind::delaminated))));
  const std::vector<double> c{0.4, -0.7, 0.5, 0.3};
  EXPECT_TRUE(rows_of(*op, c, false).intensity.empty());
  for (const double value : rows_of(*op, c).intensity) EXPECT_TRUE(std::isnan(value));
}

}  // namespace
}  // namespace anticrack::testing

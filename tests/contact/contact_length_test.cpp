// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/contact_length.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "contact/answer.hpp"
#include "contact/membrane.hpp"

namespace anticrack::contact {
namespace {

/// Loads turn from one that opens the right half to one that opens the left half.
std::string turned(double angle) {
  return fmt::format("(y > 0 ? 1 : -1)*({:.17g} + {:.17g}*x)", 0.2 * std::cos(angle),
                     std::sin(angle));
}

struct Curve {
  double largest_step = 0, shortest = 1e300, longest = 0, largest_error = 0;
};

Curve curve_on(int columns, int steps) {
  const Membrane membrane(testing::structured_mesh({columns, columns / 2, {}, {}, {"bar"}}));
  Curve curve;
  double before = 0;
  for (int k = 0; k <= steps; ++k) {
    const Answer answer =
        membrane.exact(fem::Expression{turned(std::numbers::pi * (0.2 + 0.6 * k / steps))});
    if (k > 0)
      curve.largest_step = std::max(curve.largest_step, std::abs(answer.contact_length - before));
    before = answer.contact_length;
    curve.shortest = std::min(curve.shortest, before);
    curve.longest = std::max(curve.longest, before);
    curve.largest_error = std::max(curve.largest_error, answer.contact_length_error);
    EXPECT_NEAR(answer.contact_length, answer.inclusions[0].contact_length, 1e-14);
  }
  return curve;
}

TEST(ContactLength, IsAContinuousFunctionOfTheLoad) {
  constexpr double edge = 1.0 / 16;
  const Curve coarse = curve_on(32, 60), fine = curve_on(32, 240);
  std::printf("[ figures  ] steps of %.4f and %.4f of an edge, lengths %.3f to %.3f\n",
              coarse.largest_step / edge, fine.largest_step / edge, fine.shortest, fine.longest);
  EXPECT_GT(fine.longest - fine.shortest, 3 * edge) << "nodes change";
  EXPECT_LT(fine.largest_step, 0.4 * coarse.largest_step) << "a step of a staircase would remain";
  EXPECT_LT(fine.largest_error, 4 * edge);
  EXPECT_GT(fine.largest_error, 0);
}

TEST(ContactLength, OfAClosedCrackIsAllOfIt) {
  const Membrane membrane(testing::structured_mesh({32, 8, {}, {}, {"bar"}}));
  const Answer closed = membrane.exact(0.0, "-0.7*y"),
               open = membrane.exact(fem::Expression{"y > 0 ? 1 : -1"});
  EXPECT_DOUBLE_EQ(closed.contact_length, 1);
  EXPECT_EQ(closed.contact_length_error, 0);
  EXPECT_EQ(open.contact_length, 0);
  EXPECT_EQ(open.contact_length_error, 0);
}

}  // namespace
}  // namespace anticrack::contact

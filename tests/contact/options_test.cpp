// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "contact/options.hpp"
#include "errors/errors.hpp"

namespace anticrack::contact {
namespace {

void expect_refused(const SolverOptions& options, const char* field) {
  try {
    check(options, 1000);
    FAIL() << field << " accepted";
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.reason(), errors::Reason::invalid_argument);
    ASSERT_EQ(error.fields().size(), 1U);
    EXPECT_EQ(error.fields()[0].field, field) << error.what();
  }
}

UzawaOptions good() {
  UzawaOptions options;
  options.max_iterations = 1000;
  return options;
}

TEST(UzawaOptions, RefusedFieldsAreNamed) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NO_THROW(check(good(), 1000));
  for (const double bad : {0.0, -2.0, infinity, nan}) {
    UzawaOptions options = good();
    options.theta = bad;
    expect_refused(options, "uzawa.theta");
    options = good();
    options.epsilon = bad;
    expect_refused(options, "uzawa.epsilon");
  }
  for (const double bad : {-1e-9, infinity, nan}) {
    UzawaOptions options = good();
    options.p = bad;
    expect_refused(options, "uzawa.p");
  }
  for (const int bad : {0, -5, 1001}) {
    UzawaOptions options = good();
    options.max_iterations = bad;
    expect_refused(options, "uzawa.max_iterations");
  }
}

TEST(UzawaOptions, ToleranceOfTheResidualsIsPositive) {
  UzawaOptions options = good();
  options.kkt_tolerance = 1e-9;
  EXPECT_NO_THROW(check(options, 1000));
  for (const double bad : {0.0, -1e-9, std::numeric_limits<double>::infinity(), std::nan("")}) {
    options.kkt_tolerance = bad;
    expect_refused(options, "uzawa.kkt_tolerance");
  }
}

TEST(ActiveSetOptions, RefusedFieldsAreNamed) {
  EXPECT_NO_THROW(check(ActiveSetOptions{}, 1000));
  for (const double bad : {-1e-12, 0.1, std::numeric_limits<double>::infinity(), std::nan("")}) {
    expect_refused(ActiveSetOptions{bad, 10}, "active_set.tolerance");
  }
  for (const int bad : {0, -1, 1001}) {
    expect_refused(ActiveSetOptions{0, bad}, "active_set.max_steps");
  }
}

TEST(SolverOptions, DefaultToTheActiveSet) {
  EXPECT_TRUE(std::holds_alternative<ActiveSetOptions>(SolverOptions{}));
}

TEST(UzawaOptions, AutoThetaAndNoBoundAtAllAreFine) {
  UzawaOptions options = good();
  options.theta.reset();
  options.p = 0;
  EXPECT_NO_THROW(check(options, 1000));
}

}  // namespace
}  // namespace anticrack::contact

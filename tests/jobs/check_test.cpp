// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "fields/walk.hpp"
#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::throws;
using errors::Reason;
using records::JobSpec;

JobSpec good() {
  JobSpec spec;
  spec.title = "a title";
  spec.mesh = "0123456789abcdef";
  spec.loads = {{"first", 1.0, ""},
                {"second", fem::Expression{"y > 0 ? x : -1"}, "x*y"},
                {"third", fem::PerRegion{{{"upper", 2.0}}}, ""},
                {"fourth", fem::Array{std::string(64, 'a'), true}, "", "y"}};
  spec.loads[3].point_forces = {{0.25, 0.5, 1}};
  spec.loads[3].inclusion_forces = {{"fibre", -1.0}};
  return spec;
}

/// Its options, Algorithm 2's defaults if it had another method.
contact::UzawaOptions& uzawa(JobSpec& spec) {
  if (!std::holds_alternative<contact::UzawaOptions>(spec.solver)) {
    spec.solver = contact::UzawaOptions();
  }
  return std::get<contact::UzawaOptions>(spec.solver);
}

contact::ActiveSetOptions& active_set(JobSpec& spec) {
  return std::get<contact::ActiveSetOptions>(spec.solver);
}

class Check : public ::testing::Test {
 protected:
  ::testing::AssertionResult refuses(const std::function<void(JobSpec&)>& spoil,
                                     const std::string& field,
                                     Reason reason = Reason::invalid_argument) {
    JobSpec spec = good();
    spoil(spec);
    return throws([&] { check(spec, options); }, reason, field);
  }
  EngineOptions options;
};

TEST_F(Check, TheBalancedFluxIsThatOfBounds) {
  JobSpec spec = good();
  spec.balanced_flux = true;
  EXPECT_NO_THROW(check(spec, options));
  const auto bad = [](const auto& spoil) {
    return [spoil](JobSpec& spec) {
      spec.balanced_flux = true;
      spoil(spec);
    };
  };
  EXPECT_TRUE(refuses(bad([](JobSpec& spec) { spec.without_bounds = true; }), "outputs"));
  EXPECT_TRUE(refuses(bad([](JobSpec& spec) { uzawa(spec); }), "outputs"));
}

TEST_F(Check, CountsTheBytesOfAJob) {
  JobSpec spec = good();
  const std::uint64_t before = fields::bytes_of(spec);
  std::get<fem::Expression>(spec.loads[1].force).text += std::string(1000, ' ');
  EXPECT_GE(fields::bytes_of(spec), before + 1000);
  spec.loads[3].point_forces.resize(1001);
  EXPECT_GE(fields::bytes_of(spec), before + 1000 + 1000 * sizeof(fem::PointForce));
}

TEST_F(Check, AcceptsAGoodJob) {
  EXPECT_NO_THROW(check(good(), options));
  JobSpec spec = good();
  spec.loads[0].name = "0 a_b.c-d" + std::string(55, 'x');
  uzawa(spec).theta.reset();
  uzawa(spec).p = 0;
  EXPECT_NO_THROW(check(spec, options));
}

TEST_F(Check, NamesTheLoadCaseAtFault) {
  EXPECT_TRUE(refuses([](JobSpec& spec) { spec.loads.clear(); }, "load_cases"));
  EXPECT_TRUE(refuses([](JobSpec& spec) { spec.loads[1].name = "first"; }, "load_cases[1].name"));
  for (const char* name : {"", " x", "_x", "a/b", "a\n", "\xc3\xa4"}) {
    EXPECT_TRUE(refuses([&](JobSpec& spec) { spec.loads[2].name = name; }, "load_cases[2].name"))
        << name;
  }
  EXPECT_TRUE(refuses([](JobSpec& spec) { spec.loads[0].name = std::string(65, 'x'); },
                      "load_cases[0].name"));
}

TEST_F(Check, NamesTheExpressionAtFault) {
  EXPECT_TRUE(refuses([](JobSpec& spec) { spec.loads[1].force = fem::Expression{"x +"}; },
                      "load_cases[1].force.expression", Reason::expression_invalid));
  EXPECT_TRUE(refuses([](JobSpec& spec) { spec.loads[1].force = fem::Expression{"q"}; },
                      "load_cases[1].force.expression", Reason::expression_invalid));
  EXPECT_TRUE(refuses([](JobSpec& spec) { spec.loads[2].boundary_value = "1 +"; },
                      "load_cases[2].boundary_value", Reason::expression_invalid));
}

TEST_F(Check, NamesTheLoadAtFault) {
  EXPECT_TRUE(refuses([](JobSpec& spec) { spec.loads[3].inclusion_forces["fibre"] = std::nan(""); },
                      "load_cases[3].inclusion_forces[fibre]"));
  EXPECT_TRUE(
      refuses([](JobSpec& spec) { spec.loads[3].point_forces.resize(fem::max_point_forces + 1); },
              "load_cases[3].point_forces", Reason::limit_exceeded));
}

TEST_F(Check, NamesTheProbeAtFault) {
  const auto with = [](records::Probe probe) {
    return [probe](JobSpec& s) { s.probes = {{"a", {0, 0}}, probe}; };
  };
  const double nan = std::nan("");
  EXPECT_FALSE(refuses(with({"", {1, 0}, {{2, 0}}, 999}), ""));
  EXPECT_TRUE(refuses(with({"a", {1, 0}}), "probes[1].name"));
  EXPECT_TRUE(refuses(with({"two words", {1, 0}}), "probes[1].name"));
  EXPECT_TRUE(refuses(with({"b", {nan, 0}}), "probes[1].from"));
  EXPECT_TRUE(refuses(with({"b", {0, 0}, {{0, nan}}, 3}), "probes[1].to"));
  EXPECT_TRUE(refuses(with({"b", {0, 0}, {{0, 0}}, 3}), "probes[1].to"));
  EXPECT_TRUE(refuses(with({"b", {0, 0}, {{1, 0}}, 1}), "probes[1].points"));
  EXPECT_TRUE(refuses(with({"b", {0, 0}, {}, 2}), "probes[1].points"));
  EXPECT_TRUE(
      refuses(with({"b", {0, 0}, {{1, 0}}, 1000}), "probes[1].points", Reason::limit_exceeded));
}

TEST_F(Check, NamesTheParameterAtFault) {
  EXPECT_TRUE(refuses([](JobSpec& spec) { uzawa(spec).theta = 0; }, "solver.uzawa.theta"));
  EXPECT_TRUE(refuses([](JobSpec& spec) { active_set(spec).tolerance = -1; },
                      "solver.active_set.tolerance"));
}

TEST_F(Check, HoldsTheLimits) {
  options.max_load_cases = 3;
  EXPECT_TRUE(refuses([](JobSpec&) {}, "load_cases", Reason::limit_exceeded));
  options.max_load_cases = 4;
  EXPECT_NO_THROW(check(good(), options));
}

}  // namespace
}  // namespace anticrack::jobs

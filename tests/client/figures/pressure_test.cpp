// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/pressure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <numeric>
#include <sstream>

#include "support/sample_result.hpp"

namespace anticrack::figures {
namespace {

using anticrack::testing::sample_result;

TEST(Peaks, end_the_axis_by_weight_and_not_by_number) {
  // Nine nodes in ten lie near a tip.
  std::vector<std::pair<double, double>> values{{1, 10}};
  for (int i = 0; i < 9; ++i) values.emplace_back(std::pow(10, i + 1), 1e-3);
  const Peaks seen = peaks(values, 0.9, 1.5);
  EXPECT_EQ(seen.highest, 1e9);
  EXPECT_EQ(seen.shown, 1.5);
  EXPECT_TRUE(seen.cut_off());
}

TEST(Peaks, are_shown_where_they_are_little_above_the_end) {
  const Peaks seen = peaks({{1, 10}, {1.8, 0.1}}, 0.9, 1.5);
  EXPECT_EQ(seen.shown, 1.8);
  EXPECT_FALSE(seen.cut_off());
  EXPECT_EQ(peaks({}, 0.9, 1.5).shown, 0);
}

results::Kind kind(int number) { return static_cast<results::Kind>(number); }

TEST(Pressure, is_what_python_draws) {
  std::ifstream table(ANTICRACK_SAME "/pressure.txt");
  results::Interface interface;
  results::Trace trace;
  std::vector<std::array<double, 3>> rows;
  for (std::string line; std::getline(table, line);) {
    std::istringstream words(line);
    std::string what, at, second, third;
    int contact = 0;
    words >> what >> at >> second >> third >> contact;
    if (what == "drawn") rows.push_back({std::stod(at), std::stod(second), std::stod(third)});
    if (what != "node") continue;
    interface.s.push_back(std::stod(at));
    interface.kind.push_back(kind(std::stoi(second)));
    trace.pressure.push_back(std::stod(third));
    trace.contact.push_back(contact);
  }
  const Pressure seen = pressure(interface, trace, interface.s);
  ASSERT_EQ(seen.values.size(), rows.size());
  ASSERT_GT(rows.size(), 5U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_THAT(seen.position[i], ::testing::NanSensitiveDoubleEq(rows[i][0])) << i;
    EXPECT_THAT(seen.values[i], ::testing::NanSensitiveDoubleEq(rows[i][1])) << i;
    EXPECT_EQ(seen.lengths[i], rows[i][2]) << i;
  }
}

TEST(Pressure, keeps_the_force_and_has_no_teeth) {
  auto result = sample_result(10);
  const results::Interface& interface = result.interfaces[0];
  results::Trace& trace = result.loads[1].traces[0];
  trace.pressure.front() = 7;  // the flux of glue
  double force = 0;
  for (std::size_t i = 1; i + 1 < interface.node_count(); ++i) {
    if (interface.kind[i] != results::Kind::delaminated) continue;
    trace.pressure[i] = i % 2 == 0 ? 1.25 : 0.75;
    force += trace.pressure[i] * (interface.s[i + 1] - interface.s[i - 1]) / 2;
  }
  const Pressure seen = pressure(interface, trace, interface.x);
  EXPECT_NEAR(std::inner_product(seen.values.begin(), seen.values.end(), seen.lengths.begin(), 0.0),
              force, 1e-12);
  for (std::size_t i = 1; i + 1 < seen.values.size(); ++i) EXPECT_DOUBLE_EQ(seen.values[i], 1) << i;
  EXPECT_DOUBLE_EQ(seen.position.front(), -0.425);
}

TEST(Pressure, has_no_axis_without_contact) {
  const auto result = sample_result(10);
  const results::Interface& interface = result.interfaces[0];
  EXPECT_EQ(pressure(interface, result.loads[0].traces[0], interface.s).peaks.highest, 0);
}

}  // namespace
}  // namespace anticrack::figures

// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/cli/sample_stages.hpp"

namespace anticrack::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

results::Load sample() {
  results::Load load;
  load.answer.set_name("open\ning");
  load.stages = {stage(1, 212, 0), stage(2, 1210, 0)};
  v1::StageAnswer& first = *load.stages[0].mutable_answers(0);
  first.Clear();
  first.set_energy(-0.147);
  load.stages[0].set_seconds(0.0123);
  v1::StageAnswer& last = *load.stages[1].mutable_answers(0);
  last.set_energy(-0.1675);
  last.set_energy_lower(-0.17);
  last.set_energy_upper(-0.165);
  last.set_error_bound_relative(0.05);
  last.set_displacement_error(0.012);
  return load;
}

TEST(StagesTable, has_a_row_for_each_stage) {
  EXPECT_EQ(stages_table(sample()),
            "\n"
            "open?ing, stage by stage:\n"
            "stage  triangles             energy  error of u  error of A    time\n"
            "               -                  -           %           %       s\n"
            "1            212             -0.147           -           -  0.0123\n"
            "2           1210  -0.1675 +- 0.0025           5         1.2     0.5\n");
}

TEST(StagesTable, tells_the_error_of_a_only_where_it_is_known) {
  results::Load load = sample();
  load.stages[1].mutable_answers(0)->clear_displacement_error();
  EXPECT_THAT(stages_table(load), Not(HasSubstr("error of A")));
  EXPECT_EQ(stages_table({}), "");
}

}  // namespace
}  // namespace anticrack::cli

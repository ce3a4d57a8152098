// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/stages_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace anticrack::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

results::Load sample() {
  results::Load load;
  load.name = "open\ning";
  load.stages = {{212, 1210},
                 {-0.147, -0.1669},
                 {results::unknown, -0.17},
                 {results::unknown, -0.165},
                 {results::unknown, 0.05},
                 {results::unknown, 0.012},
                 {0.0123, 0.5}};
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
  for (double& error : load.stages.displacement_error) error = results::unknown;
  EXPECT_THAT(stages_table(load), Not(HasSubstr("error of A")));
  EXPECT_EQ(stages_table({}), "");
}

}  // namespace
}  // namespace anticrack::cli

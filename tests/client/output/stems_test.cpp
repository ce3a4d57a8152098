// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/stems.hpp"

#include <gmock/gmock.h>

namespace anticrack::output {
namespace {

using ::testing::ElementsAre;

TEST(FileStems, are_safe_and_unique) {
  EXPECT_THAT(file_stems({"opening", "partly closed", "partly_closed", "PARTLY_CLOSED"}, {}),
              ElementsAre("opening", "partly_closed", "partly_closed-2", "PARTLY_CLOSED-3"));
  EXPECT_THAT(file_stems({"../etc/passwd", "-rf", "", "a'b|c"}, {}),
              ElementsAre("load.._etc_passwd", "load-rf", "load", "a_b_c"));
}

TEST(FileStems, do_not_meet_in_a_suffix) {
  EXPECT_THAT(file_stems({"a", "a-traces"}, {"-traces"}), ElementsAre("a", "a-traces-2"));
  EXPECT_THAT(file_stems({"a-traces", "a"}, {"-traces"}), ElementsAre("a-traces", "a-2"));
}

}  // namespace
}  // namespace anticrack::output

// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "casefile/sample_case.hpp"

namespace anticrack::casefile {
namespace {

using ::testing::HasSubstr;

TEST(JobSection, BecomesPriorityAndTimes) {
  const Case plain = parse(sample_text);
  EXPECT_EQ(plain.spec.priority(), v1::JobSpec::PRIORITY_UNSPECIFIED);
  EXPECT_FALSE(plain.spec.has_run_timeout());

  const Case the_case = parse(sample_text + R"([job]
priority = "bulk"
queue_timeout = 90.5
run_timeout = "2h"
)");
  EXPECT_EQ(the_case.spec.priority(), v1::JobSpec::PRIORITY_BULK);
  EXPECT_EQ(the_case.spec.queue_timeout().seconds(), 90);
  EXPECT_EQ(the_case.spec.queue_timeout().nanos(), 500'000'000);
  EXPECT_EQ(the_case.spec.run_timeout().seconds(), 7200);
  EXPECT_EQ(locate(the_case, "spec.run_timeout")->line, 24U);
}

TEST(UnitsSection, NamesUnits) {
  EXPECT_FALSE(parse(sample_text).spec.has_units());
  const Case the_case = parse(sample_text + "[units]\nlength = \"mm\"\nforce = \"N\"\n");
  EXPECT_EQ(the_case.spec.units().length(), "mm");
  EXPECT_EQ(the_case.spec.units().force(), "N");
  EXPECT_EQ(locate(the_case, "spec.units.force")->line, 23U);
  EXPECT_THAT(complaint(sample_text + "[units]\nlenght = \"mm\"\n"),
              HasSubstr("did you mean length?"));
}

TEST(JobSection, NamesWhatIsWrong) {
  EXPECT_THAT(complaint(sample_text + "[job]\npriority = \"blk\"\n"),
              HasSubstr("did you mean bulk?"));
  EXPECT_THAT(complaint(sample_text + "[job]\nprioriy = \"bulk\"\n"),
              HasSubstr("did you mean priority?"));
  for (const char* bad : {"0", "-3", "true", "\"soon\"", "\"400d\""}) {
    EXPECT_THAT(complaint(sample_text + "[job]\nrun_timeout = " + bad + "\n"),
                HasSubstr("plate.toml:22: job.run_timeout: "))
        << bad;
  }
}

TEST(JobSection, IsOverridden) {
  EXPECT_EQ(parse(sample_text, {"job.priority=interactive"}).spec.priority(),
            v1::JobSpec::PRIORITY_INTERACTIVE);
  EXPECT_EQ(parse(sample_text, {"job.queue_timeout='90'"}).spec.queue_timeout().seconds(), 90);
}

}  // namespace
}  // namespace anticrack::casefile

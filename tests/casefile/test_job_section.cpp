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

TEST(OutputSection, HasProbes) {
  const Case the_case = parse(sample_text + R"([[output.probe]]
at = [0.5, 0.25]
[[output.probe]]
name = "middle"
from = [-1, 0]
to = [1, 0]
points = 5
)");
  ASSERT_EQ(the_case.spec.probes_size(), 2);
  EXPECT_EQ(the_case.spec.probes(0).from().y(), 0.25);
  EXPECT_FALSE(the_case.spec.probes(0).has_to());
  EXPECT_EQ(the_case.spec.probes(1).name(), "middle");
  EXPECT_EQ(the_case.spec.probes(1).to().x(), 1);
  EXPECT_EQ(the_case.spec.probes(1).points(), 5);
  EXPECT_EQ(locate(the_case, "spec.probes[0].from")->line, 22U);
  EXPECT_EQ(locate(the_case, "spec.probes[1].points")->line, 27U);
  for (const char* half : {"points = 3", "from = [0, 0]\nto = [1, 0]", "to = [1, 0]\npoints = 3",
                           "at = [0, 0]\npoints = 3", "at = [0, 0]\nfrom = [0, 0]"})
    EXPECT_THAT(complaint(sample_text + "[[output.probe]]\n" + half + "\n"),
                HasSubstr("plate.toml:21: output.probe.0: neither a point nor a line; write at = "))
        << half;
  EXPECT_THAT(complaint(sample_text + "[[output.probe]]\nat = [nan, 0]\n"),
              HasSubstr("plate.toml:22: output.probe.0.at: "));
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

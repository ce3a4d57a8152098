// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/result.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/sample_result.hpp"

namespace anticrack::results {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A sheet of 200 by 50 whose inclusion moves by A.
Result moved(double a) {
  Result result;
  result.units = anticrack::testing::units_of("mm", "N");
  result.arrays["mesh/nodes"] = array_of(std::vector<double>{0, 10, 200, 10, 200, 60, 0, 60}, {2});
  result.loads.resize(2);
  result.loads[0].answer.set_name("small");
  result.loads[1].answer.set_name("large");
  result.loads[1].answer.add_inclusions()->set_displacement(a);
  return result;
}

TEST(Notes, tell_of_u_above_a_tenth_of_the_smaller_side) {
  EXPECT_THAT(notes_on(moved(5)), IsEmpty());
  EXPECT_THAT(notes_on(moved(-448.3)),
              ElementsAre(AllOf(HasSubstr("u reaches 448 mm in load \"large\""),
                                HasSubstr("smaller side of the sheet is 50 mm"),
                                HasSubstr("look for a factor"))));
}

TEST(Notes, look_at_all_of_u_that_is_known) {
  Result traced = moved(0), drawn = moved(0), swept = moved(0);
  traced.arrays["loads/small/traces/0/u_plus"] = array_of(std::vector<double>{0, -7});
  EXPECT_THAT(notes_on(traced), ElementsAre(HasSubstr("reaches 7 mm in load \"small\"")));
  drawn.arrays["loads/small/fields/0/u"] = array_of(std::vector<double>{0, 8});
  EXPECT_THAT(notes_on(drawn), ElementsAre(HasSubstr("reaches 8 mm")));
  swept.loads.clear();
  swept.sweep.emplace();
  swept.sweep->inclusions = {"fibre"};
  swept.sweep->columns = {
      {"status", array_of(std::vector<std::int32_t>{v1::LoadCaseAnswer::STATUS_CONVERGED,
                                                    v1::LoadCaseAnswer::STATUS_FAILED})},
      // that of a row that failed means nothing
      {"displacement", array_of(std::vector<double>{-9, 1e3}, {1})},
      {"energy", array_of(std::vector<double>{-1, -1})},
      {"contact_length", array_of(std::vector<double>{0, 0})}};
  EXPECT_THAT(notes_on(swept), ElementsAre(HasSubstr("u reaches 9 mm, and")));
}

TEST(Notes, say_nothing_of_u_whose_unit_may_be_another) {
  Result plain = moved(1e6);
  plain.units = {};
  EXPECT_THAT(notes_on(plain), IsEmpty());
}

TEST(Notes, tell_of_the_unit_that_is_missing) {
  Result one = moved(1);
  one.units = anticrack::testing::units_of("mm", "");
  EXPECT_THAT(notes_on(one), ElementsAre(HasSubstr("gives no force, so energies")));
  one.units = anticrack::testing::units_of("", "N");
  EXPECT_THAT(notes_on(one), ElementsAre(HasSubstr("gives no length")));
}

}  // namespace
}  // namespace anticrack::results

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
  result.mesh.xy = {0, 10, 200, 10, 200, 60, 0, 60};
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
  traced.loads[0].traces.resize(1);
  traced.loads[0].traces[0].u_plus = {0, -7};
  EXPECT_THAT(notes_on(traced), ElementsAre(HasSubstr("reaches 7 mm in load \"small\"")));
  drawn.loads[0].fields.resize(1);
  drawn.loads[0].fields[0].u = {0, 8};
  EXPECT_THAT(notes_on(drawn), ElementsAre(HasSubstr("reaches 8 mm")));
  swept.loads.clear();
  swept.sweep.emplace();
  swept.sweep->inclusions = {"fibre"};
  swept.sweep->status = {v1::LoadCaseAnswer::STATUS_CONVERGED, v1::LoadCaseAnswer::STATUS_FAILED};
  swept.sweep->displacement = {-9, 1e3};  // that of a row that failed means nothing
  swept.sweep->energy = {-1, -1};
  swept.sweep->steps = {1, 1};
  swept.sweep->contact_length = {0, 0};
  swept.sweep->kkt = {0, 0};
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

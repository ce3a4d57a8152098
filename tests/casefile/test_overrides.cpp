// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "casefile/sample_case.hpp"

namespace anticrack::casefile {
namespace {

using ::testing::HasSubstr;

TEST(Overrides, ReplaceAndAddKeys) {
  const Case the_case =
      parse(sample_text, {"solver.theta=1.7", "solver.mass=consistent", "output.fields=true"});
  EXPECT_EQ(the_case.spec.solver().uzawa().theta(), 1.7);
  EXPECT_EQ(the_case.spec.solver().uzawa().mass(), v1::MASS_CONSISTENT);
  EXPECT_EQ(the_case.spec.outputs_size(), 1);
}

TEST(Overrides, TakeBareWordsAsText) {
  EXPECT_TRUE(parse(sample_text, {"solver.theta=auto"}).spec.solver().uzawa().theta_auto());
  EXPECT_EQ(
      parse(sample_text, {"load.0.f=x * y > 0 ? 1 : -1"}).spec.load_cases(0).force().expression(),
      "x * y > 0 ? 1 : -1");
  EXPECT_EQ(parse(sample_text, {"title=a = b\nc = 1"}).spec.title(), "a = b\nc = 1");
}

TEST(Overrides, TakeTomlValues) {
  EXPECT_EQ(parse(sample_text, {"title=\"3\""}).spec.title(), "3");
  const Case the_case = parse(sample_text, {"load.1.f={omega2 = 2}"});
  EXPECT_EQ(the_case.spec.load_cases(1).force().per_region().values().at("omega2"), 2);
  EXPECT_EQ(parse(sample_text, {"geometry.boundary=[[0, 0], [1, 0], [0, 1]]"})
                .mesh.geometry()
                .boundary_size(),
            3);
}

TEST(Overrides, ReachIntoLists) {
  const Case the_case = parse(
      sample_text, {"load.0.f=5", "geometry.boundary.2.0=7", "geometry.inclusion.0.name=rod"});
  EXPECT_EQ(the_case.spec.load_cases(0).force().constant(), 5);
  EXPECT_EQ(the_case.mesh.geometry().boundary(2).x(), 7);
  EXPECT_EQ(the_case.mesh.geometry().inclusions(0).name(), "rod");
}

TEST(Overrides, AppendBehindTheLastOne) {
  const Case the_case = parse(sample_text, {"load.2.name=three", "load.2.f=3"});
  ASSERT_EQ(the_case.spec.load_cases_size(), 3);
  EXPECT_EQ(the_case.spec.load_cases(2).name(), "three");
}

TEST(Overrides, TheLastOfTwoWins) {
  EXPECT_EQ(parse(sample_text, {"solver.theta=1", "solver.theta=3"}).spec.solver().uzawa().theta(),
            3);
}

TEST(Overrides, OfTheMethodSayWhatToDoAboutKeysOfTheOther) {
  const std::string replace = "write --set 'solver={method=\"active-set\"}', which replaces all";
  const std::vector<std::string> chosen{"solver.method=active-set"};
  EXPECT_THAT(complaint(sample_text, chosen),
              HasSubstr("plate.toml:13: solver.theta: belongs to method \"uzawa\"; " + replace +
                        " of [solver], or remove it from the case"));
  EXPECT_THAT(complaint(sample_with("theta = 1.5", "theta = 1.5\np = 10"), chosen),
              HasSubstr("solver.theta: theta, p belong to method \"uzawa\"; " + replace));
  EXPECT_THAT(complaint(sample_text, {"solver.max_steps=3"}),
              HasSubstr("--set solver.max_steps=3: solver.max_steps: belongs to method "
                        "\"active-set\"; remove it, or put --set 'solver={method=\"active-set\"}' "
                        "before it"));
  EXPECT_TRUE(parse(sample_text, {"solver={method=\"active-set\"}", "solver.max_steps=3"})
                  .spec.solver()
                  .has_active_set())
      << "the cure";
}

TEST(Overrides, AreInTheTextThatIsKept) {
  const Case the_case = parse(sample_text, {"solver.theta=1.75"});
  EXPECT_THAT(the_case.text, HasSubstr("1.75"));
  const Case again = parse(the_case.text);
  EXPECT_EQ(again.spec.SerializeAsString(), the_case.spec.SerializeAsString());
  EXPECT_EQ(again.mesh.SerializeAsString(), the_case.mesh.SerializeAsString());
}

TEST(Overrides, FindAnEntryOfAListByItsName) {
  const Case by_index = parse(sample_text, {"load.1.f=2"});
  const Case by_name = parse(sample_text, {"load." + by_index.spec.load_cases(1).name() + ".f=2"});
  EXPECT_EQ(by_name.spec.SerializeAsString(), by_index.spec.SerializeAsString());
}

TEST(Overrides, NameThemselvesInErrors) {
  EXPECT_EQ(complaint(sample_text, {"solver.thta=1"}),
            "--set solver.thta=1: solver.thta: unknown key; did you mean theta?");
  EXPECT_EQ(complaint(sample_text, {"solver.epsilon=small"}),
            "--set solver.epsilon=small: solver.epsilon: 'small' is not a finite number; write a "
            "number without quotes");
}

TEST(Overrides, RefuseKeysThatLeadNowhere) {
  EXPECT_EQ(complaint(sample_text, {"load.5.f=1"}),
            "--set load.5.f=1: load.5: there is no entry 5; write an index from 0 to 2, or a name");
  EXPECT_EQ(complaint(sample_text, {"load.first.f=1"}),
            "--set load.first.f=1: load.first: none of them is called first; known are one, "
            "two");
  EXPECT_EQ(complaint(sample_text, {"solver.theta.x=1"}),
            "--set solver.theta.x=1: solver.theta.x: nothing lies below a plain value; set the key "
            "above it");
  EXPECT_EQ(complaint(sample_text, {"solver.theta"}),
            "--set solver.theta: no assignment; write --set key=value");
  EXPECT_EQ(complaint(sample_text, {"=1"}), "--set =1: no assignment; write --set key=value");
  EXPECT_EQ(complaint(sample_text, {"solver..theta=1"}),
            "--set solver..theta=1: a part of the key is empty; write for example solver.theta=2");
}

TEST(Overrides, RefuseWhatNoCaseFileCouldHold) {
  for (const std::string& bytes :
       {std::string("\x9c\x8d"), std::string("a\x7f"), std::string("\x03"), std::string("a\0b", 3),
        std::string("cut \xe2\x82")}) {
    const std::string refusal =
        "--set: it holds control characters or bytes that are not UTF-8; write plain text";
    EXPECT_EQ(complaint(sample_text, {"title=" + bytes}), refusal);
    EXPECT_EQ(complaint(sample_text, {"load.0.inclusion_forces." + bytes + "=1"}), refusal);
  }
  const std::string text = "\"quoted\", back\\slash,\ttab, \xc3\xa9";
  EXPECT_EQ(parse(sample_text, {"title=" + text}).spec.title(), text);
}

TEST(Overrides, KeepSomeLoads) {
  const Case all = parse_case(sample_text, "case.toml");
  ASSERT_EQ(all.spec.load_cases_size(), 2);
  const std::string second = all.spec.load_cases(1).name();
  const Case one = parse_case(sample_text, "case.toml", {}, Loads::needed, {second});
  ASSERT_EQ(one.spec.load_cases_size(), 1);
  EXPECT_EQ(one.spec.load_cases(0).DebugString(), all.spec.load_cases(1).DebugString());
  const Case again = parse_case(one.text, "case.toml");
  EXPECT_EQ(again.spec.DebugString(), one.spec.DebugString()) << "the text is that of what is run";
  try {
    parse_case(sample_text, "case.toml", {}, Loads::needed, {second + "s"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean " + second));
  }
}

}  // namespace
}  // namespace anticrack::casefile

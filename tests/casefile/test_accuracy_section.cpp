// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "casefile/sample_case.hpp"

namespace anticrack::casefile {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// `sample_text` by the active set, then [accuracy] in line 19 with these lines.
std::string sample_to(const std::string& lines) {
  return sample_with("theta = 1.5\nmethod = \"uzawa\"\n", "") + "[accuracy]\n" + lines;
}

TEST(AccuracySection, BecomesTheTaskOfTheJob) {
  EXPECT_FALSE(parse(sample_text).spec.has_accuracy());
  const Case the_case = parse(sample_to(R"(energy = 1e-3
A = 0.01
A_estimated = 1e-4
max_triangles = 200000
time = "10min"
keep_stages = true
largest = true
)"));
  const v1::Accuracy& accuracy = the_case.spec.accuracy();
  EXPECT_EQ(accuracy.energy(), 1e-3);
  EXPECT_EQ(accuracy.displacement(), 0.01);
  EXPECT_EQ(accuracy.displacement_estimated(), 1e-4);
  EXPECT_EQ(accuracy.max_triangles(), 200000U);
  EXPECT_EQ(accuracy.time().seconds(), 600);
  EXPECT_TRUE(accuracy.keep_stages());
  EXPECT_TRUE(accuracy.largest());
  EXPECT_THAT(the_case.spec.outputs(), ElementsAre(v1::OUTPUT_INDICATORS));
  EXPECT_EQ(locate(the_case, "spec.accuracy.energy")->line, 20U);
  EXPECT_EQ(locate(the_case, "spec.accuracy.displacement")->line, 21U);
}

/// Chords of a tenth of what is asked for, unless the case has no curve or an angle of its own.
TEST(AccuracySection, ShortensChordsOfCurves) {
  const auto angle = [](const std::string& lines) {
    return parse(sample_to(lines)).mesh.options().chord_angle();
  };
  const std::string hole = "[[geometry.hole]]\ncircle = { center = [0, 0.5], radius = 0.1 }\n";
  EXPECT_EQ(angle("A = 1e-5\n"), 0);
  EXPECT_EQ(angle("A = 1e-2\n" + hole), 5);
  EXPECT_NEAR(angle("A = 1e-2\nenergy = 1.25e-4\n" + hole), 2.5, 1e-12);
  EXPECT_NEAR(angle("A_estimated = 1e-6\n" + hole), 0.5, 1e-12);
  EXPECT_EQ(angle("A = 1e-6\n" + hole + "[mesh]\nchord_angle = 4\n"), 4);
}

TEST(OutputSection, HasIndicatorsBesideFieldsThatAreBounded) {
  const std::string output = "[output]\nfields = true\n";
  EXPECT_THAT(parse(sample_text + output).spec.outputs(), ElementsAre(v1::OUTPUT_FIELDS));
  EXPECT_THAT(parse(sample_to("A = 1e-3\n" + output)).spec.outputs(),
              ElementsAre(v1::OUTPUT_FIELDS, v1::OUTPUT_INDICATORS));
  EXPECT_THAT(parse(sample_with("theta = 1.5\nmethod = \"uzawa\"\n", "") + output).spec.outputs(),
              ElementsAre(v1::OUTPUT_FIELDS, v1::OUTPUT_INDICATORS));
}

TEST(OutputSection, LeavesBoundsOut) {
  const std::string exact = sample_with("theta = 1.5\nmethod = \"uzawa\"\n", "");
  const v1::JobSpec job = parse(exact + "[output]\nfields = true\nbounds = false\n").spec;
  EXPECT_TRUE(job.without_bounds());
  EXPECT_THAT(job.outputs(), ElementsAre(v1::OUTPUT_FIELDS));
  EXPECT_FALSE(parse(exact + "[output]\nbounds = true\n").spec.without_bounds());
}

TEST(AccuracySection, NamesWhatIsWrong) {
  const auto complaint_of = [](const std::string& line) { return complaint(sample_to(line)); };
  for (const char* key : {"energy", "A"}) {
    for (const char* bad : {"nan", "'small'", "true"})
      EXPECT_THAT(complaint_of(std::string(key) + " = " + bad + "\n"),
                  HasSubstr("is not a finite number"));
  }
  for (const char* bad : {"0", "1.5", "-3", "'all'"})
    EXPECT_THAT(complaint_of(std::string("energy = 1e-3\nmax_triangles = ") + bad + "\n"),
                HasSubstr("plate.toml:21: accuracy.max_triangles: "));
  for (const char* bad : {"0", "-3", "'soon'", "true"})
    EXPECT_THAT(complaint_of(std::string("energy = 1e-3\ntime = ") + bad + "\n"),
                HasSubstr("plate.toml:21: accuracy.time: "));
  EXPECT_THAT(complaint_of("energy = 1e-3\nkeep_stages = 1\n"),
              HasSubstr("accuracy.keep_stages: 1 is neither true nor false"));
  EXPECT_THAT(complaint_of("enrgy = 1e-3\n"), HasSubstr("did you mean energy?"));
}

TEST(AccuracySection, BeginsOnACoarseMeshUnlessThatIsChosen) {
  const auto preset = [](const std::string& text, const std::vector<std::string>& overrides = {}) {
    return parse(text, overrides).mesh.options().preset();
  };
  const std::string text = sample_to("A = 1e-3\n");
  EXPECT_EQ(preset(sample_text), v1::MESH_PRESET_GRADED);
  EXPECT_EQ(preset(text), v1::MESH_PRESET_COARSE);
  EXPECT_EQ(preset(text, {"mesh.size=0.5"}), v1::MESH_PRESET_COARSE);
  EXPECT_EQ(preset(text, {"mesh.preset=uniform"}), v1::MESH_PRESET_UNIFORM);
  EXPECT_EQ(preset(sample_text, {"mesh.preset=coarse"}), v1::MESH_PRESET_COARSE);
  EXPECT_EQ(preset(text.substr(text.find("[[load]]")), {"mesh.file=a.msh"}),
            v1::MESH_PRESET_GRADED);
}

}  // namespace
}  // namespace anticrack::casefile

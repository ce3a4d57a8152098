// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/case_file.hpp"

namespace anticrack::casefile {
namespace {

const std::string folder = ANTICRACK_EXAMPLES;

TEST(Examples, PaperHasItsFourLoadsAndParameters) {
  const Case the_case = testing::read_case_file(folder + "/paper.toml");
  ASSERT_EQ(the_case.spec.load_cases_size(), 4);
  EXPECT_EQ(the_case.mesh.options().preset(), v1::MESH_PRESET_PAPER);
  ASSERT_TRUE(the_case.spec.solver().has_uzawa());
  const v1::Uzawa& uzawa = the_case.spec.solver().uzawa();
  EXPECT_EQ(uzawa.theta(), 2);
  EXPECT_EQ(uzawa.epsilon(), 1e-12);
  EXPECT_EQ(uzawa.p(), 1e5);
}

TEST(Examples, EachOfTheFourIsOneLoadOfThePaperOnTheSameMesh) {
  const Case all = testing::read_case_file(folder + "/paper.toml");
  for (int i = 0; i < 4; ++i) {
    const Case one = testing::read_case_file(folder + "/paper-" + std::to_string(i + 1) + ".toml");
    ASSERT_EQ(one.spec.load_cases_size(), 1);
    EXPECT_EQ(one.spec.load_cases(0).SerializeAsString(),
              all.spec.load_cases(i).SerializeAsString());
    EXPECT_EQ(one.spec.load_cases(0).name(), "example-" + std::to_string(i + 1));
    EXPECT_EQ(one.mesh.geometry().SerializeAsString(), all.mesh.geometry().SerializeAsString());
    EXPECT_EQ(one.spec.solver().SerializeAsString(), all.spec.solver().SerializeAsString());
  }
}

TEST(Examples, OfOtherGeometriesUseTheDefaults) {
  for (const char* name :
       {"several-inclusions", "slit", "arc", "floating", "partly-delaminated", "shear", "tilt"}) {
    const Case the_case = testing::read_case_file(folder + "/" + name + ".toml");
    EXPECT_EQ(the_case.mesh.options().preset(), v1::MESH_PRESET_GRADED) << name;
    EXPECT_TRUE(the_case.spec.solver().has_active_set()) << name;
    EXPECT_GE(the_case.spec.load_cases_size(), 2) << name;
    EXPECT_GE(the_case.mesh.geometry().interfaces_size(), 1) << name;
  }
}

TEST(Examples, OfAMeshFileNameOneThatIsThere) {
  for (const char* name : {"plate", "section-6"}) {
    const Case the_case = testing::read_case_file(folder + "/" + name + ".toml");
    ASSERT_TRUE(the_case.mesh_file.has_value()) << name;
    EXPECT_TRUE(std::filesystem::exists(folder + "/" + *the_case.mesh_file)) << *the_case.mesh_file;
    EXPECT_FALSE(the_case.mesh.has_geometry()) << name;
  }
}

}  // namespace
}  // namespace anticrack::casefile

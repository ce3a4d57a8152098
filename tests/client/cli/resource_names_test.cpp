// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/resource_names.hpp"

#include <gtest/gtest.h>

#include "cli/report.hpp"

namespace anticrack::cli {
namespace {

std::string complaint(const Collection& collection, const std::string& given) {
  try {
    return "accepted as " + full_name(collection, given);
  } catch (const UsageError& error) {
    return error.what();
  }
}

TEST(FullName, TakesAnIdWithOrWithoutItsCollection) {
  EXPECT_EQ(full_name(Collection::jobs, "a1"), "jobs/a1");
  EXPECT_EQ(full_name(Collection::jobs, "jobs/a1"), "jobs/a1");
  EXPECT_EQ(full_name(Collection::meshes, "meshes/B-_2"), "meshes/B-_2");
}

TEST(FullName, RefusesWhatIsNoNameWithTheCure) {
  EXPECT_EQ(complaint(Collection::meshes, "jobs/a1"),
            "jobs/a1 is a job; name a mesh; see anticrack mesh list");
  EXPECT_EQ(complaint(Collection::jobs, "meshes/a1"),
            "meshes/a1 is a mesh; name a job; see anticrack job list");
  for (const char* given : {"", "jobs/", "a b", "a/b", "jobs/a/b", "case.toml"}) {
    EXPECT_EQ(complaint(Collection::jobs, given),
              "\"" + std::string(given) +
                  "\" is not a name of a job; write jobs/ID; see anticrack job list");
  }
}

TEST(NameCure, IsTheNameThatBeginsSoOrTheNearest) {
  const std::vector<std::string> known{"jobs/0123456789abcdef", "jobs/01ff456789abcdee"};
  const auto cure = [&](const std::string& name) {
    return name_cure(Collection::jobs, name, known);
  };
  EXPECT_EQ(cure("jobs/012"), "; did you mean jobs/0123456789abcdef?");
  EXPECT_EQ(cure("jobs/0123456789abcdfe"), "; did you mean jobs/0123456789abcdef?");
  EXPECT_EQ(cure("jobs/01"), "; see anticrack job list");  // both begin so
  EXPECT_EQ(cure("jobs/zz"), "; see anticrack job list");
  EXPECT_EQ(name_cure(Collection::meshes, "meshes/1", {}), "; see anticrack mesh list");
}

}  // namespace
}  // namespace anticrack::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "casefile/sample_case.hpp"

namespace anticrack::casefile {
namespace {

using ::testing::HasSubstr;

/// `sample_text` by the active set, then these lines, from line 19 on.
std::string grown(const std::string& lines) {
  return sample_with("theta = 1.5\nmethod = \"uzawa\"\n", "") + lines;
}

const std::string path =
    "[[growth.path]]\ninterface = \"fibre\"\nfrom = [-0.5, 0]\nto = [0, 0]\nGc = \"1 + x^2\"\n";

TEST(GrowthSection, IsReadWithThePlacesOfItsPaths) {
  const Case the_case = parse(
      grown("[growth]\ninclusion = \"fibre\"\npositions = 50\ndead = \"weight\"\nmembranes = 7\n" +
            path));
  const v1::Growth& growth = the_case.spec.growth();
  ASSERT_EQ(growth.paths_size(), 1);
  EXPECT_EQ(growth.paths(0).interface(), "fibre");
  EXPECT_EQ(growth.paths(0).from().x(), -0.5);
  EXPECT_EQ(growth.paths(0).to().x(), 0);
  EXPECT_EQ(growth.paths(0).toughness(), "1 + x^2");
  EXPECT_EQ(growth.inclusion(), "fibre");
  EXPECT_EQ(growth.positions(), 50);
  EXPECT_EQ(growth.dead(), "weight");
  EXPECT_EQ(growth.membranes(), 7);
  EXPECT_EQ(locate(the_case, "growth.paths[0].toughness")->line, 28U);
  EXPECT_EQ(locate(the_case, "growth.inclusion")->line, 20U);
  EXPECT_FALSE(parse(sample_text).spec.has_growth());
}

TEST(GrowthSection, NamesWhatIsWrong) {
  EXPECT_THAT(complaint(grown("[growth]\npositions = 50\n")), HasSubstr("growth.path"));
  EXPECT_THAT(complaint(grown(path + "[accuracy]\nenergy = 0.1\n")),
              HasSubstr("plate.toml:24: accuracy"));
  for (const std::string key : {"interface", "from", "to", "Gc"}) {
    std::string text = path;
    text.replace(text.find(key + " ="), 0, "# ");
    EXPECT_THAT(complaint(grown(text)), HasSubstr("growth.path.0." + key)) << key;
  }
}

}  // namespace
}  // namespace anticrack::casefile

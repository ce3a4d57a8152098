// SPDX-License-Identifier: GPL-3.0-or-later
//
// tests/client/cli/wrong_cases.py has the other mistakes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "casefile/sample_case.hpp"

namespace anticrack::casefile {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(CaseErrors, SyntaxNamesTheLine) {
  EXPECT_THAT(complaint("title = \"A\"\n[geometry\n"),
              AllOf(StartsWith("plate.toml:2: column 10: this is not TOML: "),
                    EndsWith("; the line is: [geometry")));
  const std::string cure =
      "; a value is a number as 3.5, true, false, a text in quotes or a list; units are named in "
      "[units]; the line is: ";
  for (const std::string line :
       {"length = 100 mm", "length = 3,5", "tilt = True", "side = right", "length ="})
    EXPECT_THAT(complaint("title = \"A\"\n" + line + "\n"), EndsWith(cure + line));
  for (const std::string line : {"[geometry", "leng th = 3", "title = \"B\""})
    EXPECT_THAT(complaint("title = \"A\"\n" + line + "\n"), Not(HasSubstr("a value is")));
  EXPECT_EQ(complaint(std::string("title\0", 6)),
            "plate.toml: this is not text; name a case, a TOML file");
}

TEST(Complaint, OfAKeyOfManyParts) {
  std::string plain = "a", quoted = "a";
  for (int i = 0; i < 200'000; ++i) plain += ".a";
  for (int i = 0; i < 40; ++i) quoted += ".\"=,[]#\\\"\"";
  const std::string problem =
      ": a key of more than 32 parts; shorten it: known keys have at most 5";
  for (const std::string& key : {plain, quoted}) {
    for (const std::string& text :
         {key + " = 1\n", "[" + key + "]\n", "x = { " + key + " = 1 }\n"}) {
      EXPECT_EQ(complaint("title = \"long\"\n" + text), "plate.toml:2" + problem);
    }
    EXPECT_EQ(complaint("x = { a = \"\"\"\nit's \\\n\"\"\"\"\", " + key + " = 1 }\n"),
              "plate.toml:3" + problem);
    EXPECT_EQ(complaint("title = \"open \\\n" + key + " = 1\n"), "plate.toml:2" + problem);
    EXPECT_NE(complaint("", {"load={ " + key + " = 1 }"}), "");
  }
  EXPECT_EQ(complaint("", {plain + "=1"}), "--set" + problem);  // knows no quotes
  const std::string dots(1500, '.');
  EXPECT_EQ(complaint("# " + dots + "\ntitle = \"" + dots + "\"\n").find("parts"),
            std::string::npos);
  EXPECT_EQ(complaint("", {"title=" + dots}).find("parts"), std::string::npos);
}

TEST(Complaint, OfTheDeepestNestingThatIsParsed) {
  std::string key = "a";
  for (int i = 1; i < 32; ++i) key += ".a";
  std::string text = key + " = ";
  for (int i = 0; i < 250; ++i) text += "{ " + key + " = ";
  text += "1";
  for (int i = 0; i < 250; ++i) text += " }";
  EXPECT_NE(complaint(text + "\n"), "");
}

}  // namespace
}  // namespace anticrack::casefile

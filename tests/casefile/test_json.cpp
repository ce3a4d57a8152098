// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "casefile/sample_case.hpp"

namespace anticrack::casefile {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

Case parse_json(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_case(text, "plate.json", overrides, Loads::needed, {}, Language::json);
}

std::string json_complaint(const std::string& text) {
  try {
    parse_json(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// sample_text, in JSON.
const std::string sample_json = R"({"title": "A plate", "geometry":
  {"boundary": [[-1, -1], [1, -1], [1, 1], [-1, 1]], "interface": [[-1, 0], [1, 0]],
   "inclusion": [{"name": "fibre", "from": [-0.5, 0], "to": [0.5, 0]}]},
  "solver": {"theta": 1.5, "method": "uzawa"},
  "load": [{"name": "one", "f": 1}, {"name": "two", "f": "y > 0 ? 1 : -1"}]})";

std::string with(const std::string& from, const std::string& to) {
  std::string text = sample_json;
  return text.replace(text.find(from), from.size(), to);
}

TEST(JsonCase, IsTheCaseOfTheSameTables) {
  const Case json = parse_json(sample_json), toml = parse(sample_text);
  EXPECT_EQ(json.mesh.SerializeAsString(), toml.mesh.SerializeAsString());
  EXPECT_EQ(json.spec.SerializeAsString(), toml.spec.SerializeAsString());
  EXPECT_EQ(locate(json, "spec.load_cases[1].force")->key, "load.two.f");
}

TEST(JsonCase, IsKeptAsToml) {
  const Case json = parse_json(sample_json, {"load.one.f=2"});
  const Case kept = parse(json.text);
  EXPECT_EQ(kept.spec.SerializeAsString(), json.spec.SerializeAsString());
  EXPECT_EQ(kept.spec.load_cases(0).force().constant(), 2);
}

TEST(JsonCase, HasTheMistakesOfToml) {
  EXPECT_EQ(json_complaint(with("\"theta\"", "\"thetta\"")),
            "solver.thetta: unknown key; did you mean theta?");
  EXPECT_THAT(json_complaint(with("[0.5, 0]", "[0.5]")),
              StartsWith("geometry.inclusion.fibre.to: [ 0.5 ] is not a point"));
  EXPECT_THAT(json_complaint("{}"), HasSubstr("geometry: missing"));
}

TEST(JsonCase, WholeNumbersAreCountsAndOthersAreNot) {
  const std::string steps = "\"method\": \"uzawa\", \"max_iterations\": ";
  EXPECT_EQ(
      parse_json(with("\"method\": \"uzawa\"", steps + "7")).spec.solver().uzawa().max_iterations(),
      7);
  for (const char* other : {"7.0", "7e0", "-7", "18446744073709551615", "9223372036854775808",
                            "\"7\"", "true", "[7]", "{}"})
    EXPECT_THAT(json_complaint(with("\"method\": \"uzawa\"", steps + other)), HasSubstr("max_iter"))
        << other;
}

TEST(JsonCase, OtherTextsAreRefused) {
  for (const char* text : {"", "{", "[]", "1", "null", "\"a\"", "{\"a\": 1,}", "{\"a\": NaN}",
                           "{\"a\": 1e400}", "title = 'toml'", "{\"title\": \"\xff\"}", "{}{}"})
    EXPECT_THAT(json_complaint(text), StartsWith("plate.json: this is no")) << text;
  EXPECT_EQ(json_complaint(with("1.5", "null")),
            "plate.json: solver.theta: null is not possible; leave the key out");
}

TEST(JsonCase, DepthIsBounded) {
  const auto nested = [](std::size_t depth, const char* open, const char* close) {
    std::string text = "{\"title\": ";
    for (std::size_t i = 0; i < depth; ++i) text += open;
    text += "1";
    for (std::size_t i = 0; i < depth; ++i) text += close;
    return text + "}";
  };
  for (const std::size_t depth : {20U, 1'000U, 200'000U}) {
    EXPECT_THAT(json_complaint(nested(depth, "[", "]")),
                HasSubstr("no key of a case lies so deep"));
    EXPECT_THAT(json_complaint(nested(depth, "{\"a\":", "}")),
                HasSubstr("no key of a case lies so deep"));
  }
}

}  // namespace
}  // namespace anticrack::casefile

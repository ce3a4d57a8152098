// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/read_case.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "casefile/sample_case.hpp"
#include "errors/errors.hpp"
#include "support/errors.hpp"

namespace anticrack::casefile {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

v1::ReadCaseRequest asked(const std::string& toml) {
  v1::ReadCaseRequest request;
  request.set_toml(toml);
  request.set_source("plate.toml");
  return request;
}

std::optional<errors::Error> refusal(const v1::ReadCaseRequest& request,
                                     const Limits& limits = {}) {
  return anticrack::testing::error_of([&] { read_case(request, limits); });
}

TEST(ReadCase, GivesTheRequestsAndThePlacesOfTheirFields) {
  const v1::ReadCaseResponse read = read_case(asked(sample_text), {});
  const Case parsed = parse(sample_text);
  EXPECT_EQ(read.mesh().SerializeAsString(), parsed.mesh.SerializeAsString());
  EXPECT_EQ(read.spec().SerializeAsString(), parsed.spec.SerializeAsString());
  EXPECT_EQ(read.toml(), "") << "it is as it was sent";
  const v1::CasePlace& place = read.places().at("load_cases[1].force");
  EXPECT_EQ(place.where(), "plate.toml:20");
  EXPECT_EQ(place.key(), "load.two.f");
}

TEST(ReadCase, OfACaseWithoutANameTellsTheLine) {
  v1::ReadCaseRequest request = asked(sample_with("theta", "thetta"));
  request.clear_source();
  EXPECT_STREQ(refusal(request)->what(),
               "line 13: solver.thetta: unknown key; did you mean theta?");
}

TEST(ReadCase, NamesWhatTheClientUploads) {
  v1::ReadCaseRequest request = asked(
      "mesh.file = \"sub/x.msh\"\n[[load]]\nname = \"a\"\nf = 1\n[[load]]\nname = \"b\"\n"
      "f = {file = \"f.h5\", dataset = \"/f\", per = \"node\"}\n");
  request.add_overrides("load.a.f=2");
  const v1::ReadCaseResponse read = read_case(request, {});
  EXPECT_EQ(read.mesh_file(), "sub/x.msh");
  ASSERT_THAT(read.arrays(), SizeIs(1));
  EXPECT_EQ(read.arrays(0).load_case(), 1);
  EXPECT_EQ(read.arrays(0).file(), "f.h5");
  EXPECT_EQ(read.arrays(0).dataset(), "/f");
  EXPECT_EQ(read.places().at("load_cases[0].force").where(), "--set load.a.f=2");
  EXPECT_THAT(read.toml(), HasSubstr("f = 2"));
}

TEST(ReadCase, OfAMeshFileAloneHasNoLoads) {
  v1::ReadCaseRequest request;
  request.set_msh("a/x.msh");
  request.add_overrides("mesh.groups.curve.7=glue");
  const v1::ReadCaseResponse read = read_case(request, {});
  EXPECT_EQ(read.mesh_file(), "a/x.msh");
  EXPECT_EQ(read.mesh().options().curve_groups().at(7), "glue");
  EXPECT_EQ(read.places().at("upload").where(), "a/x.msh");
}

TEST(ReadCase, RefusesWithTheKeyAsTheField) {
  const auto error = refusal(asked(sample_with("theta", "thetta")));
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), errors::Reason::case_invalid);
  EXPECT_STREQ(error->what(), "plate.toml:13: solver.thetta: unknown key; did you mean theta?");
  ASSERT_THAT(error->fields(), SizeIs(1));
  EXPECT_EQ(error->fields()[0].field, "solver.thetta");
}

TEST(ReadCase, ErrorsOfJsonNameTheSourceToo) {
  v1::ReadCaseRequest request = asked("");
  request.set_json("{\"titel\": 1}");
  EXPECT_STREQ(refusal(request)->what(), "plate.toml: titel: unknown key; did you mean title?");
  request.clear_source();
  EXPECT_STREQ(refusal(request)->what(), "titel: unknown key; did you mean title?");
}

TEST(ReadCase, IsBounded) {
  EXPECT_EQ(refusal({})->reason(), errors::Reason::invalid_argument);
  v1::ReadCaseRequest request = asked(sample_text);
  for (int i = 0; i < 201; ++i) request.add_overrides("title=a");
  EXPECT_EQ(refusal(request)->reason(), errors::Reason::limit_exceeded);
  EXPECT_THAT(refusal(asked(sample_text), {.load_cases = 1})->what(), HasSubstr("2 loads"));
  EXPECT_EQ(refusal(asked(sample_text), {.request_bytes = 100})->reason(),
            errors::Reason::limit_exceeded);
}

TEST(ReadCase, OfManyPointsTellsThePlacesOfTheirLists) {
  constexpr int count = 30'000;
  std::string points = "[[-1, -1], [1, -1]";
  for (int i = 0; i < count; ++i) points += ", [" + std::to_string(1 - 2.0 * i / count) + ", 1]";
  const v1::ReadCaseResponse read =
      read_case(asked(sample_with("[[-1, -1], [1, -1], [1, 1], [-1, 1]", points)), {});
  EXPECT_EQ(read.mesh().geometry().boundary_size(), count + 2);
  EXPECT_LT(read.places_size(), 100);
  EXPECT_EQ(read.places().at("geometry.boundary").where(), "plate.toml:4");
}

}  // namespace
}  // namespace anticrack::casefile

// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <cmath>

#include "errors/errors.hpp"
#include "mesh/refine.hpp"
#include "mesh/refinement_mesh.hpp"
#include "support/errors.hpp"

namespace anticrack::mesh {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::paper;
using testing::plenty;
using testing::structured_mesh;

errors::Error refusal(const Mesh& base, const Grading& grading, std::size_t limit = plenty) {
  const auto error = testing::error_of([&] { grade(base, grading, limit); });
  EXPECT_TRUE(error) << "not refused";
  return error.value_or(errors::Error(errors::Reason::internal, ""));
}

TEST(Grade, KeepsToTheLimitAndSaysWhatToChange) {
  const Mesh base = structured_mesh(16, 16, paper);
  const std::size_t needed = grade(base, {.h0 = 0.1}, plenty).triangle_count();
  EXPECT_EQ(grade(base, {.h0 = 0.1}, needed).triangle_count(), needed);
  for (const std::size_t limit : {needed - 1, std::size_t{600}, std::size_t{100}}) {
    const errors::Error error = refusal(base, {.h0 = 0.1}, limit);
    EXPECT_EQ(error.reason(), errors::Reason::limit_exceeded);
    EXPECT_THAT(error.what(), AllOf(HasSubstr(std::to_string(limit)), HasSubstr("h0 = 0.1"),
                                    HasSubstr("m = 0.2"), HasSubstr("raise h0")));
    ASSERT_EQ(error.fields().size(), 1U);
    EXPECT_EQ(error.fields()[0].field, "h0");
  }
}

TEST(Grade, RefusesABaseBeyondTheLimitThoughItIsFineEnough) {
  const Mesh base = structured_mesh(16, 16, paper);
  EXPECT_EQ(refusal(base, {.h0 = 1, .m = 1}, 511).reason(), errors::Reason::limit_exceeded);
}

TEST(Grade, RefusesNumbersThatAreNoSizes) {
  const Mesh base = structured_mesh(16, 16, paper);
  const double nan = std::nan("");
  const struct {
    Grading grading;
    const char* field;
  } cases[] = {{{.h0 = 0}, "h0"},
               {{.h0 = -0.1}, "h0"},
               {{.h0 = nan}, "h0"},
               {{.h0 = INFINITY}, "h0"},
               {{.h0 = 1e-14}, "h0"},
               {{.h0 = 0.1, .m = 0}, "m"},
               {{.h0 = 0.1, .m = 1.5}, "m"},
               {{.h0 = 0.1, .m = nan}, "m"},
               {{.h0 = 0.1, .tip_size = -1}, "tip_size"},
               {{.h0 = 0.1, .tip_size = nan}, "tip_size"},
               {{.h0 = 0.1, .tip_size = 1e-14}, "tip_size"}};
  for (const auto& [grading, field] : cases) {
    const errors::Error error = refusal(base, grading);
    EXPECT_EQ(error.reason(), errors::Reason::invalid_argument) << error.what();
    ASSERT_EQ(error.fields().size(), 1U);
    EXPECT_EQ(error.fields()[0].field, field) << error.what();
  }
}

TEST(Grade, RefusesAnEdgeOfThreeTriangles) {
  Mesh base = structured_mesh(4, 4, {});
  base.triangles.insert(base.triangles.end(), {0, 1, 7});
  base.subdomain.push_back(0);
  EXPECT_EQ(refusal(base, {.h0 = 0.1}).reason(), errors::Reason::mesh_invalid);
}

}  // namespace
}  // namespace anticrack::mesh

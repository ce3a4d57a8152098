// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/mesh_figure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "figures/mesh_layers.hpp"
#include "support/sample_mesh_plan.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::figures {
namespace {

using anticrack::testing::sample_mesh_plan;
using anticrack::testing::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::string file_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

double length_of(const std::vector<Stretch>& stretches) {
  double sum = 0;
  for (const Stretch& stretch : stretches) {
    for (std::size_t i = 1; i < stretch.size(); ++i) {
      sum += std::hypot(stretch[i].x - stretch[i - 1].x, stretch[i].y - stretch[i - 1].y);
    }
  }
  return sum;
}

TEST(MeshLayers, sort_everything_by_what_it_is) {
  const results::MeshPlan plan = sample_mesh_plan(10);
  const MeshLayers seen = layers(plan, whole(plan.mesh));
  EXPECT_EQ(seen.triangle_count, 800u);
  EXPECT_EQ(seen.triangles[0].size(), 400u);
  EXPECT_NEAR(length_of(seen.interfaces[1]), 0.9, 1e-12);  // glue
  EXPECT_NEAR(length_of(seen.interfaces[2]), 0.3, 1e-12);  // crack
  EXPECT_NEAR(length_of(seen.interfaces[3]), 0.4, 1e-12);  // bonded
  EXPECT_NEAR(length_of(seen.interfaces[4]), 0.4, 1e-12);  // delaminated
  EXPECT_NEAR(length_of(seen.interfaces[5]), 0.5, 1e-12);  // free crack
  EXPECT_NEAR(length_of(seen.dirichlet), 6, 1e-12);
  EXPECT_NEAR(length_of(seen.neumann), 2, 1e-12);
  EXPECT_EQ(seen.tips.size(), 6u);
}

TEST(MeshLayers, point_into_the_plus_side) {
  const results::MeshPlan plan = sample_mesh_plan(10);
  const MeshLayers seen = layers(plan, whole(plan.mesh));
  ASSERT_EQ(seen.plus_sides.size(), 2u);
  EXPECT_EQ(seen.plus_sides[0].name, "sigma +");  // walked to the right: its left is above
  EXPECT_DOUBLE_EQ(seen.plus_sides[0].from.y, 0);
  EXPECT_GT(seen.plus_sides[0].to.y, 0.05);
  EXPECT_DOUBLE_EQ(seen.plus_sides[0].to.x, seen.plus_sides[0].from.x);
  EXPECT_LT(seen.plus_sides[1].to.x, -0.05);  // walked upwards: its left is where x is smaller
}

TEST(MeshLayers, name_inclusions_on_the_minus_side) {
  const results::MeshPlan plan = sample_mesh_plan(10);
  const MeshLayers seen = layers(plan, whole(plan.mesh));
  ASSERT_EQ(seen.inclusions.size(), 1u);
  EXPECT_EQ(seen.inclusions[0].name, "fibre");
  EXPECT_NEAR(seen.inclusions[0].from.x, 0.1, 1e-12);  // from -0.3 to 0.5
  EXPECT_LT(seen.inclusions[0].to.y, -0.05);
}

TEST(MeshLayers, name_an_inclusion_that_is_its_interface_once) {
  results::MeshPlan plan = sample_mesh_plan(10);
  plan.interfaces[0].name = "fibre";
  const MeshLayers seen = layers(plan, whole(plan.mesh));
  EXPECT_EQ(seen.plus_sides[0].name, "fibre +");
  EXPECT_THAT(seen.inclusions, IsEmpty());
  EXPECT_EQ(layers(plan, whole(plan.mesh), Named::inclusions).inclusions.size(), 1u);
}

TEST(MeshLayers, let_no_name_cover_another) {
  results::MeshPlan plan = sample_mesh_plan(10);
  const results::InterfaceLine line = plan.interfaces[0];
  for (int i = 0; i < 9; ++i) plan.interfaces.push_back(line);
  const Window window = whole(plan.mesh);
  const std::vector<Pointer> seen = layers(plan, window).plus_sides;
  EXPECT_GT(seen.size(), 3u);
  EXPECT_LT(seen.size(), 11u);  // there is no room for all
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Window box = name_box(seen[i].name, seen[i].to, window);
    for (std::size_t j = i + 1; j < seen.size(); ++j)
      EXPECT_TRUE(std::abs(seen[i].to.x - seen[j].to.x) > box.width() ||
                  std::abs(seen[i].to.y - seen[j].to.y) > box.height())
          << i << " " << j;
  }
}

TEST(MeshLayers, mark_where_s_begins) {
  results::MeshPlan plan = sample_mesh_plan(10);
  std::ranges::reverse(plan.interfaces[0].nodes);  // the server turned it
  const MeshLayers seen = layers(plan, whole(plan.mesh));
  ASSERT_EQ(seen.starts.size(), 2u);
  EXPECT_DOUBLE_EQ(seen.starts[0].x, 1);
  EXPECT_DOUBLE_EQ(seen.starts[0].y, 0);
}

TEST(MeshLayers, name_subdomains_inside_them) {
  const results::MeshPlan plan = sample_mesh_plan(10);
  const MeshLayers seen = layers(plan, whole(plan.mesh));
  ASSERT_EQ(seen.subdomain_names.size(), 2u);
  EXPECT_EQ(seen.subdomain_names[0].second, "lower");
  EXPECT_LT(seen.subdomain_names[0].first.y, -0.2);
  EXPECT_GT(seen.subdomain_names[1].first.y, 0.2);
}

TEST(MeshLayers, leave_out_what_cannot_be_seen) {
  const results::MeshPlan plan = sample_mesh_plan(10, 8);
  const Window everything = whole(plan.mesh);
  EXPECT_LT(layers(plan, everything).triangle_count, 800u);
  Window near;
  results::Tip tip;
  ASSERT_TRUE(finest_tip(plan, near, tip));
  EXPECT_EQ(tip.x, 0.5);
  EXPECT_LT(near.width(), 0.06 * everything.width());
  const MeshLayers detail = layers(plan, near);
  EXPECT_FALSE(detail.tips.empty());
  for (const auto& triangle : detail.triangles[1]) {
    EXPECT_GT(triangle[0].y + triangle[1].y + triangle[2].y, 0);
  }
}

TEST(MeshLayers, of_a_uniform_mesh_have_no_finest_tip) {
  Window near;
  results::Tip tip;
  EXPECT_FALSE(finest_tip(sample_mesh_plan(10), near, tip));
  EXPECT_FALSE(finest_tip({}, near, tip));
}

TEST(MeshFigure, is_drawn_with_its_legend_and_the_finest_tip) {
  const TemporaryFolder folder;
  const Drawn drawn = draw_mesh(sample_mesh_plan(20, 4), "meshes/0123", folder / "new");
  EXPECT_THAT(drawn.notes, IsEmpty());
  EXPECT_THAT(drawn.files,
              ElementsAre(folder / "new/meshes_0123.png", folder / "new/meshes_0123.svg"));
  EXPECT_GT(std::filesystem::file_size(drawn.files[0]), 20000u);
  const std::string svg = file_bytes(drawn.files[1]);
  for (const char* text :
       {"A made-up mesh", "1681 nodes", "at the tip (0.5, 0)", "sigma +", "slit +", "upper", "glue",
        "free or traction", "bonded inclusion", "free crack", ">fibre<", "x", "y"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
}

TEST(MeshFigure, of_a_uniform_mesh_is_one_panel) {
  std::vector<std::string> notes;
  results::MeshPlan plan = sample_mesh_plan(10);
  plan.free = true;
  const std::string text = script(mesh_picture(plan, notes), {{Format::png, "a.png"}});
  EXPECT_THAT(text, Not(HasSubstr("at the tip")));
  EXPECT_THAT(text, HasSubstr("title 'free'"));
  EXPECT_THAT(notes, IsEmpty());
}

TEST(MeshFigure, of_too_many_triangles_shows_lines_and_says_so) {
  std::vector<std::string> notes;
  const std::string text =
      script(mesh_picture(sample_mesh_plan(100), notes), {{Format::png, "a.png"}});
  EXPECT_THAT(notes, ElementsAre(HasSubstr("80000 of them")));
  EXPECT_THAT(text, Not(HasSubstr("filledcurves")));
}

TEST(MeshFigure, runs_nothing_that_names_say) {
  const TemporaryFolder folder;
  results::MeshPlan plan = sample_mesh_plan(10);
  plan.title = "'`touch pwned`\n!touch pwned";
  plan.mesh.subdomains[0] = "`touch pwned`";
  plan.interfaces[0].name = "'; system('touch pwned'); '";
  draw_mesh(plan, "../`x`", folder / "a");
  EXPECT_FALSE(std::filesystem::exists(folder / "a/pwned"));
  EXPECT_FALSE(std::filesystem::exists(folder / "pwned"));
}

TEST(MeshFigure, refuses_a_mesh_that_is_inconsistent) {
  const TemporaryFolder folder;
  results::MeshPlan plan = sample_mesh_plan(10);
  plan.interfaces[0].edges.kind.pop_back();
  EXPECT_THROW(draw_mesh(plan, "m", folder.path()), Error);
  plan = sample_mesh_plan(10);
  plan.interfaces[1].nodes[0] = 9999;
  EXPECT_THROW(draw_mesh(plan, "m", folder.path()), Error);
}

TEST(MeshFigure, of_a_membrane_without_interfaces) {
  const TemporaryFolder folder;
  results::MeshPlan plan = sample_mesh_plan(10);
  plan.interfaces.clear();
  plan.tips.clear();
  EXPECT_EQ(draw_mesh(plan, "m", folder.path(), {.formats = {Format::png}}).files.size(), 1u);
}

}  // namespace
}  // namespace anticrack::figures

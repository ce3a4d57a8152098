// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/sample_result.hpp"

namespace anticrack::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

v1::Mesh sample_mesh() {
  v1::Mesh mesh;
  mesh.set_name("meshes/1");
  mesh.set_title("A plate\x1b");
  mesh.set_state(v1::Mesh::STATE_READY);
  mesh.set_node_count(5);
  mesh.set_triangle_count(4);
  mesh.set_minimum_angle(31.25);
  mesh.set_bisection_bound(15.5);
  mesh.set_operator_bytes(1000);
  v1::SubdomainInfo& patch = *mesh.add_subdomains();
  patch.set_name("patch");
  patch.set_triangle_count(4);
  patch.set_node_count(5);
  patch.set_area(0.5);
  patch.set_tension(2);
  patch.set_floating(true);
  patch.set_minimum_angle(31.25);
  patch.set_shortest_edge(1e-13);
  patch.set_longest_edge(0.1);
  mesh.add_inclusions("fibre");
  v1::InterfaceInfo& interface = *mesh.add_interfaces();
  interface.set_name("rim");
  interface.mutable_start()->set_x(-1);
  interface.mutable_start()->set_y(0.25);
  auto& glue = *interface.add_segments();
  glue.set_kind(v1::INTERFACE_KIND_GLUE);
  glue.set_inclusion(-1);
  glue.set_end(0.25);
  glue.set_edge_count(3);
  auto& delaminated = *interface.add_segments();
  delaminated.set_kind(v1::INTERFACE_KIND_DELAMINATED);
  delaminated.set_begin(0.25);
  delaminated.set_end(1);
  delaminated.set_edge_count(7);
  v1::InterfaceInfo& slit = *mesh.add_interfaces();
  slit.set_name("slit");
  auto& free = *slit.add_segments();
  free.set_kind(v1::INTERFACE_KIND_FREE);
  free.set_inclusion(-1);
  free.set_end(0.5);
  free.set_edge_count(2);
  v1::TipInfo& tip = *mesh.add_tips();
  tip.mutable_at()->set_x(0.5);
  tip.set_interface("rim");
  tip.set_smallest_edge(1e-13);
  mesh.set_dirichlet_length(6);
  mesh.set_neumann_length(2);
  mesh.add_warnings("took curve 7 for a crack");
  return mesh;
}

TEST(MeshText, ShowsALawInPlaceOfItsMean) {
  v1::Mesh mesh = sample_mesh();
  v1::Tension& law = *mesh.mutable_subdomains(0)->mutable_tension_law();
  law.set_along("1 + x");
  EXPECT_THAT(mesh_text(mesh), ::testing::HasSubstr("  1 + x  "));
  law.set_across("2");
  law.set_angle(30);
  EXPECT_THAT(mesh_text(mesh), ::testing::HasSubstr("along 1 + x, across 2, angle 30"));
}

TEST(MeshText, TabulatesWhatTheServerUnderstood) {
  EXPECT_EQ(mesh_text(sample_mesh()),
            "meshes/1: ready\n"
            "A plate?\n"
            "4 triangles, 5 nodes, meshed in 0 s; smallest angle 31.2 degrees (no grading can go "
            "below 15.5)\n"
            "factors of 1 kB made in 0 s\n"
            "\n"
            "subdomain  triangles  nodes  area  tension  smallest angle  shortest edge  longest "
            "edge  held by\n"
            "patch              4      5   0.5        2            31.2          1e-13           "
            "0.1  interfaces only\n"
            "\n"
            "interface  s = 0 at    s from  s to  kind         inclusion  edges\n"
            "rim        (-1, 0.25)       0  0.25  glue         -              3\n"
            "rim        (-1, 0.25)    0.25     1  delaminated  fibre          7\n"
            "slit       -                0   0.5  free crack   -              2\n"
            "\n"
            "tip on    x  y  smallest edge\n"
            "rim     0.5  0          1e-13\n"
            "\n"
            "boundary: u given on a length of 6, free or traction on 2\n"
            "warning: took curve 7 for a crack\n");
}

TEST(MeshText, NamesTheSidesWithATraction) {
  v1::Mesh mesh = sample_mesh();
  mesh.mutable_geometry()->add_neumann_sides("right");
  mesh.mutable_geometry()->add_neumann_sides("window");
  EXPECT_THAT(mesh_text(mesh), ::testing::HasSubstr("traction on 2: right, window\n"));
}

TEST(MeshText, HasTheUnitsOfTheCaseAndSaysWhatIsFree) {
  const std::string text =
      mesh_text(sample_mesh(), {anticrack::testing::units_of("mm", "N"), true});
  EXPECT_THAT(text, HasSubstr("held by\n"
                              "                             mm^2     N/mm         degrees         "
                              "    mm            mm\n"));
  EXPECT_THAT(text, HasSubstr("edges\n           mm              mm    mm\n"));
  EXPECT_THAT(text, HasSubstr("tip on    x   y  smallest edge\n         mm  mm             mm\n"));
  EXPECT_THAT(text, HasSubstr("u given on a length of 6 mm, free on 2 mm\n"));
}

TEST(MeshText, SaysHowAnInclusionMovesWhereItIsKnown) {
  v1::Mesh mesh = sample_mesh();
  v1::Inclusion& fibre = *mesh.mutable_geometry()->add_inclusions();
  fibre.set_name("fibre");
  fibre.set_tilt(true);
  EXPECT_THAT(mesh_text(mesh), HasSubstr("  fibre, tilts      7\n"));
  fibre.mutable_line();
  EXPECT_THAT(mesh_text(mesh), HasSubstr("  fibre, tilts, its right comes off      7\n"));
  fibre.set_delaminated_side(v1::LINE_SIDE_LEFT);
  EXPECT_THAT(mesh_text(mesh), HasSubstr("  fibre, tilts, its left comes off      7\n"));
  fibre.set_delaminated(false);
  EXPECT_THAT(mesh_text(mesh), HasSubstr("  fibre, tilts      7\n"));
  mesh.set_upload("uploads/1");
  (*mesh.mutable_options()->mutable_inclusion_motions())["fibre"].set_fixed(0);
  EXPECT_THAT(mesh_text(mesh), HasSubstr("  fibre, u = 0      7\n"));
}

TEST(MeshText, OfAMeshThatFailedSaysWhy) {
  v1::Mesh mesh = sample_mesh();
  mesh.set_triangle_count(0);
  mesh.set_state(v1::Mesh::STATE_FAILED);
  mesh.mutable_error()->set_message("no triangles");
  const std::string text = mesh_text(mesh);
  EXPECT_THAT(text, HasSubstr("failed"));
  EXPECT_THAT(text, HasSubstr("no triangles"));
  EXPECT_THAT(text, HasSubstr("took curve 7"));
  EXPECT_THAT(text, Not(HasSubstr("subdomain")));
}

TEST(MeshText, OfAMembraneWithoutInterfaces) {
  v1::Mesh mesh = sample_mesh();
  mesh.clear_interfaces();
  mesh.clear_tips();
  EXPECT_THAT(mesh_text(mesh), HasSubstr("no interfaces"));
  EXPECT_THAT(mesh_text(mesh), Not(HasSubstr("tip on")));
}

}  // namespace
}  // namespace anticrack::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/requests.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "rpc/refusals.hpp"
#include "rpc/requests.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::paper_mesh;
using api::below_mesh_request;
using api::max_interfaces;
using api::max_parts;
using api::max_regions;
using api::max_vertices;
using api::to_definition;
using errors::Error;
using errors::Reason;

mesh::Geometry geometry_of(const v1::CreateMeshRequest& request) {
  return std::get<records::GeometrySource>(to_definition(request)).geometry;
}

void expect_mesh_refused(const std::function<void(v1::CreateMeshRequest&)>& spoil, Reason reason,
                         const std::string& field) {
  v1::CreateMeshRequest request = paper_mesh();
  spoil(request);
  expect_refused([&] { to_definition(request); }, reason, field);
}

TEST(GeometryToDomain, TakesEveryPart) {
  v1::CreateMeshRequest request = paper_mesh(0.1);
  v1::Crack& crack = *request.mutable_geometry()->add_cracks();
  crack.set_name("slit");
  crack.mutable_part()->mutable_from()->set_x(0.6);
  crack.mutable_part()->mutable_to()->set_x(0.8);
  *request.mutable_geometry()->add_cracks() = crack;
  request.mutable_geometry()->mutable_cracks(1)->set_contact(false);
  *request.mutable_geometry()->add_inclusions() = request.geometry().inclusions(0);
  request.mutable_geometry()->mutable_inclusions(0)->set_fixed(0);
  request.mutable_geometry()->mutable_inclusions(1)->set_tilt(true);
  const auto source = std::get<records::GeometrySource>(to_definition(request));
  EXPECT_EQ(source.options.preset, mesh::Preset::uniform);
  EXPECT_EQ(source.options.size, 0.1);
  EXPECT_EQ(source.geometry.boundary.size(), 4u);
  ASSERT_EQ(source.geometry.interfaces.size(), 1u);
  EXPECT_EQ(source.geometry.interfaces[0].points.front(), (mesh::Point{-1, 0}));
  ASSERT_EQ(source.geometry.cracks.size(), 2u);
  EXPECT_EQ(source.geometry.cracks[0].part.to, (mesh::Point{0.8, 0}));
  EXPECT_TRUE(source.geometry.cracks[0].contact);
  EXPECT_FALSE(source.geometry.cracks[1].contact);
  ASSERT_EQ(source.geometry.inclusions.size(), 2u);
  EXPECT_EQ(source.geometry.inclusions[0].motion, (mesh::Motion{false, 0.0}));
  EXPECT_EQ(source.geometry.inclusions[1].motion, (mesh::Motion{true, {}}));
}

TEST(GeometryToDomain, TakesEveryShapeRegionAndBoundaryPart) {
  v1::CreateMeshRequest request = paper_mesh();
  v1::Geometry& geometry = *request.mutable_geometry();
  v1::InterfaceCurve& arc = *geometry.add_interfaces();
  arc.set_name("arc");
  arc.mutable_arc()->mutable_from()->set_x(1);
  arc.mutable_arc()->mutable_through()->set_x(2);
  arc.mutable_arc()->mutable_to()->set_y(3);
  v1::InterfaceCurve& spline = *geometry.add_interfaces();
  spline.set_closed(true);
  for (int i = 0; i < 4; ++i) spline.mutable_spline()->add_points()->set_x(i);
  v1::BoundaryPart& neumann = *geometry.add_neumann();
  neumann.mutable_from()->set_x(-1);
  neumann.mutable_to()->set_y(1);
  for (const double tension : {1.0, 2.5, -1.0, 0.0}) {
    v1::Region& region = *geometry.add_regions();
    region.set_name("r");
    region.mutable_at()->set_x(0.25);
    if (tension != 1) region.set_tension(tension);
  }
  const mesh::Geometry result = geometry_of(request);
  ASSERT_EQ(result.interfaces.size(), 3u);
  EXPECT_EQ(result.interfaces[0].shape, mesh::Shape::polyline);
  EXPECT_EQ(result.interfaces[1].name, "arc");
  EXPECT_EQ(result.interfaces[1].shape, mesh::Shape::arc);
  EXPECT_EQ(result.interfaces[1].points, (std::vector<mesh::Point>{{1, 0}, {2, 0}, {0, 3}}));
  EXPECT_EQ(result.interfaces[2].shape, mesh::Shape::spline);
  EXPECT_TRUE(result.interfaces[2].closed);
  EXPECT_EQ(result.interfaces[2].points.size(), 4u);
  ASSERT_EQ(result.neumann.size(), 1u);
  EXPECT_EQ(result.neumann[0].to, (mesh::Point{0, 1}));
  ASSERT_EQ(result.regions.size(), 4u);
  EXPECT_EQ(result.regions[0].tension, 1);  // unset
  EXPECT_EQ(result.regions[1].tension, 2.5);
  EXPECT_EQ(result.regions[2].tension, -1);  // for the domain to refuse
  EXPECT_EQ(result.regions[3].tension, 0);   // the same
  EXPECT_EQ(result.regions[1].at, (mesh::Point{0.25, 0}));
}

TEST(GeometryToDomain, TakesSidesHolesAndLinesOfTheirOwn) {
  v1::CreateMeshRequest request = paper_mesh();
  v1::Geometry& geometry = *request.mutable_geometry();
  v1::Inclusion& bar = *geometry.mutable_inclusions(0);
  bar.clear_part();
  v1::Segment& segment = *bar.mutable_line()->mutable_segment();
  segment.mutable_center()->set_x(0.5);
  segment.set_angle(20);
  segment.set_length(0.25);
  bar.set_delaminated_side(v1::LINE_SIDE_LEFT);
  geometry.add_cracks()->mutable_line()->mutable_spline()->add_points()->set_y(2);
  v1::Circle& circle = *geometry.add_regions()->mutable_outline()->mutable_circle();
  circle.mutable_center()->set_y(-1);
  circle.set_radius(3);
  v1::Side& side = *geometry.add_sides();
  side.set_name("left");
  side.mutable_line()->mutable_polyline()->add_points()->set_x(4);
  geometry.add_holes()->mutable_outline()->mutable_polygon()->add_points()->set_x(5);
  geometry.add_neumann_sides("left");
  const mesh::Geometry result = geometry_of(request);
  EXPECT_EQ(result.inclusions[0].line,
            (mesh::LineSpec{mesh::Shape::segment, {{0.5, 0}}, 20, 0.25}));
  EXPECT_EQ(result.inclusions[0].delaminated_side, mesh::LineSide::left);
  EXPECT_EQ(result.inclusions[0].stretches, (std::vector<mesh::StretchSpec>{{0, 1}}));
  EXPECT_TRUE(result.inclusions[0].delaminated.empty());
  EXPECT_EQ(result.cracks[0].line, (mesh::LineSpec{mesh::Shape::spline, {{0, 2}}}));
  EXPECT_EQ(result.regions[0].outline, (mesh::OutlineSpec{mesh::Shape::circle, {{0, -1}}, 3}));
  EXPECT_EQ(result.sides,
            (std::vector<mesh::SideSpec>{{"left", {mesh::Shape::polyline, {{4, 0}}}}}));
  EXPECT_EQ(result.holes, (std::vector<mesh::HoleSpec>{{"", {mesh::Shape::polyline, {{5, 0}}}}}));
  EXPECT_EQ(result.neumann_sides, std::vector<std::string>{"left"});
}

TEST(GeometryToDomain, TakesEveryOption) {
  v1::CreateMeshRequest request = paper_mesh();
  request.clear_options();
  const auto options_of = [&] {
    return std::get<records::GeometrySource>(to_definition(request)).options;
  };
  EXPECT_EQ(options_of().preset, mesh::Preset::graded);
  EXPECT_EQ(options_of().grading, 0.2);
  v1::MeshOptions& options = *request.mutable_options();
  options.set_preset(v1::MESH_PRESET_GRADED);
  options.set_tip_size(1e-6);
  options.set_grading(0.125);
  options.add_align()->add_points()->set_x(4);
  EXPECT_EQ(options_of().tip_size, 1e-6);
  EXPECT_EQ(options_of().grading, 0.125);
  ASSERT_EQ(options_of().align.size(), 1u);
  EXPECT_EQ(options_of().align[0], (std::vector<mesh::Point>{{4, 0}}));
  options.set_preset(v1::MESH_PRESET_PAPER);
  EXPECT_EQ(options_of().preset, mesh::Preset::paper);
}

TEST(GeometryToDomain, TakesTheOptionsOfAnUpload) {
  v1::CreateMeshRequest request;
  request.set_upload("uploads/" + std::string(64, 'a'));
  v1::MeshOptions& options = *request.mutable_options();
  options.set_size(0.5);
  (*options.mutable_curve_groups())[3] = "inclusion:a";
  (*options.mutable_surface_groups())[7] = "left";
  (*options.mutable_tension())["left"] = 2;
  (*options.mutable_inclusion_motions())["a"].set_tilt(true);
  (*options.mutable_inclusion_motions())["b"].set_fixed(-1);
  const auto source = std::get<records::UploadRef>(to_definition(request));
  EXPECT_EQ(source.options.preset, mesh::Preset::graded);
  EXPECT_EQ(source.options.size, 0.5);
  EXPECT_EQ(source.options.curve_groups.at(3), "inclusion:a");
  EXPECT_EQ(source.options.surface_groups.at(7), "left");
  EXPECT_EQ(source.options.tension.at("left"), 2);
  EXPECT_EQ(source.options.inclusion_motions.at("a"), (mesh::Motion{true, {}}));
  EXPECT_EQ(source.options.inclusion_motions.at("b"), (mesh::Motion{false, -1}));
  (*options.mutable_curve_groups())[3] = "fibre";
  expect_refused([&] { to_definition(request); }, Reason::invalid_argument,
                 "options.curve_groups[3]");
}

TEST(GeometryToDomain, DelaminatesWhatWasAskedFor) {
  v1::CreateMeshRequest request = paper_mesh();
  v1::Inclusion& inclusion = *request.mutable_geometry()->mutable_inclusions(0);
  const mesh::InclusionSpec whole = geometry_of(request).inclusions[0];
  ASSERT_EQ(whole.delaminated.size(), 1u);
  EXPECT_EQ(whole.delaminated[0].from, whole.part.from);
  EXPECT_EQ(whole.delaminated[0].to, whole.part.to);

  inclusion.set_delaminated(true);
  EXPECT_EQ(geometry_of(request).inclusions[0].delaminated.size(), 1u);
  inclusion.set_delaminated(false);
  EXPECT_TRUE(geometry_of(request).inclusions[0].delaminated.empty());

  v1::InterfacePart& part = *inclusion.mutable_delaminated_parts()->add_parts();
  part.mutable_from()->set_x(-0.25);
  part.mutable_to()->set_x(0.125);
  const mesh::InclusionSpec some = geometry_of(request).inclusions[0];
  ASSERT_EQ(some.delaminated.size(), 1u);
  EXPECT_EQ(some.delaminated[0].from, (mesh::Point{-0.25, 0}));
  EXPECT_EQ(some.delaminated[0].to, (mesh::Point{0.125, 0}));
}

TEST(GeometryToDomain, RefusesWhatItsTypesCannotExpress) {
  expect_mesh_refused([](auto& request) { request.clear_source(); }, Reason::invalid_argument,
                      "geometry");
  expect_mesh_refused(
      [](auto& request) {
        request.mutable_geometry()->mutable_inclusions(0)->mutable_part()->clear_from();
      },
      Reason::invalid_argument, "geometry.inclusions[0].part.from");
  expect_mesh_refused(
      [](auto& request) {
        request.mutable_geometry()->add_cracks()->mutable_part()->mutable_from();
      },
      Reason::invalid_argument, "geometry.cracks[0].part.to");
  expect_mesh_refused(
      [](auto& request) {
        request.mutable_geometry()->mutable_inclusions(0)->mutable_delaminated_parts();
      },
      Reason::invalid_argument, "geometry.inclusions[0].delaminated_parts.parts");
  expect_mesh_refused([](auto& request) { request.mutable_geometry()->add_interfaces(); },
                      Reason::invalid_argument, "geometry.interfaces[1].polyline");
  expect_mesh_refused(
      [](auto& request) {
        request.mutable_geometry()->add_interfaces()->mutable_arc()->mutable_from();
      },
      Reason::invalid_argument, "geometry.interfaces[1].arc.through");
  expect_mesh_refused(
      [](auto& request) {
        request.mutable_geometry()->mutable_inclusions(0)->mutable_line()->mutable_polyline();
      },
      Reason::invalid_argument, "geometry.inclusions[0].line");
  expect_mesh_refused(
      [](auto& request) { request.mutable_geometry()->add_cracks()->mutable_line(); },
      Reason::invalid_argument, "geometry.cracks[0].line.polyline");
  expect_mesh_refused(
      [](auto& request) {
        request.mutable_geometry()->add_cracks()->mutable_line()->mutable_segment();
      },
      Reason::invalid_argument, "geometry.cracks[0].line.segment.center");
  expect_mesh_refused(
      [](auto& request) { request.mutable_geometry()->add_holes()->mutable_outline(); },
      Reason::invalid_argument, "geometry.holes[0].outline.polygon");
  expect_mesh_refused([](auto& request) { request.mutable_geometry()->add_regions(); },
                      Reason::invalid_argument, "geometry.regions[0].at");
  expect_mesh_refused([](auto& request) { request.mutable_geometry()->add_neumann(); },
                      Reason::invalid_argument, "geometry.neumann[0].from");
  expect_mesh_refused(
      [](auto& request) { request.mutable_options()->set_preset(static_cast<v1::MeshPreset>(77)); },
      Reason::invalid_argument, "options.preset");
  expect_mesh_refused([](auto& request) { request.set_title(std::string(201, 't')); },
                      Reason::limit_exceeded, "title");
  expect_mesh_refused(
      [](auto& request) {
        request.mutable_options()->set_preset(v1::MESH_PRESET_PAPER);
        request.set_upload("uploads/1");
      },
      Reason::invalid_argument, "options.preset");
  expect_mesh_refused(
      [](auto& request) {
        request.clear_options();
        request.set_upload("uploads/1");
      },
      Reason::invalid_argument, "upload");
}

TEST(GeometryToDomain, CountsBeforeItConverts) {
  expect_mesh_refused(
      [](auto& request) {
        for (std::size_t i = 0; i <= api::max_sides; ++i) request.mutable_geometry()->add_sides();
      },
      Reason::limit_exceeded, "geometry.sides");
  expect_mesh_refused(
      [](auto& request) {
        for (std::size_t i = 0; i <= api::max_sides; ++i) request.mutable_geometry()->add_holes();
      },
      Reason::limit_exceeded, "geometry.holes");
  expect_mesh_refused(
      [](auto& request) {
        auto& holes = *request.mutable_geometry()->mutable_holes();
        for (int k = 0; k < 2; ++k) {
          auto& polygon = *holes.Add()->mutable_outline()->mutable_polygon();
          for (std::size_t i = 0; i <= max_vertices / 2; ++i) polygon.add_points();
        }
      },
      Reason::limit_exceeded, "geometry.holes[1]");
  expect_mesh_refused(
      [](auto& request) {
        auto& parts =
            *request.mutable_geometry()->mutable_inclusions(0)->mutable_delaminated_parts();
        for (std::size_t i = 0; i < max_parts; ++i) parts.add_stretches();
      },
      Reason::limit_exceeded, "geometry.inclusions");
  expect_mesh_refused(
      [](auto& request) {
        for (std::size_t i = 0; i < max_vertices; ++i) request.mutable_geometry()->add_boundary();
      },
      Reason::limit_exceeded, "geometry.boundary");
  expect_mesh_refused(
      [](auto& request) {
        for (std::size_t i = 0; i < max_vertices; ++i) {
          request.mutable_geometry()->mutable_interfaces(0)->mutable_polyline()->add_points();
        }
      },
      Reason::limit_exceeded, "geometry.interfaces[0]");
  expect_mesh_refused(
      [](auto& request) {
        for (std::size_t i = 0; i < max_interfaces; ++i) {
          request.mutable_geometry()->add_interfaces();
        }
      },
      Reason::limit_exceeded, "geometry.interfaces");
  expect_mesh_refused(
      [](auto& request) {
        for (std::size_t i = 0; i <= max_vertices; ++i) {
          auto& options = *request.mutable_options();
          if (i == 0) options.add_align();
          options.mutable_align(0)->add_points();
        }
      },
      Reason::limit_exceeded, "options.align");
  expect_mesh_refused(
      [](auto& request) {
        for (std::size_t i = 0; i <= max_regions; ++i) {
          (*request.mutable_options()->mutable_curve_groups())[static_cast<int>(i)] = "crack";
        }
      },
      Reason::limit_exceeded, "options.curve_groups");
  expect_mesh_refused(
      [](auto& request) {
        for (std::size_t i = 0; i <= max_parts; ++i)
          (*request.mutable_options()->mutable_inclusion_motions())[std::to_string(i)];
      },
      Reason::limit_exceeded, "options.inclusion_motions");
  expect_mesh_refused(
      [](auto& request) {
        for (std::size_t i = 0; i < max_parts; ++i) request.mutable_geometry()->add_cracks();
      },
      Reason::limit_exceeded, "geometry.inclusions");
}

TEST(GeometryToDomain, PutsTheDomainsFieldsIntoTheRequest) {
  const auto path = [](const char* field) {
    return below_mesh_request(Error(Reason::geometry_invalid, "m").at(field)).fields()[0].field;
  };
  EXPECT_EQ(path("boundary[2]"), "geometry.boundary[2]");
  EXPECT_EQ(path("inclusions[0].part.from"), "geometry.inclusions[0].part.from");
  EXPECT_EQ(path("inclusions[0].delaminated_parts[1].to"),
            "geometry.inclusions[0].delaminated_parts.parts[1].to");
  EXPECT_EQ(path("inclusions[0].delaminated_parts.stretches[1]"),
            "geometry.inclusions[0].delaminated_parts.stretches[1]");
  EXPECT_EQ(path("options.size"), "options.size");
  EXPECT_EQ(path("upload"), "upload");
}

}  // namespace
}  // namespace anticrack::rpc

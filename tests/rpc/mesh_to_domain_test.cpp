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

/// What is said comes back from a record: store/record_codec_test.
TEST(GeometryToDomain, FillsInWhatIsNotSaid) {
  v1::CreateMeshRequest request = paper_mesh();
  request.clear_options();
  v1::Geometry& geometry = *request.mutable_geometry();
  *geometry.add_cracks()->mutable_part() = geometry.inclusions(0).part();
  geometry.add_regions()->mutable_at();
  v1::Inclusion& bar = *geometry.add_inclusions();
  bar.set_name("bar");
  bar.mutable_line()->mutable_segment()->mutable_center();
  const auto source = std::get<records::GeometrySource>(to_definition(request));
  EXPECT_EQ(source.options.preset, mesh::Preset::graded);
  EXPECT_EQ(source.options.grading, 0.2);
  EXPECT_TRUE(source.geometry.cracks[0].contact);
  EXPECT_EQ(source.geometry.regions[0].tension, 1);
  EXPECT_EQ(source.geometry.inclusions[0].motion, mesh::Motion());
  EXPECT_EQ(source.geometry.inclusions[1].stretches, (std::vector<mesh::StretchSpec>{{0, 1}}));
  EXPECT_TRUE(source.geometry.inclusions[1].delaminated.empty());
  for (const double tension : {-1.0, 0.0}) {  // for the domain to refuse
    geometry.mutable_regions(0)->set_tension(tension);
    EXPECT_EQ(geometry_of(request).regions[0].tension, tension);
  }
}

TEST(GeometryToDomain, OfAnUploadKnowsNoOtherGroups) {
  v1::CreateMeshRequest request;
  request.set_upload("uploads/" + std::string(64, 'a'));
  (*request.mutable_options()->mutable_curve_groups())[3] = "inclusion:a";
  EXPECT_EQ(std::get<records::UploadRef>(to_definition(request)).options.preset,
            mesh::Preset::graded);
  (*request.mutable_options()->mutable_curve_groups())[3] = "fibre";
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

void expect_geometry_refused(const std::function<void(v1::Geometry&)>& spoil, Reason reason,
                             const std::string& field) {
  expect_mesh_refused([&](auto& request) { spoil(*request.mutable_geometry()); }, reason,
                      "geometry." + field);
}

TEST(GeometryToDomain, RefusesWhatItsTypesCannotExpress) {
  const auto refused = [](const std::function<void(v1::Geometry&)>& spoil, const char* field) {
    expect_geometry_refused(spoil, Reason::invalid_argument, field);
  };
  refused([](auto& of) { of.mutable_inclusions(0)->mutable_part()->clear_from(); },
          "inclusions[0].part.from");
  refused([](auto& of) { of.add_cracks()->mutable_part()->mutable_from(); }, "cracks[0].part.to");
  refused([](auto& of) { of.mutable_inclusions(0)->mutable_delaminated_parts(); },
          "inclusions[0].delaminated_parts.parts");
  refused([](auto& of) { of.add_interfaces(); }, "interfaces[1].polyline");
  refused([](auto& of) { of.add_interfaces()->mutable_arc()->mutable_from(); },
          "interfaces[1].arc.through");
  refused([](auto& of) { of.mutable_inclusions(0)->mutable_line()->mutable_polyline(); },
          "inclusions[0].line");
  refused([](auto& of) { of.add_cracks()->mutable_line(); }, "cracks[0].line.polyline");
  refused([](auto& of) { of.add_cracks()->mutable_line()->mutable_segment(); },
          "cracks[0].line.segment.center");
  refused([](auto& of) { of.add_holes()->mutable_outline(); }, "holes[0].outline.polygon");
  refused([](auto& of) { of.add_regions(); }, "regions[0].at");
  refused([](auto& of) { of.add_neumann(); }, "neumann[0].from");
  expect_mesh_refused([](auto& request) { request.clear_source(); }, Reason::invalid_argument,
                      "geometry");
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
  const auto times = [](std::size_t count, const auto& add) {
    for (std::size_t i = 0; i < count; ++i) add(i);
  };
  const auto too_many = [](const std::function<void(v1::Geometry&)>& spoil, const char* field) {
    expect_geometry_refused(spoil, Reason::limit_exceeded, field);
  };
  too_many([&](auto& of) { times(api::max_sides + 1, [&](auto) { of.add_sides(); }); }, "sides");
  too_many([&](auto& of) { times(api::max_sides + 1, [&](auto) { of.add_holes(); }); }, "holes");
  too_many(
      [&](auto& of) {
        for (int k = 0; k < 2; ++k) {
          auto& polygon = *of.add_holes()->mutable_outline()->mutable_polygon();
          times(max_vertices / 2 + 1, [&](auto) { polygon.add_points(); });
        }
      },
      "holes[1]");
  too_many(
      [&](auto& of) {
        auto& parts = *of.mutable_inclusions(0)->mutable_delaminated_parts();
        times(max_parts, [&](auto) { parts.add_stretches(); });
      },
      "inclusions");
  too_many([&](auto& of) { times(max_vertices, [&](auto) { of.add_boundary(); }); }, "boundary");
  too_many(
      [&](auto& of) {
        auto& line = *of.mutable_interfaces(0)->mutable_polyline();
        times(max_vertices, [&](auto) { line.add_points(); });
      },
      "interfaces[0]");
  too_many([&](auto& of) { times(max_interfaces, [&](auto) { of.add_interfaces(); }); },
           "interfaces");
  too_many([&](auto& of) { times(max_parts, [&](auto) { of.add_cracks(); }); }, "inclusions");

  const auto too_many_options = [](const std::function<void(v1::MeshOptions&)>& spoil,
                                   const char* field) {
    expect_mesh_refused([&](auto& request) { spoil(*request.mutable_options()); },
                        Reason::limit_exceeded, field);
  };
  too_many_options(
      [&](auto& of) {
        auto& line = *of.add_align();
        times(max_vertices + 1, [&](auto) { line.add_points(); });
      },
      "options.align");
  too_many_options(
      [&](auto& of) {
        times(max_regions + 1,
              [&](auto i) { (*of.mutable_curve_groups())[static_cast<int>(i)] = "crack"; });
      },
      "options.curve_groups");
  too_many_options(
      [&](auto& of) {
        times(max_parts + 1, [&](auto i) { (*of.mutable_inclusion_motions())[std::to_string(i)]; });
      },
      "options.inclusion_motions");
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/codec.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <tuple>

#include "support/errors.hpp"
#include "support/paper_geometry.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack {
namespace {

using mesh::Bytes;
using mesh::Mesh;

Mesh small_mesh() {
  testing::StructuredOptions options;
  options.columns = 4;
  options.rows = 1;
  Mesh mesh = testing::structured_mesh(options);
  mesh.warnings = {"one", ""};
  mesh.tension.assign(mesh.subdomains.size(), 1.0);
  mesh.tension.back() = 2.5;
  return mesh;
}

void expect_equal(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.xy, b.xy);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.subdomain, b.subdomain);
  EXPECT_EQ(a.subdomains, b.subdomains);
  EXPECT_EQ(a.tension, b.tension);
  EXPECT_EQ(a.tension_laws, b.tension_laws);
  EXPECT_EQ(a.inclusions, b.inclusions);
  EXPECT_EQ(a.motions, b.motions);
  EXPECT_EQ(a.dirichlet, b.dirichlet);
  EXPECT_EQ(a.chords, b.chords);
  ASSERT_EQ(a.interfaces.size(), b.interfaces.size());
  for (std::size_t i = 0; i < a.interfaces.size(); ++i) {
    EXPECT_EQ(a.interfaces[i].name, b.interfaces[i].name);
    EXPECT_EQ(a.interfaces[i].nodes, b.interfaces[i].nodes);
    EXPECT_EQ(a.interfaces[i].kind, b.interfaces[i].kind);
    EXPECT_EQ(a.interfaces[i].inclusion, b.interfaces[i].inclusion);
  }
}

/// One whose inclusion tilts, with a free crack.
Mesh moving_mesh() {
  Mesh mesh = small_mesh();
  mesh.motions = {{true, {}}};
  mesh.interfaces[0].kind[0] = mesh::Kind::free;
  return mesh;
}

/// One with a tension that varies, whose inclusion keeps its direction.
Mesh varying_mesh() {
  Mesh mesh = small_mesh();
  mesh.tension_laws.resize(mesh.subdomains.size());
  mesh.tension_laws.back() = {"1 + x^2", "2", 30};
  return mesh;
}

/// One with an edge on a chord.
Mesh curved_mesh() {
  Mesh mesh = small_mesh();
  const auto [a, b] = mesh.dirichlet[0];
  mesh.chords = {{a, b, -0.01, 0.005, -0.02, 0.5, 1e-3}};
  return mesh;
}

/// Every shorter part, and one byte more, must be refused.
template <class Decode>
void expect_exact(const Bytes& bytes, const Decode& decode) {
  EXPECT_NO_THROW(decode(bytes));
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    // its own allocation, so that a sanitizer sees a read past the end
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_TRUE(testing::throws([&] { decode(cut); }, errors::Reason::mesh_invalid)) << n;
  }
  Bytes longer = bytes;
  longer.push_back(std::byte{0});
  EXPECT_TRUE(testing::throws([&] { decode(longer); }, errors::Reason::mesh_invalid));
}

mesh::GenerateRequest generate_request() {
  mesh::Geometry geometry = testing::paper_geometry();
  geometry.inclusions[0].motion.fixed = 0.25;
  geometry.interfaces.push_back(
      {"ring", mesh::Shape::polyline, {{-0.5, -0.5}, {0, -0.25}, {0.5, -0.5}}, true});
  mesh::MeshOptions options;
  options.size = 0.5;
  options.grading = 0.125;
  options.tip_size = 1e-5;
  options.align = {{{-0.5, -0.75}, {0.5, -0.75}}};
  return {mesh::plan(geometry, options, 100'000), 12'345};
}

errors::Error full_error() {
  errors::Error error(errors::Reason::limit_exceeded, "too fine");
  error.at("options.size").with("limit", "7").retry_after(std::chrono::milliseconds(250));
  return error;
}

TEST(Codec, MeshComesBack) {
  for (const Mesh& mesh : {small_mesh(), moving_mesh(), varying_mesh(), curved_mesh()}) {
    const Mesh back = mesh::decode_mesh(mesh::encode(mesh));
    expect_equal(mesh, back);
    EXPECT_TRUE(back.warnings.empty());
  }
}

TEST(Codec, EqualMeshesGiveEqualBytes) {
  Mesh a = small_mesh();
  Mesh b = small_mesh();
  b.warnings.clear();
  a.xy[2] = 0.0;
  b.xy[2] = -0.0;
  EXPECT_EQ(mesh::encode(a), mesh::encode(b));
  // no tension means 1 everywhere
  a.tension.clear();
  b.tension.assign(b.subdomains.size(), 1.0);
  EXPECT_EQ(mesh::encode(a), mesh::encode(b));
  b.tension[0] = 2;
  EXPECT_NE(mesh::encode(a), mesh::encode(b));
  b.tension[0] = 1;
  // no motions mean the default of each
  b.motions.resize(b.inclusions.size());
  EXPECT_EQ(mesh::encode(a), mesh::encode(b));
  b.motions[0].fixed = 0;
  EXPECT_NE(mesh::encode(a), mesh::encode(b));
  b.motions.clear();
  b.tension_laws.resize(b.subdomains.size());
  b.tension_laws[0].along = "1";
  EXPECT_NE(mesh::encode(a), mesh::encode(b));
  b.tension_laws.clear();
  b.xy[2] = 1e-300;
  EXPECT_NE(mesh::encode(a), mesh::encode(b));
}

TEST(Codec, GenerateRequestComesBack) {
  const mesh::GenerateRequest request = generate_request();
  const auto back = std::get<mesh::GenerateRequest>(
      mesh::decode_request(mesh::encode(mesh::MesherRequest(request))));
  EXPECT_EQ(back.max_triangles, 12'345U);
  const mesh::Plan& a = request.plan;
  const mesh::Plan& b = back.plan;
  EXPECT_EQ(b.points, a.points);
  EXPECT_EQ(b.inclusions, a.inclusions);
  EXPECT_EQ(b.motions, (std::vector<mesh::Motion>{{false, 0.25}}));
  EXPECT_EQ(b.growth, a.growth);
  EXPECT_EQ(b.grading.h0, a.grading.h0);
  EXPECT_EQ(b.grading.m, 0.125);
  EXPECT_EQ(b.grading.tip_size, 1e-5);
  ASSERT_EQ(b.curves.size(), a.curves.size());
  for (std::size_t i = 0; i < a.curves.size(); ++i) {
    const auto members = [](const mesh::PlannedCurve& c) {
      return std::tuple(c.a, c.b, c.intervals, c.role, c.left, c.right, c.kind, c.inclusion);
    };
    EXPECT_EQ(members(b.curves[i]), members(a.curves[i]));
  }
  ASSERT_EQ(b.interfaces.size(), a.interfaces.size());
  for (std::size_t i = 0; i < a.interfaces.size(); ++i) {
    EXPECT_EQ(b.interfaces[i].name, a.interfaces[i].name);
    EXPECT_EQ(b.interfaces[i].curves, a.interfaces[i].curves);
  }
  ASSERT_EQ(b.faces.size(), a.faces.size());
  for (std::size_t i = 0; i < a.faces.size(); ++i) {
    const auto members = [](const mesh::PlannedFace& f) {
      return std::tuple(f.name, f.tension, f.outer, f.holes, f.embedded);
    };
    EXPECT_EQ(members(b.faces[i]), members(a.faces[i]));
  }
}

TEST(Codec, APlanWhoseNumbersPointNowhereIsRefused) {
  const auto spoiled = [](const auto& spoil) {
    mesh::GenerateRequest request = generate_request();
    spoil(request.plan);
    const Bytes bytes = mesh::encode(mesh::MesherRequest(request));
    return testing::throws([&] { mesh::decode_request(bytes); }, errors::Reason::mesh_invalid);
  };
  EXPECT_FALSE(spoiled([](mesh::Plan&) {}));
  EXPECT_TRUE(spoiled([](mesh::Plan& p) { p.curves[1].a = -1; }));
  EXPECT_TRUE(spoiled([](mesh::Plan& p) { p.curves[1].b = 1'000'000; }));
  EXPECT_TRUE(spoiled([](mesh::Plan& p) { p.curves[1].left = 77; }));
  EXPECT_TRUE(spoiled([](mesh::Plan& p) { p.curves[1].inclusion = 3; }));
  EXPECT_TRUE(spoiled([](mesh::Plan& p) { p.interfaces[0].curves[0] = 1'000'000; }));
  EXPECT_TRUE(spoiled([](mesh::Plan& p) { p.faces[0].outer[0] = 0; }));
  EXPECT_TRUE(spoiled([](mesh::Plan& p) { p.faces[0].outer[0] = -2'147'483'647 - 1; }));
  EXPECT_TRUE(spoiled([](mesh::Plan& p) { p.faces[0].holes.at(0).at(0) = 1'000'000; }));
  EXPECT_TRUE(spoiled([](mesh::Plan& p) { p.faces[0].embedded.at(0) = -1; }));
}

mesh::MesherRequest import_request() {
  mesh::ImportRequest request;
  request.path = "a file.msh";
  request.max_triangles = 99;
  request.options.preset = mesh::Preset::uniform;
  request.options.size = 0.25;
  request.options.tip_size = 1e-7;
  request.options.grading = 0.5;
  request.options.align = {{{1, 2}, {3, 4}}, {{5, 6}}};
  request.options.curve_groups = {{3, "crack"}, {-1, "delaminated:a"}};
  request.options.surface_groups = {{7, "left"}};
  request.options.tension = {{"left", 2.5}, {"right", 1}};
  request.options.inclusion_motions = {{"a", {true, {}}}, {"b", {false, -1}}};
  return request;
}

TEST(Codec, ImportRequestComesBack) {
  const mesh::MesherRequest request = import_request();
  const auto& sent = std::get<mesh::ImportRequest>(request);
  const auto back = std::get<mesh::ImportRequest>(mesh::decode_request(mesh::encode(request)));
  EXPECT_EQ(back.path, "a file.msh");
  EXPECT_EQ(back.max_triangles, 99U);
  EXPECT_EQ(back.options.preset, mesh::Preset::uniform);
  EXPECT_EQ(back.options.size, 0.25);
  EXPECT_EQ(back.options.tip_size, 1e-7);
  EXPECT_EQ(back.options.grading, 0.5);
  EXPECT_EQ(back.options.align, sent.options.align);
  EXPECT_EQ(back.options.curve_groups, sent.options.curve_groups);
  EXPECT_EQ(back.options.surface_groups, sent.options.surface_groups);
  EXPECT_EQ(back.options.tension, sent.options.tension);
  EXPECT_EQ(back.options.inclusion_motions, sent.options.inclusion_motions);
}

TEST(Codec, ReplyCarriesWarnings) {
  Mesh sent_mesh = moving_mesh();
  sent_mesh.tension_laws = varying_mesh().tension_laws;
  sent_mesh.chords = curved_mesh().chords;
  const mesh::MesherReply reply = sent_mesh;
  const Mesh back = std::get<Mesh>(mesh::decode_reply(mesh::encode(reply)));
  expect_equal(std::get<Mesh>(reply), back);
  EXPECT_EQ(back.warnings, std::get<Mesh>(reply).warnings);
}

TEST(Codec, ReplyCarriesAnError) {
  const auto back =
      std::get<errors::Error>(mesh::decode_reply(mesh::encode(mesh::MesherReply(full_error()))));
  EXPECT_EQ(back.reason(), errors::Reason::limit_exceeded);
  EXPECT_STREQ(back.what(), "too fine");
  ASSERT_EQ(back.fields().size(), 1U);
  EXPECT_EQ(back.fields()[0].field, "options.size");
  EXPECT_EQ(back.fields()[0].description, "too fine");
  EXPECT_EQ(back.metadata().at("limit"), "7");
  EXPECT_EQ(back.retry_delay(), std::chrono::milliseconds(250));
}

TEST(Codec, TruncationAtEveryByteIsRefused) {
  expect_exact(mesh::encode(small_mesh()), [](const Bytes& b) { mesh::decode_mesh(b); });
  expect_exact(mesh::encode(moving_mesh()), [](const Bytes& b) { mesh::decode_mesh(b); });
  expect_exact(mesh::encode(varying_mesh()), [](const Bytes& b) { mesh::decode_mesh(b); });
  expect_exact(mesh::encode(curved_mesh()), [](const Bytes& b) { mesh::decode_mesh(b); });
  const auto request = [](const Bytes& b) { mesh::decode_request(b); };
  expect_exact(mesh::encode(mesh::MesherRequest(generate_request())), request);
  expect_exact(mesh::encode(import_request()), request);
  const auto reply = [](const Bytes& b) { mesh::decode_reply(b); };
  expect_exact(mesh::encode(mesh::MesherReply(small_mesh())), reply);
  expect_exact(mesh::encode(mesh::MesherReply(full_error())), reply);
}

TEST(Codec, ALengthBeyondTheBytesAllocatesNothing) {
  Bytes bytes = mesh::encode(small_mesh());
  // the length of xy follows the eight bytes of the tag
  const std::uint64_t huge = std::uint64_t{1} << 61;
  std::memcpy(bytes.data() + 8, &huge, sizeof huge);
  EXPECT_TRUE(testing::throws([&] { mesh::decode_mesh(bytes); }, errors::Reason::mesh_invalid));
}

TEST(Codec, DamagedBytesThrowOrDecodeButDoNothingElse) {
  const Bytes sound = mesh::encode(mesh::MesherReply(small_mesh()));
  std::mt19937 random(1);
  std::size_t refused = 0;
  for (int round = 0; round < 20'000; ++round) {
    Bytes bytes = sound;
    for (int hits = 0; hits < 3; ++hits) {
      bytes[random() % bytes.size()] = static_cast<std::byte>(random() % 256);
    }
    if (testing::error_of([&] { mesh::decode_reply(bytes); })) ++refused;
  }
  EXPECT_GT(refused, 1000U);
}

TEST(Codec, OneFormatIsNotTakenForAnother) {
  const Bytes mesh = mesh::encode(small_mesh());
  EXPECT_TRUE(testing::throws([&] { mesh::decode_reply(mesh); }, errors::Reason::mesh_invalid));
  EXPECT_TRUE(testing::throws([&] { mesh::decode_request(mesh); }, errors::Reason::mesh_invalid));
}

}  // namespace
}  // namespace anticrack

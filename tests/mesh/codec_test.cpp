// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/codec.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

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
  return mesh;
}

void expect_equal(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.xy, b.xy);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.subdomain, b.subdomain);
  EXPECT_EQ(a.subdomains, b.subdomains);
  EXPECT_EQ(a.inclusions, b.inclusions);
  EXPECT_EQ(a.dirichlet, b.dirichlet);
  ASSERT_EQ(a.interfaces.size(), b.interfaces.size());
  for (std::size_t i = 0; i < a.interfaces.size(); ++i) {
    EXPECT_EQ(a.interfaces[i].name, b.interfaces[i].name);
    EXPECT_EQ(a.interfaces[i].nodes, b.interfaces[i].nodes);
    EXPECT_EQ(a.interfaces[i].kind, b.interfaces[i].kind);
    EXPECT_EQ(a.interfaces[i].inclusion, b.interfaces[i].inclusion);
  }
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
  return {mesh::plan(testing::paper_geometry(), {}, 100'000), 12'345};
}

errors::Error full_error() {
  errors::Error error(errors::Reason::limit_exceeded, "too fine");
  error.at("options.size").with("limit", "7").retry_after(std::chrono::milliseconds(250));
  return error;
}

TEST(Codec, MeshComesBack) {
  const Mesh mesh = small_mesh();
  const Mesh back = mesh::decode_mesh(mesh::encode(mesh));
  expect_equal(mesh, back);
  EXPECT_TRUE(back.warnings.empty());
}

TEST(Codec, EqualMeshesGiveEqualBytes) {
  Mesh a = small_mesh();
  Mesh b = small_mesh();
  b.warnings.clear();
  a.xy[2] = 0.0;
  b.xy[2] = -0.0;
  EXPECT_EQ(mesh::encode(a), mesh::encode(b));
  b.xy[2] = 1e-300;
  EXPECT_NE(mesh::encode(a), mesh::encode(b));
}

TEST(Codec, GenerateRequestComesBack) {
  const mesh::GenerateRequest request = generate_request();
  const auto back = std::get<mesh::GenerateRequest>(
      mesh::decode_request(mesh::encode(mesh::MesherRequest(request))));
  EXPECT_EQ(back.max_triangles, 12'345U);
  EXPECT_EQ(back.plan.points, request.plan.points);
  EXPECT_EQ(back.plan.inclusions, request.plan.inclusions);
  EXPECT_EQ(back.plan.growth, request.plan.growth);
  const auto same = [](const mesh::PlannedCurve& a, const mesh::PlannedCurve& b) {
    return a.a == b.a && a.b == b.b && a.intervals == b.intervals;
  };
  for (std::size_t side = 0; side < 2; ++side) {
    ASSERT_EQ(back.plan.outer[side].size(), request.plan.outer[side].size());
    for (std::size_t i = 0; i < back.plan.outer[side].size(); ++i) {
      EXPECT_TRUE(same(back.plan.outer[side][i], request.plan.outer[side][i]));
    }
  }
  ASSERT_EQ(back.plan.interface.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(same(back.plan.interface[i], request.plan.interface[i]));
    EXPECT_EQ(back.plan.interface[i].kind, request.plan.interface[i].kind);
    EXPECT_EQ(back.plan.interface[i].inclusion, request.plan.interface[i].inclusion);
  }
}

TEST(Codec, ImportRequestComesBack) {
  const mesh::MesherRequest request = mesh::ImportRequest{"a file.msh", 99};
  const auto back = std::get<mesh::ImportRequest>(mesh::decode_request(mesh::encode(request)));
  EXPECT_EQ(back.path, "a file.msh");
  EXPECT_EQ(back.max_triangles, 99U);
}

TEST(Codec, ReplyCarriesWarnings) {
  const mesh::MesherReply reply = small_mesh();
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
  const auto request = [](const Bytes& b) { mesh::decode_request(b); };
  expect_exact(mesh::encode(mesh::MesherRequest(generate_request())), request);
  expect_exact(mesh::encode(mesh::MesherRequest(mesh::ImportRequest{"x.msh", 1})), request);
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/tls.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "errors/errors.hpp"
#include "rpc/details.hpp"
#include "rpc/people.hpp"
#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"
#include "support/certificates.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::Authority;
using anticrack::testing::call;
using anticrack::testing::Context;
using anticrack::testing::Meshes;
using anticrack::testing::named;
using anticrack::testing::paper_mesh;
using anticrack::testing::Pem;
using anticrack::testing::RunningServer;
using anticrack::testing::Settings;

std::shared_ptr<grpc::ChannelCredentials> client(const std::string& root, const Pem& own = {}) {
  return grpc::SslCredentials({root, own.key, own.certificate});
}

/// The status of GetServerInfo on a channel with these credentials.
grpc::Status try_with(RunningServer& server,
                      const std::shared_ptr<grpc::ChannelCredentials>& credentials,
                      const std::string& token = "") {
  const auto stub = v1::ServerService::NewStub(server.channel(credentials));
  Context context(token);
  v1::ServerInfo info;
  return stub->GetServerInfo(&context, {}, &info);
}

TEST(Tls, IsSpokenWithWhoTrustsTheServer) {
  Authority authority;
  Authority stranger;
  RunningServer server([&](Settings& settings) {
    const Pem own = authority.issue("server");
    settings.server.security.tls = Tls{own.certificate, own.key, ""};
    settings.credentials = client(authority.root());
  });
  EXPECT_THAT(server.info().features(), ::testing::Contains("tls"));
  EXPECT_FALSE(server.create(paper_mesh()).name().empty());
  EXPECT_EQ(try_with(server, client(stranger.root())).error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(try_with(server, grpc::InsecureChannelCredentials()).error_code(),
            grpc::StatusCode::UNAVAILABLE);
}

TEST(Tls, MutualTakesTheNameFromTheCertificate) {
  Authority authority;
  Authority stranger;
  RunningServer server([&](Settings& settings) {
    const Pem own = authority.issue("server");
    settings.server.security.tls = Tls{own.certificate, own.key, authority.root()};
    settings.server.security.admins = {"root"};
    settings.credentials = client(authority.root(), authority.issue("ada"));
  });
  const v1::Mesh mesh = server.create(paper_mesh());
  EXPECT_EQ(mesh.owner(), "ada");
  EXPECT_THAT(server.info().features(), ::testing::Contains("tls.mutual"));
  const auto get = [&](const Pem& who) {
    const auto stub = v1::MeshService::NewStub(server.channel(client(authority.root(), who)));
    const auto request = named<v1::GetMeshRequest>(mesh.name());
    return call(*stub, &Meshes::GetMesh, request).error_code();
  };
  EXPECT_EQ(get(authority.issue("ada")), grpc::StatusCode::OK);
  EXPECT_EQ(get(authority.issue("bob")), grpc::StatusCode::NOT_FOUND);
  EXPECT_EQ(get(authority.issue("root")), grpc::StatusCode::OK);
  EXPECT_EQ(get(authority.issue("")), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(get(stranger.issue("ada")), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(get({}), grpc::StatusCode::UNAVAILABLE);
}

TEST(Tls, ATokenDecidesBeforeTheCertificate) {
  Authority authority;
  RunningServer server([&](Settings& settings) {
    const Pem own = authority.issue("server");
    settings.server.security.tls = Tls{own.certificate, own.key, authority.root()};
    settings.server.security.tokens = anticrack::testing::people();
    settings.credentials = client(authority.root(), authority.issue("carol"));
  });
  EXPECT_EQ(server.create(paper_mesh()).owner(), "carol");
  Context context(anticrack::testing::owner_token);
  v1::Mesh mesh;
  EXPECT_TRUE(server.meshes->CreateMesh(&context, paper_mesh(), &mesh).ok());
  EXPECT_EQ(mesh.owner(), "ada");
  const auto credentials = client(authority.root(), authority.issue("carol"));
  EXPECT_EQ(try_with(server, credentials, anticrack::testing::wrong_token).error_code(),
            grpc::StatusCode::UNAUTHENTICATED);
}

/// The field at fault; the message must contain `what`.
std::string field_at_fault(const Tls& tls, const std::string& what) {
  try {
    require_usable(tls);
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.reason(), errors::Reason::invalid_argument);
    EXPECT_THAT(error.what(), ::testing::HasSubstr(what));
    EXPECT_EQ(error.fields().size(), 1u);
    return error.fields().front().field;
  }
  return "none";
}

TEST(Tls, SaysWhichTextIsWrong) {
  Authority authority;
  const Pem good = authority.issue("server");
  const Pem other = authority.issue("server");
  EXPECT_EQ(field_at_fault({good.certificate, good.key, ""}, ""), "none");
  EXPECT_EQ(field_at_fault({good.certificate + authority.root(), good.key, authority.root()}, ""),
            "none");
  EXPECT_EQ(field_at_fault({"", good.key, ""}, "PEM"), "tls-certificate");
  EXPECT_EQ(field_at_fault({good.key, good.key, ""}, "PEM"), "tls-certificate");
  std::string damaged = good.certificate;
  damaged.replace(damaged.size() / 2, 8, "########");
  EXPECT_EQ(field_at_fault({damaged, good.key, ""}, "certificate"), "tls-certificate");
  EXPECT_EQ(field_at_fault({good.certificate + damaged, good.key, ""}, "certificate 2"),
            "tls-certificate");
  EXPECT_EQ(field_at_fault({good.certificate, good.certificate, ""}, "private key"), "tls-key");
  EXPECT_EQ(field_at_fault({good.certificate, "", ""}, "private key"), "tls-key");
  EXPECT_EQ(field_at_fault({good.certificate, other.key, ""}, "another certificate"), "tls-key");
  EXPECT_EQ(field_at_fault({good.certificate, good.key, "roots"}, "PEM"), "tls-client-roots");
  const Pem expired = authority.issue("server", -1);
  EXPECT_EQ(field_at_fault({expired.certificate, expired.key, ""}, "expired"), "tls-certificate");
}

}  // namespace
}  // namespace anticrack::rpc

// SPDX-License-Identifier: GPL-3.0-or-later
//
// TLS, mutual TLS and tokens against gRPC's own server.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/jobs.hpp"
#include "client/lib/scripted_server.hpp"
#include "support/certificates.hpp"

namespace anticrack::client {
namespace {

using anticrack::testing::Authority;
using anticrack::testing::Pem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// What a call says that cannot get through.
std::string complaint(const ConnectionOptions& options) {
  Connection connection(options);
  try {
    create_job(connection, {}, "id");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

class TlsTest : public ::testing::Test {
 protected:
  /// At `host`, trusting `roots`; impatient, for what is wrong stays wrong.
  static ConnectionOptions to(const ScriptedServer& server, const std::string& host,
                              const std::string& roots) {
    ConnectionOptions options = server.options();
    options.address = host + options.address.substr(options.address.rfind(':'));
    options.credentials.tls = true;
    options.credentials.roots = roots;
    options.credentials.files.ca = "ca.pem";
    options.first_contact = std::chrono::milliseconds(0);
    return options;
  }

  Authority _authority;
  // An address: gRPC's resolver of names (c-ares) never frees a few bytes of its own.
  const Pem _server = _authority.issue("server");
};

TEST_F(TlsTest, EncryptsAndBringsTheToken) {
  ScriptedServer server({_server.certificate, _server.key, ""});
  server.creations = {{}};
  ConnectionOptions options = to(server, "127.0.0.1", _authority.root());
  options.credentials.token = "abc";
  EXPECT_EQ(complaint(options), "");
  EXPECT_THAT(server.authorizations(), ElementsAre("Bearer abc"));
}

TEST_F(TlsTest, AnswersToItsOwnAuthorityOnly) {
  ScriptedServer server({_server.certificate, _server.key, ""});
  server.creations = {{}};
  for (const char* name : {"authority of a test", "another"}) {  // the first is its own's name
    EXPECT_THAT(complaint(to(server, "127.0.0.1", Authority(name).root())),
                AllOf(HasSubstr("is not signed by"), HasSubstr("ca.pem")));
  }
  EXPECT_TRUE(server.created().empty());
}

TEST_F(TlsTest, AnswersUnderItsOwnNameOnly) {
  const Pem elsewhere = _authority.issue("elsewhere", 1, "DNS:elsewhere");
  ScriptedServer server({elsewhere.certificate, elsewhere.key, ""});
  server.creations = {{}};
  EXPECT_THAT(complaint(to(server, "127.0.0.1", _authority.root())),
              HasSubstr("is for another name than 127.0.0.1"));
  EXPECT_TRUE(server.created().empty());
}

TEST_F(TlsTest, SaysWhichSideSpeaksNone) {
  ScriptedServer with({_server.certificate, _server.key, ""});
  ConnectionOptions plain = with.options();
  plain.first_contact = std::chrono::milliseconds(0);
  EXPECT_THAT(complaint(plain), HasSubstr("If it wants TLS, add --ca FILE"));

  ScriptedServer without;
  EXPECT_THAT(complaint(to(without, "127.0.0.1", _authority.root())), HasSubstr("speaks no TLS"));
}

TEST_F(TlsTest, ShowsItsOwnCertificateWhereItIsAsked) {
  ScriptedServer server({_server.certificate, _server.key, _authority.root()});
  server.creations = {{}};
  ConnectionOptions options = to(server, "127.0.0.1", _authority.root());
  EXPECT_NE(complaint(options), "");
  EXPECT_TRUE(server.created().empty()) << "nobody without a certificate gets in";

  const Pem mine = _authority.issue("me");
  options.credentials.certificate = mine.certificate;
  options.credentials.key = mine.key;
  EXPECT_EQ(complaint(options), "");
}

TEST(Token, TravelsWithEveryKindOfCall) {
  ScriptedServer server;
  server.creations = {{}};
  server.watches = {{{ended_event(1)}, {}}};
  server.reads = {{{}, {Code::failed_precondition, "not ended"}}};
  ConnectionOptions options = server.options();
  options.credentials.token = "abc";
  Connection connection(options);
  create_job(connection, {}, "id");
  watch_job(connection, "jobs/1", 0, [](const v1::WatchJobResponse&) {});
  EXPECT_THROW(read_result(connection, "jobs/1"), Error);
  EXPECT_THAT(server.authorizations(), ElementsAre("Bearer abc", "Bearer abc", "Bearer abc"));
}

TEST(Token, OfNobodyKnownIsAnErrorThatNamesItsFile) {
  ScriptedServer server;
  server.creations = {{Code::unauthenticated, "this server wants a token"}};
  ConnectionOptions options = server.options();
  EXPECT_THAT(complaint(options), AllOf(HasSubstr("this server wants a token"),
                                        HasSubstr("--token-file"), HasSubstr("ANTICRACK_TOKEN")));
  options.credentials.token = "abc";
  options.credentials.files.token = "my.token";
  EXPECT_THAT(complaint(options),
              AllOf(HasSubstr("check the token in my.token"), Not(HasSubstr("abc"))));
  server.creations = {{Code::permission_denied, "only administrators"}};
  EXPECT_THAT(complaint(options), AllOf(HasSubstr("only administrators"), HasSubstr("my.token")));
}

}  // namespace
}  // namespace anticrack::client

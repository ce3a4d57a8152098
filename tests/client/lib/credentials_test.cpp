// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/credentials.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "client/error.hpp"
#include "support/certificates.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::client {
namespace {

using anticrack::testing::Authority;
using anticrack::testing::Pem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class CredentialsTest : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(_folder / name, std::ios::binary) << text;
    return (_folder / name).string();
  }
  static std::string complaint(const CredentialFiles& files,
                               const std::string& address = "localhost:1") {
    try {
      read_credentials(files, address);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Code::invalid_argument);
      return error.what();
    }
    return "";
  }

 private:
  testing::TemporaryFolder _folder;
};

TEST_F(CredentialsTest, NothingGivenIsNothing) {
  const Credentials none = read_credentials({}, "far.example:7433");
  EXPECT_FALSE(none.tls);
  EXPECT_EQ(none.token, "");
}

TEST_F(CredentialsTest, AnyCertificateMeansTls) {
  Authority authority;
  const Pem mine = authority.issue("me");
  CredentialFiles files;
  files.ca = write("ca.pem", authority.root());
  EXPECT_TRUE(read_credentials(files, "far.example:1").tls);
  files = {};
  files.certificate = write("me.pem", mine.certificate);
  files.key = write("me.key", mine.key);
  EXPECT_TRUE(read_credentials(files, "far.example:1").tls);
  files = {};
  files.tls = true;
  EXPECT_TRUE(read_credentials(files, "far.example:1").tls);
}

TEST_F(CredentialsTest, NamesTheFileThatIsWrong) {
  Authority authority;
  const Pem mine = authority.issue("me");
  CredentialFiles files;
  files.ca = "/nonexistent/ca.pem";
  EXPECT_THAT(complaint(files), AllOf(HasSubstr("--ca"), HasSubstr("/nonexistent/ca.pem")));
  files.ca = write("ca.pem", "no certificate");
  EXPECT_THAT(complaint(files), HasSubstr("ca.pem holds no certificate"));
  files = {};
  files.certificate = write("me.pem", mine.certificate);
  EXPECT_THAT(complaint(files), HasSubstr("--cert needs --key"));
  files.key = write("me.key", mine.certificate);
  EXPECT_THAT(complaint(files), HasSubstr("me.key holds no private key"));
  files.key = write("other.key", authority.issue("other").key);
  EXPECT_THAT(complaint(files), HasSubstr("other.key is not the key of the certificate"));
  files.certificate.clear();
  EXPECT_THAT(complaint(files), HasSubstr("--key needs --cert"));
}

TEST_F(CredentialsTest, ReadsOneTokenFromAFileOrTheEnvironment) {
  CredentialFiles files;
  files.token_text = "from-environment";
  EXPECT_EQ(read_credentials(files, "localhost:1").token, "from-environment");
  files.token = write("token", "abc.DEF-123\n");
  EXPECT_EQ(read_credentials(files, "localhost:1").token, "abc.DEF-123");
  for (const char* bad : {"", "\n", "two words\n", "two\nlines\n", "\x01"}) {
    files.token = write("bad", bad);
    EXPECT_THAT(complaint(files), HasSubstr("bad is not a token")) << bad;
  }
  files = {};
  files.token_text = "two words";
  EXPECT_THAT(complaint(files), AllOf(HasSubstr("ANTICRACK_TOKEN"), Not(HasSubstr("two words"))));
}

TEST_F(CredentialsTest, ATokenCrossesNoNetworkUnencrypted) {
  CredentialFiles files;
  files.token_text = "secret";
  const std::string refusal = complaint(files, "far.example:7433");
  EXPECT_THAT(refusal, AllOf(HasSubstr("far.example:7433"), HasSubstr("--ca")));
  EXPECT_THAT(refusal, Not(HasSubstr("secret")));
  files.tls = true;
  EXPECT_EQ(complaint(files, "far.example:7433"), "");
}

TEST(Loopback, IsWhatDoesNotLeaveTheMachine) {
  for (const char* near : {"localhost:7433", "localhost", "127.0.0.1:1", "127.8.9.1:1", "[::1]:1",
                           "::1", "unix:/run/a", "unix-abstract:a", "ipv4:127.0.0.1:1",
                           "dns:///localhost:1", "ipv6:[::1]:1", "LocalHost:1", "localhost.:1"}) {
    EXPECT_TRUE(is_loopback(near)) << near;
  }
  for (const char* far : {"10.0.0.1:1", "example:7433", "127.evil.example:1", "localhost.example:1",
                          "[::2]:1", "0.0.0.0:1", "", "dns:///far.example:1"}) {
    EXPECT_FALSE(is_loopback(far)) << far;
  }
}

}  // namespace
}  // namespace anticrack::client

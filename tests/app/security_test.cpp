// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/security.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "app/secret_file.hpp"
#include "rpc/tls.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string refusal_of(const std::function<void()>& action) {
  try {
    action();
    return "accepted";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

class Security : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    _folder = std::make_unique<anticrack::testing::TemporaryFolder>();
    for (const char* name : {"a", "b"}) {
      anticrack::testing::Process make({MAKE_CERTIFICATES, *_folder / name});
      ASSERT_EQ(make.wait(), 0) << make.error();
    }
  }
  static void TearDownTestSuite() { _folder.reset(); }

  static std::string path(const std::string& name) { return *_folder / name; }
  static std::string write(const std::string& name, const std::string& content) {
    std::ofstream(path(name)) << content;
    return path(name);
  }
  static Config with_tls() {
    Config config;
    config.tls_certificate = path("a/server.crt");
    config.tls_key = path("a/server.key");
    return config;
  }
  static std::string problem_of(const Config& config) {
    return refusal_of([&] { load_security(config); });
  }

  static std::unique_ptr<anticrack::testing::TemporaryFolder> _folder;
};

std::unique_ptr<anticrack::testing::TemporaryFolder> Security::_folder;

const std::string no_hash(64, '0');

TEST_F(Security, IsNoneByDefault) {
  const LoadedSecurity loaded = load_security({});
  EXPECT_FALSE(loaded.security.tls);
  EXPECT_TRUE(loaded.security.tokens.empty());
  EXPECT_THAT(loaded.warnings, IsEmpty()) << "on loopback there is nothing to warn of";
}

TEST_F(Security, IsReadFromItsFiles) {
  Config config = with_tls();
  config.listen = "0.0.0.0:7433";
  config.tls_client_roots = path("a/ca.crt");
  config.tokens = write("tokens", "ann admin " + no_hash + "\n");
  config.admins = "trial, ops";
  const LoadedSecurity loaded = load_security(config);
  ASSERT_TRUE(loaded.security.tls);
  EXPECT_THAT(loaded.security.tls->certificate, HasSubstr("BEGIN CERTIFICATE"));
  EXPECT_THAT(loaded.security.tls->key, HasSubstr("PRIVATE KEY"));
  EXPECT_THAT(loaded.security.tls->client_roots, HasSubstr("BEGIN CERTIFICATE"));
  EXPECT_FALSE(loaded.security.tokens.empty());
  EXPECT_THAT(loaded.security.admins, ElementsAre("trial", "ops"));
  EXPECT_THAT(loaded.warnings, IsEmpty());
}

TEST_F(Security, WarnsOfWhatIsOpenToStrangers) {
  Config config = with_tls();
  config.listen = "0.0.0.0:7433";
  EXPECT_THAT(load_security(config).warnings, ElementsAre(HasSubstr("is an administrator")));
  Config plain;
  plain.listen = "0.0.0.0:7433";
  plain.tokens = write("tokens", "ann admin " + no_hash + "\n");
  EXPECT_THAT(load_security(plain).warnings, ElementsAre(HasSubstr("nothing is encrypted")));
}

TEST_F(Security, RefusesAKeyOthersCanRead) {
  Config config = with_tls();
  config.tls_key = path("open.key");
  std::filesystem::copy_file(path("a/server.key"), config.tls_key);
  std::filesystem::permissions(config.tls_key, std::filesystem::perms::others_read,
                               std::filesystem::perm_options::add);
  EXPECT_THAT(problem_of(config), HasSubstr("chmod o-rw"));
}

TEST_F(Security, RefusesTokensOthersCanWrite) {
  Config config;
  config.tokens = write("shared-tokens", "ann admin " + no_hash + "\n");
  std::filesystem::permissions(config.tokens, std::filesystem::perms::others_read,
                               std::filesystem::perm_options::add);
  EXPECT_EQ(problem_of(config), "accepted") << "they are hashes";
  std::filesystem::permissions(config.tokens, std::filesystem::perms::others_write,
                               std::filesystem::perm_options::add);
  EXPECT_THAT(problem_of(config), HasSubstr("accessible to every user"));
}

TEST_F(Security, DoesNotTakeAnEmptyFileOfTokensForNoTokens) {
  Config config;
  config.tokens = write("empty", "# nobody yet\n");
  EXPECT_THAT(problem_of(config), HasSubstr("holds no token"));
  config.tokens = write("bad", "\nann king " + no_hash + "\n");
  EXPECT_THAT(problem_of(config), HasSubstr("line 2"));
  config.tokens = path("none");
  EXPECT_THAT(problem_of(config), HasSubstr("cannot be read"));
  config.tokens = write("large", std::string((1 << 20) + 1, '#'));
  EXPECT_THAT(problem_of(config), HasSubstr("1 MiB"));
}

TEST_F(Security, ChecksThatCertificateAndKeyBelongTogether) {
  Config config = with_tls();
  config.tls_key = path("b/server.key");
  EXPECT_THAT(problem_of(config), HasSubstr("tls-key: the key belongs to another certificate"));
  config.tls_key = path("a/server.crt");
  EXPECT_NE(problem_of(config), "accepted");
  config = with_tls();
  config.tls_certificate = path("a/server.key");
  EXPECT_THAT(problem_of(config), HasSubstr("tls-certificate: no certificate in it"));
  config = with_tls();
  config.tls_client_roots = write("roots", "none");
  EXPECT_THAT(problem_of(config), HasSubstr("tls-client-roots: no certificate in it"));
}

/// The certificate of the same key with other dates, which the command openssl refuses to make.
std::string with_end(const std::string& certificate, long seconds_from_now) {
  BIO* in = BIO_new_mem_buf(certificate.data(), static_cast<int>(certificate.size()));
  X509* changed = PEM_read_bio_X509(in, nullptr, nullptr, nullptr);
  X509_gmtime_adj(X509_getm_notAfter(changed), seconds_from_now);
  i2d_re_X509_tbs(changed, nullptr);  // or the encoding of before is written
  BIO* out = BIO_new(BIO_s_mem());
  PEM_write_bio_X509(out, changed);
  char* text = nullptr;
  const long size = BIO_get_mem_data(out, &text);
  std::string result(text, static_cast<std::size_t>(size));
  BIO_free(out);
  X509_free(changed);
  BIO_free(in);
  return result;
}

TEST_F(Security, KnowsWhenACertificateRunsOut) {
  const Config files = with_tls();
  const rpc::Tls tls = *load_security(files).security.tls;
  constexpr long day = 86'400;
  EXPECT_EQ(rpc::check_certificate(with_end(tls.certificate, 5 * day + day / 2), tls.key), 5);
  EXPECT_EQ(rpc::check_certificate(with_end(tls.certificate, day / 2), tls.key), 0);

  Config config = files;
  config.tls_certificate = write("brief.crt", with_end(tls.certificate, 5 * day));
  EXPECT_THAT(load_security(config).warnings, ElementsAre(HasSubstr("expires in")));
  config.tls_certificate = write("old.crt", with_end(tls.certificate, -5 * day));
  EXPECT_THAT(problem_of(config), HasSubstr("tls-certificate: the certificate expired on"));
}

TEST(Names, AreSplitAtCommas) {
  EXPECT_THAT(split_names("ann, bob b ,,c"), ElementsAre("ann", "bob b", "c"));
  EXPECT_THAT(split_names(""), IsEmpty());
}

}  // namespace
}  // namespace anticrack::app

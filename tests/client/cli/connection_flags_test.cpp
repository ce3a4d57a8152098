// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/connection_flags.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "cli/report.hpp"

namespace anticrack::cli {
namespace {

using std::chrono::milliseconds;

TEST(ConnectionFlags, NothingGivenIsTheDefaultServer) {
  const client::ConnectionOptions options = connection_options({}, {});
  EXPECT_EQ(options.address, client::default_address);
  EXPECT_FALSE(options.credentials.tls);
  EXPECT_EQ(options.retry.patience, std::chrono::minutes(5));
  EXPECT_EQ(as_flags({}), "");
}

TEST(ConnectionFlags, PatienceIsAlsoForAServerThatIsNotThereYet) {
  ConnectionFlags flags;
  flags.retry_for = milliseconds(7'000);
  const client::ConnectionOptions options = connection_options(flags, {});
  EXPECT_EQ(options.retry.patience, milliseconds(7'000));
  EXPECT_EQ(options.first_contact, milliseconds(7'000));
}

TEST(ConnectionFlags, TakesTheTokenFromTheEnvironment) {
  ASSERT_EQ(setenv("ANTICRACK_TOKEN", "abc", 1), 0);
  EXPECT_EQ(connection_options({}, {}).credentials.token, "abc");
  ConnectionFlags far;
  far.server = "far.example:7433";
  EXPECT_THROW(connection_options(far, {}), client::Error);
  ASSERT_EQ(unsetenv("ANTICRACK_TOKEN"), 0);
}

TEST(ConnectionFlags, AreToldAgainAsTheyWereGiven) {
  ConnectionFlags flags;
  flags.server = "far.example:7433";
  flags.credentials.ca = "ca.pem";
  flags.credentials.token = "my.token";
  EXPECT_EQ(as_flags(flags), " --server far.example:7433 --ca ca.pem --token-file my.token");
}

TEST(ConnectionFlags, AreToldAsAShellReadsThem) {
  ConnectionFlags flags;
  flags.server = "unix:/tmp/my server/it's $HOME";
  EXPECT_EQ(as_flags(flags), R"( --server 'unix:/tmp/my server/it'\''s $HOME')");
}

TEST(ServerAddress, TakesHostAndPortOrAScheme) {
  for (const char* address : {"localhost:7433", "10.0.0.1:1", "[::1]:65535", "a-b.example:7433",
                              "unix:/run/a.sock", "unix:a.sock", "unix-abstract:a",
                              "dns:///server:7433", "ipv4:127.0.0.1:7433", "ipv6:[::1]:7433"}) {
    EXPECT_NO_THROW(check_server_address(address)) << address;
  }
}

TEST(ServerAddress, RefusesWhatWouldLeadElsewhere) {
  for (const char* address :
       {"localhost", "localhost:", "localhost:0", "localhost:65536", "localhost:74x", ":7433",
        "::1", "[::1]", "http://localhost:7433", "", "/run/a.sock"}) {
    EXPECT_THROW(check_server_address(address), UsageError) << address;
  }
}

}  // namespace
}  // namespace anticrack::cli

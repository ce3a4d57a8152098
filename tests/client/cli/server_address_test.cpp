// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/connection_flags.hpp"

#include <gtest/gtest.h>

#include "cli/report.hpp"

namespace anticrack::cli {
namespace {

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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/descriptors.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace anticrack::app {
namespace {

Config with(int connections) {
  Config config;
  config.limits.connections = connections;
  return config;
}

TEST(Descriptors, LeaveAsManyConnectionsAsThereIsRoomFor) {
  for (const auto& [descriptors, connections] :
       {std::pair{1u << 20, 4096}, {5000u, 4096}, {1024u, 1024 - other_descriptors(with(0))}}) {
    Config config = with(0);
    fit_connections(config, descriptors);
    EXPECT_EQ(config.limits.connections, connections) << descriptors;
  }
}

TEST(Descriptors, KeepWhatIsGiven) {
  Config config = with(10'000);
  fit_connections(config, 20'000);
  EXPECT_EQ(config.limits.connections, 10'000);
}

TEST(Descriptors, AreRefusedWhereTheyDoNotSuffice) {
  for (const int connections : {0, 4096}) {
    Config config = with(connections);
    try {
      fit_connections(config, 256);
      ADD_FAILURE();
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("this process has 256; raise it (ulimit -n "));
    }
  }
}

TEST(Descriptors, LeaveRoomForTransfers) {
  Config config = with(0);
  const int before = other_descriptors(config);
  config.limits.transfers += 100;
  EXPECT_EQ(other_descriptors(config), before + 100);
}

}  // namespace
}  // namespace anticrack::app

// SPDX-License-Identifier: GPL-3.0-or-later
//
// Real servers on a real PostgreSQL.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "service/daemon.hpp"
#include "support/database.hpp"

namespace anticrack::service_test {

constexpr std::uint64_t numbers_of_an_attempt = std::uint64_t{1} << 40U;

class Group : public ::testing::Test {
 protected:
  void SetUp() override { url = database.address(); }

  Daemon& add(std::vector<std::string> more = {}) {
    std::vector<std::string> options{"--store", url, "--threads", "1", "--crashes", "0"};
    options.insert(options.end(), more.begin(), more.end());
    return *servers.emplace_back(std::make_unique<Daemon>(options));
  }

  std::size_t count(const std::string& rows) const {
    return std::stoul(database.sql("SELECT count(*) FROM anticrack." + rows));
  }

  anticrack::testing::Database database;
  std::string url;
  std::vector<std::unique_ptr<Daemon>> servers;
};

}  // namespace anticrack::service_test

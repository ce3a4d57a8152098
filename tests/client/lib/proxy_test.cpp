// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/proxy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

namespace anticrack::client {
namespace {

/// "NAME=VALUE,NAME=VALUE", in whose values ; is a comma.
std::map<std::string, std::string> environment_of(const std::string& text) {
  std::map<std::string, std::string> variables;
  std::istringstream entries(text);
  for (std::string entry; std::getline(entries, entry, ',');) {
    const std::size_t equals = entry.find('=');
    if (equals == std::string::npos) continue;
    std::string value = entry.substr(equals + 1);
    std::ranges::replace(value, ';', ',');
    variables[entry.substr(0, equals)] = value;
  }
  return variables;
}

TEST(Proxy, IsWhatTheEnvironmentSaysUnlessTheServerIsNearOrExempt) {
  std::ifstream table(ANTICRACK_SAME "/proxies.txt");
  std::size_t rows = 0;
  for (std::string line; std::getline(table, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    std::string address, environment, variable, server;
    words >> address >> environment >> variable >> server;
    const auto variables = environment_of(environment);
    const auto proxy = proxy_for(address, [&](const char* name) {
      const auto found = variables.find(name);
      return found == variables.end() ? nullptr : found->second.c_str();
    });
    EXPECT_EQ(proxy ? proxy->variable : "-", variable) << line;
    EXPECT_EQ(proxy ? proxy->server : "", server) << line;
    ++rows;
  }
  EXPECT_GT(rows, 40U);
}

}  // namespace
}  // namespace anticrack::client

// SPDX-License-Identifier: GPL-3.0-or-later
//
// The server's configuration file, read, printed and read again.
#include "app/config_file.hpp"

#include "app/config.hpp"
#include "fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace anticrack;
  std::string printed;
  try {
    const auto settings = app::parse_config(std::string(fuzz::text_of(data, size)), "server.toml");
    printed = app::to_toml(app::make_config(settings, {}));
  } catch (const app::ConfigError&) {
    return 0;
  }
  const auto again = app::make_config(app::parse_config(printed, "printed.toml"), {});
  fuzz::require(app::to_toml(again) == printed, "what was printed reads as another configuration");
  return 0;
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/check_files.hpp"

#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "app/options.hpp"
#include "app/security.hpp"

namespace anticrack::app {
namespace {

namespace fs = std::filesystem;

/// Checks that the folder is writable or, if it does not exist, the one in which it will be made.
void require_writable(const std::string& data) {
  std::error_code code;
  fs::path path = fs::absolute(data).lexically_normal();
  while (path.has_relative_path() && !fs::exists(path, code)) path = path.parent_path();
  const std::string where = "data-dir: " + data + ": ";
  if (!fs::is_directory(path, code))
    throw ConfigError(where + path.string() + " is not a folder; choose another with --data-dir");
  if (::access(path.c_str(), W_OK | X_OK) != 0) {
    throw ConfigError(where + path.string() +
                      " cannot be written: " + std::generic_category().message(errno) +
                      "; give it to the server's user or choose another with --data-dir");
  }
}

}  // namespace

std::vector<std::string> problems_of_files(const Config& config) {
  std::vector<std::string> problems = problems_of_security(config);
  note_problem(problems, [&] { require_writable(config.store.folder); });
  note_problem(problems, [&] { require_mesher(config); });
  return problems;
}

}  // namespace anticrack::app

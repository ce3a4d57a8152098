// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/find_program.hpp"

#include <unistd.h>

#include <cstdlib>
#include <sstream>
#include <system_error>
#include <vector>

namespace anticrack::cli {

namespace fs = std::filesystem;

fs::path this_program() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error);
}

fs::path find_program(const std::string& name, const fs::path& executable,
                      const std::string& search_path) {
  std::vector<fs::path> folders{executable.parent_path()};
  std::istringstream path(search_path);
  for (std::string folder; std::getline(path, folder, ':');)
    folders.emplace_back(folder.empty() ? "." : folder);
  for (const fs::path& folder : folders) {
    fs::path candidate = folder / name;
    std::error_code error;
    if (fs::is_regular_file(candidate, error) && access(candidate.c_str(), X_OK) == 0)
      return candidate;
  }
  return {};
}

fs::path find_program(const std::string& name) {
  const char* search_path = std::getenv("PATH");
  return find_program(name, this_program(), search_path == nullptr ? "" : search_path);
}

}  // namespace anticrack::cli

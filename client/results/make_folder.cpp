// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/make_folder.hpp"

#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "results/error.hpp"

namespace anticrack::results {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) {
    throw Error(folder.string(), "cannot be made a folder" + (error ? ": " + error.message() : ""),
                "choose another folder");
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw Error(folder.string(), std::generic_category().message(errno),
                "make the folder writable, or choose another one");
  }
}

}  // namespace anticrack::results

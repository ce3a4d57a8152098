// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/data_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "app/config.hpp"

namespace anticrack::app {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw ConfigError("data-dir: " + path + ": " + why + "; choose another with --data-dir");
}

/// Like mkdir -p with mode 0700 for every folder it makes.
void make_private(const std::filesystem::path& path) {
  if (path.empty() || std::filesystem::is_directory(path)) return;
  make_private(path.parent_path());
  if (::mkdir(path.c_str(), 0700) != 0 && errno != EEXIST)
    refuse(path, std::generic_category().message(errno));
}

int open_lock(const std::string& path) {
  make_private(std::filesystem::absolute(path).lexically_normal());
  const int lock =
      ::open((path + "/lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (lock < 0) refuse(path, "cannot be written: " + std::generic_category().message(errno));
  return lock;
}

}  // namespace

DataFolder::DataFolder(const std::string& path) : _lock(open_lock(path)) {
  if (::flock(_lock.get(), LOCK_EX | LOCK_NB) != 0) refuse(path, "another anticrackd uses it");
}

}  // namespace anticrack::app

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

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw ConfigError("data-dir: " + path + ": " + why + "; choose another with --data-dir");
}

/// Like mkdir -p, with mode 0700 for every folder that it makes.
void make_private(const fs::path& path) {
  std::error_code ignored;
  if (path.empty() || fs::is_directory(path, ignored)) return;
  make_private(path.parent_path());
  if (::mkdir(path.c_str(), 0700) == 0) return;
  if (errno != EEXIST) refuse(path, std::generic_category().message(errno));
  if (fs::is_directory(path, ignored)) return;  // another process has just made it
  refuse(path,
         fs::is_symlink(path, ignored) ? "a symbolic link to what is not there" : "not a folder");
}

fs::path absolute(const std::string& path) {
  std::error_code problem;
  const fs::path whole = fs::absolute(path, problem);
  if (problem)
    refuse(path, "the folder in which the server was started is gone; start it in another one");
  return whole.lexically_normal();
}

int open_lock(const std::string& path) {
  make_private(absolute(path));
  const int lock =
      ::open((path + "/lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (lock < 0) refuse(path, "cannot be written: " + std::generic_category().message(errno));
  return lock;
}

}  // namespace

DataFolder::DataFolder(const std::string& path) : _lock(open_lock(path)) {
  if (::flock(_lock.get(), LOCK_EX | LOCK_NB) == 0) return;
  if (errno == EWOULDBLOCK) refuse(path, "another anticrackd uses it");
  refuse(path, "its file system cannot lock files: " + std::generic_category().message(errno) +
                   "; the server needs a local one");
}

}  // namespace anticrack::app

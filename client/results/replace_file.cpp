// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/replace_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "results/error.hpp"
#include "results/file.hpp"

namespace anticrack::results {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error) {
  const char* cure = "choose another path with -o";
  if (error == ENOSPC || error == EDQUOT) cure = "free space there, or choose another path with -o";
  if (error == EACCES || error == EPERM || error == EROFS)
    cure = "make the folder writable, or choose another path with -o";
  if (error == ENOENT) cure = "create the folder first, or choose another path with -o";
  throw Error(path.string(), what + ": " + std::generic_category().message(error), cure);
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// A new file beside `path`, removed unless it was renamed to it.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& path) : _target(path) {
    // O_EXCL with an own name instead of mkstemp: the file gets the permissions of the umask.
    static std::atomic<unsigned> counter{0};
    do {
      _name = folder_of(path) / ("." + std::to_string(getpid()) + "-" +
                                 std::to_string(counter.fetch_add(1)) + ".anticrack-partial");
      _descriptor = open(_name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (_descriptor < 0 && errno == EEXIST);
    if (_descriptor < 0) fail(path, "cannot create a file in this folder", errno);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (_descriptor >= 0) close(_descriptor);
    if (!_renamed) unlink(_name.c_str());
  }

  void write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(_descriptor, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(_target, "cannot be written", errno);
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
  }

  void rename_to_target() {
    if (fsync(_descriptor) != 0) fail(_target, "cannot be written", errno);
    if (close(std::exchange(_descriptor, -1)) != 0) fail(_target, "cannot be written", errno);
    if (rename(_name.c_str(), _target.c_str()) != 0) fail(_target, "cannot be replaced", errno);
    _renamed = true;
    // The rename must reach the disk too. Not every file system can fsync a folder; the file is
    // complete either way.
    const int folder = open(folder_of(_target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder >= 0) {
      fsync(folder);
      close(folder);
    }
  }

 private:
  fs::path _target, _name;
  int _descriptor = -1;
  bool _renamed = false;
};

}  // namespace

void check_writable(const fs::path& path) {
  struct stat status {};
  if (path.filename().empty() || path.filename() == "." || path.filename() == "..")
    throw Error(path.string(), "is a folder", "name a file with -o");
  if (stat(path.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) throw Error(path.string(), "is a folder", "name a file with -o");
    if (!S_ISREG(status.st_mode))
      throw Error(path.string(), "is not a regular file", "choose another path with -o");
    if (access(path.c_str(), W_OK) != 0) fail(path, "may not be replaced", errno);
    if (fs::is_directory(backup_of(path)))
      throw Error(backup_of(path).string(), "is a folder, and a former result is kept by this name",
                  "choose another path with -o");
  } else if (errno != ENOENT) {
    fail(path, "cannot be written", errno);
  }
  TemporaryFile{path};
}

fs::path backup_of(const fs::path& path) {
  fs::path backup = path;
  return backup += "~";
}

void replace_file(const fs::path& path, std::span<const std::byte> bytes, bool keep) {
  TemporaryFile file(path);
  file.write(bytes);
  if (keep) {
    const fs::path backup = backup_of(path);
    unlink(backup.c_str());
    // A second name, so that the first is never without a file; not every file system has them.
    if (link(path.c_str(), backup.c_str()) != 0 && rename(path.c_str(), backup.c_str()) != 0)
      fail(path, "cannot be kept as " + backup.string(), errno);
  }
  file.rename_to_target();
}

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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "output/standard.hpp"

namespace anticrack::output {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error) {
  const char* cure = "choose another path with -o";
  if (error == ENOSPC || error == EDQUOT) cure = "free space there, or choose another path with -o";
  if (error == EFBIG) cure = "raise the limit of a file's size (ulimit -f)";
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
    // O_EXCL with an own name instead of mkstemp: so the file gets the permissions of the umask.
    static std::atomic<unsigned> counter{0};
    do {
      _name =
          folder_of(path) / fmt::format(".{}-{}.anticrack-partial", getpid(), counter.fetch_add(1));
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

  /// Writes the bytes and takes the permissions of the file that it replaces.
  void write(std::span<const std::byte> bytes) {
    struct stat former {};
    if (stat(_target.c_str(), &former) == 0) fchmod(_descriptor, former.st_mode & 0777);
    if (const int error = write_all(_descriptor, bytes)) fail(_target, "cannot be written", error);
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

/// The N of /dev/fd/N and /proc/self/fd/N, whose links lead to names that may not be those of the
/// open file.
std::optional<int> descriptor_named(const fs::path& path) {
  std::error_code none;
  if (!fs::equivalent(path.has_parent_path() ? path.parent_path() : fs::path("."), "/proc/self/fd",
                      none) ||
      none)
    return std::nullopt;
  const std::string name = path.filename();
  int number = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size() || fcntl(number, F_GETFD) < 0)
    return std::nullopt;
  return number;
}

bool is_terminal(const fs::path& path) {
  const int descriptor = open(path.c_str(), O_WRONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool terminal = isatty(descriptor) == 1;
  close(descriptor);
  return terminal;
}

/// The descriptor of standard output or standard error if one of them is this file, else -1. A
/// device such as /dev/null counts as a stream of its own.
int standard_stream(const struct stat& file, const fs::path& path) {
  if (S_ISCHR(file.st_mode) && !is_terminal(path)) return -1;
  for (const int number : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat own {};
    if (fstat(number, &own) == 0 && own.st_dev == file.st_dev && own.st_ino == file.st_ino)
      return number;
  }
  return -1;
}

Target target_behind(const fs::path& given, const fs::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) {
    if (errno != ENOENT && errno != ENOTDIR) fail(given, "cannot be written", errno);
    return {Target::Kind::file, path};
  }
  if (S_ISDIR(status.st_mode)) return {Target::Kind::folder, path};
  if (S_ISBLK(status.st_mode)) throw Error(given.string(), "is a disk", "choose another path");
  if (S_ISSOCK(status.st_mode)) throw Error(given.string(), "is a socket", "choose another path");
  const int number = standard_stream(status, path);
  if (number >= 0 || !S_ISREG(status.st_mode)) return {Target::Kind::stream, path, number};
  return {Target::Kind::file, path};
}

void write_stream(const fs::path& path, const Target& target, std::span<const std::byte> bytes) {
  if (target.is_standard_output()) return print(bytes);
  const int descriptor = target.descriptor >= 0 ? dup(target.descriptor)
                                                : open(target.path.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) fail(path, "cannot be written", errno);
  const int error = write_all(descriptor, bytes);
  const int late = close(descriptor) == 0 ? 0 : errno;
  if (error != 0 || late != 0) fail(path, "cannot be written", error != 0 ? error : late);
}

}  // namespace

Target target_of(const fs::path& given) {
  if (given == "-") return {Target::Kind::stream, given, STDOUT_FILENO};
  constexpr int most_links = 40;  // the kernel's limit
  fs::path path = given;
  for (int links = 0; links <= most_links; ++links) {
    if (const auto number = descriptor_named(path)) return {Target::Kind::stream, path, *number};
    std::error_code error;
    const fs::path next = fs::read_symlink(path, error);
    if (error) return target_behind(given, path);  // it is no link
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  fail(given, "cannot be written", ELOOP);
}

fs::path backup_of(const fs::path& path) {
  fs::path backup = path;
  return backup += "~";
}

void check_writable(const fs::path& path) {
  const fs::path name = path.filename();
  const bool named = !name.empty() && name != "." && name != "..";
  const Target target = named ? target_of(path) : Target{Target::Kind::folder, path};
  if (target.kind == Target::Kind::folder)
    throw Error(path.string(), "is a folder", "name a file with -o");
  if (target.descriptor >= 0) return;
  if (access(target.path.c_str(), W_OK) != 0 && errno != ENOENT)
    fail(path, "cannot be written", errno);
  if (target.kind == Target::Kind::stream) return;
  if (fs::is_directory(backup_of(target.path)))
    throw Error(backup_of(target.path).string(),
                "is a folder, and a former result is kept by this name",
                "choose another path with -o");
  TemporaryFile{target.path};
}

void write_file(const fs::path& path, std::span<const std::byte> bytes, bool keep) {
  const Target target = target_of(path);
  if (target.kind == Target::Kind::stream) return write_stream(path, target, bytes);
  if (target.kind == Target::Kind::folder) fail(path, "cannot be written", EISDIR);
  TemporaryFile file(target.path);
  file.write(bytes);
  if (keep) {
    const fs::path backup = backup_of(target.path);
    unlink(backup.c_str());
    // A hard link, so that the first name always has a file; not every file system has hard links.
    if (link(target.path.c_str(), backup.c_str()) != 0 &&
        rename(target.path.c_str(), backup.c_str()) != 0)
      fail(path, "cannot be kept as " + backup.string(), errno);
  }
  file.rename_to_target();
}

void write_file(const fs::path& path, std::string_view text) {
  write_file(path, std::as_bytes(std::span(text)));
}

void make_folder(const fs::path& folder) {
  if (folder == "-")
    throw Error("-", "is standard output, and several files are to be written", "name a folder");
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

}  // namespace anticrack::output

// SPDX-License-Identifier: GPL-3.0-or-later

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <optional>
#include <string>
#include <system_error>

#include "output/file.hpp"

namespace anticrack::output {
namespace {

namespace fs = std::filesystem;

const char* const other_path = "choose another path";

[[noreturn]] void cannot_write(const fs::path& path, int error) {
  throw Error(path.string(), "cannot be written: " + std::generic_category().message(error),
              other_path);
}

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
    if (errno != ENOENT && errno != ENOTDIR) cannot_write(given, errno);
    return {Target::Kind::file, path};
  }
  if (S_ISDIR(status.st_mode)) return {Target::Kind::folder, path};
  if (S_ISBLK(status.st_mode)) throw Error(given.string(), "is a disk", other_path);
  if (S_ISSOCK(status.st_mode)) throw Error(given.string(), "is a socket", other_path);
  const int number = standard_stream(status, path);
  if (number >= 0 || !S_ISREG(status.st_mode)) return {Target::Kind::stream, path, number};
  return {Target::Kind::file, path};
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
  cannot_write(given, ELOOP);
}

}  // namespace anticrack::output

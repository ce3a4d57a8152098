// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/uploads.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <vector>

#include "errors/errors.hpp"

namespace anticrack::store {

namespace {

namespace fs = std::filesystem;
using errors::Error;
using errors::Reason;

constexpr std::string_view part_prefix = "part-";

Error refused(const std::string& what, const fs::path& path, const std::error_code& code) {
  return {Reason::storage, "cannot " + what + " " + path.string() + ": " + code.message() +
                               "; check that the data folder exists, is writable and has space"};
}

std::error_code last_error() {
  return {errno, std::generic_category()};
}

/// A hash becomes part of a path: nothing but its own digits may pass.
bool is_sha256(const std::string& text) {
  return text.size() == 64 && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

void flush(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) {
    throw refused("open", path, last_error());
  }
  const int result = ::fsync(file);
  const std::error_code code = last_error();
  ::close(file);
  if (result != 0) {
    throw refused("flush", path, code);
  }
}

}  // namespace

Uploads::Uploads(fs::path folder) : _folder(std::move(folder)) {
  std::error_code code;
  fs::create_directories(_folder, code);
  if (code) {
    throw refused("make the folder", _folder, code);
  }
  std::vector<fs::path> left_over;
  for (fs::directory_iterator entry(_folder, code), end; !code && entry != end;
       entry.increment(code)) {
    if (entry->path().filename().string().starts_with(part_prefix)) {
      left_over.push_back(entry->path());
    }
  }
  if (code) {
    throw refused("list", _folder, code);
  }
  for (const fs::path& path : left_over) {
    fs::remove(path, code);
    if (code) {
      throw refused("remove", path, code);
    }
  }
  fs::remove(new_part(), code);  // a folder that cannot be written shows now, not in an upload
}

std::optional<std::string> Uploads::path(const std::string& sha256) const {
  std::error_code code;
  if (!is_sha256(sha256) || !fs::is_regular_file(_folder / sha256, code)) {
    return std::nullopt;
  }
  return (_folder / sha256).string();
}

std::string Uploads::new_part() const {
  std::string path = (_folder / part_prefix).string() + "XXXXXX";
  const int file = ::mkostemp(path.data(), O_CLOEXEC);
  if (file < 0) {
    throw refused("make a file in", _folder, last_error());
  }
  ::close(file);
  return path;
}

void Uploads::keep(const std::string& part, const std::string& sha256) const {
  if (!is_sha256(sha256)) {
    throw Error(Reason::invalid_argument,
                "\"" + sha256 + "\" is no sha256: give its 64 lower-case hexadecimal digits");
  }
  flush(part);
  std::error_code code;
  fs::rename(part, _folder / sha256, code);
  if (code) {
    throw refused("rename", part, code);
  }
  flush(_folder);
}

}  // namespace anticrack::store

// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/helpers.hpp"
#include "digest/digest.hpp"
#include "stop/stop.hpp"
#include "store/disk_errors.hpp"
#include "store/store.hpp"

namespace anticrack::store {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view part_prefix = "part-";

constexpr std::size_t copy_bytes = std::size_t{1} << 20U;

void flush_file(const base::Descriptor& file, const std::string& path) {
  if (::fsync(file.get()) != 0) throw disk_error("flush " + path, errno);
}

}  // namespace

std::string database_path(const std::string& data) { return data + "/anticrack.db"; }

std::string folder_of(const std::string& data, FileKind kind) {
  constexpr std::array names{"/meshes", "/results", "/uploads"};
  return data + names[static_cast<std::size_t>(kind)];
}

std::vector<std::string> file_names(const std::string& folder) {
  std::error_code code;
  std::vector<std::string> names;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end;
       entry.increment(code))
    if (std::string name = entry->path().filename().string(); digest::is_sha256(name))
      names.push_back(std::move(name));
  if (code && code != std::errc::no_such_file_or_directory)
    throw disk_error("list " + folder, code.value());
  return names;
}

void make_folder(const std::string& path) {
  std::error_code code;
  if (fs::is_directory(path, code)) return;
  const fs::path parent = fs::absolute(path).parent_path();
  fs::create_directories(parent, code);
  if (code || (::mkdir(path.c_str(), S_IRWXU) != 0 && errno != EEXIST))
    throw disk_error("make the folder " + path, code ? code.value() : errno);
  flush(parent.string());
}

void flush(const std::string& path) {
  const base::Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file) throw disk_error("flush " + path, errno);
  flush_file(file, path);
}

void flush_all(const std::vector<std::string>& paths) {
  constexpr std::size_t most_at_once = 16;
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::optional<errors::Error> failure;
  const std::function<void()> work = [&] {
    for (std::size_t i = next++; i < paths.size(); i = next++) {
      try {
        flush(paths[i]);
      } catch (const errors::Error& error) {
        const std::lock_guard lock(mutex);
        failure = error;
      }
    }
  };
  {
    const base::Helpers others(static_cast<int>(std::min(paths.size(), most_at_once)) - 1, work);
    work();
  }
  if (failure) throw errors::Error(*failure);
}

std::optional<std::uint64_t> file_size(const std::string& path) noexcept {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return static_cast<std::uint64_t>(status.st_size);
}

base::Descriptor open_to_read(const std::string& path) {
  base::Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file && errno != ENOENT) throw disk_error("open " + path, errno);
  return file;
}

base::Descriptor open_to_write(const std::string& path) {
  base::Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (!file) throw disk_error("open " + path, errno);
  return file;
}

std::uint64_t file_size(const base::Descriptor& file, const std::string& path) {
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) throw disk_error("read " + path, errno);
  return static_cast<std::uint64_t>(status.st_size);
}

void read_at(const base::Descriptor& file, const std::string& path, std::uint64_t offset,
             std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count =
        ::pread(file.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count == 0) {
      throw errors::Error(errors::Reason::storage,
                          "{} is cut off: restore the data folder from a backup", path);
    }
    if (count < 0 && errno != EINTR) throw disk_error("read " + path, errno);
    const auto done = static_cast<std::size_t>(std::max<ssize_t>(count, 0));
    offset += done;
    bytes = bytes.subspan(done);
  }
}

void write_at(const base::Descriptor& file, const std::string& path, std::uint64_t offset,
              std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count =
        ::pwrite(file.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno != EINTR) throw disk_error("write " + path, errno);
    const auto done = static_cast<std::size_t>(std::max<ssize_t>(count, 0));
    offset += done;
    bytes = bytes.subspan(done);
  }
}

std::optional<std::vector<std::byte>> read_file(const std::string& path) {
  const base::Descriptor file = open_to_read(path);
  if (!file) return std::nullopt;
  std::vector<std::byte> bytes(static_cast<std::size_t>(file_size(file, path)));
  read_at(file, path, 0, bytes);
  return bytes;
}

std::string sha256_of(const std::string& path) {
  const base::Descriptor file = open_to_read(path);
  return file ? digest::sha256_of(file_size(file, path),
                                  [&](std::uint64_t offset, std::span<std::byte> bytes) {
                                    stop::look("reading a file");
                                    read_at(file, path, offset, bytes);
                                  })
              : std::string();
}

std::string sha256_of(std::span<const std::byte> bytes) {
  constexpr std::size_t piece = std::size_t{1} << 20U;
  digest::Sha256 hash;
  while (!bytes.empty()) {
    stop::look("hashing a mesh");
    hash.add(bytes.first(std::min(piece, bytes.size())));
    bytes = bytes.subspan(std::min(piece, bytes.size()));
  }
  return hash.finish();
}

std::string require_upload(const Store& store, const std::string& sha256,
                           const std::string& owner) {
  if (std::optional<std::string> path = store.upload_path(sha256, owner)) return std::move(*path);
  throw errors::Error(errors::Reason::not_found, "there is no uploads/{}; upload it first", sha256);
}

void require_intact_upload(const std::string& path, const std::string& sha256) {
  if (sha256_of(path) != sha256) {
    throw errors::Error(errors::Reason::storage,
                        "uploads/{} is damaged or gone from the disk: upload it again", sha256);
  }
}

void replace_file(const std::string& path, std::span<const std::byte> bytes) {
  const std::string made = path + ".new";
  {
    const base::Descriptor file(
        ::open(made.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, S_IRUSR | S_IWUSR));
    if (!file) throw disk_error("make " + made, errno);
    write_at(file, made, 0, bytes);
    flush_file(file, made);
  }
  if (::rename(made.c_str(), path.c_str()) != 0) throw disk_error("rename " + made, errno);
  flush(fs::path(path).parent_path().string());
}

Part::~Part() {
  if (!_path.empty()) ::unlink(_path.c_str());  // if this fails, the next start does it
}

Files::Files(const std::string& data, FileKind kind, DiskUsage& usage)
    : _folder(folder_of(data, kind)), _kind(kind), _usage(usage) {
  make_folder(_folder);
}

bool Files::is_part(const std::string& path) const {
  return path.starts_with(_folder + "/" + std::string(part_prefix)) &&
         path.find('/', _folder.size() + 1) == std::string::npos;
}

std::string Files::new_part() const {
  std::string path = _folder + "/" + std::string(part_prefix) + "XXXXXX";
  if (!base::Descriptor(::mkostemp(path.data(), O_CLOEXEC)))
    throw disk_error("make a file in " + _folder, errno);
  return path;
}

base::Descriptor Files::nameless() const {
  const Part part(new_part());
  base::Descriptor file(::open(part.path().c_str(), O_RDWR | O_CLOEXEC));
  if (!file) throw disk_error("open " + part.path(), errno);
  return file;
}

Part Files::write(std::span<const std::byte> start, std::uint64_t size, const Read& read) const {
  Part part(new_part());
  const base::Descriptor file = open_to_write(part.path());
  write_at(file, part.path(), 0, start);
  std::vector<std::byte> buffer(
      static_cast<std::size_t>(std::min<std::uint64_t>(copy_bytes, size)));
  for (std::uint64_t offset = 0; offset < size; offset += buffer.size()) {
    buffer.resize(static_cast<std::size_t>(std::min<std::uint64_t>(copy_bytes, size - offset)));
    read(offset, buffer);
    write_at(file, part.path(), start.size() + offset, buffer);
  }
  flush_file(file, part.path());
  return part;
}

Part Files::copy(const std::string& original) const {
  const base::Descriptor from = open_to_read(original);
  if (!from) throw disk_error("read " + original, ENOENT);
  return write({}, file_size(from, original),
               [&](std::uint64_t offset, std::span<std::byte> bytes) {
                 read_at(from, original, offset, bytes);
               });
}

void Files::rename(const std::string& part, const std::string& sha256) {
  const std::string final_path = path(sha256);
  const std::uint64_t replaced = file_size(final_path).value_or(0);
  const std::uint64_t bytes = file_size(part).value_or(0);
  if (::rename(part.c_str(), final_path.c_str()) != 0) throw disk_error("rename " + part, errno);
  _usage.add(_kind, bytes);
  _usage.remove(_kind, replaced);
}

void Files::link(const std::string& part, const std::string& sha256) {
  if (::link(part.c_str(), path(sha256).c_str()) == 0)
    _usage.add(_kind, file_size(part).value_or(0));
  else if (errno != EEXIST)
    throw disk_error("link " + part, errno);
}

void Files::remove(const std::string& sha256) {
  const std::optional<std::uint64_t> bytes = file_size(path(sha256));
  if (!bytes) return;
  if (::unlink(path(sha256).c_str()) != 0) throw disk_error("remove " + path(sha256), errno);
  _usage.remove(_kind, *bytes);
}

std::vector<std::string> Files::sweep(
    const std::function<bool(const std::string& sha256)>& wanted) {
  std::error_code code;
  std::vector<std::string> parts;
  std::vector<std::string> unwanted;
  for (fs::directory_iterator entry(_folder, code), end; !code && entry != end;
       entry.increment(code)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(part_prefix)) {
      parts.push_back(name);
      continue;
    }
    _usage.add(_kind, file_size(entry->path().string()).value_or(0));
    if (digest::is_sha256(name) && !wanted(name)) unwanted.push_back(name);
  }
  if (code) throw disk_error("list " + _folder, code.value());
  for (const std::string& name : parts)
    if (::unlink(path(name).c_str()) != 0 && errno != ENOENT)
      throw disk_error("remove " + path(name), errno);
  return unwanted;
}

}  // namespace anticrack::store

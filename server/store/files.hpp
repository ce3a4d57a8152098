// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files in one folder, each named by its sha256. "part-XXXXXX" is a file that is being written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/descriptor.hpp"
#include "store/disk_usage.hpp"

namespace anticrack::store {

class Store;

/// The paths, in a data folder, of its database and of the folder for files of a kind.
std::string database_path(const std::string& data);
std::string folder_of(const std::string& data, FileKind kind);
/// The files in a folder whose names are a sha256; none if there is no folder. Throws as disk_error
/// does.
std::vector<std::string> file_names(const std::string& folder);

/// Makes the folder if it is missing, accessible to its owner only. Throws errors::Error (storage).
void make_folder(const std::string& path);
/// Flushes a file, or the names in a folder, to the disk. Throws as disk_error does.
void flush(const std::string& path);
/// Flushes files in parallel: a disk flushes several files in little more time than one. Throws as
/// flush does, when all have been tried.
void flush_all(const std::vector<std::string>& paths);
std::optional<std::uint64_t> file_size(const std::string& path) noexcept;

/// Opens a file for reading; empty if there is no such file. Throws as disk_error does.
base::Descriptor open_to_read(const std::string& path);
/// Opens a file that is there for writing. Throws as disk_error does.
base::Descriptor open_to_write(const std::string& path);
/// The size of a file in bytes. Throws as disk_error does.
std::uint64_t file_size(const base::Descriptor& file, const std::string& path);
/// Fills `bytes` from `offset` on. Throws errors::Error (storage), also if the file is shorter.
void read_at(const base::Descriptor& file, const std::string& path, std::uint64_t offset,
             std::span<std::byte> bytes);
/// Writes from `offset` on. Throws as disk_error does.
void write_at(const base::Descriptor& file, const std::string& path, std::uint64_t offset,
              std::span<const std::byte> bytes);
/// The whole file; none if there is no such file.
std::optional<std::vector<std::byte>> read_file(const std::string& path);
/// The hash of a file's content; empty if there is no such file. Throws as read_at does.
std::string sha256_of(const std::string& path);
/// The hash of bytes in memory. Both functions look at the stop token (stop/stop.hpp).
std::string sha256_of(std::span<const std::byte> bytes);
/// The path of an upload of `owner`. Throws errors::Error (not_found).
std::string require_upload(const Store& store, const std::string& sha256, const std::string& owner);
/// Reads the file. Throws errors::Error (storage) if its content no longer has the hash `sha256`.
void require_intact_upload(const std::string& path, const std::string& sha256);
/// Makes the file or replaces its content, on the disk, all or nothing. Throws as disk_error does.
void replace_file(const std::string& path, std::span<const std::byte> bytes);

/// A file with a temporary name, removed at the end of the scope unless it has got its final name.
class Part {
 public:
  explicit Part(std::string path) : _path(std::move(path)) {}
  ~Part();
  Part(Part&& other) noexcept : _path(std::move(other._path)) { other._path.clear(); }
  Part& operator=(Part&&) = delete;
  const std::string& path() const noexcept { return _path; }
  /// Keeps the file where it is.
  void release() noexcept { _path.clear(); }

 private:
  std::string _path;
};

/// Any thread may write parts; names are given and taken by one thread at a time.
class Files {
 public:
  using Read = std::function<void(std::uint64_t offset, std::span<std::byte> bytes)>;

  /// Counts files that are added and removed in `usage`, under `kind`.
  Files(const std::string& data, FileKind kind, DiskUsage& usage);

  /// The path of the file with this name, whether it exists or not.
  std::string path(const std::string& sha256) const { return _folder + "/" + sha256; }
  /// The names of the files. Throws as disk_error does.
  std::vector<std::string> names() const { return file_names(_folder); }
  /// Whether a path is one that new_part() gives.
  bool is_part(const std::string& path) const;
  /// A new empty file.
  std::string new_part() const;
  /// An empty file without a name, to write and read; it disappears when it is closed.
  base::Descriptor nameless() const;
  /// Writes a new file with these bytes to the disk. Throws as disk_error does.
  Part write(std::span<const std::byte> bytes) const { return write(bytes, 0, {}); }
  /// The same, with the `size` bytes that read(offset, bytes) gives after `start`.
  Part write(std::span<const std::byte> start, std::uint64_t size, const Read& read) const;
  /// Copies a part, on the disk.
  Part copy(const std::string& part) const;
  /// Gives a part its name; a file that had the name before has the same content. Not flushed.
  void rename(const std::string& part, const std::string& sha256);
  /// The same, but the part stays.
  void link(const std::string& part, const std::string& sha256);
  /// Flushes names that were given.
  void flush_names() const { flush(_folder); }
  /// Removes a file, if it exists. Throws as disk_error does.
  void remove(const std::string& sha256);
  /// Removes parts, counts the bytes of the other files and returns those that are not `wanted`.
  std::vector<std::string> sweep(const std::function<bool(const std::string& sha256)>& wanted);

 private:
  std::string _folder;
  FileKind _kind;
  DiskUsage& _usage;
};

}  // namespace anticrack::store

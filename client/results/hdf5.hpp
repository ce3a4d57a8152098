// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the result file needs of HDF5's C API: owned handles, and attributes and datasets of
// numbers and UTF-8 text. Functions throw Fault without the path, which their callers add.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "results/value_type.hpp"

namespace anticrack::results::hdf5 {

class Fault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An HDF5 identifier, closed once.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  /// Throws Fault(`what`) if `id` is an error.
  Handle(hid_t id, Close close, const std::string& what) : _id(id), _close(close) {
    if (id < 0) throw Fault(what);
  }
  Handle(Handle&& other) noexcept : _id(std::exchange(other._id, -1)), _close(other._close) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (_id >= 0) _close(_id);
  }

  /// Still owned by the handle; below 0: none.
  hid_t get() const noexcept { return _id; }
  /// Gives it up without closing it.
  hid_t release() noexcept { return std::exchange(_id, -1); }
  /// Closes it now; throws Fault(`what`) where the destructor would ignore an error.
  void close_now(const std::string& what) {
    if (_close(std::exchange(_id, -1)) < 0) throw Fault(what);
  }

 private:
  hid_t _id;
  Close _close;
};

/// Keeps HDF5 from printing its error stack until the end of the scope.
class Quiet {
 public:
  /// Silences it.
  Quiet();
  ~Quiet();
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t _function = nullptr;
  void* _data = nullptr;
};

inline constexpr std::size_t any_columns = static_cast<std::size_t>(-1);

/// What a dataset of n rows has in each: its shape is (n) for 0 columns, else (n, columns), and
/// with a depth above 1 (n, columns, depth).
struct Row {
  std::size_t columns = 0;
  std::size_t depth = 1;

  /// Of the dataset.
  int rank() const noexcept { return columns == 0 ? 1 : depth == 1 ? 2 : 3; }
  /// Entries of one.
  std::size_t width() const noexcept { return columns == 0 ? 1 : columns * depth; }
};

// Writing.

/// The bytes of an HDF5 file (format 1.10) that `fill` writes into, given its root group. Made in
/// memory: a full disk while HDF5 closes a file makes it crash when the program ends.
std::vector<std::byte> file_image(const std::function<void(const Handle& root)>& fill);

/// Creation properties of a class, without times: the same result gives the same bytes.
Handle without_times(hid_t property_class);
Handle create_group(const Handle& parent, const std::string& name);

/// An attribute of one value or, with `count`, a list. `values` are doubles, int32 or std::string.
void put_attribute(const Handle& object, const std::string& name, ValueType type,
                   const void* values, std::optional<std::size_t> count = {});
template <class T>
void put(const Handle& object, const std::string& attribute, const T& value) {
  put_attribute(object, attribute, value_type<T>, &value);
}
inline void put(const Handle& object, const std::string& attribute,
                const std::vector<std::string>& texts) {
  put_attribute(object, attribute, ValueType::text, texts.data(), texts.size());
}

/// Dataset of `count` values. Numbers carry a checksum; large datasets are compressed. An empty
/// unit is that of the case. Returned for further attributes.
Handle put_array(const Handle& group, const std::string& name, ValueType type, const void* values,
                 std::size_t count, const Row& row, const std::string& unit = "-");

// Reading. Only hard links are followed and only data inside the file is read, so a file from
// elsewhere cannot pull in others.

/// The root group of a file. Throws Error with `cure` where there is no HDF5 file, Fault where it
/// is damaged.
Handle open_root(const std::filesystem::path& path, const std::string& cure);
/// The largest number of bytes a dataset of the file can take in memory.
std::uint64_t memory_budget(const std::filesystem::path& path);

bool has(const Handle& group, const std::string& name);
bool has_attribute(const Handle& object, const std::string& name);
Handle open_group(const Handle& parent, const std::string& name);
std::vector<std::string> names_in(const Handle& group);
/// The first ten names, separated by commas.
std::string listed(const std::vector<std::string>& names);

/// An attribute of one value: double, int32 or std::string.
void get_attribute(const Handle& object, const std::string& name, ValueType type, void* value);
template <class T>
void get(const Handle& object, const std::string& attribute, T& value) {
  get_attribute(object, attribute, value_type<T>, &value);
}
/// A list of at most `most` texts.
void get(const Handle& object, const std::string& attribute, std::vector<std::string>& texts,
         std::uint64_t most = 1'000'000);

/// A dataset to be read; its shape is known.
struct Dataset {
  Handle id;
  std::string name;
  ValueType type;
  std::size_t rows;
  std::size_t columns;  ///< entries in a row; 1 for one dimension

  /// Entries in total.
  std::size_t count() const { return rows * columns; }
};
/// Throws Fault unless it has the type and rows like this, with any_columns two dimensions.
/// Allocates nothing; `budget` is the largest number of bytes it may take in memory.
Dataset open_array(const Handle& group, const std::string& name, ValueType type,
                   std::uint64_t budget, const Row& row);
/// Reads all entries into `values`, which has room for them.
void read_values(const Dataset& dataset, void* values);
template <class T>
void get_array(const Handle& group, const std::string& name, std::uint64_t budget, const Row& row,
               std::vector<T>& values) {
  const Dataset dataset = open_array(group, name, value_type<T>, budget, row);
  values.resize(dataset.count());
  read_values(dataset, values.data());
}

}  // namespace anticrack::results::hdf5

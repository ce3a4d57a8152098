// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the result file needs of HDF5's C API: owned handles, and attributes and datasets of
// numbers and UTF-8 text. The functions throw Fault without the path; their callers add it.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "results/arrays.hpp"

namespace anticrack::results::hdf5 {

class Fault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Owns an HDF5 identifier and closes it once.
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

  /// The identifier, which the handle still owns; below 0 if it has none.
  hid_t get() const noexcept { return _id; }
  /// Gives the identifier to the caller without closing it.
  hid_t release() noexcept { return std::exchange(_id, -1); }
  /// Closes the identifier now; throws Fault(`what`) on an error, which the destructor ignores.
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
  /// Stops HDF5 from printing; the destructor restores what was set before.
  Quiet();
  ~Quiet();
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t _function = nullptr;
  void* _data = nullptr;
};

/// A member of the records of a dataset. A text is a pointer to it in memory; `unit`: see unit_of.
struct Member {
  std::string_view name;
  ValueType type;
  std::string_view unit;
  auto operator<=>(const Member&) const = default;
};
using Members = std::vector<Member>;

/// HDF5's type of an entry or of packed records: in memory and, as both are little-endian, in
/// files.
hid_t type_of(ValueType type);
hid_t type_of(const Members& members);
/// Transfer properties with a small buffer for texts, which are few: by default HDF5 clears a
/// megabyte for each list of texts.
hid_t text_transfer();

// Writing.

/// Returns the bytes of an HDF5 file (format 1.10) whose root group `fill` has filled. It is made
/// in memory, as a disk that is full while HDF5 closes a file makes HDF5 crash at program end.
std::vector<std::byte> file_image(const std::function<void(const Handle& root)>& fill);

/// Creation properties of a class that record no times, so that equal results give equal bytes.
Handle without_times(hid_t property_class);
/// `members`: how many are expected, at most 32, for which the group's header has room at once.
Handle create_group(const Handle& parent, const std::string& name, unsigned members = 4);
/// Makes what is at `path` from `parent`, "." for itself, a member of another group, too.
void link(const Handle& parent, const std::string& path, const Handle& group,
          const std::string& name);

/// Writes an attribute: one value or, with `count`, a list of doubles, int32 or std::string.
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

/// Writes a dataset of numbers, texts or records and returns it for attributes. What has numbers
/// has a checksum; large datasets of them but coordinates are compressed.
Handle put_dataset(const Handle& group, const std::string& name, hid_t type, const void* values,
                   const Shape& shape);

// Reading. Only hard links are followed and only data inside the file is read, so that a file
// from elsewhere cannot make us read other files.

/// Opens the root group of a file. Throws Error with `cure` if there is no HDF5 file at the path,
/// and Fault if the file is damaged.
Handle open_root(const std::filesystem::path& path, const std::string& cure);
/// The largest number of bytes a dataset of the file can take in memory.
std::uint64_t memory_budget(const std::filesystem::path& path);

bool has(const Handle& group, const std::string& name);
bool has_attribute(const Handle& object, const std::string& name);
Handle open_group(const Handle& parent, const std::string& name);
std::vector<std::string> names_in(const Handle& group);
/// The first ten names, separated by commas.
std::string listed(const std::vector<std::string>& names);

/// Reads an attribute of one value: double, int32 or std::string.
void get_attribute(const Handle& object, const std::string& name, ValueType type, void* value);
template <class T>
void get(const Handle& object, const std::string& attribute, T& value) {
  get_attribute(object, attribute, value_type<T>, &value);
}
/// Reads an attribute that is a list of at most `most` texts.
void get(const Handle& object, const std::string& attribute, std::vector<std::string>& texts,
         std::uint64_t most = 1'000'000);

/// An open dataset of known shape, not yet read.
struct Dataset {
  Handle id;
  std::string name;
  hid_t type;  ///< of its entries, as type_of gives it
  Shape shape;
};
/// Opens a dataset, allocating nothing. Throws Fault unless its entries are of `type`, its shape
/// fits `shape` and what is `known` of it (see results::fits), and reading it takes at most
/// `budget` bytes.
Dataset open_array(const Handle& group, const std::string& name, hid_t type, std::uint64_t budget,
                   std::string_view shape, Extents& known);
/// Reads all entries into `values`, which has room for them.
void read_values(const Dataset& dataset, void* values, hid_t transfer = H5P_DEFAULT);
/// Reads a dataset of one dimension, of texts or records: calls use(entry) for each. A text, or one
/// in a record, is a pointer that may be null and is not valid after the call.
void get_list(const Handle& group, const std::string& name, hid_t type, std::uint64_t budget,
              const std::function<void(const std::byte* entry)>& use);

}  // namespace anticrack::results::hdf5

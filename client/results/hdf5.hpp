// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the result file needs of HDF5's C API: owned handles, and attributes and datasets of
// numbers and UTF-8 text. Every function throws Fault, without the path: file.hpp adds it.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <span>
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

  /// Stays the handle's; below 0: none.
  hid_t get() const noexcept { return _id; }
  /// Closes it now; throws Fault(`what`) where the destructor would keep silent.
  void close_now(const std::string& what) {
    if (_close(std::exchange(_id, -1)) < 0) throw Fault(what);
  }

 private:
  hid_t _id;
  Close _close;
};

/// Keeps HDF5 from printing its error stack; Faults say what a user can use.
class Quiet {
 public:
  /// Until the end of the scope.
  Quiet();
  ~Quiet();
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t _function = nullptr;
  void* _data = nullptr;
};

// Writing.

/// Creation properties of a class, times off: so the same result gives the same bytes.
Handle without_times(hid_t property_class);
Handle create_group(const Handle& parent, const std::string& name);
void put(const Handle& object, const std::string& attribute, double value);
void put(const Handle& object, const std::string& attribute, std::int32_t value);
void put(const Handle& object, const std::string& attribute, const std::string& text);
/// A list of texts.
void put(const Handle& object, const std::string& attribute, std::span<const std::string> texts);
/// Dataset of `count` values, of shape (n) for columns 0, else (n / columns, columns). Numbers
/// carry a checksum; a large one is compressed. Returns it, for further attributes.
Handle put_array(const Handle& group, const std::string& name, ValueType type, const void* values,
                 std::size_t count, std::size_t columns);
template <class T>
Handle put_array(const Handle& group, const std::string& name, const std::vector<T>& values,
                 std::size_t columns = 0) {
  return put_array(group, name, value_type<T>, values.data(), values.size(), columns);
}

// Reading. Only hard links are followed and only data inside the file is read, so a file from
// elsewhere cannot pull in others.
bool has(const Handle& group, const std::string& name);
bool has_attribute(const Handle& object, const std::string& name);
Handle open_group(const Handle& parent, const std::string& name);
std::vector<std::string> names_in(const Handle& group);
void get(const Handle& object, const std::string& attribute, double& value);
void get(const Handle& object, const std::string& attribute, std::int32_t& value);
void get(const Handle& object, const std::string& attribute, std::string& text);
/// A list of texts, at most `most` of them.
void get(const Handle& object, const std::string& attribute, std::vector<std::string>& texts,
         std::uint64_t most = 1'000'000);

inline constexpr std::size_t any_columns = static_cast<std::size_t>(-1);

/// A dataset to be read; its shape is known.
struct Dataset {
  Handle id;
  std::string name;
  ValueType type;
  std::size_t rows;
  std::size_t columns;  ///< 1 for one dimension

  /// Entries in all.
  std::size_t count() const { return rows * columns; }
};
/// Of the type and shape asked for: (n) for columns 0, else (n, columns). Nothing is allocated for
/// it yet; `budget` is the largest number of bytes it may take in memory.
Dataset open_array(const Handle& group, const std::string& name, ValueType type,
                   std::uint64_t budget, std::size_t columns);
/// Puts all entries of a dataset where there is room for them; of text they are std::string.
void read_values(const Dataset& dataset, void* values);
template <class T>
void get_array(const Handle& group, const std::string& name, std::uint64_t budget,
               std::size_t columns, std::vector<T>& values) {
  const Dataset dataset = open_array(group, name, value_type<T>, budget, columns);
  values.resize(dataset.count());
  read_values(dataset, values.data());
}

}  // namespace anticrack::results::hdf5

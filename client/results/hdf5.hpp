// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the result file needs of HDF5's C API: owned handles, and attributes and datasets of
// float64, int32 and UTF-8 text. Every function throws Fault, without the path: file.hpp adds it.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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
/// Dataset of shape (n) for columns 0, else (n / columns, columns). It carries a
/// checksum; a large one is compressed. `units` becomes its attribute. Returns it, for further
/// attributes.
Handle put_array(const Handle& group, const std::string& name, std::span<const double> values,
                 const std::string& units, std::size_t columns = 0);
Handle put_array(const Handle& group, const std::string& name, std::span<const std::int32_t> values,
                 const std::string& units, std::size_t columns = 0);
Handle put_array(const Handle& group, const std::string& name, std::span<const std::uint8_t> values,
                 const std::string& units, std::size_t columns = 0);
void put_array(const Handle& group, const std::string& name, std::span<const std::string> values);

// Reading. Only hard links are followed and only data inside the file is read, so a file from
// elsewhere cannot pull in others.
bool has(const Handle& group, const std::string& name);
bool has_attribute(const Handle& object, const std::string& name);
Handle open_group(const Handle& parent, const std::string& name);
std::vector<std::string> names_in(const Handle& group);
double get_double(const Handle& object, const std::string& attribute);
std::int32_t get_int(const Handle& object, const std::string& attribute);
std::string get_text(const Handle& object, const std::string& attribute);
/// A list of texts, at most `most` of them.
std::vector<std::string> get_text_list(const Handle& object, const std::string& attribute,
                                       std::uint64_t most);
/// `budget`: largest number of bytes the dataset may take in memory.
std::vector<double> get_doubles(const Handle& group, const std::string& name, std::uint64_t budget,
                                std::size_t columns = 0);
std::vector<std::int32_t> get_ints(const Handle& group, const std::string& name,
                                   std::uint64_t budget, std::size_t columns = 0);
std::vector<std::uint8_t> get_bytes(const Handle& group, const std::string& name,
                                    std::uint64_t budget, std::size_t columns = 0);
/// A dataset of float64 and any shape (rows, columns), row by row.
struct Rows {
  std::vector<double> values;
  std::size_t rows = 0;
  std::size_t columns = 0;
};
/// `budget` as above. Throw Fault.
Rows get_rows(const Handle& group, const std::string& name, std::uint64_t budget);
std::vector<std::string> get_texts(const Handle& group, const std::string& name,
                                   std::uint64_t budget);

}  // namespace anticrack::results::hdf5

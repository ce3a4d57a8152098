// SPDX-License-Identifier: GPL-3.0-or-later
//
// A block of the server, array by array, believed only as far as it fits. For the sources of this
// folder only.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "arrays/table.hpp"
#include "results/assemble.hpp"

namespace anticrack::results {

static_assert(std::endian::native == std::endian::little, "blocks are little-endian");

/// For messages: "(3,2)".
std::string text_of(const std::vector<std::uint64_t>& shape);
/// Bytes of an array of its type and shape; throws where their product leaves 64 bits.
std::uint64_t byte_count(const std::string& subject, const ArrayView& array);

/// One block, arrays by name.
class Block {
 public:
  /// `subject` begins the messages: whose block it is. Throws Error where a name is there twice.
  /// The arrays must outlive it.
  Block(std::string subject, std::span<const ArrayView> arrays) : _subject(std::move(subject)) {
    for (const ArrayView& array : arrays) {
      if (!_arrays.emplace(array.name, &array).second) fail("array " + array.name + " twice");
    }
  }

  /// Whether there is an array of this name.
  bool has(const std::string& name) const { return _arrays.count(name) != 0; }

  /// Any array below a folder, e.g. "loads/0/traces/".
  bool has_below(const std::string& prefix) const {
    const auto found = _arrays.lower_bound(prefix);
    return found != _arrays.end() && found->first.compare(0, prefix.size(), prefix) == 0;
  }

  /// Array of shape (rows) for columns 0, else (rows, columns).
  template <typename T>
  std::vector<T> get(const std::string& name, std::uint64_t columns = 0) const {
    const ArrayView& array = find<T>(name);
    const bool fits = columns == 0 ? array.shape.size() == 1
                                   : array.shape.size() == 2 && array.shape[1] == columns;
    if (!fits) {
      fail("array " + name + " has shape " + text_of(array.shape) + ", not " +
           (columns == 0 ? std::string("(n)") : "(n," + std::to_string(columns) + ")"));
    }
    return values_of<T>(array);
  }

  /// Array of shape (rows, any); also where that is (rows, 0).
  template <typename T>
  std::vector<T> get_rows(const std::string& name, std::uint64_t rows) const {
    const ArrayView& array = find<T>(name);
    if (array.shape.size() != 2 || array.shape[0] != rows) {
      fail("array " + name + " has shape " + text_of(array.shape) + ", not (" +
           std::to_string(rows) + ",n)");
    }
    return values_of<T>(array);
  }

  /// Throws Error: the subject, `cause`, and the cure.
  [[noreturn]] void fail(const std::string& cause) const;

 private:
  template <typename T>
  const ArrayView& find(const std::string& name) const {
    const auto found = _arrays.find(name);
    if (found == _arrays.end()) fail("array " + name + " is missing");
    constexpr ValueType wanted = value_type<T>;
    if (found->second->type != wanted) {
      fail("array " + name + " is " + name_of(found->second->type) + ", not " + name_of(wanted));
    }
    return *found->second;
  }

  template <typename T>
  std::vector<T> values_of(const ArrayView& array) const {
    if (byte_count(_subject, array) != array.bytes.size()) {
      fail("array " + array.name + " of shape " + text_of(array.shape) + " comes with " +
           std::to_string(array.bytes.size()) + " bytes");
    }
    std::vector<T> values(array.bytes.size() / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), array.bytes.data(), array.bytes.size());
    return values;
  }

  std::string _subject;
  std::map<std::string, const ArrayView*> _arrays;
};

/// The arrays of a table, of shapes that are not words; `folder` ends with a slash.
template <class Record, class Table>
void get_arrays(const Block& block, const std::string& folder, Record& record, const Table& table) {
  arrays::for_each(
      [&](const auto& row) {
        auto& values = std::invoke(row.member, record);
        using Value = typename std::remove_cvref_t<decltype(values)>::value_type;
        values = block.get<Value>(folder + std::string(row.name), arrays::columns_of(row.shape));
      },
      table);
}

/// What the block of a mesh says of the edges of an interface. Not checked.
Edges edges_of(const Block& block, const std::string& interface);

/// The arrays of a mesh, checked.
void add_mesh(const Block& block, Mesh& mesh);

}  // namespace anticrack::results

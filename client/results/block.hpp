// SPDX-License-Identifier: GPL-3.0-or-later
//
// A block of the server, array by array, checked before it is used. For the sources of this folder
// only.
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
/// Bytes of an array of its type and shape; throws Error where they exceed 64 bits.
std::uint64_t byte_count(const std::string& subject, const ArrayView& array);

/// One block, arrays by name.
class Block {
 public:
  /// `subject` begins the messages. Throws Error for a name that occurs twice. The arrays must
  /// outlive the block.
  Block(std::string subject, std::span<const ArrayView> arrays) : _subject(std::move(subject)) {
    for (const ArrayView& array : arrays)
      if (!_arrays.emplace(array.name, &array).second) fail("array " + array.name + " twice");
  }

  /// Any array below a folder, e.g. "loads/0/traces/".
  bool has_below(const std::string& prefix) const {
    const auto found = _arrays.lower_bound(prefix);
    return found != _arrays.end() && found->first.compare(0, prefix.size(), prefix) == 0;
  }

  bool has(const std::string& name) const { return _arrays.contains(name); }

  /// Array of shape (n) for columns 0, (rows, n) for columns arrays::named, else (n, columns); with
  /// a depth above 1 (rows, n, depth) or (n, columns, depth).
  template <typename T>
  std::vector<T> get(const std::string& name, std::uint64_t columns = 0, std::uint64_t rows = 0,
                     std::uint64_t depth = 1) const {
    const ArrayView& array = find<T>(name);
    const std::vector<std::uint64_t>& shape = array.shape;
    const bool by_rows = columns == arrays::named;
    const bool fits = shape.size() == (columns == 0 ? 1U : 2U) + (depth > 1 ? 1U : 0U) &&
                      (columns == 0 || (by_rows ? shape[0] == rows : shape[1] == columns)) &&
                      (depth == 1 || shape.back() == depth);
    if (!fits) {
      fail("array " + name + " has shape " + text_of(shape) + ", not (" +
           (by_rows ? std::to_string(rows) + "," : "") + "n" +
           (by_rows || columns == 0 ? "" : "," + std::to_string(columns)) +
           (depth == 1 ? "" : "," + std::to_string(depth)) + ")");
    }
    if (byte_count(_subject, array) != array.bytes.size()) {
      fail("array " + name + " of shape " + text_of(shape) + " comes with " +
           std::to_string(array.bytes.size()) + " bytes");
    }
    std::vector<T> values(array.bytes.size() / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), array.bytes.data(), array.bytes.size());
    return values;
  }

  /// Throws Error: the subject, `cause`, and the cure.
  [[noreturn]] void fail(const std::string& cause) const;
  /// The same, unless `fault` is empty.
  void require(const std::string& fault) const {
    if (!fault.empty()) fail(fault);
  }

 private:
  template <typename T>
  const ArrayView& find(const std::string& name) const {
    const auto found = _arrays.find(name);
    if (found == _arrays.end()) fail("array " + name + " is missing");
    constexpr ValueType wanted = value_type<T>;
    if (found->second->type != wanted)
      fail("array " + name + " is " + name_of(found->second->type) + ", not " + name_of(wanted));
    return *found->second;
  }

  std::string _subject;
  std::map<std::string, const ArrayView*> _arrays;
};

/// The arrays of a table; what is optional and missing stays as it is. `folder` ends with a slash;
/// `rows`: of shapes whose columns are a word.
template <class Record, class Table>
void get_arrays(const Block& block, const std::string& folder, Record& record, const Table& table,
                std::uint64_t rows = 0) {
  arrays::for_each(
      [&](const auto& row) {
        auto& values = std::invoke(row.member, record);
        using Value = typename std::remove_cvref_t<decltype(values)>::value_type;
        const std::string name = folder + std::string(row.name);
        if (row.optional && !block.has(name)) return;
        values = block.get<Value>(name, arrays::columns_of(row.shape), rows,
                                  arrays::depth_of(row.shape));
      },
      table);
}

}  // namespace anticrack::results

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
#include <string_view>
#include <utility>
#include <vector>

#include "arrays/table.hpp"
#include "results/assemble.hpp"
#include "results/value_type.hpp"

namespace anticrack::results {

static_assert(std::endian::native == std::endian::little, "blocks are little-endian");

/// One block, arrays by name.
class Block {
 public:
  /// `subject` begins the messages. Throws Error for a name that occurs twice. What the view is of
  /// must outlive the block.
  Block(std::string subject, const BlockView& view);

  /// Any array below a folder, e.g. "loads/0/traces/".
  bool has_below(const std::string& prefix) const;
  bool has(const std::string& name) const { return _arrays.contains(name); }

  /// Array of shape (n) for columns 0, (rows, n) for columns arrays::named, else (n, columns); with
  /// a depth above 1 (rows, n, depth) or (n, columns, depth).
  template <typename T>
  std::vector<T> get(const std::string& name, std::uint64_t columns = 0, std::uint64_t rows = 0,
                     std::uint64_t depth = 1) const {
    const auto bytes = bytes_of(name, value_type<T>, columns, rows, depth);
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }

  /// Throws Error: the subject, `cause`, and the cure.
  [[noreturn]] void fail(const std::string& cause) const;
  /// The same, unless `fault` is empty.
  void require(const std::string& fault) const {
    if (!fault.empty()) fail(fault);
  }

 private:
  std::span<const std::byte> bytes_of(const std::string& name, ValueType type,
                                      std::uint64_t columns, std::uint64_t rows,
                                      std::uint64_t depth) const;

  std::string _subject;
  std::span<const std::byte> _bytes;
  std::map<std::string_view, const v1::ArrayLayout*> _arrays;
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

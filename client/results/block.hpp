// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reads the arrays of a server's block; each is checked before it is used. For the sources of this
// folder only.
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

/// One block, whose arrays are found by name.
class Block {
 public:
  /// `subject` begins the messages. Throws Error for a name that occurs twice. The layout and bytes
  /// that the view refers to must outlive the block.
  Block(std::string subject, const BlockView& view);

  /// Whether the block has any array below a folder, e.g. "loads/0/traces/".
  bool has_below(const std::string& prefix) const;
  bool has(const std::string& name) const { return _arrays.contains(name); }

  /// Copies an array of shape (n) if columns is 0, (rows, n) if it is arrays::named, else (n,
  /// columns); a depth above 1 adds a last dimension. Throws Error for another shape or type.
  template <typename T>
  std::vector<T> get(const std::string& name, std::uint64_t columns = 0, std::uint64_t rows = 0,
                     std::uint64_t depth = 1) const {
    const auto bytes = bytes_of(name, value_type<T>, columns, rows, depth);
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }

  /// Throws Error with the subject, `cause`, and the cure.
  [[noreturn]] void fail(const std::string& cause) const;
  /// Calls fail(fault) unless `fault` is empty.
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

/// Reads the arrays of a table into a record; a missing optional array leaves its member as it is.
/// `folder` ends with a slash; `rows` is the row count of arrays whose columns are named by a word.
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

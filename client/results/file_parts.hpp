// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes and reads messages of the API (entries_of lists the values) and tables of arrays as groups
// of a file. For the sources of this folder only.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "arrays/table.hpp"
#include "results/entries.hpp"
#include "results/hdf5.hpp"
#include "results/result.hpp"

namespace anticrack::results::hdf5 {

/// Writes the messages of one file; must not outlive the file.
class Messages {
 public:
  explicit Messages(const v1::Units& units) : _units(units) {}

  /// Writes values as attributes of the group, lists of texts as datasets, lists of messages as
  /// groups of columns. A list that is empty is written once and linked into every group that has
  /// it: of many loads with short answers most datasets would be empty ones.
  void put(const Handle& group, const google::protobuf::Message& message);

 private:
  const v1::Units& _units;
  std::map<const google::protobuf::FieldDescriptor*, Handle> _empty;  ///< lists, as written
};
/// Reads what Messages writes.
void get_message(const Handle& group, std::uint64_t budget, google::protobuf::Message& message);

/// Writes messages of a type as datasets of a group, one dataset for each entry.
void put_columns(const Handle& group, const v1::Units& units,
                 const google::protobuf::Descriptor& type,
                 const std::vector<const google::protobuf::Message*>& messages);
/// Reads the columns into the messages at(0), at(1), ... Throws Fault unless all columns have the
/// same length, and that of `length` if it is set; sets `length`. `what` names the list in errors.
void get_columns(const Handle& group, std::uint64_t budget, const std::string& what,
                 const google::protobuf::Descriptor& type, std::optional<std::size_t>& length,
                 const std::function<google::protobuf::Message&(std::size_t)>& at);

/// Writes the dataset `meanings`, which explains the numbers of the messages: each row says where
/// a number is, its name, unit and meaning.
void put_meanings(const Handle& root, const v1::Units& units);

/// Number of columns of the array that a row of a table describes; 0 if it has one dimension.
template <class Row, class Record>
std::size_t columns_of(const Row& row, const Record& record) {
  if constexpr (requires { record.extent(row.shape); }) {
    if (arrays::columns_of(row.shape) == arrays::named)
      return record.extent(arrays::second_of(row.shape));
  }
  return arrays::columns_of(row.shape);
}

/// Writes a dataset, with its meaning if the table says that the file holds the meaning.
template <class Row, class T>
void put_row(const Handle& group, const v1::Units& units, const Row& row,
             const std::vector<T>& values, std::size_t columns) {
  const Handle dataset =
      put_array(group, std::string(row.name), value_type<T>, values.data(), values.size(),
                {columns, arrays::depth_of(row.shape)}, unit_of(units, row.unit));
  if (row.explained) put(dataset, "meaning", std::string(row.what));
}

/// Writes and reads the members of a table as attributes of an object.
template <class Record, class Table>
void put_values(const Handle& object, const Record& record, const Table& table) {
  arrays::for_each(
      [&](const auto& row) { put(object, std::string(row.name), std::invoke(row.member, record)); },
      table);
}
template <class Record, class Table>
void get_values(const Handle& object, Record& record, const Table& table) {
  arrays::for_each(
      [&](const auto& row) { get(object, std::string(row.name), std::invoke(row.member, record)); },
      table);
}

template <class Row>
bool may_be_missing(const Row& row) {
  return row.optional || arrays::columns_of(row.shape) == arrays::named;
}

/// Writes arrays as datasets of a group. An empty array is left out if it is optional or if a word
/// names its columns, as HDF5 has no chunks without extent.
template <class Record, class... Tables>
void put_arrays(const Handle& group, const v1::Units& units, const Record& record,
                const Tables&... tables) {
  arrays::for_each(
      [&](const auto& row) {
        const auto& values = std::invoke(row.member, record);
        if (values.empty() && may_be_missing(row)) return;
        put_row(group, units, row, values, columns_of(row, record));
      },
      tables...);
}
template <class Record, class... Tables>
void get_arrays(const Handle& group, std::uint64_t budget, Record& record,
                const Tables&... tables) {
  arrays::for_each(
      [&](const auto& row) {
        const std::string name(row.name);
        if (may_be_missing(row) && !has(group, name)) return;
        get_array(group, name, budget, {columns_of(row, record), arrays::depth_of(row.shape)},
                  std::invoke(row.member, record));
      },
      tables...);
}

}  // namespace anticrack::results::hdf5

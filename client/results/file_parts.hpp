// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes and reads messages of the API (entries_of lists the values) and tables of arrays as groups
// of a file. For the sources of this folder only.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "results/entries.hpp"
#include "results/hdf5.hpp"
#include "results/tables.hpp"

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

/// Writes the arrays of a table, which are at `path` plus their names, as datasets of a group, with
/// the meanings that the table has for files. One that has no numbers is left out if it may be
/// missing, else it is empty.
void put_arrays(const Handle& group, const v1::Units& units, std::span<const tables::Row> table,
                const Arrays& arrays, const std::string& path);
/// Reads them; `known`: as in fits.
void get_arrays(const Handle& group, std::uint64_t budget, std::span<const tables::Row> table,
                Arrays& arrays, const std::string& path, Extents known = {});

}  // namespace anticrack::results::hdf5

// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes and reads messages of the API (entries_of lists the values) and tables of arrays as groups
// of a file. For the sources of this folder only.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "results/entries.hpp"
#include "results/hdf5.hpp"
#include "results/tables.hpp"

namespace anticrack::results::hdf5 {

/// Types of the messages that a record of a list has, one after another.
using Types = std::vector<const google::protobuf::Descriptor*>;

/// Writes the messages of one file; must not outlive the file. A list that is empty is written once
/// and linked into every group that has it: of many loads with short answers most lists would be
/// empty ones.
class Messages {
 public:
  explicit Messages(const v1::Units& units) : _units(units) {}

  /// Writes values as attributes of the group, lists as datasets: of texts, or of records with a
  /// member for each value of a message.
  void put(const Handle& group, const google::protobuf::Message& message);
  /// Writes a list; each record is made of messages of all types, which come one after another.
  void put(const Handle& group, const std::string& name, const Types& types,
           const std::vector<const google::protobuf::Message*>& messages);
  /// Writes the arrays of a table as put_arrays, but as one dataset of records. They have one
  /// length, or there are none.
  void put(const Handle& group, const std::string& name, std::span<const tables::Row> table,
           const Arrays& arrays, const std::string& path);

 private:
  void put_list(const Handle& group, const std::string& name, const Members& members,
                const std::vector<std::byte>& entries);

  const v1::Units& _units;
  std::map<hid_t, Handle> _empty;  ///< lists by the types of their entries, as written
};
/// Reads what Messages writes.
void get_message(const Handle& group, std::uint64_t budget, google::protobuf::Message& message);
/// Reads a list: calls next(), which gives the message to be filled in, for each in it.
void get_messages(const Handle& group, const std::string& name, std::uint64_t budget,
                  const Types& types, const std::function<google::protobuf::Message&()>& next);

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

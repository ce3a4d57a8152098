// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes and reads messages of the API as groups of a file, by what entries_of says. For the
// sources of this folder only.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "results/entries.hpp"
#include "results/hdf5.hpp"
#include "results/result.hpp"

namespace anticrack::results::hdf5 {

/// Values as attributes of the group, lists of texts as datasets, lists of messages as groups of
/// columns.
void put_message(const Handle& group, const v1::Units& units,
                 const google::protobuf::Message& message);
void get_message(const Handle& group, std::uint64_t budget, google::protobuf::Message& message);

/// Messages of a type as datasets of a group, one for each entry.
void put_columns(const Handle& group, const v1::Units& units,
                 const google::protobuf::Descriptor& type,
                 const std::vector<const google::protobuf::Message*>& messages);
/// Into the messages at(0), at(1), ... Throws Fault unless all columns are as long as each other
/// and as `length`, which is then known; `what` names the list.
void get_columns(const Handle& group, std::uint64_t budget, const std::string& what,
                 const google::protobuf::Descriptor& type, std::optional<std::size_t>& length,
                 const std::function<google::protobuf::Message&(std::size_t)>& at);

/// What the numbers of the messages are: the dataset `meanings`, a row for each of where, name,
/// unit and meaning.
void put_meanings(const Handle& root, const v1::Units& units);

}  // namespace anticrack::results::hdf5

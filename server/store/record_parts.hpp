// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the codecs of meshes, jobs and results share.
#pragma once

#include <google/protobuf/message_lite.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "errors/errors.hpp"
#include "store/records.hpp"
#include "store/records.pb.h"

namespace anticrack::store::disk {

/// The error (storage) of a record that is not as it was written; `what` is wrong with it.
errors::Error damaged_record(const std::string& what);

/// Number of a choice on the disk: its place in the list of all choices. The lists only grow at
/// their ends, whatever becomes of the order in the enum.
template <class Enum, std::size_t N>
std::uint32_t number(const std::array<Enum, N>& choices, Enum value) {
  return static_cast<std::uint32_t>(std::find(choices.begin(), choices.end(), value) -
                                    choices.begin());
}

/// The way back. Throws damaged_record() for a number that is none.
template <class Enum, std::size_t N>
Enum choice(const std::array<Enum, N>& choices, std::uint32_t number) {
  if (number >= N) {
    throw damaged_record("a choice has number " + std::to_string(number) + " of " +
                         std::to_string(N));
  }
  return choices[number];
}

/// Nanoseconds since 1970, and the way back.
inline std::int64_t to_disk(Clock::time_point time) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
}
/// See to_disk().
inline Clock::time_point time_of(std::int64_t nanoseconds) {
  return Clock::time_point(
      std::chrono::duration_cast<Clock::duration>(std::chrono::nanoseconds(nanoseconds)));
}

/// Parts of records as they are on the disk, and the way back; read() throws damaged_record().
void write(const errors::Error& error, Error& out);
errors::Error read(const Error& in);

using NamedValues = google::protobuf::RepeatedPtrField<NamedValue>;
/// Named values, in order of the names.
void write(const std::map<std::string, double>& values, NamedValues& out);
std::map<std::string, double> read(const NamedValues& in);

using Texts = google::protobuf::RepeatedPtrField<std::string>;
/// Texts, in their order.
inline void write(const std::vector<std::string>& texts, Texts& out) {
  out.Assign(texts.begin(), texts.end());
}
/// See write().
inline std::vector<std::string> read(const Texts& in) {
  return {in.begin(), in.end()};
}

/// write(item, message) of each.
template <class Item, class Message>
void write_all(const std::vector<Item>& items, google::protobuf::RepeatedPtrField<Message>& out) {
  out.Reserve(static_cast<int>(items.size()));
  for (const Item& item : items) {
    write(item, *out.Add());
  }
}

/// read(message) of each.
template <class Message>
auto read_all(const google::protobuf::RepeatedPtrField<Message>& in) {
  std::vector<decltype(read(*in.begin()))> items;
  items.reserve(static_cast<std::size_t>(in.size()));
  for (const Message& message : in) {
    items.push_back(read(message));
  }
  return items;
}

/// Throws std::length_error for more than a message can hold (2 GB).
std::string serialized(const google::protobuf::MessageLite& message);
/// Throws errors::Error (storage).
void parse(std::string_view bytes, google::protobuf::MessageLite& message);

}  // namespace anticrack::store::disk

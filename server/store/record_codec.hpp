// SPDX-License-Identifier: GPL-3.0-or-later
//
// Records as bytes: messages of the API (records.proto). Every field comes back bit by bit, except
// the values of an array, which a record does not keep, and bytes that are not UTF-8.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "errors/errors.hpp"
#include "records/clock.hpp"

namespace anticrack::records {
struct JobRecord;
struct MeshRecord;
}  // namespace anticrack::records

namespace anticrack::store {

/// A time as nanoseconds since 1970, as in columns of the database.
inline std::int64_t to_disk(records::Clock::time_point time) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
}
/// The time of to_disk()'s nanoseconds.
inline records::Clock::time_point time_of(std::int64_t nanoseconds) {
  return records::Clock::time_point(
      std::chrono::duration_cast<records::Clock::duration>(std::chrono::nanoseconds(nanoseconds)));
}

/// The bytes that the database keeps.
std::string encode(const records::MeshRecord& record);
std::string encode(const records::JobRecord& record);

/// The error (storage) of a record that is not as it was written. `what`: its fault.
errors::Error damaged_record(const std::string& what);

/// Decode a record. They throw damaged_record() if the bytes are not a record.
records::MeshRecord decode_mesh_record(std::string_view bytes);
records::JobRecord decode_job_record(std::string_view bytes);

}  // namespace anticrack::store

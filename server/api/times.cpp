// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>
#include <cstdint>

#include "api/translations.hpp"

namespace anticrack::api {

using errors::Error;
using errors::Reason;
using std::chrono::nanoseconds;
using std::chrono::seconds;

namespace {

template <class To>
void write_parts(nanoseconds value, seconds whole, To& to) {
  to.set_seconds(whole.count());
  to.set_nanos(static_cast<std::int32_t>((value - whole).count()));
}

/// Beyond 292 years a count of nanoseconds overflows.
template <class From>
nanoseconds read_parts(const From& from) {
  constexpr std::int64_t most = std::chrono::floor<seconds>(nanoseconds::max()).count() - 3;
  if (from.seconds() > most || from.seconds() < -most) {
    throw Error(Reason::invalid_argument,
                "a time of " + std::to_string(from.seconds()) + " s is longer than 292 years")
        .at("seconds");
  }
  return seconds(from.seconds()) + nanoseconds(from.nanos());
}

}  // namespace

void Translation<nanoseconds>::write(const nanoseconds& value, google::protobuf::Duration& to) {
  write_parts(value, std::chrono::duration_cast<seconds>(value), to);
}

nanoseconds Translation<nanoseconds>::read(const google::protobuf::Duration& from) {
  return read_parts(from);
}

void Translation<store::Clock::time_point>::write(const store::Clock::time_point& value,
                                                  google::protobuf::Timestamp& to) {
  const nanoseconds since = value.time_since_epoch();
  write_parts(since, std::chrono::floor<seconds>(since), to);
}

store::Clock::time_point Translation<store::Clock::time_point>::read(
    const google::protobuf::Timestamp& from) {
  return store::Clock::time_point(read_parts(from));
}

}  // namespace anticrack::api

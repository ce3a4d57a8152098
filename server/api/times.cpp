// SPDX-License-Identifier: GPL-3.0-or-later
#include <google/protobuf/util/time_util.h>

#include <chrono>

#include "api/translations.hpp"

namespace anticrack::api {

using google::protobuf::util::TimeUtil;
using std::chrono::nanoseconds;

/// Checks the range, as a count of nanoseconds overflows beyond 292 years.
template <class Time>
static const Time& within_range(const Time& time) {
  constexpr auto most = std::chrono::floor<std::chrono::seconds>(nanoseconds::max()).count() - 3;
  if (time.seconds() > most || time.seconds() < -most) {
    throw errors::Error(errors::Reason::invalid_argument, "a time of {} s is longer than 292 years",
                        time.seconds())
        .at("seconds");
  }
  return time;
}

void Translation<nanoseconds>::write(const nanoseconds& value, google::protobuf::Duration& to) {
  to = TimeUtil::NanosecondsToDuration(value.count());
}

nanoseconds Translation<nanoseconds>::read(const google::protobuf::Duration& from) {
  return nanoseconds(TimeUtil::DurationToNanoseconds(within_range(from)));
}

void Translation<records::Clock::time_point>::write(const records::Clock::time_point& value,
                                                    google::protobuf::Timestamp& to) {
  to = TimeUtil::NanosecondsToTimestamp(nanoseconds(value.time_since_epoch()).count());
}

records::Clock::time_point Translation<records::Clock::time_point>::read(
    const google::protobuf::Timestamp& from) {
  return records::Clock::time_point(
      nanoseconds(TimeUtil::TimestampToNanoseconds(within_range(from))));
}

}  // namespace anticrack::api

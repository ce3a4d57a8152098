// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/stream_hub.hpp"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <optional>

namespace anticrack::rpc {
namespace {

using namespace std::chrono_literals;
using errors::Error;
using errors::Reason;

/// Leaves the hub when it is ended, or only when it is aborted.
class Recorded final : public Stream {
 public:
  Recorded(StreamHub& hub, bool stubborn) : _hub(hub), _stubborn(stubborn) {}

  void wake() noexcept override { count(_wakes); }
  void tick(SteadyClock::time_point /*now*/) noexcept override { count(_ticks); }
  void end(const Error& error) noexcept override {
    {
      const std::lock_guard lock(_mutex);
      ended_with = error.reason();
    }
    if (!_stubborn) _hub.remove(*this);
  }
  void abort() noexcept override { _hub.remove(*this); }

  void wait_for_wake() { wait(_wakes); }
  void wait_for_tick() { wait(_ticks); }
  std::optional<Reason> ended_with;

 private:
  void count(int& counter) {
    {
      const std::lock_guard lock(_mutex);
      ++counter;
    }
    _changed.notify_all();
  }
  void wait(const int& counter) {
    std::unique_lock lock(_mutex);
    ASSERT_TRUE(_changed.wait_for(lock, 60s, [&] { return counter > 0; }));
  }

  StreamHub& _hub;
  const bool _stubborn;
  std::mutex _mutex;
  std::condition_variable _changed;
  int _wakes = 0;
  int _ticks = 0;
};

StreamLimits limits() {
  return {2, 1, 20ms, 1000ms};
}

TEST(StreamHub, WakesAndTicksOnItsOwnThread) {
  StreamHub hub(limits());
  const auto stream = std::make_shared<Recorded>(hub, false);
  hub.add(StreamKind::watch, stream);
  hub.wake(stream);
  stream->wait_for_wake();
  stream->wait_for_tick();
  hub.remove(*stream);
}

TEST(StreamHub, RefusesMoreThanItsLimitOfAKind) {
  StreamHub hub(limits());
  const auto a = std::make_shared<Recorded>(hub, false);
  const auto b = std::make_shared<Recorded>(hub, false);
  const auto c = std::make_shared<Recorded>(hub, false);
  hub.add(StreamKind::watch, a);
  hub.add(StreamKind::watch, b);
  EXPECT_EQ(hub.watchers(), 2);
  try {
    hub.add(StreamKind::watch, c);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.reason(), Reason::busy);
    EXPECT_GT(error.retry_delay().count(), 0);
  }
  hub.add(StreamKind::transfer, c);
  hub.remove(*a);
  hub.add(StreamKind::watch, a);
  EXPECT_EQ(hub.watchers(), 2);
}

TEST(StreamHub, ToleratesAWakeOfWhatIsGone) {
  StreamHub hub(limits());
  std::weak_ptr<Stream> gone;
  {
    const auto stream = std::make_shared<Recorded>(hub, false);
    hub.add(StreamKind::watch, stream);
    gone = stream;
    hub.wake(gone);
    hub.remove(*stream);
  }
  hub.wake(gone);
  EXPECT_EQ(hub.watchers(), 0);
}

TEST(StreamHub, DrainEndsAndThenBreaksOff) {
  StreamHub hub(limits());
  const auto willing = std::make_shared<Recorded>(hub, false);
  const auto stubborn = std::make_shared<Recorded>(hub, true);
  hub.add(StreamKind::watch, willing);
  hub.add(StreamKind::transfer, stubborn);
  hub.drain(draining_error(), 10ms, SteadyClock::now() + 60s);
  EXPECT_EQ(willing->ended_with, Reason::draining);
  EXPECT_EQ(stubborn->ended_with, Reason::draining);
  EXPECT_EQ(hub.watchers(), 0);
  EXPECT_THROW(hub.add(StreamKind::watch, willing), Error);
}

}  // namespace
}  // namespace anticrack::rpc

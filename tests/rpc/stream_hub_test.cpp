// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/stream_hub.hpp"

#include <gtest/gtest.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>

#include "support/errors.hpp"

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

StreamLimits hub_limits() { return {2, 1, 3, 20ms, 1000ms}; }

TEST(StreamHub, WakesAndTicksOnItsOwnThread) {
  StreamHub hub(hub_limits());
  const auto stream = std::make_shared<Recorded>(hub, false);
  hub.add(StreamKind::watch, "client", stream);
  hub.wake(stream);
  stream->wait_for_wake();
  stream->wait_for_tick();
  hub.remove(*stream);
}

void expect_busy(const std::function<void()>& add) {
  const auto error = anticrack::testing::error_of(add);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), Reason::busy);
  EXPECT_GT(error->retry_delay().count(), 0);
}

TEST(StreamHub, RefusesMoreThanItsLimitOfAKind) {
  StreamHub hub(hub_limits());
  const auto a = std::make_shared<Recorded>(hub, false);
  const auto b = std::make_shared<Recorded>(hub, false);
  const auto c = std::make_shared<Recorded>(hub, false);
  hub.add(StreamKind::watch, "client", a);
  hub.add(StreamKind::watch, "client", b);
  EXPECT_EQ(hub.counts().watchers, 2);
  expect_busy([&] { hub.add(StreamKind::watch, "client", c); });
  hub.add(StreamKind::transfer, "client", c);
  hub.remove(*a);
  hub.add(StreamKind::watch, "client", a);
  EXPECT_EQ(hub.counts().watchers, 2);
}

TEST(StreamHub, RefusesMoreThanAClientMayHold) {
  StreamHub hub({5, 5, 2, 20ms, 1000ms});
  const auto a = std::make_shared<Recorded>(hub, false);
  const auto b = std::make_shared<Recorded>(hub, false);
  const auto c = std::make_shared<Recorded>(hub, false);
  hub.add(StreamKind::watch, "ada", a);
  hub.add(StreamKind::transfer, "ada", b);
  expect_busy([&] { hub.add(StreamKind::watch, "ada", c); });
  hub.add(StreamKind::watch, "bob", c);
  EXPECT_EQ(hub.counts().transfers, 1);
  hub.remove(*c);
  hub.remove(*a);
  hub.add(StreamKind::watch, "ada", c);
  EXPECT_EQ(hub.counts().watchers, 1);
  EXPECT_THROW(hub.add(StreamKind::watch, "ada", a), Error);
}

/// Not before its time, whoever wakes it.
class Late final : public Wakeable {
 public:
  void wake() noexcept override {
    {
      const std::lock_guard lock(_mutex);
      early = early || SteadyClock::now() < time;
      ++_wakes;
    }
    _changed.notify_all();
  }
  SteadyClock::time_point not_before() const noexcept override { return time; }
  int wait() {
    std::unique_lock lock(_mutex);
    EXPECT_TRUE(_changed.wait_for(lock, 60s, [&] { return _wakes > 0; }));
    return _wakes;
  }

  const SteadyClock::time_point time = SteadyClock::now() + 30ms;
  bool early = false;

 private:
  std::mutex _mutex;
  std::condition_variable _changed;
  int _wakes = 0;
};

TEST(StreamHub, KeepsAWakeUntilItsTime) {
  StreamHub hub(hub_limits());
  const auto late = std::make_shared<Late>();
  hub.wake(late);
  EXPECT_GE(late->wait(), 1);
  EXPECT_FALSE(late->early);
}

TEST(StreamHub, ToleratesAWakeOfWhatIsGone) {
  StreamHub hub(hub_limits());
  std::weak_ptr<Stream> gone;
  {
    const auto stream = std::make_shared<Recorded>(hub, false);
    hub.add(StreamKind::watch, "client", stream);
    gone = stream;
    hub.wake(gone);
    hub.remove(*stream);
  }
  hub.wake(gone);
  EXPECT_EQ(hub.counts().watchers, 0);
}

TEST(StreamHub, DrainEndsAndThenBreaksOff) {
  StreamHub hub(hub_limits());
  const auto willing = std::make_shared<Recorded>(hub, false);
  const auto stubborn = std::make_shared<Recorded>(hub, true);
  hub.add(StreamKind::watch, "client", willing);
  hub.add(StreamKind::transfer, "client", stubborn);
  hub.drain(draining_error(), 10ms, SteadyClock::now() + 60s);
  EXPECT_EQ(willing->ended_with, Reason::draining);
  EXPECT_EQ(stubborn->ended_with, Reason::draining);
  EXPECT_EQ(hub.counts().watchers, 0);
  EXPECT_THROW(hub.add(StreamKind::watch, "client", willing), Error);
}

}  // namespace
}  // namespace anticrack::rpc

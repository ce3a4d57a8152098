// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/watch_feed.hpp"

#include <gtest/gtest.h>

#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"
#include "rpc/stream_hub.hpp"
#include "support/eventually.hpp"

namespace anticrack::rpc {
namespace {

using namespace std::chrono_literals;
using anticrack::testing::endless_job;
using anticrack::testing::eventually;
using anticrack::testing::paper_mesh;
using anticrack::testing::RunningServer;

/// Reads all there is and returns the last message.
v1::WatchJobResponse read_to_the_end(WatchFeed& feed) {
  v1::WatchJobResponse last;
  EXPECT_TRUE(eventually([&] {
    v1::WatchJobResponse response;
    WatchFeed::Next next{};
    while ((next = feed.next(response)) == WatchFeed::Next::message) {
      last = response;
      response.Clear();
    }
    return next == WatchFeed::Next::end;
  }));
  return last;
}

TEST(WatchFeed, IsEndingFromTheEndOfTheJobOnWhateverWasRead) {
  RunningServer server;
  const v1::Job job = server.create(endless_job(server.create(paper_mesh()).name()));
  const std::string id = job.name().substr(job.name().find('/') + 1);
  StreamHub hub{{1, 1, 1, 10s, 60s}};
  WatchGroups groups(hub);
  const rpc::Backend backend = server.backend();
  WatchFeed feed(backend, groups, id, 0);
  feed.start([] {});
  ASSERT_TRUE(eventually([&] { return feed.lag() > 2 * WatchFeed::max_batch; }));
  EXPECT_FALSE(feed.ending());
  EXPECT_TRUE(server.cancel(job.name()).ok());
  EXPECT_TRUE(eventually([&] { return feed.ending(); }));
  EXPECT_GT(feed.lag(), 0U);
  EXPECT_TRUE(read_to_the_end(feed).has_ended());
  EXPECT_EQ(feed.lag(), 0U);
  EXPECT_TRUE(feed.ending());
}

}  // namespace
}  // namespace anticrack::rpc

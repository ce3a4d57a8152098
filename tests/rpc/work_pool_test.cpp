// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/work_pool.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <vector>

namespace anticrack::rpc {
namespace {

TEST(WorkPool, OneThatWaitsHoldsUpNoOther) {
  WorkPool pool(2);
  std::promise<void> gate;
  std::promise<void> passed;
  pool.post("client", [&] { gate.get_future().wait(); });
  pool.post("client", [&] { passed.set_value(); });
  EXPECT_EQ(passed.get_future().wait_for(std::chrono::minutes(1)), std::future_status::ready);
  gate.set_value();
}

TEST(WorkPool, TakesClientsInTurnsAndCountsWhatWaits) {
  std::promise<void> begun;
  std::promise<void> gate;
  std::vector<int> order;
  {
    WorkPool pool(1);
    pool.post("client", [&] {
      begun.set_value();
      gate.get_future().wait();
    });
    begun.get_future().wait();
    for (int i = 0; i < 3; ++i) pool.post("client", [&order, i] { order.push_back(i); });
    pool.post("another", [&order] { order.push_back(3); });
    EXPECT_EQ(pool.waiting(), 4u);
    EXPECT_FALSE(pool.has_room("client", 8));
    EXPECT_TRUE(pool.has_room("another", 8));
    gate.set_value();
  }
  EXPECT_EQ(order, (std::vector<int>{0, 3, 1, 2}));  // all that was posted is done before it goes
}

}  // namespace
}  // namespace anticrack::rpc

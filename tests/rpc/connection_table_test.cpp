// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/connection_table.hpp"

#include <gtest/gtest.h>

#include <map>

namespace anticrack::rpc {
namespace {

using namespace std::chrono_literals;

/// Sockets that the test opens and closes.
class ConnectionTableTest : public ::testing::Test {
 protected:
  Admitted connect(ConnectionTable& table, const std::string& address) {
    ++_last;
    _sockets[_last] = 100'000u + static_cast<unsigned>(_last);
    const Admitted admitted = table.add(address, _last, _sockets[_last], _now);
    if (admitted != Admitted::yes) _sockets.erase(_last);
    return admitted;
  }
  int connect_all(ConnectionTable& table, const std::string& address, int wanted) {
    int taken = 0;
    while (taken < wanted && connect(table, address) == Admitted::yes) ++taken;
    return taken;
  }
  void close_all() { _sockets.clear(); }
  ConnectionTable::IsOpen is_open() {
    return [this](int descriptor, std::uint64_t socket) {
      ++_asked;
      const auto found = _sockets.find(descriptor);
      return found != _sockets.end() && found->second == socket;
    };
  }

  ConnectionTable::Clock::time_point _now{1h};
  std::map<int, std::uint64_t> _sockets;
  int _last = 2;
  int _asked = 0;
};

TEST_F(ConnectionTableTest, LimitsAnAddressAndLeavesRoomForAnother) {
  ConnectionTable table({100, 10}, is_open());
  EXPECT_EQ(connect_all(table, "a", 1000), 10);
  EXPECT_EQ(connect(table, "a"), Admitted::address_full);
  EXPECT_EQ(connect_all(table, "b", 1000), 10);
  EXPECT_EQ(table.open(), 20);
}

TEST_F(ConnectionTableTest, NoAddressHasMoreThanStaysFree) {
  ConnectionTable table({100, 1000}, is_open());
  EXPECT_EQ(connect_all(table, "a", 1000), 50);
  EXPECT_GE(connect_all(table, "b", 1000), 16);
  EXPECT_EQ(connect(table, "c"), Admitted::yes) << "a newcomer finds room";
}

TEST_F(ConnectionTableTest, RefusesEverybodyWhereItIsFull) {
  ConnectionTable table({3, 3}, is_open());
  for (const char* address : {"a", "b", "c"}) EXPECT_EQ(connect(table, address), Admitted::yes);
  EXPECT_EQ(connect(table, "d"), Admitted::full);
}

TEST_F(ConnectionTableTest, FindsThoseThatWereClosed) {
  ConnectionTable table({100, 10}, is_open());
  for (int round = 0; round < 100; ++round) {
    EXPECT_EQ(connect_all(table, "a", 10), 10) << round;
    close_all();
    _now += ConnectionTable::patience;
  }
  EXPECT_EQ(table.open(), 0);
}

TEST_F(ConnectionTableTest, ANumberThatIsTakenAgainCountsOnce) {
  ConnectionTable table({100, 10}, is_open());
  for (std::uint64_t socket = 1; socket < 1000; ++socket) {
    _sockets[7] = socket;
    EXPECT_EQ(table.add("a", 7, socket, _now), Admitted::yes);
  }
  EXPECT_EQ(table.open(), 1);
}

TEST_F(ConnectionTableTest, AsksTheSystemSeldom) {
  ConnectionTable table({100, 10}, is_open());
  EXPECT_EQ(connect_all(table, "a", 10), 10);
  EXPECT_EQ(_asked, 0) << "there was room";
  for (int i = 0; i < 10'000; ++i) EXPECT_EQ(connect(table, "a"), Admitted::address_full);
  EXPECT_EQ(_asked, 10) << "once for each, as no time has passed";
}

}  // namespace
}  // namespace anticrack::rpc

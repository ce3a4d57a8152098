// SPDX-License-Identifier: GPL-3.0-or-later
//
// What systemd hears, on a socket of its kind.
#include "app/notify.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>

#include "support/temporary_folder.hpp"

namespace anticrack::app {
namespace {

class Notify : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string path = _folder / "notify";
    _socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::strncpy(name.sun_path, path.c_str(), sizeof(name.sun_path) - 1);
    ASSERT_EQ(::bind(_socket, reinterpret_cast<const sockaddr*>(&name), sizeof(name)), 0);
    ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
  }
  void TearDown() override {
    ::unsetenv("NOTIFY_SOCKET");
    ::unsetenv("WATCHDOG_USEC");
    ::close(_socket);
  }
  /// A datagram is there as soon as it was sent.
  std::string heard() const {
    std::array<char, 1024> text{};
    const ssize_t size = ::recv(_socket, text.data(), text.size(), MSG_DONTWAIT);
    return {text.data(), size < 0 ? 0 : static_cast<std::size_t>(size)};
  }

  anticrack::testing::TemporaryFolder _folder;
  int _socket = -1;
};

TEST_F(Notify, TellsOfReadyStoppingAndAlive) {
  notify_ready("listening");
  EXPECT_EQ(heard(), "READY=1\nSTATUS=listening");
  notify_stopping("draining");
  EXPECT_EQ(heard(), "STOPPING=1\nSTATUS=draining");
  notify_alive();
  EXPECT_EQ(heard(), "WATCHDOG=1");
}

TEST_F(Notify, KnowsHowOftenTheWatchdogWantsToHear) {
  EXPECT_EQ(watchdog_interval(), std::nullopt);
  ::setenv("WATCHDOG_USEC", "3000000", 1);
  EXPECT_EQ(watchdog_interval(), std::chrono::milliseconds(1500));
}

TEST(NotifyWithoutSystemd, DoesNothing) {
  ::unsetenv("NOTIFY_SOCKET");
  notify_ready("x");
  EXPECT_EQ(watchdog_interval(), std::nullopt);
}

}  // namespace
}  // namespace anticrack::app

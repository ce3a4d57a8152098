// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/listen_address.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "app/config.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::app {
namespace {

/// A listening unix socket.
int listen_on(const std::string& path) {
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  std::strncpy(name.sun_path, path.c_str(), sizeof(name.sun_path) - 1);
  EXPECT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&name), sizeof(name)), 0);
  EXPECT_EQ(::listen(socket, 1), 0);
  return socket;
}

TEST(ListenAddress, IsTakenApart) {
  EXPECT_EQ(parse_listen_address("localhost:0").host, "localhost");
  EXPECT_EQ(parse_listen_address("10.0.0.1:7433").port, 7433);
  EXPECT_EQ(parse_listen_address("[::1]:1").host, "::1");
  EXPECT_EQ(parse_listen_address("unix:/run/a").socket_path, "/run/a");
}

TEST(ListenAddress, OfOtherFormsIsRefused) {
  for (const std::string text : {"", "7433", ":7433", "localhost", "localhost:", "localhost:x",
                                 "localhost:65536", "::1:7433", "a b:1", "unix:", "dns:///a:1"}) {
    EXPECT_THROW(parse_listen_address(text), std::invalid_argument) << text;
  }
  EXPECT_THROW(parse_listen_address("unix:/" + std::string(200, 'a')), std::invalid_argument);
}

TEST(ListenAddress, IsLocalOnLoopbackOnly) {
  for (const char* text : {"localhost:1", "127.0.0.1:1", "127.9.8.7:1", "[::1]:1", "unix:/a"}) {
    EXPECT_TRUE(is_local(parse_listen_address(text))) << text;
  }
  for (const char* text : {"0.0.0.0:1", "[::]:1", "192.168.0.1:1", "example.org:1", "*:1",
                           "127.0.0.1.example.org:1"}) {
    const ListenAddress address = parse_listen_address(text);
    EXPECT_FALSE(is_local(address)) << text;
    EXPECT_THROW(require_local(address, false), ConfigError) << text;
    require_local(address, true);
  }
}

TEST(StaleSocket, IsRemovedOnlyWhenNobodyAnswers) {
  const anticrack::testing::TemporaryFolder folder;
  const std::string path = folder / "socket";
  const ListenAddress address = parse_listen_address("unix:" + path);
  clear_stale_socket(address);  // nothing there
  const int socket = listen_on(path);
  EXPECT_THROW(clear_stale_socket(address), ConfigError);
  EXPECT_TRUE(std::filesystem::exists(path));
  ::close(socket);
  clear_stale_socket(address);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(StaleSocket, LeavesOtherFilesAlone) {
  const anticrack::testing::TemporaryFolder folder;
  std::ofstream(folder / "file") << "precious";
  EXPECT_THROW(clear_stale_socket(parse_listen_address("unix:" + (folder / "file").string())),
               ConfigError);
  EXPECT_TRUE(std::filesystem::exists(folder / "file"));
}

}  // namespace
}  // namespace anticrack::app

// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/file.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include "support/temporary_folder.hpp"

namespace anticrack::output {
namespace {

namespace fs = std::filesystem;
using anticrack::testing::TemporaryFolder;
using ::testing::HasSubstr;

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

std::string complaint(const fs::path& path, std::string_view text = "x") {
  try {
    write_file(path, text);
  } catch (const Error& error) {
    return error.what();
  }
  return "written";
}

class Output : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(_folder / "scratch");
    std::ofstream(_folder / "scratch/old") << "old";
  }
  TemporaryFolder _folder;
};

TEST_F(Output, WritesThroughSymbolicLinks) {
  const std::pair<const char*, fs::path> links[]{{"absolute", _folder / "scratch/old"},
                                                 {"relative", "scratch/old"},
                                                 {"through", "absolute"},
                                                 {"new", "scratch/new"},
                                                 {"scratch/inside", "old"},
                                                 {"up", "scratch/../scratch/inside"}};
  for (const auto& [name, to] : links) {
    const fs::path link = _folder / name;
    fs::create_symlink(to, link);
    check_writable(link);
    write_file(link, std::string_view(name));
    EXPECT_TRUE(fs::is_symlink(link)) << name;
    EXPECT_EQ(content(link), name);
    EXPECT_EQ(content(_folder / (name == std::string("new") ? "scratch/new" : "scratch/old")),
              name);
  }
  fs::create_directory_symlink(_folder / "scratch", _folder / "elsewhere");
  write_file(_folder / "elsewhere/old", "again");
  EXPECT_EQ(content(_folder / "scratch/old"), "again");
  EXPECT_TRUE(fs::is_symlink(_folder / "elsewhere"));
}

TEST_F(Output, KeepsTheFormerFileBesideTheOneThatIsReplaced) {
  fs::create_symlink("scratch/old", _folder / "link");
  write_file(_folder / "link", std::as_bytes(std::span("new", 3)), true);
  EXPECT_EQ(content(_folder / "scratch/old"), "new");
  EXPECT_EQ(content(_folder / "scratch/old~"), "old");
}

TEST_F(Output, KeepsPermissions) {
  chmod((_folder / "scratch/old").c_str(), 0640);
  write_file(_folder / "scratch/old", "new");
  struct stat found {};
  ASSERT_EQ(stat((_folder / "scratch/old").c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777, 0640u);
  const mode_t before = umask(027);
  write_file(_folder / "scratch/new", "new");
  umask(before);
  ASSERT_EQ(stat((_folder / "scratch/new").c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777, 0640u) << "of the umask";
}

TEST_F(Output, ThatCannotBeIsRefusedAndNamed) {
  fs::create_symlink("round", _folder / "about");
  fs::create_symlink("about", _folder / "round");
  fs::create_symlink("missing/file", _folder / "nowhere");
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  std::strncpy(name.sun_path, (_folder / "socket").c_str(), sizeof(name.sun_path) - 1);
  ASSERT_EQ(bind(socket, reinterpret_cast<const sockaddr*>(&name), sizeof(name)), 0);
  const std::pair<const char*, const char*> wrong[]{{"round", "Too many levels of symbolic links"},
                                                    {"nowhere", "No such file or directory"},
                                                    {"scratch", "directory"},
                                                    {"socket", "is a socket"},
                                                    {"scratch/old/file", "Not a directory"}};
  for (const auto& [path, cause] : wrong) {
    EXPECT_THAT(complaint(_folder / path), HasSubstr(cause));
    EXPECT_THAT(complaint(_folder / path), HasSubstr(_folder.path()));
    EXPECT_THROW(check_writable(_folder / path), Error) << path;
  }
  close(socket);
  EXPECT_THAT(complaint("/proc/a.h5"),
              HasSubstr("/proc/a.h5: cannot create a file in this folder"));
  EXPECT_THROW(check_writable(""), Error);
  check_writable(_folder / "scratch/new");
  EXPECT_EQ(files_in(_folder / "scratch"), 1u) << "the check leaves nothing behind";
  fs::create_directory(_folder / "scratch/old~");
  EXPECT_THROW(check_writable(_folder / "scratch/old"), Error) << "where a former file is kept";
  if (geteuid() == 0) return;  // permissions do not hold for root
  chmod((_folder / "scratch/old").c_str(), 0444);
  fs::remove(_folder / "scratch/old~");
  EXPECT_THROW(check_writable(_folder / "scratch/old"), Error);
  chmod((_folder / "scratch").c_str(), 0555);
  EXPECT_THAT(complaint(_folder / "scratch/b"), HasSubstr("Permission denied"));
  chmod((_folder / "scratch").c_str(), 0755);
}

TEST_F(Output, GoesIntoPipesAndDevicesAsAStream) {
  const std::string pipe = _folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  fs::create_symlink(pipe, _folder / "to pipe");
  for (const fs::path& path : {fs::path(pipe), _folder / "to pipe"}) {
    check_writable(path);
    std::string read;
    std::thread reader([&] { read = content(pipe); });
    const std::string text(200'000, 'x');  // more than a pipe holds
    write_file(path, text);
    reader.join();
    EXPECT_EQ(read, text);
    EXPECT_TRUE(fs::is_fifo(pipe));
  }
  fs::create_symlink("/dev/null", _folder / "null");
  for (const fs::path& path : {fs::path("/dev/null"), _folder / "null"}) {
    check_writable(path);
    write_file(path, std::as_bytes(std::span("new", 3)), true);
    EXPECT_TRUE(fs::is_character_file(path));
  }
  EXPECT_THAT(complaint("/dev/full"), HasSubstr("/dev/full: cannot be written: No space left"));
}

TEST_F(Output, GoesIntoWhatThisProcessHasOpenWhereItIs) {
  const fs::path file = _folder / "open";
  const int number = open(file.c_str(), O_WRONLY | O_CREAT, 0600);
  ASSERT_GE(number, 0);
  ASSERT_EQ(write(number, "before ", 7), 7);
  const std::string name = std::to_string(number);
  fs::create_symlink("/proc/self/fd/" + name, _folder / "link");
  for (const fs::path& path : {fs::path("/dev/fd/" + name), _folder / "link"}) {
    EXPECT_EQ(target_of(path).descriptor, number);
    check_writable(path);
    write_file(path, "x");
  }
  EXPECT_EQ(content(file), "before xx");
  close(number);
}

TEST_F(Output, IsStandardOutputByEachOfItsNames) {
  const fs::path file = _folder / "redirected";
  const int number = open(file.c_str(), O_WRONLY | O_CREAT, 0600);
  const int former = dup(STDOUT_FILENO);
  ASSERT_EQ(dup2(number, STDOUT_FILENO), STDOUT_FILENO);
  fs::create_symlink("/dev/stdout", _folder / "link");
  for (const fs::path& path : {fs::path("-"), fs::path("/dev/stdout"), fs::path("/proc/self/fd/1"),
                               _folder / "link", file}) {
    check_writable(path);
    EXPECT_TRUE(target_of(path).is_standard_output()) << path;
    write_file(path, "x");
  }
  dup2(former, STDOUT_FILENO);
  close(former);
  close(number);
  EXPECT_EQ(content(file), "xxxxx");
  EXPECT_EQ(target_of(file).kind, Target::Kind::file) << "now that it is not";
  EXPECT_FALSE(fs::exists("-"));
}

TEST_F(Output, ThatIsCutOffLeavesWhatWasThere) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1'000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string much(5'000, 'x');
  const std::string old = complaint(_folder / "scratch/old", much);
  const std::string other = complaint(_folder / "scratch/other", much);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(old, HasSubstr("cannot be written: File too large"));
  EXPECT_THAT(other, HasSubstr("ulimit -f"));
  EXPECT_EQ(content(_folder / "scratch/old"), "old");
  EXPECT_EQ(files_in(_folder / "scratch"), 1u);
}

}  // namespace
}  // namespace anticrack::output

// SPDX-License-Identifier: GPL-3.0-or-later
//
// A disk that fails, or a process that is killed, at every single call that writes.
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "store/operations.hpp"
#include "store/sqlite.hpp"
#include "store/store_fixture.hpp"
#include "support/process.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::Process;
using anticrack::testing::TemporaryFolder;

constexpr const char* folders[] = {"meshes", "results", "uploads"};

struct Outcome {
  int exit = 0;
  std::size_t acknowledged = 0;
  std::vector<std::string> refusals;  ///< reasons
  std::string output;
};

/// The driver on a folder with these faults.
Outcome drive(const std::string& folder, std::vector<std::string> environment) {
  environment.insert(environment.end(), {"LD_PRELOAD=" FAULTS_LIBRARY, "FAULTS_FOLDER=" + folder,
                                         "ASAN_OPTIONS=verify_asan_link_order=0"});
  Process driver({STORE_DRIVER, folder}, environment);
  Outcome run;
  run.exit = driver.wait().value_or(-1);
  run.output = driver.output() + driver.error();
  std::istringstream lines(run.output);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string what, name, reason;
    words >> what >> name >> reason;
    run.acknowledged += what == "done" ? 1 : 0;
    // Opening says storage, whatever the cause: nobody waits there for space.
    if (what == "refused" && name != "open") run.refusals.push_back(reason);
  }
  return run;
}

std::set<std::string> listed(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

std::set<std::string> rows(Connection& connection, const std::string& sql) {
  std::set<std::string> values;
  Statement select = connection.prepare(sql);
  while (select.step()) values.insert(select.text(0));
  return values;
}

class StoreFaults : public ::testing::Test {
 protected:
  void SetUp() override {
#ifdef __SANITIZE_THREAD__
    GTEST_SKIP() << "the driver has one thread: ThreadSanitizer would only make it slow";
#endif
    // In memory where the system has such a folder: thousands of flushes are no test of a disk.
    if (std::filesystem::is_directory("/dev/shm")) ::setenv("TMPDIR", "/dev/shm", 1);
    // What is there after 0, 1, 2, ... operations.
    const TemporaryFolder folder;
    const auto store = open({folder.path(), 0});
    expected.push_back(content(*store));
    for (const Operation& operation : operations()) {
      operation(*store);
      expected.push_back(content(*store));
    }
  }

  void TearDown() override {
    if (_temporary) {
      ::setenv("TMPDIR", _temporary->c_str(), 1);
    } else {
      ::unsetenv("TMPDIR");
    }
  }

  /// Calls that write, of a driver nobody disturbs.
  static long count_calls() {
    const TemporaryFolder outside;
    const TemporaryFolder folder;
    const std::string path = (outside / "count").string();
    const Outcome run = drive(folder.path(), {"FAULTS_COUNT=" + path});
    EXPECT_EQ(run.exit, 0) << run.output;
    EXPECT_EQ(run.acknowledged, operations().size());
    EXPECT_TRUE(run.refusals.empty()) << run.output;
    long count = 0;
    std::ifstream(path) >> count;
    EXPECT_GT(count, 100) << "the driver's writing is not seen";
    return count;
  }

  /// Opens what the driver left, and compares: the operations it acknowledged, and of the next one
  /// all or nothing.
  void expect_whole(const std::string& folder, const Outcome& run) const {
    const auto store = open({folder, 0});
    const std::string found = content(*store);
    const std::size_t next = std::min(run.acknowledged + 1, expected.size() - 1);
    EXPECT_TRUE(found == expected[run.acknowledged] || found == expected[next])
        << "after " << run.acknowledged << " operations there is\n"
        << found << "\n"
        << run.output;
    Connection database(folder + "/anticrack.db");
    EXPECT_EQ(rows(database, "PRAGMA integrity_check"), std::set<std::string>{"ok"});
    const std::map<std::string, std::string> names{
        {"meshes", "SELECT sha256 FROM meshes WHERE sha256 <> ''"},
        {"results", "SELECT result FROM jobs WHERE result <> ''"},
        {"uploads", "SELECT sha256 FROM uploads"}};
    for (const auto& [name, sql] : names) {
      EXPECT_EQ(listed(folder + "/" + name), rows(database, sql)) << name;
    }
  }

  /// The driver with one fault at every call (every `step`th), one run for each. Returns how often
  /// it was refused.
  std::map<std::string, int> at_every_call(const std::string& error, int exit, long step = 1) {
    std::map<std::string, int> refusals;
    const long calls = count_calls();
    for (long n = 1; n <= calls && !HasFailure(); n += step) {
      SCOPED_TRACE(error + " at call " + std::to_string(n) + " of " + std::to_string(calls));
      const TemporaryFolder folder;
      const Outcome run =
          drive(folder.path(), {"FAULTS_AT=" + std::to_string(n), "FAULTS_ERROR=" + error});
      EXPECT_EQ(run.exit, exit) << run.output;
      if (exit == 0) {
        EXPECT_EQ(run.acknowledged, operations().size()) << run.output;
      }
      for (const std::string& reason : run.refusals) ++refusals[reason];
      expect_whole(folder.path(), run);
    }
    return refusals;
  }

  static constexpr int killed = 128 + 9;
  std::vector<std::string> expected;

 private:
  static std::optional<std::string> temporary() {
    const char* const value = std::getenv("TMPDIR");
    return value == nullptr ? std::nullopt : std::optional<std::string>(value);
  }
  const std::optional<std::string> _temporary = temporary();
};

TEST_F(StoreFaults, KilledAtEveryCall) { EXPECT_TRUE(at_every_call("KILL", killed).empty()); }

TEST_F(StoreFaults, KilledInTheMiddleOfAWrite) {
  EXPECT_TRUE(at_every_call("TORN", killed, 3).empty());
}

TEST_F(StoreFaults, NoSpaceAtEveryCall) {
  const auto refusals = at_every_call("ENOSPC", 0);
  EXPECT_THAT(refusals, ::testing::ElementsAre(::testing::Key("DISK_FULL")));
  EXPECT_GT(refusals.at("DISK_FULL"), 50);
}

TEST_F(StoreFaults, AnErrorOfTheDiskAtEveryCall) {
  const auto refusals = at_every_call("EIO", 0);
  EXPECT_THAT(refusals, ::testing::ElementsAre(::testing::Key("STORAGE")));
  EXPECT_GT(refusals.at("STORAGE"), 50);
}

TEST_F(StoreFaults, AWriteThatIsNotFinished) {
  EXPECT_TRUE(at_every_call("SHORT", 0, 5).empty()) << "the rest can be written";
}

TEST_F(StoreFaults, SpaceThatReturns) {
  const TemporaryFolder outside;
  const TemporaryFolder folder;
  const std::string control = (outside / "full").string();
  std::ofstream(control) << "x";
  const std::vector<std::string> environment{"FAULTS_SWITCH=" + control, "FAULTS_ERROR=ENOSPC"};
  EXPECT_EQ(drive(folder.path(), environment).exit, 3);
  std::filesystem::remove(control);
  const Outcome run = drive(folder.path(), environment);
  EXPECT_EQ(run.exit, 0) << run.output;
  expect_whole(folder.path(), run);
}

TEST_F(StoreFaults, AFullDiskForGood) {
  const long calls = count_calls();
  for (long n = 1; n <= calls && !HasFailure(); n += 7) {
    SCOPED_TRACE("no space from call " + std::to_string(n));
    const TemporaryFolder folder;
    const Outcome run = drive(
        folder.path(), {"FAULTS_AT=" + std::to_string(n), "FAULTS_FROM=1", "FAULTS_ERROR=ENOSPC"});
    EXPECT_TRUE(run.exit == 3 || run.acknowledged == operations().size()) << run.output;
    for (const std::string& reason : run.refusals) EXPECT_EQ(reason, "DISK_FULL") << run.output;
    expect_whole(folder.path(), run);
  }
}

}  // namespace
}  // namespace anticrack::store

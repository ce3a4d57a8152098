// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/machine.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "app/control_group.hpp"
#include "app/values.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::app {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Optional;

constexpr const char* second =
    "30 23 0:27 / /sys/fs/cgroup rw,nosuid - cgroup2 cgroup2 rw,nsdelegate\n";
constexpr const char* memory = "35 31 0:32 / /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory\n";
constexpr const char* cpu =
    "36 31 0:33 / /sys/fs/cgroup/cpu,cpuacct rw shared:9 - cgroup cgroup rw,cpu,cpuacct\n";

/// /proc and /sys in a folder.
class ControlGroup : public ::testing::Test {
 protected:
  ControlGroup() { write("/proc/self/mountinfo", "23 1 8:1 / / rw - ext4 /dev/sda1 rw\n"); }

  void write(const std::string& path, const std::string& text) {
    std::filesystem::create_directories(std::filesystem::path(_folder.path() + path).parent_path());
    std::ofstream(_folder.path() + path, std::ios::app) << text;
  }
  void remove(const std::string& path) { std::filesystem::remove(_folder.path() + path); }
  void mount(const std::string& line) { write("/proc/self/mountinfo", line); }
  void group(const std::string& line) { write("/proc/self/cgroup", line); }
  GroupLimits limits() { return group_limits(_folder.path()); }
  Machine machine() { return this_machine(_folder.path()); }

 private:
  anticrack::testing::TemporaryFolder _folder;
};

TEST_F(ControlGroup, ThatIsMissingLimitsNothing) {
  EXPECT_FALSE(limits().memory_bytes || limits().processors);
  EXPECT_FALSE(group_limits("/does/not/exist").memory_bytes);
  EXPECT_EQ(machine().memory_limit, "the memory of the machine");
}

TEST_F(ControlGroup, OfVersion2LimitsMemoryAndProcessors) {
  mount(second);
  group("0::/service\n");
  write("/sys/fs/cgroup/service/memory.max", "700000000\n");
  write("/sys/fs/cgroup/service/cpu.max", "150000 100000\n");
  EXPECT_THAT(limits().memory_bytes, Optional(700'000'000));
  EXPECT_EQ(limits().memory_file, "/sys/fs/cgroup/service/memory.max");
  EXPECT_THAT(limits().processors, Optional(1.5));
  EXPECT_EQ(machine().memory_bytes, 700'000'000U);
  EXPECT_LE(machine().processors, 2);
}

TEST_F(ControlGroup, OfVersion2CountsWithTheTightestOfThoseAroundIt) {
  mount(second);
  group("0::/a/b/c\n");
  write("/sys/fs/cgroup/a/b/c/memory.max", "max\n");
  write("/sys/fs/cgroup/a/b/memory.max", "900000000\n");
  write("/sys/fs/cgroup/a/memory.max", "800000000\n");
  write("/sys/fs/cgroup/memory.max", "1000000000\n");
  write("/sys/fs/cgroup/a/b/c/cpu.max", "400000 100000\n");
  write("/sys/fs/cgroup/a/b/cpu.max", "25000 50000\n");
  write("/sys/fs/cgroup/a/cpu.max", "max 100000\n");
  EXPECT_THAT(limits().memory_bytes, Optional(800'000'000));
  EXPECT_THAT(limits().processors, Optional(0.5));
  EXPECT_EQ(machine().processors, 1);
}

TEST_F(ControlGroup, IsNotToBeSlowedDown) {
  mount(second);
  group("0::/a\n");
  write("/sys/fs/cgroup/a/memory.max", "900000000\n");
  write("/sys/fs/cgroup/a/memory.high", "600000000\n");
  EXPECT_THAT(limits().memory_bytes, Optional(600'000'000));
}

TEST_F(ControlGroup, OfVersion2AtTheTopOfAContainer) {
  mount(second);
  group("0::/\n");
  write("/sys/fs/cgroup/memory.max", "500000000\n");
  write("/sys/fs/cgroup/cpu.max", "200000 100000\n");
  EXPECT_THAT(limits().memory_bytes, Optional(500'000'000));
  EXPECT_THAT(limits().processors, Optional(2.0));
}

TEST_F(ControlGroup, OfVersion1LimitsMemoryAndProcessors) {
  mount(memory);
  mount(cpu);
  group("9:name=systemd:/\n4:memory:/one/two\n3:cpu,cpuacct:/three\n0::/\n");
  write("/sys/fs/cgroup/memory/one/two/memory.limit_in_bytes", "9223372036854771712\n");
  write("/sys/fs/cgroup/memory/one/memory.limit_in_bytes", "700002304\n");
  write("/sys/fs/cgroup/cpu,cpuacct/three/cpu.cfs_quota_us", "100000\n");
  write("/sys/fs/cgroup/cpu,cpuacct/three/cpu.cfs_period_us", "100000\n");
  EXPECT_THAT(limits().memory_bytes, Optional(700'002'304));
  EXPECT_THAT(limits().memory_file, EndsWith("/one/memory.limit_in_bytes"));
  EXPECT_THAT(limits().processors, Optional(1.0));
  EXPECT_EQ(machine().processors, 1);
}

TEST_F(ControlGroup, OfVersion1WithoutAQuota) {
  mount(cpu);
  group("3:cpu,cpuacct:/three\n");
  write("/sys/fs/cgroup/cpu,cpuacct/three/cpu.cfs_quota_us", "-1\n");
  write("/sys/fs/cgroup/cpu,cpuacct/three/cpu.cfs_period_us", "100000\n");
  EXPECT_FALSE(limits().processors);
}

TEST_F(ControlGroup, OfVersion1InAContainerThatSeesItsOwnPartOnly) {
  mount("35 31 0:32 /docker/ab /sys/fs/cgroup/memory ro - cgroup cgroup rw,memory\n");
  group("4:memory:/docker/ab\n");
  write("/sys/fs/cgroup/memory/memory.limit_in_bytes", "700000000\n");
  // A group outside the container is tighter, and only told of here.
  write("/sys/fs/cgroup/memory/memory.stat",
        "cache 1\nhierarchical_memory_limit 650000000\ntotal_cache 2\n");
  EXPECT_THAT(limits().memory_bytes, Optional(650'000'000));
  EXPECT_THAT(limits().memory_file, EndsWith("memory.stat"));
}

TEST_F(ControlGroup, InsideAContainersOwn) {
  mount("35 31 0:32 /docker/ab /sys/fs/cgroup/memory ro - cgroup cgroup rw,memory\n");
  group("4:memory:/docker/ab/inner\n");
  write("/sys/fs/cgroup/memory/memory.limit_in_bytes", "700000000\n");
  write("/sys/fs/cgroup/memory/inner/memory.limit_in_bytes", "300000000\n");
  EXPECT_THAT(limits().memory_bytes, Optional(300'000'000));
}

TEST_F(ControlGroup, ThatAContainerKnowsByAnotherName) {
  mount("35 31 0:32 /outer/ab /sys/fs/cgroup/memory ro - cgroup cgroup rw,memory\n");
  group("4:memory:/ab\n");
  write("/sys/fs/cgroup/memory/memory.limit_in_bytes", "700000000\n");
  EXPECT_THAT(limits().memory_bytes, Optional(700'000'000));
}

TEST_F(ControlGroup, OutsideWhatCanBeSeen) {
  mount(second);
  group("0::/../../other\n");
  write("/sys/fs/cgroup/memory.max", "400000000\n");
  EXPECT_THAT(limits().memory_bytes, Optional(400'000'000));
}

TEST_F(ControlGroup, OfAnotherMountIsNotMeant) {
  mount("35 31 0:32 /foreign /mnt/foreign rw - cgroup cgroup rw,memory\n");
  group("4:memory:/mine\n");
  write("/mnt/foreign/memory.limit_in_bytes", "1000000\n");
  EXPECT_FALSE(limits().memory_bytes);
}

TEST_F(ControlGroup, OfBothVersions) {
  mount("41 31 0:38 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n");
  mount(memory);
  group("4:memory:/a\n0::/b\n");
  write("/sys/fs/cgroup/memory/a/memory.limit_in_bytes", "700000000\n");
  write("/sys/fs/cgroup/unified/b/cpu.max", "300000 100000\n");
  EXPECT_THAT(limits().memory_bytes, Optional(700'000'000));
  EXPECT_THAT(limits().processors, Optional(3.0));
}

TEST_F(ControlGroup, WithOddNames) {
  mount("35 31 0:32 / /sys/fs/cgroup/a\\040b rw - cgroup2 cgroup rw\n");
  group("0::/c:d e (deleted)\n");
  write("/sys/fs/cgroup/a b/c:d e (deleted)/memory.max", "700000000\n");
  EXPECT_THAT(limits().memory_bytes, Optional(700'000'000));
}

TEST_F(ControlGroup, WithDamagedFilesLimitsNothing) {
  mount(second);
  mount("damaged - cgroup2\n");
  group("0::nowhere\nrubbish\n::\n");
  for (const char* text : {"", "-1", "max", "1e9", "700000000000000000000000", "12 x"}) {
    remove("/sys/fs/cgroup/memory.max");
    write("/sys/fs/cgroup/memory.max", text);
    EXPECT_FALSE(limits().memory_bytes) << text;
  }
  write("/sys/fs/cgroup/cpu.max", "100000 0\n");
  EXPECT_FALSE(limits().processors);
}

TEST_F(ControlGroup, IsNoReasonForMoreThanTheMachineHas) {
  const Machine bare = machine();
  mount(second);
  group("0::/a\n");
  write("/sys/fs/cgroup/a/memory.max", "9000000000000000000\n");
  write("/sys/fs/cgroup/a/cpu.max", "900000000 100000\n");
  EXPECT_EQ(machine().memory_bytes, bare.memory_bytes);
  EXPECT_EQ(machine().processors, bare.processors);
}

/// What the real server makes of limits, run by a shell that sets them first.
std::string checked_config(const std::string& before) {
  anticrack::testing::Process server(
      {"/bin/sh", "-c",
       before + " && exec " ANTICRACKD " --data-dir d --listen unix:s --check-config"});
  EXPECT_EQ(server.wait(), 0) << server.error();
  return server.output();
}

TEST(Machine, GivesTheServerTheProcessorsItMayRunOn) {
  cpu_set_t own;
  ASSERT_EQ(::sched_getaffinity(0, sizeof own, &own), 0);
  int first = 0;
  while (!CPU_ISSET(first, &own)) ++first;
  EXPECT_THAT(checked_config("taskset -cp " + std::to_string(first) + " $$ >&2"),
              HasSubstr("threads = 1\n"));
}

// Sanitizers reserve more than any limit.
#ifdef __has_feature  // clang
#define ANTICRACK_SANITIZED (__has_feature(address_sanitizer) || __has_feature(thread_sanitizer))
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ANTICRACK_SANITIZED 1
#else
#define ANTICRACK_SANITIZED 0
#endif

#if !ANTICRACK_SANITIZED

TEST(Machine, GivesTheServerHalfOfWhatUlimitLeaves) {
  const std::string output = checked_config("ulimit -v 8000000");
  const std::string key = "memory-budget = \"";
  const std::size_t begin = output.find(key) + key.size();
  const std::uint64_t budget = to_bytes(output.substr(begin, output.find('"', begin) - begin));
  EXPECT_GE(budget, 64U << 20);
  EXPECT_LT(budget, 4'000'000 * std::uint64_t{1024});
}

/// Whatever the value, the server serves or says which limit is too small.
TEST(Machine, WithTooSmallAUlimitIsRefused) {
  int served = 0, refused = 0;
  for (int mebibytes = 100; mebibytes <= 2600; mebibytes += 100) {
    const anticrack::testing::TemporaryFolder folder;
    anticrack::testing::Process server(
        {"/bin/sh", "-c",
         "ulimit -c 0; ulimit -v " + std::to_string(mebibytes * 1024) +
             "; exec " ANTICRACKD " --threads 2 --data-dir " + folder.path() +
             "/d --listen unix:" + folder.path() + "/s"});
    if (server.wait_for_output("listening")) {
      server.signal(SIGTERM);
      EXPECT_EQ(server.wait(), 0) << mebibytes << " MiB: " << server.error();
      ++served;
      continue;
    }
    EXPECT_EQ(served, 0) << "less is enough than " << mebibytes << " MiB";
    const int code = server.wait().value_or(-1);
    EXPECT_TRUE(code == 2 || code == 127) << mebibytes << " MiB ended with " << code;
    EXPECT_THAT(server.error(),
                ::testing::AnyOf(HasSubstr("ulimit -v"), HasSubstr("loading shared libraries")));
    ++refused;
  }
  EXPECT_GT(refused, 0);
}

#endif

/// A real group, where this machine has the first version and lets us make one.
TEST(Machine, GivesTheServerHalfOfWhatARealGroupAllows) {
  const std::string group =
      "/sys/fs/cgroup/memory/anticrack-test-" + std::to_string(::getpid()) + "/inner";
  std::error_code error;
  std::filesystem::create_directories(group, error);
  const std::string outer = std::filesystem::path(group).parent_path();
  if (!error) std::ofstream(outer + "/memory.limit_in_bytes") << (512 << 20);
  std::string limit;
  std::ifstream(outer + "/memory.limit_in_bytes") >> limit;
  const bool made = limit == "536870912";
  const std::string output =
      made ? checked_config("echo $$ > " + group + "/cgroup.procs") : std::string();
  ::rmdir(group.c_str());
  ::rmdir(outer.c_str());
  if (!made) GTEST_SKIP() << "no group can be made under /sys/fs/cgroup/memory";
  EXPECT_THAT(output, HasSubstr("memory-budget = \"256MiB\"\n"));
}

}  // namespace
}  // namespace anticrack::app

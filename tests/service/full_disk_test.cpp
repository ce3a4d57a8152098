// SPDX-License-Identifier: GPL-3.0-or-later
//
// A data folder of a few MiB that fills up while a job runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "client/jobs.hpp"
#include "client/meshes.hpp"
#include "service/daemon.hpp"
#include "service/stored_data.hpp"
#include "service/workload.hpp"
#include "support/eventually.hpp"

namespace anticrack::service_test {
namespace {

using ::testing::IsEmpty;

/// A small file system in memory, unmounted at the end of the scope.
class SmallDisk {
 public:
  explicit SmallDisk(std::string path) : _path(std::move(path)) {
    std::filesystem::create_directory(_path);
    if (mount("tmpfs", _path.c_str(), "tmpfs", 0, "size=24m,mode=0700") != 0) {
      _problem = std::strerror(errno);
    }
  }
  ~SmallDisk() {
    if (_problem.empty()) umount2(_path.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  /// Why it could not be mounted; empty where it is.
  const std::string& problem() const noexcept { return _problem; }
  void fill() const {
    std::ofstream file(_path + "/filler", std::ios::binary | std::ios::app);
    const std::string block(4096, 'x');
    while (file.write(block.data(), static_cast<std::streamsize>(block.size())).flush()) {
    }
  }
  void make_room() const { std::filesystem::remove(_path + "/filler"); }

 private:
  std::string _path;
  std::string _problem;
};

/// The code with which a submission is refused at once; ok where it is taken.
client::Code refusal(const Daemon& daemon, const Work& work) {
  client::ConnectionOptions options = daemon.connection();
  options.retry.patience = std::chrono::milliseconds(0);
  client::Connection connection(options);
  try {
    submit(connection, work, client::make_uuid());
  } catch (const client::Error& error) {
    return error.code();
  }
  return client::Code::ok;
}

TEST(FullDisk, RefusesCleanlyAndLosesNothing) {
  const anticrack::testing::TemporaryFolder folder;
  const SmallDisk disk((folder / "disk").string());
  if (!disk.problem().empty()) {
    GTEST_SKIP() << "a file system cannot be mounted here: " << disk.problem();
  }
  Daemon daemon(folder / "disk" / "data", {});
  client::Connection connection(daemon.connection());
  const Work work_of_this = work("paper-3.toml", iterations(20'000));
  const std::string before = submit(connection, work_of_this, client::make_uuid()).name();
  EXPECT_TRUE(ran_to_its_end(wait_for_end(connection, before)));

  const std::string meanwhile = submit(connection, work_of_this, client::make_uuid()).name();
  ASSERT_TRUE(anticrack::testing::eventually([&] {
    return client::get_job(connection, meanwhile).status().state() >= v1::JobStatus::STATE_RUNNING;
  }));
  disk.fill();
  ASSERT_TRUE(anticrack::testing::eventually([&] {
    disk.fill();  // what the server gave back
    return refusal(daemon, work_of_this) == client::Code::resource_exhausted;
  }));
  EXPECT_TRUE(ran_to_its_end(client::get_job(connection, before)));
  EXPECT_NO_THROW(client::read_result(connection, before)) << "reading needs no room";

  disk.make_room();
  EXPECT_TRUE(ran_to_its_end(wait_for_end(connection, meanwhile)));
  EXPECT_EQ(difference(client::read_result(connection, meanwhile),
                       client::read_result(connection, before)),
            "");
  EXPECT_TRUE(anticrack::testing::eventually(
      [&] { return refusal(daemon, work_of_this) == client::Code::ok; }));
  EXPECT_EQ(daemon.stop(), 0);
  EXPECT_THAT(flaws_of(daemon.data()), IsEmpty());
}

TEST(FullDisk, AMeshThatWasAcknowledgedGoesOnWhenThereIsRoom) {
  const anticrack::testing::TemporaryFolder folder;
  const SmallDisk disk((folder / "disk").string());
  if (!disk.problem().empty()) {
    GTEST_SKIP() << "a file system cannot be mounted here: " << disk.problem();
  }
  Daemon daemon(folder / "disk" / "data", {});
  client::Connection connection(daemon.connection());
  // Seconds in the mesher, and a triangulation of some MiB.
  const Work large = work("paper-3.toml", {"mesh.preset=\"uniform\"", "mesh.size=0.01"});
  const std::string mesh = client::create_mesh(connection, large.mesh).name();
  disk.fill();
  const auto state = [&] { return client::get_mesh(connection, mesh).state(); };
  ASSERT_TRUE(anticrack::testing::eventually([&] { return state() != v1::Mesh::STATE_PENDING; }));
  ASSERT_TRUE(anticrack::testing::eventually([&] {
    disk.fill();
    return state() == v1::Mesh::STATE_PENDING;
  })) << "the disk has no room for it";
  disk.make_room();
  EXPECT_TRUE(anticrack::testing::eventually([&] { return client::settled(state()); }));
  EXPECT_NE(state(), v1::Mesh::STATE_FAILED);
  EXPECT_EQ(daemon.stop(), 0);
  EXPECT_THAT(flaws_of(daemon.data()), IsEmpty());
}

}  // namespace
}  // namespace anticrack::service_test

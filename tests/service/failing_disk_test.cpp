// SPDX-License-Identifier: GPL-3.0-or-later
//
// A disk that refuses every write of a running server for a while.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "client/jobs.hpp"
#include "service/daemon.hpp"
#include "service/stored_data.hpp"
#include "service/workload.hpp"
#include "support/eventually.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::service_test {
namespace {

using ::testing::IsEmpty;

class FailingDisk : public ::testing::TestWithParam<const char*> {
 protected:
  void fail() const { std::ofstream(_switch) << "now\n"; }
  void recover() const { std::filesystem::remove(_switch); }

  /// Whether a submission is refused at once.
  bool refuses(const Work& work) const {
    client::ConnectionOptions options = daemon.connection();
    options.retry.patience = std::chrono::milliseconds(0);
    client::Connection connection(options);
    try {
      submit(connection, work, client::make_uuid());
    } catch (const client::Error&) {
      return true;
    }
    return false;
  }

 private:
  const anticrack::testing::TemporaryFolder _folder;
  const std::filesystem::path _switch = _folder / "switch";

 protected:
  Daemon daemon{_folder / "data",
                {},
                {"LD_PRELOAD=" FAULTS_LIBRARY, "FAULTS_FOLDER=" + (_folder / "data").string(),
                 "FAULTS_SWITCH=" + _switch.string(), std::string("FAULTS_ERROR=") + GetParam(),
                 "ASAN_OPTIONS=verify_asan_link_order=0"}};
};

TEST_P(FailingDisk, KeepsAResultUntilItCanBeWritten) {
  client::Connection connection(daemon.connection());
  const Work work_of_this = work("paper-3.toml", iterations(100'000));
  const std::string before = submit(connection, work_of_this, client::make_uuid()).name();
  EXPECT_TRUE(ran_to_its_end(wait_for_end(connection, before)));

  const std::string meanwhile = submit(connection, work_of_this, client::make_uuid()).name();
  ASSERT_TRUE(anticrack::testing::eventually([&] {
    return client::get_job(connection, meanwhile).status().state() == v1::JobStatus::STATE_RUNNING;
  }));
  fail();
  EXPECT_TRUE(refuses(work_of_this));
  ASSERT_TRUE(anticrack::testing::eventually([&] {
    const v1::Job job = client::get_job(connection, meanwhile);
    return !job.status().timeline().empty() &&
           job.status().timeline().rbegin()->detail() == "writing the result";
  }));
  EXPECT_EQ(client::get_job(connection, meanwhile).status().state(), v1::JobStatus::STATE_RUNNING);
  EXPECT_TRUE(refuses(work_of_this));
  EXPECT_NO_THROW(client::read_result(connection, before)) << "reading writes nothing";

  recover();
  EXPECT_TRUE(ran_to_its_end(wait_for_end(connection, meanwhile)));
  EXPECT_EQ(difference(client::read_result(connection, meanwhile),
                       client::read_result(connection, before)),
            "");
  EXPECT_FALSE(refuses(work_of_this));
  EXPECT_EQ(daemon.stop(), 0);
  EXPECT_THAT(flaws_of(daemon.data()), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Errors, FailingDisk, ::testing::Values("ENOSPC", "EIO"));

}  // namespace
}  // namespace anticrack::service_test

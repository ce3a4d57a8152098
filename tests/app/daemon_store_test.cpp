// SPDX-License-Identifier: GPL-3.0-or-later
//
// The real executable and its database: what it says of one that it cannot use, and when it is
// gone.
#include <gmock/gmock.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/security/credentials.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <future>
#include <memory>

#include "support/database.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::app {
namespace {

using anticrack::testing::eventually;
using anticrack::testing::Process;
using ::testing::HasSubstr;
using ::testing::Not;

class DaemonStore : public ::testing::Test {
 protected:
  std::unique_ptr<Process> start(const std::string& url, const std::string& password = "") {
    return std::make_unique<Process>(
        std::vector<std::string>{ANTICRACKD, "--listen", address(), "--data-dir", _folder / "data",
                                 "--store", url},
        std::vector<std::string>{"PGPASSWORD=" + password, "PGPASSFILE=/nowhere"});
  }
  /// What it says when it does not start.
  std::string refused(int code, const std::string& url, const std::string& password = "") {
    const auto daemon = start(url, password);
    EXPECT_EQ(daemon->wait(), code) << url;
    return daemon->error();
  }
  std::string address() const { return "unix:" + _folder.path() + "/socket"; }
  /// Whether it tells balancers to send it calls.
  bool serves() const {
    grpc::GenericStub stub(grpc::CreateChannel(address(), grpc::InsecureChannelCredentials()));
    grpc::ClientContext context;
    const grpc::Slice nothing("");
    const grpc::ByteBuffer request(&nothing, 1);
    grpc::ByteBuffer response;
    std::promise<bool> ok;
    stub.UnaryCall(&context, "/grpc.health.v1.Health/Check", grpc::StubOptions(), &request,
                   &response, [&](const grpc::Status& status) { ok.set_value(status.ok()); });
    grpc::Slice flat;
    constexpr std::uint8_t serving = 1;
    return ok.get_future().get() && response.DumpToSingleSlice(&flat).ok() && flat.size() == 2 &&
           flat.begin()[1] == serving;
  }

  anticrack::testing::TemporaryFolder _folder;
  anticrack::testing::Database _database;
};

TEST_F(DaemonStore, SaysWhyItDoesNotStart) {
  const std::string url = _database.fresh();
  const std::string name = url.substr(url.rfind('/', url.find('?')) + 1);
  const std::string guarded =
      "postgresql://" + std::string(anticrack::testing::Database::guarded) + "@/" + name;
  EXPECT_THAT(refused(1, guarded), HasSubstr("no password was given"));
  EXPECT_THAT(refused(1, guarded, "wrong"), HasSubstr("give the right password in ~/.pgpass"));
  EXPECT_THAT(refused(1, "postgresql://ann@/crack?host=" + _folder.path() + "/none"),
              HasSubstr("check that it runs and can be reached from here"));
  EXPECT_THAT(refused(2, "mysql://ann@db/crack"), HasSubstr("store: this is no address"));
  const std::string shown = refused(2, "postgresql://ann:secret@db/crack");
  EXPECT_THAT(shown, HasSubstr("PGPASSFILE"));
  EXPECT_THAT(shown, Not(HasSubstr("secret")));

  const auto daemon = start(url);
  ASSERT_TRUE(daemon->wait_for_output("\n")) << daemon->error();
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->error();
  _database.sql("UPDATE anticrack.tables SET version = 99, oldest = 99",
                name.substr(0, name.find('?')));
  EXPECT_THAT(refused(1, url), HasSubstr("start the newer anticrack that made them"));
}

TEST_F(DaemonStore, IsNotReadyWhileTheDatabaseIsGone) {
  const auto daemon = start(_database.fresh());
  ASSERT_TRUE(daemon->wait_for_output("\n")) << daemon->error();
  EXPECT_TRUE(serves());
  _database.stop();
  EXPECT_TRUE(eventually([&] { return !serves(); }));
  EXPECT_THAT(daemon->error(), HasSubstr("out_of_reach_for_s=5"));
  _database.start();
  EXPECT_TRUE(eventually([&] { return serves(); }));
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->error();
}

}  // namespace
}  // namespace anticrack::app

// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>
#include <stdexcept>

#include "client/jobs.hpp"
#include "client/lib/scripted_server.hpp"

namespace anticrack::client {
namespace {

TEST(Uuid, IsVersionFourAndNewEveryTime) {
  std::set<std::string> seen;
  for (int i = 0; i < 1000; ++i) seen.insert(make_uuid());
  EXPECT_EQ(seen.size(), 1000U);
  EXPECT_THAT(seen, ::testing::Each(::testing::MatchesRegex("[0-9a-f]{8}-[0-9a-f]{4}-4[0-9a-f]{3}-"
                                                            "[89ab][0-9a-f]{3}-[0-9a-f]{12}")));
}

TEST(CreateJob, RetriesUnderTheSameId) {
  ScriptedServer server;
  server.creations = {{Code::unavailable, "gone"}, {Code::unknown, "Stream removed"}, {}};
  Connection connection(server.options());
  const std::string id = make_uuid();
  v1::JobSpec job;
  job.set_title("A plate");
  EXPECT_EQ(create_job(connection, job, id).name(), "jobs/1");
  const auto requests = server.created();
  ASSERT_EQ(requests.size(), 3U);
  for (const v1::CreateJobRequest& request : requests) {
    EXPECT_EQ(request.request_id(), id);
    EXPECT_EQ(request.spec().title(), "A plate");
  }
}

TEST(CreateJob, IsNotRepeatedWhenRefused) {
  ScriptedServer server;
  server.creations = {{Code::invalid_argument, "theta is 0"}};
  Connection connection(server.options());
  EXPECT_THROW(create_job(connection, {}, make_uuid()), Error);
  EXPECT_EQ(server.created().size(), 1U);
}

TEST(DeleteJob, ThatWentThroughUnheardIsNoError) {
  ScriptedServer server;
  server.deletions = {{Code::unavailable, "gone"}, {Code::not_found, "no such job"}};
  Connection connection(server.options());
  EXPECT_NO_THROW(delete_job(connection, "jobs/1"));
  EXPECT_THROW(delete_job(connection, "jobs/1"), Error) << "this one had not been there";
}

TEST(CreateJob, WaitsOutAQueueThatIsFull) {
  ScriptedServer server;
  server.creations = {{Code::resource_exhausted, "queue full", std::chrono::milliseconds(1)}, {}};
  Connection connection(server.options());
  EXPECT_EQ(create_job(connection, {}, make_uuid()).name(), "jobs/1");
  EXPECT_EQ(server.created().size(), 2U);
}

TEST(Connection, TellsThatItTriesAgain) {
  ScriptedServer server;
  server.creations = {{Code::unavailable, "gone"}, {}};
  ConnectionOptions options = server.options();
  std::vector<std::string> notices;
  options.notice = [&notices](const std::string& message) { notices.push_back(message); };
  Connection connection(options);
  create_job(connection, {}, make_uuid());
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_THAT(notices[0], ::testing::HasSubstr(options.address));
}

TEST(Connection, ToNobodyFailsWithTheAddressAndTheCure) {
  ConnectionOptions options;
  options.address = "unix:/nonexistent/socket";
  options.first_contact = std::chrono::milliseconds(0);
  Connection connection(options);
  try {
    server_info(connection);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Code::unavailable);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("/nonexistent/socket"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("--local"));
  }
}

/// A variable until the end of the scope.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : _name(name) {
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { unsetenv(_name); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* _name;
};

TEST(Connection, ToThisMachineUsesNoProxy) {
  const Variable proxies[]{{"grpc_proxy", "http://127.0.0.1:9"},
                           {"https_proxy", "http://127.0.0.1:9"},
                           {"http_proxy", "http://127.0.0.1:9"}};
  ScriptedServer server;
  server.deletions = {{}};
  Connection connection(server.options());
  EXPECT_NO_THROW(delete_job(connection, "jobs/1"));
}

TEST(Connection, ThroughAProxyThatFailsNamesItsVariable) {
  const Variable proxy("https_proxy", "http://name:secret@127.0.0.1:9");
  ConnectionOptions options;
  options.address = "far.example:7433";
  options.first_contact = std::chrono::milliseconds(0);
  Connection connection(options);
  try {
    server_info(connection);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("https_proxy sends what goes there through the "
                                                   "proxy 127.0.0.1:9"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("no_proxy"));
    EXPECT_THAT(error.what(), ::testing::Not(::testing::HasSubstr("secret")));
  }
}

TEST(Connection, ThatIsLostForGoodEndsTheCallAtOnce) {
  ConnectionOptions options;
  options.address = "unix:/nonexistent/socket";
  options.first_contact = std::chrono::hours(1);
  options.lost = [] { throw std::domain_error("the server is dead"); };
  Connection connection(options);
  EXPECT_THROW(server_info(connection), std::domain_error);
}

}  // namespace
}  // namespace anticrack::client

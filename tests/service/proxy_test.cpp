// SPDX-License-Identifier: GPL-3.0-or-later
//
// Real proxies between the client and a server that is killed: what they make of it is retried.
#include <gtest/gtest.h>

#include <filesystem>

#include "client/jobs.hpp"
#include "service/daemon.hpp"
#include "service/workload.hpp"
#include "support/eventually.hpp"

namespace anticrack::service_test {
namespace {

constexpr const char* haproxy = "/usr/sbin/haproxy";
constexpr const char* nginx = "/usr/sbin/nginx";

/// One way to stand in between: the program, and its configuration for two unix sockets.
struct Proxy {
  std::string name;
  std::string program;
  std::vector<std::string> (*arguments)(const std::string& configuration);
  std::string (*configuration)(const std::string& front, const std::string& back);
};

std::string haproxy_configuration(const std::string& mode, const std::string& protocol,
                                  const std::string& front, const std::string& back) {
  return std::string("defaults\n  mode ") + mode +
         "\n  timeout connect 10s\n  timeout client 1h\n  timeout server 1h\n"
         "listen anticrack\n  bind unix@" +
         front + protocol + "\n  server one unix@" + back + protocol + "\n";
}

std::vector<std::string> haproxy_arguments(const std::string& file) { return {"-db", "-f", file}; }

const std::vector<Proxy> proxies{
    {"HaproxyPassingThrough", haproxy, haproxy_arguments,
     [](const std::string& front, const std::string& back) {
       return haproxy_configuration("tcp", "", front, back);
     }},
    {"HaproxySpeakingHttp2", haproxy, haproxy_arguments,
     [](const std::string& front, const std::string& back) {
       return haproxy_configuration("http", " proto h2", front, back);
     }},
    {"Nginx", nginx,
     [](const std::string& file) {
       return std::vector<std::string>{"-c", file, "-e", "stderr"};
     },
     [](const std::string& front, const std::string& back) {
       return std::string("daemon off;\nmaster_process off;\nuser root;\npid ") + front +
              ".pid;\nerror_log stderr error;\nevents {}\nhttp {\n  access_log off;\n"
              "  server {\n    listen unix:" +
              front +
              " http2;\n    location / {\n      grpc_read_timeout 1h;\n"
              "      grpc_pass grpc://unix:" +
              back + ";\n    }\n  }\n}\n";
     }}};

class ProxyTest : public ::testing::TestWithParam<Proxy> {};

TEST_P(ProxyTest, AKilledServerBehindItIsRetriedAndTheWatchResumed) {
  constexpr int long_run = 100'000;
  if (!std::filesystem::exists(GetParam().program)) {
    GTEST_SKIP() << GetParam().program << " is not installed";
  }
  Daemon daemon;
  const std::string front = (daemon.folder() / "front").string();
  const std::string back = daemon.address().substr(std::string("unix:").size());
  std::vector<std::string> argv = GetParam().arguments(
      write_file(daemon.folder(), "proxy.conf", GetParam().configuration(front, back)));
  argv.insert(argv.begin(), GetParam().program);
  anticrack::testing::Process proxy(argv);
  ASSERT_TRUE(anticrack::testing::eventually([&] { return std::filesystem::exists(front); }))
      << proxy.error();

  std::vector<std::string> arguments = {"run", example("paper-3.toml"), "-o",
                                        daemon.folder() / "out.h5"};
  for (const std::string& override_text : iterations(long_run)) {
    arguments.insert(arguments.end(), {"--set", override_text});
  }
  const auto run = start_client("unix:" + front, arguments);
  // Its first iterations have come through the proxy; most are still to come.
  ASSERT_TRUE(run->wait_for_output("example-3: iteration")) << run->output() << run->error();
  daemon.kill();
  ASSERT_TRUE(run->wait_for_output("trying again")) << run->output() << run->error();
  daemon.start();

  EXPECT_EQ(run->wait(std::chrono::seconds(300)), 3) << run->output() << run->error();
  client::Connection connection(daemon.connection());
  const v1::ListJobsResponse jobs = client::list_jobs(connection, {});
  ASSERT_EQ(jobs.jobs_size(), 1) << "nothing was submitted twice";
  const v1::Job job = client::get_job(connection, jobs.jobs(0).name());
  EXPECT_GE(job.status().attempt(), 2);
  EXPECT_EQ(job.status().answers(0).iterations(), long_run);
  const Work same = work("paper-3.toml", iterations(long_run));
  const std::string alone = submit(connection, same, client::make_uuid()).name();
  wait_for_end(connection, alone);
  EXPECT_EQ(difference(client::read_result(connection, job.name()),
                       client::read_result(connection, alone)),
            "");
}

INSTANTIATE_TEST_SUITE_P(Proxies, ProxyTest, ::testing::ValuesIn(proxies),
                         [](const auto& proxy) { return proxy.param.name; });

}  // namespace
}  // namespace anticrack::service_test

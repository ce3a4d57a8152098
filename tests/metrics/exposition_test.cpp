// SPDX-License-Identifier: GPL-3.0-or-later
//
// What Prometheus gets when it asks over HTTP.
#include <curl/curl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "metrics/metrics.hpp"
#include "records/job_record.hpp"
#include "records/mesh_record.hpp"
#include "support/errors.hpp"
#include "support/process.hpp"

namespace anticrack::metrics {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::size_t append(const char* data, std::size_t size, std::size_t count, void* text) {
  static_cast<std::string*>(text)->append(data, size * count);
  return size * count;
}

/// The body of a GET; empty where there is no answer with 200.
std::string get(const std::string& url) {
  const std::unique_ptr<CURL, decltype(&curl_easy_cleanup)> curl(curl_easy_init(),
                                                                 &curl_easy_cleanup);
  std::string body;
  curl_easy_setopt(curl.get(), CURLOPT_URL, url.c_str());
  curl_easy_setopt(curl.get(), CURLOPT_NOPROXY, "*");
  curl_easy_setopt(curl.get(), CURLOPT_FAILONERROR, 1L);
  curl_easy_setopt(curl.get(), CURLOPT_TIMEOUT, 30L);
  curl_easy_setopt(curl.get(), CURLOPT_WRITEFUNCTION, append);
  curl_easy_setopt(curl.get(), CURLOPT_WRITEDATA, &body);
  return curl_easy_perform(curl.get()) == CURLE_OK ? body : "";
}

records::JobRecord ended_job(records::JobState state) {
  const records::Clock::time_point begin{std::chrono::seconds(1'000'000)};
  records::JobRecord job;
  job.id = "secret-job";
  job.owner = "secret-owner";
  job.state = state;
  job.created = begin;
  job.started = begin + std::chrono::seconds(2);
  job.ended = begin + std::chrono::seconds(5);
  job.spec.priority = records::Priority::bulk;
  job.timeline = {{begin, records::JobState::queued, ""},
                  {*job.started, records::JobState::running, ""}};
  if (state == records::JobState::failed) {
    job.error.emplace(errors::Reason::numerical, "secret-message");
  }
  return job;
}

class Exposition : public ::testing::Test {
 protected:
  void SetUp() override {
    _address = _metrics.listen("127.0.0.1:0", [this] {
      Snapshot now;
      now.engine.iterations = ++_reads;
      now.cache.hits = 7;
      now.disk.results = 4096;
      now.ready = true;
      return now;
    });
  }

  std::string scrape() const { return get("http://" + _address + "/metrics"); }
  void let_everything_happen() {
    _metrics.call_ended("/anticrack.v1.SolveService/GetJob", 5, std::chrono::milliseconds(20));
    _metrics.job_ended(ended_job(records::JobState::succeeded));
    _metrics.job_ended(ended_job(records::JobState::failed));
    records::MeshRecord mesh;
    mesh.mesh_seconds = 1.5;
    _metrics.meshed(mesh);
    mesh.error.emplace(errors::Reason::mesher_failed, "secret-message");
    _metrics.meshed(mesh);
    _metrics.factorised(std::chrono::seconds(3));
  }

  Metrics _metrics{"1.2.3", "GNU 12"};
  std::atomic<std::uint64_t> _reads{0};
  std::string _address;
};

TEST_F(Exposition, TellsWhatHappened) {
  let_everything_happen();
  const std::string text = scrape();
  for (const char* line : {
           "anticrack_build_info{build=\"GNU 12\",version=\"1.2.3\"} 1",
           "anticrack_rpc_handled_total{code=\"NOT_FOUND\","
           "method=\"/anticrack.v1.SolveService/GetJob\"} 1",
           "anticrack_rpc_duration_seconds_bucket{method=\"/anticrack.v1.SolveService/GetJob\","
           "le=\"0.03\"} 1",
           "anticrack_jobs_ended_total{state=\"SUCCEEDED\"} 1",
           "anticrack_jobs_ended_total{state=\"CANCELLED\"} 0",
           "anticrack_job_failures_total{reason=\"NUMERICAL\"} 1",
           "anticrack_queue_wait_seconds_sum{priority=\"BULK\"} 4",
           "anticrack_job_phase_seconds_sum{phase=\"solving\"} 6",
           "anticrack_meshing_seconds_sum 1.5",
           "anticrack_mesh_failures_total{reason=\"MESHER_FAILED\"} 1",
           "anticrack_factorization_seconds_count 1",
           "anticrack_cache_hits_total 7",
           "anticrack_disk_bytes{kind=\"results\"} 4096",
           "anticrack_ready 1",
       }) {
    EXPECT_THAT(text, HasSubstr(line + std::string("\n")));
  }
  EXPECT_THAT(text, ::testing::ContainsRegex("process_resident_memory_bytes [1-9]"));
  EXPECT_THAT(text, Not(HasSubstr("secret"))) << "no label names a job, an owner or a message";
}

TEST_F(Exposition, ReadsAnewAtEachScrape) {
  EXPECT_THAT(scrape(), HasSubstr("anticrack_iterations_total 1\n"));
  EXPECT_THAT(scrape(), HasSubstr("anticrack_iterations_total 2\n"));
}

/// Connections to `address`, each of which has sent `text`.
class HalfOpen {
 public:
  HalfOpen(const std::string& address, int count, const std::string& text) {
    sockaddr_in where{};
    where.sin_family = AF_INET;
    where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int port = std::stoi(address.substr(address.rfind(':') + 1));
    where.sin_port = htons(static_cast<std::uint16_t>(port));
    for (int i = 0; i < count; ++i) {
      const int made = _sockets.emplace_back(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
      EXPECT_EQ(::connect(made, reinterpret_cast<const sockaddr*>(&where), sizeof(where)), 0);
      ::send(made, text.data(), text.size(), MSG_NOSIGNAL);
    }
  }
  ~HalfOpen() {
    for (const int socket : _sockets) ::close(socket);
  }

 private:
  std::vector<int> _sockets;
};

TEST_F(Exposition, AnswersWhileManyHaveBegunToAsk) {
  for (const char* begun : {"", "GET", "GET /metrics HTTP/1.1\r\nHost: a\r\n",
                            "POST /metrics HTTP/1.1\r\nHost: a\r\nContent-Length: 9\r\n\r\n1"}) {
    const HalfOpen before(_address, 200, begun);
    EXPECT_THAT(scrape(), HasSubstr("anticrack_ready 1\n")) << begun;
    EXPECT_THAT(scrape(), HasSubstr("anticrack_ready 1\n")) << begun;
  }
}

TEST_F(Exposition, PleasesPromtool) {
  if (!std::filesystem::exists(PROMTOOL))
    GTEST_SKIP() << "promtool is not installed (Debian package prometheus)";
  let_everything_happen();
  anticrack::testing::Process lint({PROMTOOL, "check", "metrics"}, {}, scrape());
  EXPECT_EQ(lint.wait(), 0) << lint.error() << lint.output();
}

TEST_F(Exposition, HoldsNoMoreMethodsThanThereAre) {
  for (int i = 0; i < 1000; ++i) _metrics.call_ended("/made/up" + std::to_string(i), 12, {});
  const std::string text = scrape();
  EXPECT_THAT(text,
              HasSubstr("anticrack_rpc_handled_total{code=\"UNIMPLEMENTED\",method=\"other\"}"));
  EXPECT_THAT(text, Not(HasSubstr("/made/up999")));
}

TEST(Owners, HaveFewLabelsAndNothingIsLeftOut) {
  Metrics metrics("1.2.3", "GNU 12");
  const std::string address = metrics.listen("127.0.0.1:0", [] {
    Snapshot now;
    for (std::uint64_t i = 0; i < 1000; ++i) {
      now.owners.push_back({"user-" + std::to_string(i), 2, 1, i});
    }
    return now;
  });
  const std::string text = get("http://" + address + "/metrics");
  EXPECT_THAT(text, HasSubstr("anticrack_owner_result_bytes{owner=\"user-999\"} 999\n"));
  EXPECT_THAT(text, HasSubstr("anticrack_owner_jobs{owner=\"user-950\"} 2\n"));
  EXPECT_THAT(text, Not(HasSubstr("user-949"))) << "fifty of them";
  EXPECT_THAT(text, HasSubstr("anticrack_owner_jobs{owner=\"(others)\"} 1900\n"));
  EXPECT_THAT(text, HasSubstr("anticrack_owner_unfinished_jobs{owner=\"(others)\"} 950\n"));
  EXPECT_THAT(text, HasSubstr("anticrack_owner_result_bytes{owner=\"(others)\"} 450775\n"));
}

TEST_F(Exposition, CountsFromManyThreads) {
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([this] {
      for (int k = 0; k < 250; ++k) _metrics.job_ended(ended_job(records::JobState::cancelled));
    });
  }
  EXPECT_FALSE(scrape().empty());
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(scrape(), HasSubstr("anticrack_jobs_ended_total{state=\"CANCELLED\"} 1000\n"));
}

TEST_F(Exposition, IsOnePageToBeRead) {
  EXPECT_EQ(get("http://" + _address + "/"), "");
  EXPECT_EQ(get("http://" + _address + "/metrics/../secret"), "");
  EXPECT_NE(get("http://" + _address + "/metrics?x=y"), "");
}

TEST_F(Exposition, IsNotHeldUpByWhoeverSaysNothing) {
  std::vector<std::unique_ptr<CURL, decltype(&curl_easy_cleanup)>> silent;
  for (int i = 0; i < 8; ++i) {
    silent.emplace_back(curl_easy_init(), &curl_easy_cleanup);
    curl_easy_setopt(silent.back().get(), CURLOPT_URL, ("http://" + _address).c_str());
    curl_easy_setopt(silent.back().get(), CURLOPT_NOPROXY, "*");
    curl_easy_setopt(silent.back().get(), CURLOPT_CONNECT_ONLY, 1L);
    ASSERT_EQ(curl_easy_perform(silent.back().get()), CURLE_OK);
  }
  EXPECT_THAT(scrape(), HasSubstr("anticrack_ready 1"));
}

TEST_F(Exposition, EndsWithStop) {
  EXPECT_FALSE(scrape().empty());
  _metrics.stop();
  const std::uint64_t reads = _reads;
  EXPECT_EQ(scrape(), "");
  EXPECT_EQ(_reads, reads);
  let_everything_happen();  // still allowed
}

TEST_F(Exposition, SaysWhereItCannotListen) {
  Metrics other("1", "1");
  for (const std::string& address : {_address, std::string("203.0.113.1:1"), std::string("9464"),
                                     std::string("127.0.0.1:http")}) {
    EXPECT_TRUE(
        anticrack::testing::throws([&] { other.listen(address, [] { return Snapshot(); }); },
                                   errors::Reason::invalid_argument, "metrics-listen"))
        << address;
  }
}

TEST(Readiness, IsAPageThatReadsNothing) {
  Metrics metrics("1", "1");
  std::atomic<bool> ready = true;
  const std::string address = metrics.listen(
      "127.0.0.1:0", []() -> Snapshot { throw errors::Error(errors::Reason::storage, "broken"); },
      [&] { return ready.load(); });
  EXPECT_EQ(get("http://" + address + "/ready"), "ready\n");
  ready = false;
  EXPECT_EQ(get("http://" + address + "/ready"), "") << "503";
}

TEST(ExpositionOfABrokenServer, LeavesOutWhatCannotBeRead) {
  Metrics metrics("1", "1");
  const std::string address = metrics.listen(
      "127.0.0.1:0", []() -> Snapshot { throw errors::Error(errors::Reason::storage, "broken"); });
  const std::string text = get("http://" + address + "/metrics");
  EXPECT_THAT(text, HasSubstr("process_resident_memory_bytes"));
  EXPECT_THAT(text, Not(HasSubstr("anticrack_ready")));
}

}  // namespace
}  // namespace anticrack::metrics

// SPDX-License-Identifier: GPL-3.0-or-later
//
// Many clients that submit and watch for a while: no error but documented backpressure, every job
// ends, the server's memory stays within bounds; latencies are told, not judged. With --greedy, two
// owners with many clients each beside a modest one with one: its times alone and beside them. What
// the greedy ones want (--work) is "small" jobs on one mesh or on a dozen meshes ("many"), jobs
// with an accuracy on "fresh" meshes, more than memory holds, or loads that are "slow" to
// integrate. With --owner it is the clients of one owner of servers that others started
// (tests/benchmarks/group).
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <mutex>
#include <random>
#include <thread>

#include "client/jobs.hpp"
#include "digest/digest.hpp"
#include "service/daemon.hpp"
#include "service/workload.hpp"
#include "support/process_memory.hpp"

namespace anticrack::service_test {
namespace {

using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

struct Options {
  int seconds = 60;
  int clients = 200;
  int channels = 8;
  unsigned seed = 1;
  std::uint64_t memory = 2'048;  ///< MiB the server may come to hold
  int greedy = 0;                ///< clients of each greedy owner; 0: no owners
  std::string work = "small";    ///< of the greedy ones
  std::string owner;             ///< in a process of greedy clients: theirs
  std::string address;           ///< and the server's
  std::string ca;                ///< its authority, where it speaks TLS
};

struct Run {
  std::vector<Work> works;
  std::function<Work()> next;  ///< instead of them
  std::atomic<bool> done = false;
  std::atomic<std::uint64_t> jobs = 0;
  std::atomic<std::uint64_t> waits = 0;  ///< for a queue that was full
  std::mutex mutex;
  std::string latest;  ///< job that ended: older ones are erased when many more were made since
  std::vector<std::string> complaints;
  std::vector<double> times;  ///< from request to end [ms]

  void ended(const std::string& job, Milliseconds time) {
    ++jobs;
    const std::lock_guard lock(mutex);
    latest = job;
    times.push_back(time.count());
  }
  std::string latest_job() {
    const std::lock_guard lock(mutex);
    return latest;
  }

  void complain(const std::string& text) {
    const std::lock_guard lock(mutex);
    complaints.push_back(text);
  }
  /// Prints the complaints; the exit code.
  int report() {
    for (const std::string& complaint : complaints)
      std::fprintf(stderr, "anticrack-load: %s\n", complaint.c_str());
    return complaints.empty() ? 0 : 1;
  }
};

void be_a_client(Run& run, client::Connection& connection, unsigned seed) {
  std::minstd_rand random(seed);
  try {
    while (!run.done) {
      const Work work = run.next ? run.next() : run.works[random() % run.works.size()];
      const auto begin = Clock::now();
      const v1::Job job =
          wait_for_end(connection, submit(connection, work, client::make_uuid()).name());
      if (!run.next && !ran_to_its_end(job)) {
        run.complain("a job ended in another state: " + job.ShortDebugString());
      }
      run.ended(job.name(), Clock::now() - begin);
    }
  } catch (const std::exception& error) {
    run.complain(std::string("a client failed: ") + error.what());
  }
}

/// The standard health service, whose messages are small enough to be written by hand.
bool healthy(grpc::GenericStub& stub) {
  grpc::ClientContext context;
  grpc::CompletionQueue queue;
  const grpc::Slice nothing;
  const grpc::ByteBuffer request(&nothing, 1);
  grpc::ByteBuffer response;
  grpc::Status status;
  const auto call =
      stub.PrepareUnaryCall(&context, "/grpc.health.v1.Health/Check", request, &queue);
  call->StartCall();
  call->Finish(&response, &status, &queue);
  void* tag = nullptr;
  bool fine = false;
  queue.Next(&tag, &fine);
  std::vector<grpc::Slice> slices;
  if (!status.ok() || !response.Dump(&slices).ok()) return false;
  std::string bytes;
  for (const grpc::Slice& slice : slices) bytes.append(slice.begin(), slice.end());
  return bytes == "\x08\x01";  // status: SERVING
}

void tell(const char* what, std::vector<double> times) {
  if (times.empty()) return;
  std::sort(times.begin(), times.end());
  const auto at = [&](double part) {
    return times[static_cast<std::size_t>(part * static_cast<double>(times.size() - 1))];
  };
  std::printf("%s: %zu calls, p50 %.2f ms, p99 %.2f ms, longest %.2f ms\n", what, times.size(),
              at(0.5), at(0.99), times.back());
}

/// "VmRSS" or "VmHWM" of the server, MiB.
std::uint64_t mebibytes_of(int process, const std::string& key) {
  return anticrack::testing::memory_of(key, std::to_string(process)) >> 20U;
}

/// Asks for the latest job and for the server's health, over and over, until the time is up.
void probe(Run& run, const Daemon& daemon, int seconds) {
  client::Connection connection(daemon.connection());
  grpc::GenericStub health(
      grpc::CreateChannel(daemon.address(), grpc::InsecureChannelCredentials()));
  std::vector<double> gets;
  std::vector<double> checks;
  const auto end = Clock::now() + std::chrono::seconds(seconds);
  while (Clock::now() < end) {
    const auto begin = Clock::now();
    client::get_job(connection, run.latest_job());
    const auto middle = Clock::now();
    if (!healthy(health)) run.complain("the server said it was not healthy");
    gets.push_back(Milliseconds(middle - begin).count());
    checks.push_back(Milliseconds(Clock::now() - middle).count());
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  tell("GetJob", gets);
  tell("health check", checks);
}

/// Whether they were not in memory.
bool waited_for_factors(const v1::Job& job) {
  return std::any_of(job.status().timeline().begin(), job.status().timeline().end(),
                     [](const v1::JobStatus::Step& step) {
                       return step.detail().find("factorising") != std::string::npos;
                     });
}

/// Jobs of one client, one after the other, timed from the request to the end.
void be_modest(Run& run, const client::ConnectionOptions& chosen, int seconds, const char* what) {
  client::Connection connection(chosen);
  std::vector<double> times;
  const auto end = Clock::now() + std::chrono::seconds(seconds);
  wait_for_end(connection, submit(connection, run.works.front(), client::make_uuid()).name());
  while (Clock::now() < end) {
    const auto begin = Clock::now();
    const v1::Job job =
        wait_for_end(connection, submit(connection, run.works.front(), client::make_uuid()).name());
    if (!ran_to_its_end(job)) run.complain("a modest job did not succeed");
    if (waited_for_factors(job)) run.complain("a modest job had to wait for factors it had before");
    times.push_back(Milliseconds(Clock::now() - begin).count());
  }
  tell(what, times);
}

Work small_work() { return work("paper-3.toml", {"mesh.preset=uniform", "mesh.size=0.1"}); }

/// By the active set, on a mesh that no other has.
Work fresh_work(unsigned number) {
  Work one = work("slit.toml", {"mesh.preset=uniform", "mesh.size=0.05"});
  one.mesh.mutable_options()->set_size(0.05 + 1e-6 * number);
  one.spec.mutable_accuracy()->set_energy(4e-3);
  return one;
}

/// No two have the same result, which would be stored once.
Work one_of_many(unsigned number) {
  constexpr unsigned meshes = 12;
  Work one = small_work();
  one.mesh.mutable_options()->set_size(0.1 + 1e-4 * (number % meshes));
  one.spec.mutable_load_cases(0)->mutable_force()->set_expression("1 + " + std::to_string(number) +
                                                                  "e-9");
  return one;
}

Work slow_work() {
  Work one = work("slit.toml", {"mesh.preset=uniform", "mesh.size=0.03"});
  v1::LoadCase load = one.spec.load_cases(0);
  one.spec.clear_load_cases();
  for (int i = 0; i < 8; ++i) {
    load.set_name("slow " + std::to_string(i));
    load.mutable_force()->set_expression("sin(" + std::to_string(200 + i) +
                                         "*x*y) + cos(300*x) + (x*x + y*y < 0.1 ? exp(x) : 1)");
    *one.spec.add_load_cases() = load;
  }
  return one;
}

/// What the greedy ones want next.
Work greedy_work(const std::string& kind, unsigned number) {
  return kind == "fresh"  ? fresh_work(number)
         : kind == "slow" ? slow_work()
         : kind == "many" ? one_of_many(number)
                          : small_work();
}

client::ConnectionOptions as(const std::string& owner, const std::string& address, Run& run,
                             const std::string& ca = {}) {
  client::ConnectionOptions chosen;
  chosen.address = address;
  chosen.first_contact = std::chrono::seconds(30);
  client::CredentialFiles files;
  files.ca = ca;
  if (!ca.empty()) chosen.credentials = client::read_credentials(files, address);
  chosen.credentials.token = "token of " + owner;
  chosen.notice = [&run](const std::string&) { ++run.waits; };
  return chosen;
}

/// A process of its own: the clients of one greedy owner.
int be_greedy(const Options& options) {
  Run run;
  std::atomic<unsigned> made = options.seed;
  run.next = [&] { return greedy_work(options.work, ++made); };
  std::vector<std::unique_ptr<client::Connection>> connections;
  std::vector<std::thread> clients;
  for (int i = 0; i < options.greedy; ++i) {
    connections.push_back(
        std::make_unique<client::Connection>(as(options.owner, options.address, run, options.ca)));
    clients.emplace_back(be_a_client, std::ref(run), std::ref(*connections.back()),
                         options.seed + static_cast<unsigned>(i));
  }
  std::this_thread::sleep_for(std::chrono::seconds(options.seconds));
  run.done = true;
  for (std::thread& thread : clients) thread.join();
  std::printf("%s: %llu jobs, %llu times turned away\n", options.owner.c_str(),
              static_cast<unsigned long long>(run.jobs.load()),
              static_cast<unsigned long long>(run.waits.load()));
  tell("a job", run.times);
  if (run.jobs == 0) run.complain("no job of " + options.owner + " ended");
  return run.report();
}

int drive_owners(const Options& options) {
  Run run;
  run.works = {small_work()};
  const anticrack::testing::TemporaryFolder folder;
  const std::string file = folder / "tokens";
  const std::vector<std::string> greedy{"greedy", "another"};
  std::ofstream tokens(file);
  for (const std::string& name : {std::string("modest"), greedy[0], greedy[1]})
    tokens << name << " user " << digest::Sha256().add("token of " + name).finish() << '\n';
  tokens.close();
  std::filesystem::permissions(file, std::filesystem::perms::owner_read);
  Daemon daemon({"--log-level", "error", "--queued-jobs", std::to_string(options.greedy + 4),
                 "--kept-jobs", "200", "--memory-budget", "40MiB", "--tokens", file});
  const client::ConnectionOptions modest = as("modest", daemon.address(), run);
  be_modest(run, modest, options.seconds / 2, "modest, alone");
  // Clients run elsewhere: these leave the processors to the server and to the modest one.
  std::vector<std::unique_ptr<anticrack::testing::Process>> others;
  unsigned seed = 1;
  for (const std::string& owner : greedy) {
    others.push_back(std::make_unique<anticrack::testing::Process>(std::vector<std::string>{
        "/usr/bin/nice", "-n", "19", std::filesystem::read_symlink("/proc/self/exe"), "--owner",
        owner, "--address", daemon.address(), "--greedy", std::to_string(options.greedy), "--work",
        options.work, "--seed", std::to_string(seed += 10'000), "--seconds",
        std::to_string(options.seconds / 2 + 2)}));
  }
  std::this_thread::sleep_for(std::chrono::seconds(1));
  be_modest(run, modest, options.seconds / 2, "modest, beside two greedy owners");
  for (const auto& other : others) {
    if (other->wait() != 0) run.complain("greedy clients: " + other->error());
    std::printf("%s", other->output().c_str());
  }
  client::Connection connection(modest);
  const v1::ServerMetrics metrics = client::server_info(connection).metrics();
  std::printf("%llu factorisations, %llu evictions\n",
              static_cast<unsigned long long>(metrics.factorizations()),
              static_cast<unsigned long long>(metrics.operator_evictions()));
  if (options.work == "fresh" && metrics.operator_evictions() == 0)
    run.complain("memory was never short");
  if (daemon.stop() != 0) run.complain("anticrackd did not stop well");
  return run.report();
}

int drive(const Options& options) {
  Run run;
  const std::vector<std::string> coarse{"mesh.preset=uniform", "mesh.size=0.1"};
  run.works = {work("paper.toml", iterations(300)), work("paper-3.toml", iterations(1'000)),
               work("slit.toml", coarse), work("arc.toml", coarse)};
  // A queue shorter than the clients are many, so that some of them are turned away.
  Daemon daemon({"--log-level", "error", "--queued-jobs",
                 std::to_string(std::max(options.clients / 4, 1)), "--kept-jobs", "2000"});
  client::ConnectionOptions chosen = daemon.connection();
  chosen.notice = [&run](const std::string&) { ++run.waits; };
  std::vector<std::unique_ptr<client::Connection>> connections;
  for (int i = 0; i < options.channels; ++i) {
    connections.push_back(std::make_unique<client::Connection>(chosen));
  }
  for (const Work& work : run.works) {  // the meshes are made before the clock starts
    run.latest = submit(*connections.front(), work, client::make_uuid()).name();
    wait_for_end(*connections.front(), run.latest);
  }
  const int server = daemon.process().id();
  const std::uint64_t begin = mebibytes_of(server, "VmRSS");
  std::minstd_rand random(options.seed);
  std::vector<std::thread> clients;
  for (int i = 0; i < options.clients; ++i) {
    client::Connection& connection = *connections[static_cast<std::size_t>(i) % connections.size()];
    clients.emplace_back(be_a_client, std::ref(run), std::ref(connection), random());
  }
  try {
    probe(run, daemon, options.seconds);
  } catch (const std::exception& error) {
    run.complain(std::string("GetJob failed: ") + error.what());
  }
  run.done = true;
  for (std::thread& thread : clients) thread.join();

  const std::uint64_t peak = mebibytes_of(server, "VmHWM");
  std::printf("%llu jobs, %llu times turned away; the server held %llu MiB, at most %llu MiB\n",
              static_cast<unsigned long long>(run.jobs.load()),
              static_cast<unsigned long long>(run.waits.load()),
              static_cast<unsigned long long>(begin), static_cast<unsigned long long>(peak));
  if (run.jobs == 0) run.complain("no job ended");
  if (peak > options.memory) run.complain("the server came to hold too much memory");
  const v1::ServerMetrics metrics = client::server_info(*connections.front()).metrics();
  if (metrics.jobs_queued() + metrics.jobs_running() != 0) {
    run.complain("some job has not ended");
  }
  if (daemon.stop() != 0) run.complain("anticrackd did not stop well");
  return run.report();
}

}  // namespace
}  // namespace anticrack::service_test

int main(int argc, char** argv) {
  anticrack::service_test::Options options;
  CLI::App app("Lets many clients submit and watch for a while.", "anticrack-load");
  app.add_option("--seconds", options.seconds, "How long")->capture_default_str();
  app.add_option("--clients", options.clients, "How many")->capture_default_str();
  app.add_option("--channels", options.channels, "That they share")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Of the jobs they choose")->capture_default_str();
  app.add_option("--memory", options.memory, "What the server may come to hold, MiB")
      ->capture_default_str();
  app.add_option("--greedy", options.greedy, "Clients of each of two greedy owners; 0: no owners")
      ->capture_default_str();
  app.add_option("--work", options.work, "What they want")
      ->check(CLI::IsMember({"small", "many", "fresh", "slow"}))
      ->capture_default_str();
  app.add_option("--owner", options.owner, "Be the clients of this greedy owner");
  app.add_option("--address", options.address, "Of their server");
  app.add_option("--ca", options.ca, "Of their server's certificate");
  CLI11_PARSE(app, argc, argv);
  try {
    if (!options.owner.empty()) return anticrack::service_test::be_greedy(options);
    return options.greedy > 0 ? anticrack::service_test::drive_owners(options)
                              : anticrack::service_test::drive(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "anticrack-load: %s\n", error.what());
    return 1;
  }
}

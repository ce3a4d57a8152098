// SPDX-License-Identifier: GPL-3.0-or-later
//
// Kills anticrackd at random moments while clients upload, submit, watch and read beside a backlog;
// then every job it acknowledged is there once, with the numbers of a server that was left alone.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <thread>

#include "client/jobs.hpp"
#include "service/daemon.hpp"
#include "service/stored_data.hpp"
#include "service/workload.hpp"
#include "support/eventually.hpp"

namespace anticrack::service_test {
namespace {

using std::chrono::milliseconds;

struct Options {
  int kills = 100;
  unsigned seed = 1;
  int clients = 3;
  int pause = 120;  ///< mean time between start and kill, milliseconds
  int backlog = 200;
};

/// A job the server has acknowledged.
struct Acknowledged {
  std::string name;
  std::string request_id;
  std::size_t work = 0;
};

/// What the clients share.
struct Run {
  std::vector<Work> works = mixed_work();
  std::atomic<bool> done = false;
  std::atomic<int> retries = 0;
  std::atomic<int> heard = 0;  ///< jobs acknowledged and events of watches
  std::mutex mutex;
  std::vector<Acknowledged> jobs;
  std::vector<std::string> complaints;

  bool failed() {
    const std::lock_guard lock(mutex);
    return !complaints.empty();
  }
  void complain(const std::string& text) {
    const std::lock_guard lock(mutex);
    complaints.push_back(text);
  }
  void acknowledge(const Acknowledged& job) {
    const std::lock_guard lock(mutex);
    jobs.push_back(job);
    ++heard;
  }
  void watch(client::Connection& connection, const std::string& name) {
    client::watch_job(connection, name, 0, [this](const v1::WatchJobResponse&) { ++heard; });
  }
};

const std::vector<std::string> server_options{"--log-level", "error", "--threads",    "2",
                                              "--crashes",   "0",     "--job-memory", "32MiB"};

/// Submits one job after another while the server is killed; no more than a few at a time.
void be_a_client(Run& run, client::ConnectionOptions options, unsigned seed) {
  constexpr std::size_t most_open = 3;
  options.notice = [&run](const std::string&) { ++run.retries; };
  client::Connection connection(options);
  std::minstd_rand random(seed);
  std::vector<std::string> open;
  try {
    while (!run.done) {
      const std::size_t index = random() % run.works.size();
      const std::string id = client::make_uuid();
      const v1::Job job = submit(connection, run.works[index], id);
      run.acknowledge({job.name(), id, index});
      open.push_back(job.name());
      if (open.size() > most_open) {
        run.watch(connection, open.front());
        open.erase(open.begin());
      }
    }
    for (const std::string& name : open) run.watch(connection, name);
  } catch (const std::exception& error) {
    run.complain(std::string("a client failed: ") + error.what());
  }
}

/// A result of 2 MB, of which a job holds one in memory.
Work large_result() {
  Work large = work("slit.toml");
  large.spec.add_outputs(v1::OUTPUT_FIELDS);
  for (int i = 1; i < 40; ++i) {
    v1::LoadCase& load = *large.spec.add_load_cases();
    load = large.spec.load_cases(0);
    load.set_name(load.name() + "-" + std::to_string(i));
  }
  return large;
}

/// Values on the nodes of a mesh, sent again for each job.
Work uploaded_array(const Daemon& daemon) {
  Work array = work("slit.toml");
  array.name += " (array)";
  client::Connection connection(daemon.connection());
  const v1::Mesh mesh =
      client::wait_for_mesh(connection, client::create_mesh(connection, array.mesh).name());
  for (std::uint64_t i = 0; i < mesh.node_count(); ++i)
    array.array.push_back(1 + static_cast<double>(i % 7));
  return array;
}

/// Jobs that wait while all others overtake them.
void queue_backlog(Run& run, const Daemon& daemon, int jobs) {
  constexpr std::size_t small = 4;  // a coarse mesh, behind the two works above
  Work work = run.works[small];
  work.spec.set_priority(v1::JobSpec::PRIORITY_BULK);
  run.works.insert(run.works.begin(), work);
  client::Connection connection(daemon.connection());
  for (int i = 0; i < jobs; ++i) {
    const std::string id = client::make_uuid();
    run.acknowledge({submit(connection, work, id).name(), id, 0});
  }
}

/// Meshing takes longer than a server lives here; with the meshes there, kills fall into all that
/// comes after it too. The last ones are left to be meshed under the kills.
void make_most_meshes(const Run& run, const Daemon& daemon) {
  client::Connection connection(daemon.connection());
  for (std::size_t i = 0; i + 2 < run.works.size(); ++i) {
    client::wait_for_mesh(connection, client::create_mesh(connection, run.works[i].mesh).name());
  }
}

void kill_again_and_again(Daemon& daemon, Run& run, const Options& options,
                          std::minstd_rand& random) {
  std::exponential_distribution<double> pause(1.0 / options.pause);
  for (int kill = 1; kill <= options.kills; ++kill) {
    // Some fall into the start itself, where the server recovers from the last one; before the
    // others the clients are back at work, however slow the machine is.
    if (random() % 8 != 0) {
      const int before = run.heard;
      daemon.wait_until_ready();
      anticrack::testing::eventually([&] { return run.heard > before || run.failed(); });
    }
    std::this_thread::sleep_for(milliseconds(static_cast<int>(pause(random))));
    daemon.kill();
    daemon.launch();
  }
  daemon.wait_until_ready();
}

std::vector<client::Block> references(const std::vector<Work>& works) {
  const Daemon daemon(server_options);
  client::Connection connection(daemon.connection());
  std::vector<client::Block> blocks;
  for (const Work& work : works) {
    const v1::Job job = submit(connection, work, client::make_uuid());
    wait_for_end(connection, job.name());
    blocks.push_back(client::read_result(connection, job.name()));
  }
  return blocks;
}

std::multiset<std::string> names_of_all_jobs(client::Connection& connection) {
  std::multiset<std::string> names;
  v1::ListJobsRequest request;
  request.set_page_size(1000);
  do {
    const v1::ListJobsResponse response = client::list_jobs(connection, request);
    for (const v1::Job& job : response.jobs()) names.insert(job.name());
    request.set_page_token(response.next_page_token());
  } while (!request.page_token().empty());
  return names;
}

void check_jobs(Run& run, client::Connection& connection) {
  const std::vector<client::Block> expected = references(run.works);
  std::multiset<std::string> acknowledged;
  for (const Acknowledged& job : run.jobs) acknowledged.insert(job.name);
  if (names_of_all_jobs(connection) != acknowledged) {
    run.complain("the jobs on the server are not those it acknowledged, each once");
  }
  for (const Acknowledged& each : run.jobs) {
    const v1::Job job = wait_for_end(connection, each.name);
    if (!ran_to_its_end(job)) {
      run.complain(each.name + " ended in another state: " + job.ShortDebugString());
      continue;
    }
    if (submit(connection, run.works[each.work], each.request_id).name() != each.name) {
      run.complain(each.name + " is not found under its request id");
    }
    const std::string problem =
        difference(client::read_result(connection, each.name), expected[each.work]);
    if (!problem.empty()) {
      run.complain(each.name + " (" + run.works[each.work].name + "): " + problem);
    }
  }
}

int most_attempts(const Run& run, client::Connection& connection) {
  int most = 0;
  for (const Acknowledged& each : run.jobs) {
    most = std::max(most, client::get_job(connection, each.name).status().attempt());
  }
  return most;
}

int drive(const Options& options) {
  std::printf("seed %u, %d kills\n", options.seed, options.kills);
  std::fflush(stdout);
  Run run;
  std::minstd_rand random(options.seed);
  Daemon daemon(server_options);
  make_most_meshes(run, daemon);
  run.works.insert(run.works.begin(), {large_result(), uploaded_array(daemon)});
  queue_backlog(run, daemon, options.backlog);
  std::vector<std::thread> clients;
  for (int i = 0; i < options.clients; ++i) {
    clients.emplace_back(be_a_client, std::ref(run), daemon.connection(), random());
  }
  std::exception_ptr failure;
  try {
    kill_again_and_again(daemon, run, options, random);
  } catch (...) {
    failure = std::current_exception();
  }
  run.done = true;
  if (failure) {
    // Nobody will answer the clients any more, so that they cannot be waited for.
    try {
      std::rethrow_exception(failure);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "anticrack-crash: %s\n", error.what());
    }
    daemon.kill();
    std::_Exit(1);
  }
  for (std::thread& thread : clients) thread.join();

  client::Connection connection(daemon.connection());
  check_jobs(run, connection);
  std::printf("%zu jobs, %d retries, up to %d attempts of one job\n", run.jobs.size(),
              run.retries.load(), most_attempts(run, connection));
  if (run.jobs.size() < run.works.size()) run.complain("hardly a job got through");
  if (const int code = daemon.stop(); code != 0) {
    run.complain("anticrackd stopped with exit code " + std::to_string(code));
  }
  for (const std::string& flaw : flaws_of(daemon.data())) run.complain(flaw);
  for (const std::string& complaint : run.complaints) {
    std::fprintf(stderr, "anticrack-crash: %s\n", complaint.c_str());
  }
  return run.complaints.empty() ? 0 : 1;
}

}  // namespace
}  // namespace anticrack::service_test

int main(int argc, char** argv) {
  anticrack::service_test::Options options;
  CLI::App app("Kills anticrackd at random moments and checks that nothing is lost.",
               "anticrack-crash");
  app.add_option("--kills", options.kills, "How often")->capture_default_str();
  app.add_option("--seed", options.seed, "Of the moments and of the jobs")->capture_default_str();
  app.add_option("--clients", options.clients, "That submit meanwhile")->capture_default_str();
  app.add_option("--backlog", options.backlog, "Jobs that wait from the start")
      ->capture_default_str();
  app.add_option("--pause", options.pause, "Mean time between start and kill, ms")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    return anticrack::service_test::drive(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "anticrack-crash: %s\n", error.what());
    return 1;
  }
}

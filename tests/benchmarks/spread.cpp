// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sweeps, and final positions of growth, of a group of servers with one thread each, on a
// PostgreSQL of its own: what a server alone takes, a group of one, and of two. `speedup` is by
// wall time. With `--share 0.3` each server gets that part of a core (a control group, which takes
// root), as on a slower machine of its own, and what is left of this one is for PostgreSQL.
#include <time.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <thread>

#include "benchmarks/figures.hpp"
#include "benchmarks/plain_mesh.hpp"
#include "client/jobs.hpp"
#include "client/meshes.hpp"
#include "service/daemon.hpp"
#include "service/workload.hpp"
#include "support/database.hpp"

namespace anticrack::benchmarks {
namespace {

using service_test::Daemon;
namespace fs = std::filesystem;

struct Kind {
  std::string name;
  int rows;  ///< of a sweep; 0: growth
  bool bounds, tips;
};

constexpr int basis = 8;

/// Growth whose final positions take most of its time.
service_test::Work growth_of(bool tiny) {
  return service_test::work(
      "growth.toml",
      {"mesh.preset=uniform", "mesh.size=0.02", "geometry.boundary=[[-1,-1],[1,-1],[1,1],[-1,1]]",
       "growth.positions=20", tiny ? "growth.final=2" : "growth.final=16"});
}

v1::JobSpec sweep_of(const Kind& kind) {
  v1::JobSpec spec;
  for (int j = 0; j < basis; ++j) {
    v1::LoadCase& load = *spec.add_load_cases();
    load.set_name("load " + std::to_string(j));
    load.mutable_force()->set_expression("sin(1.3*x + " + std::to_string(2 + j) + "*y)");
  }
  spec.mutable_sweep()->set_bounds(kind.bounds);
  spec.mutable_sweep()->set_tips(kind.tips);
  return spec;
}

/// What a sweep took.
struct Taken {
  double wall = 0;
  std::vector<double> cpu;  ///< of each server
  std::string sha256;       ///< of the result
};

/// Part of a core for a process, as long as this object lives; of version 1 of control groups.
class Share {
 public:
  Share(pid_t process, double cores)
      : _folder("/sys/fs/cgroup/cpu/anticrack-bench-" + std::to_string(process)) {
    constexpr int period = 20'000;  // us
    fs::create_directory(_folder);
    write("cpu.cfs_period_us", period);
    write("cpu.cfs_quota_us", static_cast<int>(cores * period));
    write("cgroup.procs", process);
  }
  Share(const Share&) = delete;
  Share& operator=(const Share&) = delete;
  ~Share() {
    std::error_code error;  // it goes once the process has
    for (int i = 0; i < 100 && !fs::remove(_folder, error); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }

 private:
  void write(const char* file, int value) const {
    std::ofstream out(_folder / file);
    if (!(out << value << std::flush))
      throw std::runtime_error("--share: cannot write " + (_folder / file).string());
  }

  const fs::path _folder;
};

/// Servers of one group, or one alone.
struct Servers {
  std::vector<std::unique_ptr<Share>> shares;  ///< end after the servers
  std::vector<std::unique_ptr<Daemon>> all;

  Servers(std::size_t count, const std::vector<std::string>& options, double share) {
    for (std::size_t i = 0; i < count; ++i) {
      all.push_back(std::make_unique<Daemon>(options));
      if (share > 0) shares.push_back(std::make_unique<Share>(all.back()->process().id(), share));
    }
  }
};

double cpu_of(Daemon& server) {
  clockid_t clock{};
  timespec now{};
  if (clock_getcpuclockid(server.process().id(), &clock) != 0 || clock_gettime(clock, &now) != 0)
    throw std::runtime_error("a server is gone");
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Solves the sweep at the first of the servers, whose factors are all there.
Taken solve(const Servers& group, const Kind& kind, int round, bool tiny) {
  const auto& servers = group.all;
  client::Connection connection(servers[0]->connection());
  const service_test::Work work =
      kind.rows > 0 ? service_test::work("paper.toml") : growth_of(tiny);
  const std::string mesh = client::create_mesh(connection, work.mesh).name();
  for (const auto& server : servers) {
    client::Connection each(server->connection());
    client::warm_mesh(each, mesh, true);
    client::wait_for_mesh(each, mesh);
  }
  v1::JobSpec spec = kind.rows > 0 ? sweep_of(kind) : work.spec;
  spec.set_mesh(mesh);
  std::vector<double> matrix;
  for (int k = 0; k < kind.rows; ++k)
    for (int j = 0; j < basis; ++j) matrix.push_back(combination(k + round, j));
  if (!matrix.empty())
    spec.mutable_sweep()->mutable_coefficients()->set_upload(
        client::upload_array(connection, matrix));
  std::this_thread::sleep_for(std::chrono::seconds(2));  // for factors and BLAS's threads
  Taken taken;
  for (const auto& server : servers) taken.cpu.push_back(-cpu_of(*server));
  const v1::Job created = client::create_job(connection, spec, client::make_uuid());
  const v1::Job ended = service_test::wait_for_end(connection, created.name());
  for (std::size_t i = 0; i < servers.size(); ++i) taken.cpu[i] += cpu_of(*servers[i]);
  const v1::SweepAnswer& answer = ended.status().sweep_answer();
  if (!service_test::ran_to_its_end(ended) ||
      answer.converged() != static_cast<std::uint64_t>(kind.rows))
    throw std::runtime_error("not all of it converged: " + ended.status().ShortDebugString());
  const auto seconds = [](const google::protobuf::Timestamp& time) {
    return static_cast<double>(time.seconds()) + 1e-9 * static_cast<double>(time.nanos());
  };
  taken.wall = seconds(ended.status().end_time()) - seconds(ended.status().start_time());
  taken.sha256 = client::read_result(connection, created.name()).layout.sha256();
  return taken;
}

void run(int repetitions, bool tiny, double share, const std::vector<std::string>& only) {
  std::vector<Kind> kinds{{"combinations", 1'000'000, false, false},
                          {"tips", 200'000, false, true},
                          {"bounds", 200'000, true, false},
                          {"growth", 0, false, false}};
  if (tiny) kinds = {{"combinations", 40'000, false, false}, {"growth", 0, false, false}};
  if (!only.empty())
    std::erase_if(kinds, [&](const Kind& kind) { return !std::ranges::count(only, kind.name); });
  const anticrack::testing::Database database;
  const std::vector<std::string> alone{"--threads", "1", "--log-level", "error"};
  std::vector<std::string> grouped = alone;
  grouped.insert(grouped.end(), {"--store", database.address()});
  Figures figures;
  for (const Kind& kind : kinds) {
    Figures of_kind;
    std::vector<double> alone_cpu, one_cpu, two_cpu, both_cpu, alone_wall, one_wall, two_wall;
    for (int round = 0; round < repetitions; ++round) {
      // New servers each time: none has seen the rows before.
      const Taken by_itself = solve(Servers(1, alone, share), kind, round, tiny);
      const Taken by_one = solve(Servers(1, grouped, share), kind, round, tiny);
      const Taken by_two = solve(Servers(2, grouped, share), kind, round, tiny);
      if (by_one.sha256 != by_itself.sha256 || by_two.sha256 != by_itself.sha256)
        throw std::runtime_error("the numbers differ");
      alone_wall.push_back(by_itself.wall);
      one_wall.push_back(by_one.wall);
      two_wall.push_back(by_two.wall);
      alone_cpu.push_back(by_itself.cpu[0]);
      one_cpu.push_back(by_one.cpu[0]);
      two_cpu.push_back(std::ranges::max(by_two.cpu));
      both_cpu.push_back(by_two.cpu[0] + by_two.cpu[1]);
    }
    const auto least = [](const std::vector<double>& times) { return std::ranges::min(times); };
    of_kind.set("rows", kind.rows);
    of_kind.set("alone_wall", alone_wall);
    of_kind.set("one_wall", one_wall);
    of_kind.set("two_wall", two_wall);
    of_kind.set("alone_cpu", alone_cpu);
    of_kind.set("one_cpu", one_cpu);
    of_kind.set("busier_of_two_cpu", two_cpu);
    of_kind.set("both_of_two_cpu", both_cpu);
    of_kind.set("speedup", least(one_wall) / least(two_wall));
    of_kind.set("speedup_of_alone", least(alone_wall) / least(two_wall));
    of_kind.set("speedup_by_cpu", 2 * least(one_cpu) / least(both_cpu));
    figures.set(kind.name, of_kind);
  }
  figures.print();
}

}  // namespace
}  // namespace anticrack::benchmarks

int main(int argc, char** argv) {
  int repetitions = 3;
  bool tiny = false;
  double share = 0;
  std::vector<std::string> only;
  CLI::App app("Sweeps that several servers solve.", "bench_spread");
  app.add_option("--repetitions", repetitions, "Of everything")->check(CLI::Range(1, 1000));
  app.add_option("--only", only, "Kinds of sweeps; all without it");
  app.add_option("--share", share, "Of a core for each server")->check(CLI::Range(0.05, 1.0));
  app.add_flag("--tiny", tiny, "Short jobs: does it work?");
  CLI11_PARSE(app, argc, argv);
  try {
    anticrack::benchmarks::run(repetitions, tiny, share, only);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_spread: %s\n", error.what());
    return 1;
  }
  return 0;
}

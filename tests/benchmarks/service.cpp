// SPDX-License-Identifier: GPL-3.0-or-later
//
// The real server and the real client library over loopback: what a load case, a combination, a
// nodal load and a sample cost from end to end.
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include "benchmarks/figures.hpp"
#include "benchmarks/plain_mesh.hpp"
#include "client/jobs.hpp"
#include "client/meshes.hpp"
#include "service/processes.hpp"
#include "service/workload.hpp"

namespace anticrack::benchmarks {
namespace {

struct Options {
  int repetitions = 5;
  bool tiny = false;
  std::vector<std::string> only;  ///< figures; empty: all
  // Of one job each:
  int cases = 256;
  int combinations = 20'000;
  int nodal_loads = 1'000;
  int sampled_cases = 16;
  int samples = 20'000;  ///< of each case
};

Options tiny(Options options) {
  options.cases = 4;
  options.combinations = 200;
  options.nodal_loads = 10;
  options.sampled_cases = 2;
  options.samples = 200;
  return options;
}

/// The paper's membrane on a server of its own, factorised.
class Bench {
 public:
  explicit Bench(const Options& chosen)
      : options(chosen),
        _server({"--log-level", "error", "--event-log", "512MiB"}),
        connection(to(_server.address())) {
    std::vector<std::string> coarse;
    if (options.tiny) coarse = {"mesh.preset=uniform", "mesh.size=0.25"};
    mesh = client::create_mesh(connection, service_test::work("paper.toml", coarse).mesh).name();
    client::warm_mesh(connection, mesh, true);
    const v1::Mesh made = client::wait_for_mesh(connection, mesh);
    if (made.state() == v1::Mesh::STATE_FAILED) throw std::runtime_error("there is no mesh");
    const client::Block block = client::read_mesh(connection, mesh);
    for (const v1::ArrayLayout& array : block.layout.arrays()) {
      if (array.name() != "nodes") continue;
      nodes.resize(2 * static_cast<std::size_t>(array.shape(0)));
      std::memcpy(nodes.data(), block.bytes.data() + array.offset(), nodes.size() * sizeof(double));
    }
    // The first job waits for the factors; none that is timed does.
    v1::JobSpec first = spec();
    *first.add_load_cases() = constant(0);
    run(first);
    let_blas_fall_asleep();
  }

  int server() noexcept { return _server.process().id(); }

  v1::JobSpec spec() const {
    v1::JobSpec result;
    result.set_mesh(mesh);
    return result;
  }

  static v1::LoadCase named(int number) {
    v1::LoadCase load;
    load.set_name(std::string("load ") + std::to_string(number));
    return load;
  }
  static v1::LoadCase constant(int number) {
    v1::LoadCase load = named(number);
    load.mutable_force()->set_constant(1 + number);
    return load;
  }
  static v1::LoadCase expression(int number) {
    v1::LoadCase load = named(number);
    const int tone = number % 64;  // a finer one takes more points, and this is about none such
    load.mutable_force()->set_expression("sin(1.3*x + (2 + 0.11*" + std::to_string(tone) +
                                         ")*y + 0.7*" + std::to_string(number) + ")");
    return load;
  }
  v1::LoadCase array(int number) {
    v1::LoadCase load = named(number);
    load.mutable_force()->mutable_array()->set_upload(
        client::upload_array(connection, nodal(number)));
    return load;
  }
  std::vector<double> nodal(int number) const {
    std::vector<double> values(nodes.size() / 2);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = force(number, nodes[2 * i], nodes[2 * i + 1]);
    }
    return values;
  }

  /// From asking for it to hearing that it has ended well.
  v1::Job run(const v1::JobSpec& wanted) {
    const v1::Job created = client::create_job(connection, wanted, client::make_uuid());
    const v1::Job ended = service_test::wait_for_end(connection, created.name());
    if (!service_test::ran_to_its_end(ended)) {
      throw std::runtime_error("a job ended in another state: " + ended.ShortDebugString());
    }
    return ended;
  }

  const Options options;

 private:
  static client::ConnectionOptions to(const std::string& address) {
    client::ConnectionOptions result;
    result.address = address;
    return result;
  }
  service_test::Server _server;

 public:
  client::Connection connection;
  std::string mesh;
  std::vector<double> nodes;  ///< (n,2)
};

double seconds(const google::protobuf::Timestamp& from, const google::protobuf::Timestamp& to) {
  return static_cast<double>(to.seconds() - from.seconds()) +
         1e-9 * static_cast<double>(to.nanos() - from.nanos());
}

/// Seconds a load case of a job with many, all different; what comes before the job is not timed.
/// `name` is the whole, and `name`_running what of it the job ran, by the server's clock.
void load_cases(Bench& bench, const std::string& name, const std::function<v1::LoadCase(int)>& load,
                Figures& figures) {
  Times whole, running;
  int number = 0;
  for (int i = 0; i < bench.options.repetitions; ++i) {
    v1::JobSpec spec = bench.spec();
    for (int k = 0; k < bench.options.cases; ++k) *spec.add_load_cases() = load(number++);
    const Stopwatch watch(bench.server());
    const v1::Job ended = bench.run(spec);
    watch.stop(whole, bench.options.cases);
    const double each =
        seconds(ended.status().start_time(), ended.status().end_time()) / bench.options.cases;
    running.wall.push_back(each);
    running.cpu.push_back(each);  // a clock of the wall's time
  }
  figures.set(name, whole);
  figures.set(name + "_running", running);
}

/// A job with one load case: what its user waits, and where the time goes by the server's clock.
void single_case(Bench& bench, Figures& figures) {
  Times whole, accepting, waiting, running;
  const auto add = [](Times& times, double value) {
    times.wall.push_back(value);
    times.cpu.push_back(value);  // of another process: it cannot be told apart
  };
  for (int i = 0; i < 10 * bench.options.repetitions; ++i) {
    v1::JobSpec spec = bench.spec();
    *spec.add_load_cases() = bench.array(1'000 + i);
    const Stopwatch watch(bench.server());
    const v1::Job created = client::create_job(bench.connection, spec, client::make_uuid());
    watch.stop(accepting);
    const v1::Job ended = service_test::wait_for_end(bench.connection, created.name());
    watch.stop(whole);
    if (!service_test::ran_to_its_end(ended)) throw std::runtime_error("a job failed");
    add(waiting, seconds(ended.status().create_time(), ended.status().start_time()));
    add(running, seconds(ended.status().start_time(), ended.status().end_time()));
  }
  figures.set("single_case", whole);
  figures.set("single_case_until_accepted", accepting);
  figures.set("single_case_until_started", waiting);
  figures.set("single_case_from_start_to_end", running);
}

Times uploads(Bench& bench) {
  Times times;
  for (int i = 0; i < 10 * bench.options.repetitions; ++i) {
    const std::vector<double> values = bench.nodal(2'000 + i);
    const Stopwatch watch(bench.server());
    client::upload_array(bench.connection, values);
    watch.stop(times);
  }
  return times;
}

/// What a job of one load case waits for at least three times: a flush of a file that grows, here
/// by as much as the server's log of changes does for the creation of a job.
Times flushes(Bench& bench) {
  std::string path = std::filesystem::temp_directory_path() / "anticrack-flush-XXXXXX";
  const int file = mkstemp(path.data());
  if (file < 0 || ::unlink(path.c_str()) != 0) throw std::runtime_error("no file in " + path);
  const std::vector<char> bytes(48 << 10, 'x');
  Times times;
  for (int i = 0; i < 10 * bench.options.repetitions; ++i) {
    const Stopwatch watch;
    const auto written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 || ::fdatasync(file) != 0) throw std::runtime_error("cannot write " + path);
    watch.stop(times);
  }
  ::close(file);
  return times;
}

/// A call that does nothing: what is left of a job's time when its work is taken away.
Times round_trips(Bench& bench) {
  Times times;
  for (int i = 0; i < 40 * bench.options.repetitions; ++i) {
    const Stopwatch watch(bench.server());
    client::server_info(bench.connection);
    watch.stop(times);
  }
  return times;
}

void require_rows(const v1::Job& ended, int rows) {
  const v1::SweepAnswer& answer = ended.status().sweep_answer();
  if (answer.converged() != static_cast<std::uint64_t>(rows)) {
    throw std::runtime_error("not every row of a sweep converged: " + answer.ShortDebugString());
  }
}

/// Rows of a sweep, the upload of their matrix included.
Times combinations(Bench& bench) {
  constexpr int basis = 8;
  const int rows = bench.options.combinations;
  v1::JobSpec spec = bench.spec();
  for (int j = 0; j < basis; ++j) *spec.add_load_cases() = bench.array(j);
  Times times;
  for (int i = 0; i < bench.options.repetitions; ++i) {
    std::vector<double> matrix;
    for (int k = 0; k < rows; ++k) {
      for (int j = 0; j < basis; ++j) matrix.push_back(combination(k + i * rows, j));
    }
    const Stopwatch watch(bench.server());
    spec.mutable_sweep()->mutable_coefficients()->set_upload(
        client::upload_array(bench.connection, matrix));
    const v1::Job ended = bench.run(spec);
    watch.stop(times, rows);
    require_rows(ended, rows);
  }
  return times;
}

Times nodal_loads(Bench& bench) {
  const int rows = bench.options.nodal_loads;
  Times times;
  for (int i = 0; i < bench.options.repetitions; ++i) {
    std::vector<double> matrix;
    for (int k = 0; k < rows; ++k) {
      const std::vector<double> row = bench.nodal(k + i * rows);
      matrix.insert(matrix.end(), row.begin(), row.end());
    }
    v1::JobSpec spec = bench.spec();
    const Stopwatch watch(bench.server());
    spec.mutable_sweep()->mutable_nodal_forces()->set_upload(
        client::upload_array(bench.connection, matrix));
    const v1::Job ended = bench.run(spec);
    watch.stop(times, rows);
    require_rows(ended, rows);
  }
  return times;
}

/// Seconds a sample that one watcher is sent: the log of a job that has ended, from the earliest
/// event kept, so that it is the watch that is timed and not Algorithm 2.
Times samples(Bench& bench) {
  v1::JobSpec spec = bench.spec();
  for (int k = 0; k < bench.options.sampled_cases; ++k) {
    *spec.add_load_cases() = Bench::constant(k);
  }
  v1::Uzawa& uzawa = *spec.mutable_solver()->mutable_uzawa();
  uzawa.set_theta(1e-4);  // still on its way after so many iterations
  uzawa.set_epsilon(1e-300);
  uzawa.set_max_iterations(bench.options.samples);
  const v1::Job ended = bench.run(spec);
  Times times;
  for (int i = 0; i < bench.options.repetitions; ++i) {
    double seen = 0;
    const Stopwatch watch(bench.server());
    client::watch_job(bench.connection, ended.name(), 0, [&seen](const auto& event) {
      if (event.has_samples()) seen += event.samples().iteration_size();
    });
    watch.stop(times, seen);
    if (seen < bench.options.samples) throw std::runtime_error("a watcher saw too few samples");
  }
  return times;
}

bool wanted(const Options& options, const std::string& figure) {
  const auto& only = options.only;
  return only.empty() || std::find(only.begin(), only.end(), figure) != only.end();
}

void run(const Options& options) {
  Bench bench(options);
  Figures figures;
  figures.set("nodes", static_cast<double>(bench.nodes.size()) / 2);
  figures.set("cases", options.cases);
  figures.set("combinations", options.combinations);
  figures.set("nodal_loads", options.nodal_loads);
  const auto measure = [&](const std::string& name, const std::function<Times()>& take) {
    if (wanted(options, name)) figures.set(name, take());
  };
  if (wanted(options, "load_case")) {
    load_cases(
        bench, "load_case", [&](int number) { return bench.array(number); }, figures);
  }
  if (wanted(options, "load_case_by_expression")) {
    load_cases(bench, "load_case_by_expression", Bench::expression, figures);
  }
  if (wanted(options, "single_case")) single_case(bench, figures);
  measure("flush_of_the_disk", [&] { return flushes(bench); });
  measure("round_trip", [&] { return round_trips(bench); });
  measure("upload_of_a_load", [&] { return uploads(bench); });
  measure("combination", [&] { return combinations(bench); });
  measure("nodal_load", [&] { return nodal_loads(bench); });
  measure("sample", [&] { return samples(bench); });
  figures.print();
}

}  // namespace
}  // namespace anticrack::benchmarks

int main(int argc, char** argv) {
  anticrack::benchmarks::Options options;
  CLI::App app("The service over loopback.", "bench_service");
  app.add_option("--repetitions", options.repetitions, "Of everything")->check(CLI::Range(1, 1000));
  app.add_option("--only", options.only, "Figures to take; all without it");
  app.add_flag("--tiny", options.tiny, "A tiny mesh and short jobs: does it work?");
  CLI11_PARSE(app, argc, argv);
  if (options.tiny) options = anticrack::benchmarks::tiny(options);
  try {
    anticrack::benchmarks::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_service: %s\n", error.what());
    return 1;
  }
  return 0;
}

// SPDX-License-Identifier: GPL-3.0-or-later
//
//   anticrack server
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <map>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/report.hpp"
#include "cli/text.hpp"
#include "client/jobs.hpp"

namespace anticrack::cli {
namespace {

// Lines like "force: array, constant, ...", one for each prefix before a dot, one for the others.
std::vector<std::string> feature_lines(const v1::ServerInfo& info) {
  std::map<std::string, std::string> groups;
  for (const std::string& feature : info.features()) {
    const std::size_t dot = feature.find('.');
    const bool grouped = dot != std::string::npos;
    std::string& group = groups[grouped ? feature.substr(0, dot) : ""];
    group += (group.empty() ? "" : ", ") + (grouped ? feature.substr(dot + 1) : feature);
  }
  std::vector<std::string> lines;
  lines.reserve(groups.size());
  for (const auto& [name, features] : groups)
    lines.push_back(name.empty() ? features : name + ": " + features);
  return lines;
}

std::string seconds(const google::protobuf::Duration& time) {
  constexpr std::int64_t hour = 3600;
  constexpr std::int64_t day = 24 * hour;
  if (time.seconds() >= 2 * day && time.seconds() % day == 0)
    return fmt::format("{} days", time.seconds() / day);
  return time.seconds() >= hour && time.seconds() % hour == 0
             ? fmt::format("{} h", time.seconds() / hour)
             : fmt::format("{} s", time.seconds());
}

std::string info_text(const v1::ServerInfo& info, const std::string& address) {
  const v1::ServerMetrics& metrics = info.metrics();
  const v1::ServerLimits& limits = info.limits();
  std::vector<std::vector<std::string>> rows{
      {"address", address},
      {"version", info.version() + " (" + info.build() + ")"},
      {"started", clock_text(info.start_time().seconds())}};
  for (const std::string& line : feature_lines(info))
    rows.push_back({rows.size() == 3 ? "features" : "", line});
  const std::vector<std::vector<std::string>> counters{
      {"solver threads", std::to_string(info.threads())},
      {"jobs", fmt::format("{} queued, {} running, {} ended", metrics.jobs_queued(),
                           metrics.jobs_running(), metrics.jobs_ended())},
      {"load cases ended", std::to_string(metrics.load_cases_ended())},
      {"iterations", std::to_string(metrics.iterations())},
      {"meshings", std::to_string(metrics.meshings())},
      {"factorisations", fmt::format("{}, reused {} times, joined {} times, evicted {}",
                                     metrics.factorizations(), metrics.operator_hits(),
                                     metrics.operator_joins(), metrics.operator_evictions())},
      {"factors in memory",
       bytes(metrics.operator_bytes()) + " of " + bytes(limits.memory_budget_bytes())},
      {"watchers", fmt::format("{} of {}", metrics.watchers(), limits.watchers())},
      {"limits",
       fmt::format("{} triangles a mesh, uploads of {}, {} load cases a job",
                   limits.mesh_triangles(), bytes(limits.upload_bytes()), limits.load_cases())},
      {"", fmt::format("{} iterations a load case, sweeps of {} rows and {} loads",
                       limits.iterations(), limits.sweep_rows(), limits.sweep_basis())},
      {"queue", fmt::format("{} jobs, {} load cases a mesh, {} of memory", limits.queued_jobs(),
                            limits.queued_cases(), bytes(limits.queued_bytes()))},
      {"times", "a job waits at most " + seconds(limits.queue_time()) + " and runs at most " +
                    seconds(limits.run_time())},
      {"results", "kept " +
                      (limits.result_ttl().seconds() > 0 ? "for " + seconds(limits.result_ttl())
                                                         : std::string("without a limit of time")) +
                      (limits.disk_budget_bytes() > 0
                           ? " within " + bytes(limits.disk_budget_bytes()) + " on the disk"
                           : std::string(" while the disk has space"))}};
  rows.insert(rows.end(), counters.begin(), counters.end());
  return table(rows, {1});
}

}  // namespace

void add_server(CLI::App& app, const Globals& globals, Command& chosen) {
  CLI::App* command =
      app.add_subcommand("server", "Show version, limits and counters of the server");
  command->footer("Example:\n  anticrack --server 127.0.0.1:7433 server");
  command->callback([&globals, &chosen] {
    chosen = [&globals] {
      Session session(globals);
      const v1::ServerInfo info = client::server_info(session.connection(), session.stop());
      print_document(globals.json ? to_json(info)
                                  : info_text(info, session.connection().address()));
      return exit_ok;
    };
  });
}

}  // namespace anticrack::cli

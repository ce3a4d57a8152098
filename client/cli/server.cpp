// SPDX-License-Identifier: GPL-3.0-or-later
//
//   anticrack server
#include <CLI/CLI.hpp>

#include <map>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/exit_codes.hpp"
#include "cli/json.hpp"
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
    group += (group.empty() ? "" : ", ") + sanitise(grouped ? feature.substr(dot + 1) : feature);
  }
  std::vector<std::string> lines;
  lines.reserve(groups.size());
  for (const auto& [name, features] : groups)
    lines.push_back(name.empty() ? features : sanitise(name) + ": " + features);
  return lines;
}

std::string seconds(const google::protobuf::Duration& time) {
  constexpr std::int64_t hour = 3600;
  constexpr std::int64_t day = 24 * hour;
  if (time.seconds() >= 2 * day && time.seconds() % day == 0)
    return std::to_string(time.seconds() / day) + " days";
  return time.seconds() >= hour && time.seconds() % hour == 0
             ? std::to_string(time.seconds() / hour) + " h"
             : std::to_string(time.seconds()) + " s";
}

std::string info_text(const v1::ServerInfo& info, const std::string& address) {
  const v1::ServerMetrics& metrics = info.metrics();
  const v1::ServerLimits& limits = info.limits();
  std::vector<std::vector<std::string>> rows{
      {"address", sanitise(address)},
      {"version", sanitise(info.version()) + " (" + sanitise(info.build()) + ")"},
      {"started", clock_text(info.start_time().seconds())}};
  for (const std::string& line : feature_lines(info))
    rows.push_back({rows.size() == 3 ? "features" : "", line});
  const std::vector<std::vector<std::string>> counters{
      {"solver threads", std::to_string(info.threads())},
      {"jobs", std::to_string(metrics.jobs_queued()) + " queued, " +
                   std::to_string(metrics.jobs_running()) + " running, " +
                   std::to_string(metrics.jobs_ended()) + " ended"},
      {"load cases ended", std::to_string(metrics.load_cases_ended())},
      {"iterations", std::to_string(metrics.iterations())},
      {"meshings", std::to_string(metrics.meshings())},
      {"factorisations", std::to_string(metrics.factorizations()) + ", reused " +
                             std::to_string(metrics.operator_hits()) + " times, joined " +
                             std::to_string(metrics.operator_joins()) + " times, evicted " +
                             std::to_string(metrics.operator_evictions())},
      {"factors in memory",
       bytes(metrics.operator_bytes()) + " of " + bytes(limits.memory_budget_bytes())},
      {"watchers", std::to_string(metrics.watchers()) + " of " + std::to_string(limits.watchers())},
      {"limits", std::to_string(limits.mesh_triangles()) + " triangles a mesh, uploads of " +
                     bytes(limits.upload_bytes()) + ", " + std::to_string(limits.load_cases()) +
                     " load cases a job"},
      {"", std::to_string(limits.iterations()) + " iterations a load case, sweeps of " +
               std::to_string(limits.sweep_rows()) + " rows and " +
               std::to_string(limits.sweep_basis()) + " loads"},
      {"queue", std::to_string(limits.queued_jobs()) + " jobs, " +
                    std::to_string(limits.queued_cases()) + " load cases a mesh, " +
                    bytes(limits.queued_bytes()) + " of memory"},
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

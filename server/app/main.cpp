// SPDX-License-Identifier: GPL-3.0-or-later
//
// anticrackd: reads the configuration and runs the service until a signal.
#include <malloc.h>
#include <signal.h>
#include <sys/stat.h>

#include <iostream>
#include <memory>
#include <new>
#include <optional>
#include <system_error>

#include "app/address_space.hpp"
#include "app/backup.hpp"
#include "app/check_files.hpp"
#include "app/command_line.hpp"
#include "app/config_file.hpp"
#include "app/notify.hpp"
#include "app/service.hpp"
#include "app/signals.hpp"
#include "app/store_check.hpp"
#include "errors/errors.hpp"
#include "log/log.hpp"
#include "rpc/version.hpp"

namespace {

using namespace anticrack;

constexpr int usage_error = 2;
constexpr const char* limits_on_memory =
    "raise the limit that is too small: ulimit -v (address space), ulimit -u (threads), or memory "
    "and pids of the control group";

/// Waits for the first signal to stop. Meanwhile SIGHUP reads certificates and tokens again, and
/// systemd's watchdog, if there is one, is kept informed.
int wait_for_end(const app::Signals& signals, app::Service& service) {
  const std::optional<std::chrono::milliseconds> interval = app::watchdog_interval();
  for (;;) {
    const std::optional<int> number = interval ? signals.wait_for(*interval) : signals.wait();
    if (number && *number != SIGHUP) return *number;
    if (number) {
      service.reload();
      continue;
    }
    service.check_alive();
    app::notify_alive();
  }
}

int serve(const app::Config& config) {
  ::umask(0077);
  const app::Signals signals;
  auto service = std::make_unique<app::Service>(config);
  std::cout << "anticrackd listening on " << service->address() << std::endl;
  log::info("started", {{"version", rpc::version()},
                        {"address", service->address()},
                        {"data", config.store.folder}});
  app::notify_ready("listening on " + service->address());
  const int number = wait_for_end(signals, *service);
  log::info("stopping", {{"signal", number}, {"again", "stops at once"}});
  app::notify_stopping("draining; jobs that do not end are queued again at the next start");
  signals.run_unless_interrupted([&] {
    service->drain();
    service.reset();
  });
  log::info("stopped");
  return 0;
}

int start(const app::Config& config) {
  const bool json = config.log_format == "json";
  log::start(config.log_level, json ? log::Format::json : log::Format::text);
  try {
    return serve(config);
  } catch (const std::exception& error) {
    // In text format main() prints it.
    if (json) log::error("refused to start", {{"message", error.what()}});
    throw;
  }
}

int run(int argc, char** argv) {
  // A heap for each thread reserves 64 MiB, and ulimit -v counts them.
  if (app::address_space_limit() > 0) ::mallopt(M_ARENA_MAX, 2);
  const app::CommandLine line = app::parse_command_line(argc, argv, rpc::version());
  if (line.text) {
    std::cout << *line.text;
    return 0;
  }
  const std::vector<app::Setting> file = line.config_file.empty()
                                             ? std::vector<app::Setting>{}
                                             : app::read_config_file(line.config_file);
  const app::Config config = app::make_config(file, line.settings);
  if (line.check_config) {
    std::cout << app::to_toml(config) << std::flush;
    const std::vector<std::string> problems = app::problems_of_files(config);
    for (const std::string& problem : problems) std::cerr << "anticrackd: " << problem << "\n";
    return problems.empty() ? 0 : usage_error;
  }
  if (!line.backup.empty()) return app::back_up(config, line.backup, std::cout);
  if (line.check_store) return app::check_store(config, line.repair, std::cout);
  return start(config);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const app::ConfigError& error) {
    std::cerr << "anticrackd: " << error.what() << "\n";
    return usage_error;
  } catch (const std::bad_alloc&) {
    std::cerr << "anticrackd: not enough memory; " << limits_on_memory << "\n";
    return 1;
  } catch (const std::system_error& error) {
    const bool thread = error.code() == std::errc::resource_unavailable_try_again;
    std::cerr << "anticrackd: " << (thread ? "a thread cannot be started; " : "")
              << (thread ? limits_on_memory : error.what()) << "\n";
    return 1;
  } catch (const std::exception& error) {
    std::cerr << "anticrackd: " << error.what() << "\n";
    return 1;
  }
}

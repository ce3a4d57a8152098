// SPDX-License-Identifier: GPL-3.0-or-later
//
// anticrackd: reads the configuration and runs the service until a signal.
#include <malloc.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <iterator>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "app/address_space.hpp"
#include "app/command_line.hpp"
#include "app/config_file.hpp"
#include "app/descriptors.hpp"
#include "app/notify.hpp"
#include "app/orphans.hpp"
#include "app/private_place.hpp"
#include "app/security.hpp"
#include "app/service.hpp"
#include "app/signals.hpp"
#include "app/store_check.hpp"
#include "app/surroundings.hpp"
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
  std::optional<std::chrono::milliseconds> interval = app::watchdog_interval();
  app::Orphans orphans;
  const bool first = app::Orphans::may_come();
  if (first && !interval) interval = std::chrono::seconds(1);
  for (;;) {
    if (first) orphans.reap();
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

std::atomic<bool> stopping = false;

/// Treats the end of a private server's client like a signal. end_soon() then ends the server so
/// quickly, whatever its threads do, that nobody has to wait until its folder is removed.
void end_with_client() {
  std::thread([] {
    app::wait_for_end_of_input();
    if (!stopping) ::kill(::getpid(), SIGTERM);  // a second signal would prevent an orderly end
  }).detach();
}

void end_soon(const app::PrivatePlace& place) {
  std::thread([remove = place.removal()] {
    constexpr std::chrono::seconds patience{2};
    std::this_thread::sleep_for(patience);
    remove();
    std::_Exit(0);
  }).detach();
}

int serve(const app::Config& config, const app::PrivatePlace* place) {
  app::require_usable_surroundings(config);
  const app::Signals signals;
  auto service = std::make_unique<app::Service>(config);
  if (place == nullptr) {  // a private server keeps nothing
    for (const std::string& odd : app::odd_surroundings(config))
      log::warn("surroundings", {{"odd", odd}});
  }
  std::cout << "anticrackd listening on " << service->address() << std::endl;
  log::info("started", {{"version", rpc::version()},
                        {"address", service->address()},
                        {"data", config.store.folder}});
  if (!app::notify_ready("listening on " + service->address()))
    log::warn("surroundings", {{"odd",
                                "NOTIFY_SOCKET is set, but nothing listens there: systemd "
                                "does not learn that the server is ready"}});
  if (place != nullptr) end_with_client();
  const int number = wait_for_end(signals, *service);
  stopping = true;
  log::info("stopping", {{"signal", number}, {"again", "stops at once"}});
  if (place != nullptr) end_soon(*place);
  app::notify_stopping("draining; jobs that do not end are queued again at the next start");
  signals.run_unless_interrupted([&] {
    service->drain();
    service.reset();
  });
  log::info("stopped");
  return 0;
}

int start(const app::Config& config, const app::PrivatePlace* place) {
  const bool json = config.log_format == "json";
  log::start(config.log_level, json ? log::Format::json : log::Format::text);
  try {
    return serve(config, place);
  } catch (const std::exception& error) {
    // In text format, main() prints the error.
    if (json) log::error("refused to start", {{"message", error.what()}});
    throw;
  }
}

int run(int argc, char** argv) {
  // Each heap of a thread reserves 64 MiB, which ulimit -v counts.
  if (app::address_space_limit() > 0) ::mallopt(M_ARENA_MAX, 2);
  const app::CommandLine line = app::parse_command_line(argc, argv, rpc::version());
  if (line.text) {
    std::cout << *line.text << std::flush;
    if (std::cout) return 0;
    if (errno == EPIPE) return 128 + SIGPIPE;  // the reader, such as head, has enough
    throw std::runtime_error("standard output cannot be written");
  }
  std::optional<app::PrivatePlace> place;
  std::vector<app::Setting> file;
  if (line.is_private) file = place.emplace().settings();
  if (!line.config_file.empty())
    std::ranges::copy(app::read_config_file(line.config_file), std::back_inserter(file));
  app::Config config = app::make_config(file, line.settings);
  const bool serves = line.backup.empty() && !line.check_store && !line.copy_store;
  if (serves) app::fit_connections(config, app::raise_descriptor_limit());
  if (line.check_config) {
    std::cout << app::to_toml(config) << std::flush;
    const std::vector<std::string> problems = app::problems_of_files(config);
    for (const std::string& problem : problems) std::cerr << "anticrackd: " << problem << "\n";
    return problems.empty() ? 0 : usage_error;
  }
  if (!line.backup.empty()) return app::back_up(config, line.backup, std::cout);
  if (line.copy_store) return app::copy_store(config, line.dry_run, std::cout);
  if (line.check_store) return app::check_store(config, line.repair, std::cout);
  return start(config, place ? &*place : nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  app::settle();
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

// SPDX-License-Identifier: GPL-3.0-or-later
//
// anticrackd: configuration, signals, and the service between them.
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <iostream>
#include <memory>

#include "app/command_line.hpp"
#include "app/config_file.hpp"
#include "app/service.hpp"
#include "app/signals.hpp"
#include "errors/errors.hpp"
#include "rpc/version.hpp"

namespace {

constexpr int usage_error = 2;

void log_to_stderr(const std::string& level) {
  const auto logger = spdlog::stderr_logger_mt("anticrackd");
  logger->set_pattern("%Y-%m-%dT%H:%M:%S.%e%z %l %v");
  logger->set_level(spdlog::level::from_str(level));
  spdlog::set_default_logger(logger);
}

int serve(const anticrack::app::Config& config) {
  ::umask(0077);
  const anticrack::app::Signals signals;
  auto service = std::make_unique<anticrack::app::Service>(config);
  std::cout << "anticrackd listening on " << service->address() << std::endl;
  spdlog::info("anticrackd {} listening on {}, data in {}", anticrack::rpc::version(),
               service->address(), config.data_dir);
  const int number = signals.wait();
  spdlog::info("signal {}: stopping; once more to stop at once", number);
  signals.run_unless_interrupted([&] {
    service->drain();
    service.reset();
  });
  spdlog::info("stopped");
  return 0;
}

int run(int argc, char** argv) {
  using namespace anticrack::app;
  const CommandLine line = parse_command_line(argc, argv, anticrack::rpc::version());
  if (line.text) {
    std::cout << *line.text;
    return 0;
  }
  const std::vector<Setting> file =
      line.config_file.empty() ? std::vector<Setting>{} : read_config_file(line.config_file);
  const Config config = make_config(file, line.settings);
  if (line.check_config) {
    std::cout << to_toml(config);
    return 0;
  }
  log_to_stderr(config.log_level);
  return serve(config);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const anticrack::app::ConfigError& error) {
    std::cerr << "anticrackd: " << error.what() << "\n";
    return usage_error;
  } catch (const std::exception& error) {
    std::cerr << "anticrackd: " << error.what() << "\n";
    return 1;
  }
}

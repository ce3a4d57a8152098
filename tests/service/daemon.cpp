// SPDX-License-Identifier: GPL-3.0-or-later
#include "service/daemon.hpp"

#include <signal.h>

#include <stdexcept>
#include <utility>

namespace anticrack::service_test {

Daemon::Daemon(std::vector<std::string> options, std::vector<std::string> environment)
    : _data(_folder / "data"), _options(std::move(options)), _environment(std::move(environment)) {
  start();
}

Daemon::Daemon(const std::filesystem::path& data, std::vector<std::string> options,
               std::vector<std::string> environment)
    : _data(data), _options(std::move(options)), _environment(std::move(environment)) {
  start();
}

void Daemon::launch() {
  if (_process) throw std::logic_error("anticrackd runs already");
  std::vector<std::string> argv = {ANTICRACKD, "--listen", address(), "--data-dir", data()};
  argv.insert(argv.end(), _options.begin(), _options.end());
  _process = std::make_unique<anticrack::testing::Process>(argv, _environment);
}

void Daemon::wait_until_ready() {
  if (!_process->wait_for_output("listening on")) {
    throw std::runtime_error("anticrackd did not start: " + _process->error());
  }
}

void Daemon::start() {
  launch();
  wait_until_ready();
}

void Daemon::kill() {
  _process->signal(SIGKILL);
  _process->wait();
  _process.reset();
}

int Daemon::stop() {
  _process->signal(SIGTERM);
  const std::optional<int> code = _process->wait();
  if (!code) throw std::runtime_error("anticrackd does not stop: " + _process->error());
  _process.reset();
  return *code;
}

Ended Daemon::run_on_data(std::vector<std::string> options) const {
  options.insert(options.begin(), {ANTICRACKD, "--data-dir", data()});
  anticrack::testing::Process process(options);
  const int code = process.wait().value_or(-1);
  return {code, process.output(), process.error()};
}

client::ConnectionOptions Daemon::connection() const {
  client::ConnectionOptions options;
  options.address = address();
  options.first_contact = options.retry.patience;
  options.retry.longest = std::chrono::milliseconds(200);
  return options;
}

Ended Daemon::client(const std::vector<std::string>& arguments) const {
  return run_client(address(), arguments);
}

}  // namespace anticrack::service_test

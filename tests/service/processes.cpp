// SPDX-License-Identifier: GPL-3.0-or-later
#include "service/processes.hpp"

#include <google/protobuf/util/json_util.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace anticrack::service_test {

namespace {

template <class Message>
Message from_json(const Ended& ended) {
  Message message;
  const auto status = google::protobuf::util::JsonStringToMessage(ended.output, &message);
  if (ended.code != 0 || !status.ok()) {
    throw std::runtime_error("exit code " + std::to_string(ended.code) + ", output '" +
                             ended.output + "', error '" + ended.error + "'");
  }
  return message;
}

bool is_ended(v1::JobStatus::State state) { return state >= v1::JobStatus::STATE_SUCCEEDED; }

}  // namespace

std::unique_ptr<anticrack::testing::Process> start_client(
    const std::string& address, const std::vector<std::string>& arguments) {
  std::vector<std::string> argv = {ANTICRACK, "--server", address};
  argv.insert(argv.end(), arguments.begin(), arguments.end());
  return std::make_unique<anticrack::testing::Process>(argv);
}

Ended run_client(const std::string& address, const std::vector<std::string>& arguments) {
  const auto process = start_client(address, arguments);
  const int code = process->wait(std::chrono::seconds(300)).value_or(-1);
  return {code, process->output(), process->error()};
}

Server::Server(const std::vector<std::string>& options) {
  std::vector<std::string> argv = {ANTICRACKD, "--listen", "127.0.0.1:0", "--data-dir",
                                   _folder / "data"};
  argv.insert(argv.end(), options.begin(), options.end());
  _process = std::make_unique<anticrack::testing::Process>(argv);
  if (!_process->wait_for_output("\n")) {
    throw std::runtime_error("anticrackd did not start: " + _process->error());
  }
  const std::string line = _process->output();
  const std::string before = "listening on ";
  _address = line.substr(line.find(before) + before.size());
  _address.erase(_address.find('\n'));
}

std::unique_ptr<anticrack::testing::Process> Server::start_client(
    const std::vector<std::string>& arguments) const {
  return service_test::start_client(_address, arguments);
}

Ended Server::client(const std::vector<std::string>& arguments) const {
  return run_client(_address, arguments);
}

v1::ServerInfo Server::info() const {
  return from_json<v1::ServerInfo>(client({"server", "--json"}));
}

v1::Job Server::job(const std::string& name) const {
  return from_json<v1::Job>(client({"job", "show", name, "--json"}));
}

std::vector<std::string> Server::jobs() const {
  const auto list = from_json<v1::ListJobsResponse>(client({"job", "list", "--json"}));
  std::vector<std::string> names;
  for (const v1::Job& job : list.jobs()) names.push_back(job.name());
  return names;
}

v1::Job Server::ended_job(const std::string& name) const {
  for (int attempt = 0; attempt < 600; ++attempt) {
    v1::Job current = job(name);
    if (is_ended(current.status().state())) return current;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  throw std::runtime_error(name + " has not ended within a minute");
}

std::string Server::running_job() const {
  for (int attempt = 0; attempt < 600; ++attempt) {
    for (const std::string& name : jobs()) {
      if (job(name).status().state() == v1::JobStatus::STATE_RUNNING) return name;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  throw std::runtime_error("no job was running within a minute");
}

std::string example(const std::string& name) { return std::string(EXAMPLES) + "/" + name; }

std::vector<std::string> endless() {
  return {"--set", "solver.theta=1e-7",    "--set", "solver.max_iterations=1000000",
          "--set", "solver.epsilon=1e-300"};
}

google::protobuf::Struct parse_json(const std::string& text) {
  google::protobuf::Struct result;
  const auto status = google::protobuf::util::JsonStringToMessage(text, &result);
  if (!status.ok()) throw std::runtime_error("not one JSON document: '" + text + "'");
  return result;
}

std::string write_file(const anticrack::testing::TemporaryFolder& folder, const std::string& name,
                       const std::string& content) {
  const std::string path = (folder / name).string();
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

std::string read_file(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

}  // namespace anticrack::service_test

// SPDX-License-Identifier: GPL-3.0-or-later
//
// The real server and the real client, as processes.
#pragma once

#include <google/protobuf/struct.pb.h>

#include <memory>
#include <string>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/server.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::service_test {

/// What a command that has ended left behind.
struct Ended {
  int code = -1;
  std::string output;
  std::string error;
};

/// Runs `anticrack --server ADDRESS ...` to its end.
Ended run_client(const std::string& address, const std::vector<std::string>& arguments);
/// Starts it and lets it run.
std::unique_ptr<anticrack::testing::Process> start_client(
    const std::string& address, const std::vector<std::string>& arguments);

/// anticrackd on a free loopback port with a data folder of its own.
class Server {
 public:
  explicit Server(const std::vector<std::string>& options = {});

  const std::string& address() const noexcept { return _address; }
  anticrack::testing::Process& process() noexcept { return *_process; }

  /// Runs `anticrack ...` against this server to its end.
  Ended client(const std::vector<std::string>& arguments) const;
  /// Starts `anticrack ...` against this server and lets it run.
  std::unique_ptr<anticrack::testing::Process> start_client(
      const std::vector<std::string>& arguments) const;

  v1::ServerInfo info() const;
  v1::Job job(const std::string& name) const;
  /// Names of all jobs, newest first.
  std::vector<std::string> jobs() const;
  /// Waits until the job has ended and returns it.
  v1::Job ended_job(const std::string& name) const;
  /// Waits until some job is in its iterations; its name.
  std::string running_job() const;

 private:
  anticrack::testing::TemporaryFolder _folder;
  std::string _address;
  std::unique_ptr<anticrack::testing::Process> _process;
};

/// Path of a case shipped with the client, e.g. "paper-3.toml".
std::string example(const std::string& name);

/// Overrides that make a shipped case iterate for minutes: it is only ever interrupted.
std::vector<std::string> endless();

google::protobuf::Struct parse_json(const std::string& text);

std::string write_file(const anticrack::testing::TemporaryFolder& folder, const std::string& name,
                       const std::string& content);
std::string read_file(const std::string& path);

}  // namespace anticrack::service_test

// SPDX-License-Identifier: GPL-3.0-or-later
//
// anticrackd on a data folder and a unix socket that outlive it: killed, stopped, started again.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "client/connection.hpp"
#include "service/processes.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::service_test {

class Daemon {
 public:
  /// Runs when it returns. `environment`: "NAME=value" beside the inherited ones.
  explicit Daemon(std::vector<std::string> options = {}, std::vector<std::string> environment = {});

  /// The same on a data folder that is there already, e.g. a mounted one.
  Daemon(const std::filesystem::path& data, std::vector<std::string> options,
         std::vector<std::string> environment = {});

  std::string address() const { return "unix:" + (_folder / "socket").string(); }
  std::string data() const { return _data.string(); }
  /// For what belongs to this server: other sockets, results.
  const anticrack::testing::TemporaryFolder& folder() const noexcept { return _folder; }
  anticrack::testing::Process& process() noexcept { return *_process; }

  /// Begins to start. Throws where it runs already.
  void launch();
  /// Waits until it listens; throws what it said when it ended instead.
  void wait_until_ready();
  void start();
  /// SIGKILL, and waits for its end.
  void kill();
  /// SIGTERM, and waits for its end; its exit code.
  int stop();

  /// Runs anticrackd with these options on the data folder to its end, while this one is stopped.
  Ended run_on_data(std::vector<std::string> options) const;

  /// Of a client that waits patiently for it.
  client::ConnectionOptions connection() const;

  Ended client(const std::vector<std::string>& arguments) const;

 private:
  anticrack::testing::TemporaryFolder _folder;
  std::filesystem::path _data;
  std::vector<std::string> _options;
  std::vector<std::string> _environment;
  std::unique_ptr<anticrack::testing::Process> _process;
};

}  // namespace anticrack::service_test

// SPDX-License-Identifier: GPL-3.0-or-later
//
// A child process whose output a test can wait for.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace anticrack::testing {

/// Starts a program, drains its output in the background, kills it at the end of the scope.
class Process {
 public:
  /// `argv[0]` is a path. `environment` entries ("NAME=value") are added to the inherited ones.
  explicit Process(std::vector<std::string> argv, const std::vector<std::string>& environment = {},
                   const std::string& input = {});
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Waits until the text appears on standard output (or error); false when the process ended or
  /// the limit passed first.
  bool wait_for_output(const std::string& text,
                       std::chrono::seconds limit = std::chrono::seconds(60));
  bool wait_for_error(const std::string& text,
                      std::chrono::seconds limit = std::chrono::seconds(60));
  /// Exit code, 128 + signal, or nothing when the limit passed.
  std::optional<int> wait(std::chrono::seconds limit = std::chrono::seconds(60));
  void signal(int number) const;
  int id() const noexcept { return _pid; }
  std::string output() const;
  std::string error() const;

 private:
  struct Stream {
    int descriptor = -1;
    std::string text;
    bool closed = false;
    std::thread reader;
  };
  void drain(Stream& stream);
  bool wait_for(const Stream& stream, const std::string& text, std::chrono::seconds limit);

  int _pid = -1;
  std::optional<int> _exit;
  Stream _output;
  Stream _error;
  mutable std::mutex _mutex;
  std::condition_variable _changed;
};

}  // namespace anticrack::testing

// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <utility>

namespace anticrack::testing {

namespace {

std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe2 failed");
  return ends;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  result.reserve(texts.size() + 1);
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

}  // namespace

Process::Process(std::vector<std::string> argv, const std::vector<std::string>& environment,
                 const std::string& input) {
  const auto in = make_pipe();
  const auto out = make_pipe();
  const auto err = make_pipe();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);

  std::vector<std::string> variables = environment;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string inherited = *entry;
    const std::string name = inherited.substr(0, inherited.find('=') + 1);
    bool replaced = false;
    for (const std::string& given : environment) replaced = replaced || given.starts_with(name);
    if (!replaced) variables.push_back(inherited);
  }
  std::vector<char*> arguments = pointers(argv);
  std::vector<char*> variable_pointers = pointers(variables);
  const int status = posix_spawn(&_pid, argv[0].c_str(), &actions, nullptr, arguments.data(),
                                 variable_pointers.data());
  posix_spawn_file_actions_destroy(&actions);
  close(in[0]);
  close(out[1]);
  close(err[1]);
  // Inputs of tests are far below a pipe's buffer, so this cannot block.
  const bool fed = write(in[1], input.data(), input.size()) == static_cast<ssize_t>(input.size());
  close(in[1]);
  _output.descriptor = out[0];
  _error.descriptor = err[0];
  if (status != 0 || !fed) throw std::runtime_error("cannot start " + argv[0]);
  _output.reader = std::thread([this] { drain(_output); });
  _error.reader = std::thread([this] { drain(_error); });
}

Process::~Process() {
  if (!_exit) {
    signal(SIGKILL);
    wait();
  }
  _output.reader.join();
  _error.reader.join();
  close(_output.descriptor);
  close(_error.descriptor);
}

void Process::drain(Stream& stream) {
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t count = read(stream.descriptor, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    const std::scoped_lock lock(_mutex);
    if (count > 0) {
      stream.text.append(buffer.data(), static_cast<std::size_t>(count));
    } else {
      stream.closed = true;
    }
    _changed.notify_all();
    if (count <= 0) return;
  }
}

bool Process::wait_for(const Stream& stream, const std::string& text, std::chrono::seconds limit) {
  std::unique_lock lock(_mutex);
  const auto found = [&] { return stream.text.find(text) != std::string::npos; };
  _changed.wait_for(lock, limit, [&] { return found() || stream.closed; });
  return found();
}

bool Process::wait_for_output(const std::string& text, std::chrono::seconds limit) {
  return wait_for(_output, text, limit);
}

bool Process::wait_for_error(const std::string& text, std::chrono::seconds limit) {
  return wait_for(_error, text, limit);
}

std::optional<int> Process::wait(std::chrono::seconds limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!_exit) {
    int status = 0;
    const pid_t ended = waitpid(_pid, &status, WNOHANG);
    if (ended == _pid) {
      _exit = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
      // What it wrote last may still be on its way through the pipes.
      std::unique_lock lock(_mutex);
      _changed.wait_for(lock, std::chrono::seconds(5),
                        [&] { return _output.closed && _error.closed; });
    } else if (std::chrono::steady_clock::now() > deadline) {
      return std::nullopt;
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  return _exit;
}

void Process::signal(int number) const {
  if (!_exit) kill(_pid, number);
}

std::string Process::output() const {
  const std::scoped_lock lock(_mutex);
  return _output.text;
}

std::string Process::error() const {
  const std::scoped_lock lock(_mutex);
  return _error.text;
}

}  // namespace anticrack::testing

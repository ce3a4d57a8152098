// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/helper.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "mesher/child.hpp"
#include "mesher/mesh_start.hpp"
#include "stop/stop.hpp"

namespace anticrack::mesher {
namespace {

using Clock = std::chrono::steady_clock;
using errors::Error;
using errors::Reason;

/// Processor time beyond the wall time, so that the wall clock, with its better message, is first.
constexpr std::chrono::seconds cpu_slack{10};
/// More than a triangle with its nodes and edges takes, without names and warnings.
constexpr std::size_t reply_bytes_a_triangle = 256;
constexpr std::size_t other_reply_bytes = 16U << 20;

Error failed(const std::string& message) { return {Reason::mesher_failed, message}; }

std::size_t most_reply_bytes(const mesh::MesherRequest& request) {
  const std::size_t triangles =
      std::visit([](const auto& wanted) { return wanted.max_triangles; }, request);
  const std::size_t most = (SIZE_MAX - other_reply_bytes) / reply_bytes_a_triangle;
  return other_reply_bytes + std::min(triangles, most) * reply_bytes_a_triangle;
}

std::string ending(int status, const HelperOptions& options) {
  if (WIFEXITED(status)) {
    return fmt::format(
        "the mesher ended with status {} and no answer; see the server's error output",
        WEXITSTATUS(status));
  }
  const int signal = WTERMSIG(status);
  const char* abbreviation = sigabbrev_np(signal);
  const std::string name =
      abbreviation == nullptr ? std::to_string(signal) : std::string("SIG") + abbreviation;
  switch (signal) {
    case SIGXCPU:
      return fmt::format(
          "the mesher was stopped by {}, its limit of processor time; choose a "
          "coarser mesh (larger size or tip_size) or raise the time limit",
          name);
    case SIGSYS:
      return fmt::format("the mesher was stopped by {}: it tried a system call it may not use",
                         name);
    case SIGKILL:
      return fmt::format(
          "the mesher was killed ({}), perhaps because the machine ran out of memory; "
          "choose a coarser mesh (larger size or tip_size)",
          name);
    default:
      return fmt::format(
          "the mesher crashed ({}), perhaps at its limit of {} MiB of memory; choose "
          "a coarser mesh (larger size or tip_size) or change the geometry",
          name, options.memory_limit >> 20);
  }
}

/// Makes a stop request visible to poll().
class StopSignal {
 public:
  explicit StopSignal(const std::stop_token& stop)
      : _event(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)), _callback(stop, Wake{_event.get()}) {
    if (_event.get() < 0) throw std::system_error(errno, std::system_category(), "eventfd");
  }
  int descriptor() const noexcept { return _event.get(); }

 private:
  struct Wake {
    int descriptor;
    // If the counter is full, the descriptor is readable already.
    void operator()() const noexcept { eventfd_write(descriptor, 1); }
  };
  base::Descriptor _event;
  std::stop_callback<Wake> _callback;
};

/// Sends a request to a helper and receives the reply within the time limit.
class Conversation {
 public:
  /// `kind`: "import" of `file`, or "generate" without one.
  Conversation(const HelperOptions& options, std::stop_token stop, std::size_t most_bytes,
               const char* kind, base::Descriptor file, const ProgressListener& listener)
      : _options(options),
        _listener(listener),
        _stop(std::move(stop)),
        _wake(_stop),
        _deadline(Clock::now() + options.time_limit),
        _most_bytes(most_bytes),
        _child(options.executable,
               {std::to_string(options.memory_limit),
                std::to_string((options.time_limit + cpu_slack).count()), kind},
               std::move(file)) {}

  mesh::Bytes exchange(std::span<const std::byte> request) {
    mesh::Bytes reply;
    bool open = true;
    while (open) {
      const short events = wait(request.empty() ? POLLIN : POLLIN | POLLOUT);
      if ((events & POLLOUT) != 0 && !request.empty()) {
        request = request.subspan(_child.send(request));
        if (request.empty()) _child.end_input();
      }
      if ((events & (POLLIN | POLLHUP | POLLERR)) != 0) open = receive(reply);
      if (!_replies) take_reports(reply);
    }
    // The child closes its output just before it ends.
    while (!_child.ended()) wait(0, std::chrono::milliseconds(2));
    if (!WIFEXITED(_child.status()) || WEXITSTATUS(_child.status()) != 0 || reply.empty())
      throw failed(ending(_child.status(), _options));
    return reply;
  }

 private:
  /// Waits for the child, at most `longest`, and returns poll's events of its socket. Throws when
  /// stopped or out of time, which kills the child.
  short wait(short events, std::chrono::milliseconds longest = std::chrono::hours(1)) {
    if (_stop.stop_requested()) throw Error(Reason::cancelled, "meshing was cancelled");
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(_deadline - Clock::now());
    if (left.count() <= 0) {
      throw failed(
          fmt::format("the mesher was stopped after {} s, its time limit; choose a coarser "
                      "mesh or raise the limit",
                      _options.time_limit.count()));
    }
    // poll ignores a negative descriptor; a closed socket would always be ready
    pollfd polled[2] = {{events == 0 ? -1 : _child.socket(), events, 0},
                        {_wake.descriptor(), POLLIN, 0}};
    const auto timeout = std::min(left + std::chrono::milliseconds(1), longest);
    if (poll(polled, 2, static_cast<int>(timeout.count())) < 0 && errno != EINTR)
      throw std::system_error(errno, std::system_category(), "poll");
    return polled[0].revents;
  }

  /// Receives bytes; false at the end of the child's output.
  bool receive(mesh::Bytes& reply) {
    constexpr std::size_t step = 1U << 18;
    const std::size_t used = reply.size();
    reply.resize(used + step);
    const ssize_t n = recv(_child.socket(), reply.data() + used, step, 0);
    reply.resize(used + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    if (reply.size() > _most_bytes) {
      throw failed(
          fmt::format("the mesher's answer is longer than {} bytes, too long for the "
                      "triangles asked for",
                      _most_bytes));
    }
    if (n > 0) return true;
    return n < 0 && (errno == EAGAIN || errno == EINTR);
  }

  /// Takes the reports, and then the mark of the reply, off the beginning of the received bytes.
  void take_reports(mesh::Bytes& received) {
    std::size_t taken = 0;
    while (taken < received.size() && received[taken] == report_mark) {
      const auto report = first_report(std::span(received).subspan(taken));
      if (!report) break;
      if (_listener) _listener(report->first);
      taken += report->second;
    }
    if (taken < received.size() && received[taken] != report_mark) {
      _replies = true;
      taken += received[taken] == reply_mark ? 1 : 0;  // otherwise decoding will fail
    }
    received.erase(received.begin(), received.begin() + static_cast<std::ptrdiff_t>(taken));
  }

  const HelperOptions& _options;
  const ProgressListener& _listener;
  bool _replies = false;  ///< whether the reports have ended
  std::stop_token _stop;
  StopSignal _wake;
  Clock::time_point _deadline;
  std::size_t _most_bytes;
  Child _child;
};

mesh::Bytes converse(const HelperOptions& options, const mesh::MesherRequest& request,
                     base::Descriptor file, std::stop_token stop,
                     const ProgressListener& listener) {
  try {
    const char* kind = file ? "import" : "generate";
    Conversation conversation(options, std::move(stop), most_reply_bytes(request), kind,
                              std::move(file), listener);
    return conversation.exchange(mesh::encode(request));
  } catch (const std::system_error& error) {
    throw failed(
        fmt::format("cannot run the mesher \"{}\": {}; it is installed with the server, "
                    "beside it or in ../libexec/anticrack",
                    options.executable, error.code().message()));
  }
}

/// Opens a file and checks by its beginning that its format can be read. The check and the child
/// use the same descriptor, so the file cannot be exchanged in between.
base::Descriptor open_msh(const std::string& path) {
  base::Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  char start[start_bytes] = {};
  // pread leaves the offset, which the child shares, at 0
  const ssize_t n = file ? pread(file.get(), start, sizeof start, 0) : -1;
  if (n < 0) {
    throw Error(Reason::mesh_invalid, "the mesh file cannot be read: {}",
                std::generic_category().message(errno));
  }
  format_of(std::string_view(start, static_cast<std::size_t>(n)));
  return file;
}

mesh::MesherReply understand(std::span<const std::byte> bytes) {
  try {
    return mesh::decode_reply(bytes);
  } catch (const Error& error) {
    throw failed(std::string("the mesher's answer makes no sense: ") + error.what());
  }
}

}  // namespace

mesh::Mesh run(const HelperOptions& options, const mesh::MesherRequest& request,
               std::stop_token stop, const ProgressListener& listener) {
  const stop::Scope scope(stop);
  if (stop.stop_requested()) throw Error(Reason::cancelled, "meshing was cancelled");
  base::Descriptor file;
  if (const auto* import = std::get_if<mesh::ImportRequest>(&request))
    file = open_msh(import->path);
  mesh::MesherReply reply =
      understand(converse(options, request, std::move(file), std::move(stop), listener));
  if (auto* error = std::get_if<Error>(&reply)) throw std::move(*error);
  mesh::Mesh mesh = std::get<mesh::Mesh>(std::move(reply));
  try {
    mesh::validate(mesh);
  } catch (const Error& error) {
    // the triangles are not the user's, so no field of the request is at fault
    if (std::holds_alternative<mesh::ImportRequest>(request) || error.reason() == Reason::cancelled)
      throw;
    throw failed(std::string("the mesh made of this geometry is not usable: ") + error.what() +
                 "; choose preset uniform, or remove details far smaller than the rest");
  }
  return mesh;
}

void require_msh(const std::string& path) { open_msh(path); }

const char* mark() noexcept { return "anticrack-mesher of anticrack " ANTICRACK_VERSION; }

bool is_helper(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  return bytes.starts_with("#!") || bytes.find(mark()) != std::string::npos;
}

std::string default_executable() {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path folder = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  const fs::path beside = folder / "anticrack-mesher";
  const fs::path installed = folder.parent_path() / "libexec" / "anticrack" / "anticrack-mesher";
  return !fs::exists(beside, ignored) && fs::exists(installed, ignored) ? installed : beside;
}

}  // namespace anticrack::mesher

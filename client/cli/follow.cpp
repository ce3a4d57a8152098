// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/follow.hpp"

#include <chrono>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "cli/live_view.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "client/jobs.hpp"

namespace anticrack::cli {
namespace {

/// The progress of a job on a terminal or in a log.
class View {
 public:
  explicit View(Session& session) : _session(session) {
    std::FILE* stream = people(session.globals());
    if (is_terminal(stream) && !session.globals().quiet) {
      _painter = std::make_unique<Painter>(stream, [this](Size size) {
        const std::lock_guard lock(_mutex);
        return frame(_progress, size.width, size.height - 1);
      });
    }
    session.tell([this](const std::string& message) {
      change([&](JobProgress& progress) { progress.notice = message; });
    });
  }
  ~View() { _session.tell({}); }
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  template <class Change>
  void change(const Change& apply) {
    std::vector<std::string> lines;
    {
      const std::lock_guard lock(_mutex);
      apply(_progress);
      if (!_painter) {
        lines = _log.lines(_progress);
      }
    }
    if (_painter) {
      _painter->refresh();
    }
    for (const std::string& line : lines) {
      say(_session.globals(), line);
    }
  }

 private:
  Session& _session;
  std::mutex _mutex;
  JobProgress _progress;
  PlainLog _log;
  std::unique_ptr<Painter> _painter;  // last: its thread uses the others
};

v1::Job watch(Session& session, const std::string& name, const std::stop_token& stop) {
  View view(session);
  return client::watch_job(
      session.connection(), name, 0,
      [&view](const v1::WatchJobResponse& event) {
        const std::chrono::duration<double> now =
            std::chrono::steady_clock::now().time_since_epoch();
        view.change([&](JobProgress& progress) { progress.apply(event, now.count()); });
      },
      stop);
}

}  // namespace

Followed follow(Session& session, const v1::Job& job) {
  const Globals& globals = session.globals();
  try {
    return {Followed::How::ended, watch(session, job.name(), session.signals().first())};
  } catch (const client::Interrupted&) {
    // Detached; what that means is decided below.
  }
  if (!globals.local) {
    constexpr std::chrono::seconds time_to_cancel{2};
    say(globals, "Detaching; press Ctrl-C again now to cancel the job instead");
    if (!session.signals().second_within(time_to_cancel)) {
      say(globals, "The job goes on. To attach again: anticrack job watch " + job.name() +
                       session.server_option());
      return {Followed::How::detached, job};
    }
  }
  say(globals, "Cancelling " + job.name());
  client::cancel_job(session.connection(), job.name());
  v1::Job last = watch(session, job.name(), {});
  const bool in_time = last.state() == v1::Job::STATE_CANCELLED;
  return {in_time ? Followed::How::cancelled : Followed::How::ended, std::move(last)};
}

}  // namespace anticrack::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/job_run.hpp"

#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "cli/live_view.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "cli/text.hpp"
#include "client/jobs.hpp"
#include "client/meshes.hpp"

namespace anticrack::cli {
namespace {

using google::protobuf::util::TimeUtil;

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// The age of a job by two clocks that may differ; never negative.
double age_of(const v1::Job& job) {
  return std::max(0., seconds_between(job.status().create_time(), TimeUtil::GetCurrentTime()));
}

/// The progress of a job or a mesh on a terminal or in a log.
class View {
 public:
  /// `age`: seconds since its beginning; `rows`: those of a sweep.
  View(Session& session, const std::string& name, double age, std::uint64_t rows = 0)
      : _session(session), _begin(steady_seconds() - age) {
    _progress.job = sanitise(name);
    if (rows > 0) _progress.sweep.emplace().total = rows;
    if (shows_frames(session.globals())) {
      _painter.emplace(people(session.globals()), [this](Size size) { return frame_now(size); });
      session.signals().tell_screen([this](Signals::Screen event) {
        if (event == Signals::Screen::leaving) _painter->pause();
        if (event == Signals::Screen::back) _painter->resume();
        if (event == Signals::Screen::resized) _painter->redraw();
      });
    }
    session.tell([this](const std::string& message) {
      change([&](JobProgress& progress) { progress.notice = sanitise(message); });
    });
  }
  ~View() {
    _session.tell({});
    _session.signals().tell_screen({});
  }
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  template <class Change>
  void change(const Change& apply) {
    const std::lock_guard lock(_mutex);
    apply(_progress);
    if (_painter) return _painter->refresh();
    if (_progress.job.empty()) return;
    for (const std::string& line : _log.lines(_progress)) say(_session.globals(), line);
  }

  void prompt(const std::string& text) {
    change([&](JobProgress& progress) { progress.prompt = text; });
  }

 private:
  std::vector<std::string> frame_now(Size size) {
    const std::lock_guard lock(_mutex);
    if (_progress.job.empty()) return {};
    if (!client::ended(_progress.state)) _progress.elapsed = steady_seconds() - _begin;
    return frame(_progress, size.width, size.height - 1);
  }

  Session& _session;
  const double _begin;  // of the job, by the steady clock
  std::mutex _mutex;
  JobProgress _progress;
  PlainLog _log;
  std::optional<Painter> _painter;  // last: its thread uses the others
};

/// Handles Ctrl-C while a job is watched: the first one detaches, a second one cancels. With a
/// private server the first one cancels. Returns whether the job was cancelled.
bool heed_interrupts(Session& session, const std::string& job, View& view,
                     std::stop_source& detached, const std::stop_token& over) {
  Signals& signals = session.signals();
  if (!signals.wait_for_first(over)) return false;
  if (!session.globals().local) {
    constexpr std::chrono::seconds time_to_cancel{2};
    if (signals.interactive())
      view.prompt("Detaching; press Ctrl-C again now to cancel the job instead");
    if (!signals.second_within(time_to_cancel, over)) {
      detached.request_stop();
      return false;
    }
  }
  view.prompt("Cancelling " + job);
  try {
    client::cancel_job(session.connection(), job, over);
  } catch (const client::Interrupted&) {
    // The watch was over before the server could be told.
  }
  return true;
}

// The job as it ended; empty if the watch was detached.
std::optional<v1::Job> watch(Session& session, const std::string& job, View& view,
                             const std::stop_token& detached) {
  try {
    return client::watch_job(
        session.connection(), job, 0,
        [&view](const v1::WatchJobResponse& event) {
          view.change([&](JobProgress& progress) { progress.apply(event, steady_seconds()); });
        },
        detached);
  } catch (const client::Interrupted&) {
    return std::nullopt;
  }
}

}  // namespace

Followed follow(Session& session, const v1::Job& job, std::uint64_t rows) {
  std::optional<v1::Job> last;
  bool cancelling = false;
  {
    View view(session, job.name(), age_of(job), rows);
    std::stop_source detached;
    std::exception_ptr failure;
    std::jthread interrupts([&](const std::stop_token& over) {
      try {
        cancelling = heed_interrupts(session, job.name(), view, detached, over);
      } catch (...) {
        failure = std::current_exception();
        detached.request_stop();
      }
    });
    last = watch(session, job.name(), view, detached.get_token());
    interrupts.request_stop();
    interrupts.join();
    if (failure) std::rethrow_exception(failure);
    view.prompt("");
  }
  if (!last) {
    const std::string target = job.name() + session.server_option();
    say_always(session.globals(),
               "The job goes on. To attach again: anticrack job watch " + target);
    say_always(session.globals(), "To save its results in the end: anticrack job fetch " + target);
    return {Followed::How::detached, job, {}};
  }
  const bool in_time = cancelling && last->status().state() == v1::JobStatus::STATE_CANCELLED;
  return {in_time ? Followed::How::cancelled : Followed::How::ended, *std::move(last), {}};
}

v1::Mesh follow_mesh(Session& session, const std::string& name) {
  View view(session, name, 0);
  const auto show = [&view](const v1::Mesh& mesh) {
    view.change([&](JobProgress& progress) {
      progress.doing = state_text(mesh);
      progress.notice.clear();
      if (client::settled(mesh.state())) progress.job.clear();  // the caller reports the end
    });
  };
  return client::wait_for_mesh(session.connection(), name, show, session.stop());
}

}  // namespace anticrack::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/job_run.hpp"

#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <memory>
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
    if (shows_frames(session.globals()))
      _frames = std::make_unique<Frames>(session, [this](Size size) { return frame_now(size); });
    session.tell([this](const std::string& message) {
      change([&](JobProgress& progress) { progress.notice = sanitise(message); });
    });
  }
  ~View() { _session.tell({}); }
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  template <class Change>
  void change(const Change& apply) {
    const std::lock_guard lock(_mutex);
    apply(_progress);
    if (_frames) {
      _frames->refresh();
      return;
    }
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
  std::unique_ptr<Frames> _frames;  // last: its thread uses the others
};

/// Handles Ctrl-C while a job is watched: the first one detaches, a second one cancels. With a
/// private server the first one cancels.
class Interrupts {
 public:
  Interrupts(Session& session, const std::string& job, View& view)
      : _thread([&session, job, &view, this](const std::stop_token& over) {
          try {
            heed(session, job, view, over);
          } catch (const client::Interrupted&) {
            // The watch was over before the server could be told.
          } catch (...) {
            _failure = std::current_exception();
            _detached.request_stop();
          }
        }) {}

  /// The token that ends the watch.
  std::stop_token detached() const noexcept { return _detached.get_token(); }

  /// Whether the job was to be cancelled; to be called after the watch. Throws the error if
  /// cancelling failed.
  bool asked_to_cancel() {
    _thread.request_stop();
    _thread.join();
    if (_failure) std::rethrow_exception(_failure);
    return _cancelling;
  }

 private:
  void heed(Session& session, const std::string& job, View& view, const std::stop_token& over) {
    Signals& signals = session.signals();
    if (!signals.wait_for_first(over)) return;
    if (!session.globals().local) {
      constexpr std::chrono::seconds time_to_cancel{2};
      if (signals.interactive())
        view.prompt("Detaching; press Ctrl-C again now to cancel the job instead");
      if (!signals.second_within(time_to_cancel, over)) {
        _detached.request_stop();
        return;
      }
    }
    view.prompt("Cancelling " + job);
    _cancelling = true;
    client::cancel_job(session.connection(), job, over);
  }

  std::stop_source _detached;
  bool _cancelling = false;
  std::exception_ptr _failure;
  std::jthread _thread;  // last: it uses the others
};

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
    Interrupts interrupts(session, job.name(), view);
    last = watch(session, job.name(), view, interrupts.detached());
    cancelling = interrupts.asked_to_cancel();
    view.prompt("");
  }
  if (!last) {
    const std::string target = job.name() + session.server_option();
    say_always(session.globals(),
               "The job goes on. To attach again: anticrack job watch " + target);
    say_always(session.globals(), "To save its results in the end: anticrack job fetch " + target);
    return {Followed::How::detached, job};
  }
  const bool in_time = cancelling && last->status().state() == v1::JobStatus::STATE_CANCELLED;
  return {in_time ? Followed::How::cancelled : Followed::How::ended, *std::move(last)};
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/job_run.hpp"

#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <vector>

#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "cli/text.hpp"
#include "client/meshes.hpp"

namespace anticrack::cli {
namespace {

using std::chrono::steady_clock;

class MeshView {
 public:
  explicit MeshView(Session& session) : _session(session) {
    if (!shows_frames(session.globals())) return;
    _frames = std::make_unique<Frames>(session, [this](Size size) { return frame_now(size); });
    session.tell([this](const std::string& message) {
      const std::lock_guard lock(_mutex);
      _notice = sanitise(message);
      _frames->refresh();
    });
  }
  ~MeshView() { _session.tell({}); }
  MeshView(const MeshView&) = delete;
  MeshView& operator=(const MeshView&) = delete;

  void show(const v1::Mesh& mesh) {
    const std::string text =
        client::settled(mesh.state()) ? "" : sanitise(mesh.name()) + ": " + state_text(mesh);
    if (_frames) {
      const std::lock_guard lock(_mutex);
      _text = text;
      _notice.clear();
      _frames->refresh();
    } else if (!text.empty()) {
      say(_session.globals(), text);
    }
  }

 private:
  // The caller reports the end.
  std::vector<std::string> frame_now(Size size) {
    const std::lock_guard lock(_mutex);
    if (_text.empty()) return {};
    const std::chrono::duration<double> elapsed = steady_clock::now() - _begin;
    std::vector<std::string> lines{_text + ", " + time_text(std::floor(elapsed.count()))};
    if (!_notice.empty()) lines.push_back("  " + _notice);
    for (std::string& line : lines) line = fit(line, size.width - 1);
    return lines;
  }

  Session& _session;
  const steady_clock::time_point _begin = steady_clock::now();
  std::mutex _mutex;
  std::string _text;
  std::string _notice;
  std::unique_ptr<Frames> _frames;  // last: its thread uses the others
};

}  // namespace

v1::Mesh follow_mesh(Session& session, const std::string& name) {
  MeshView view(session);
  return client::wait_for_mesh(
      session.connection(), name, [&view](const v1::Mesh& mesh) { view.show(mesh); },
      session.stop());
}

}  // namespace anticrack::cli

// SPDX-License-Identifier: GPL-3.0-or-later
//
// A terminal on which each frame is drawn over the one before.
#pragma once

#include <termios.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace anticrack::cli {

/// Whether frames can be drawn: on a terminal that can move its cursor, if `redraws` is true.
bool takes_frames(std::FILE* stream);

/// Whether the environment allows it: not if TERM is "dumb" or null (unset), or NO_COLOR is set.
bool redraws(const char* term, const char* no_color) noexcept;

struct Size {
  std::size_t width = 80;
  std::size_t height = 24;
};
/// The current size; 80 by 24 if unknown.
Size size_of(std::FILE* terminal);

/// Draws frames on a separate thread, at most 15 times a second; also at each `tick`, for clocks.
///
/// Between frames the cursor is on the frame's first character: a terminal that moves or wraps the
/// frame when resized moves the cursor along, and the next frame starts there and wipes all below.
/// Keys are not echoed. In the background nothing is drawn.
class Painter {
 public:
  /// `render` gives the lines of a frame; it is called on the painter's thread.
  Painter(std::FILE* terminal, std::function<std::vector<std::string>(Size)> render,
          std::chrono::milliseconds tick = std::chrono::seconds(1));
  /// Draws the last frame and leaves it.
  ~Painter();
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  /// To be called when there is something new to draw.
  void refresh();
  /// Draws again even if nothing is new, as the size of the terminal has changed.
  void redraw();
  /// Leaves the frame, puts the cursor below it and restores the terminal; nothing is drawn until
  /// `resume`. For a process that is about to be stopped or ended.
  void pause();
  /// Draws the next frame at the cursor.
  void resume();

 private:
  enum class Draw { if_new, anew, last };

  void work();
  void draw(Draw how);
  void leave_frame();
  void write(const std::string& text);
  void hide_keys();
  void show_keys();

  std::FILE* _terminal;
  std::function<std::vector<std::string>(Size)> _render;
  const std::chrono::milliseconds _tick;

  std::timed_mutex _drawing;  // guards the terminal and the next members
  std::string _drawn;
  std::size_t _drawn_lines = 0;    // lines of the frame on the terminal; 0: no frame
  std::optional<termios> _before;  // the terminal's modes before keys were no longer echoed
  std::atomic<bool> _paused = false;

  std::mutex _mutex;  // guards the members below
  std::condition_variable _woken;
  bool _stale = false;
  bool _anew = false;
  bool _ending = false;
  std::thread _thread;
};

}  // namespace anticrack::cli

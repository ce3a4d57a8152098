// SPDX-License-Identifier: GPL-3.0-or-later
//
// A terminal that frames are drawn on, each over the one before.
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

/// Whether frames can be drawn on it: a terminal that can move its cursor, and whose user does not
/// want plain text (TERM, NO_COLOR; see redraws).
bool takes_frames(std::FILE* stream);

/// By the environment: not on a TERM that is "dumb" or not set, nor with any NO_COLOR. Either may
/// be null.
bool redraws(const char* term, const char* no_color) noexcept;

struct Size {
  std::size_t width = 80;
  std::size_t height = 24;
};
/// As it is now; 80 by 24 where it cannot be told.
Size size_of(std::FILE* terminal);

/// Draws on a thread of its own, at most 15 times a second, so that a burst of events costs
/// nothing and the last of them is always seen; each `tick` also without an event, for clocks.
///
/// Between two frames the cursor stands on the frame's first character: wherever a terminal moves
/// or wraps the frame when its size changes, the cursor goes with it, and the next frame can start
/// there and wipe out all below. Keys are not echoed meanwhile. In the background nothing is drawn.
class Painter {
 public:
  /// `render` gives the lines of a frame; it is called on the painter's thread.
  Painter(std::FILE* terminal, std::function<std::vector<std::string>(Size)> render,
          std::chrono::milliseconds tick = std::chrono::seconds(1));
  /// Draws the last frame and leaves it.
  ~Painter();
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  /// There is something new to draw.
  void refresh();
  /// Draws even what is not new: the terminal's size has changed.
  void redraw();
  /// Leaves the frame as it stands, puts the cursor below and the terminal back as it was; draws no
  /// more before `resume`. For a process that is about to be stopped or ended.
  void pause();
  /// The next frame is drawn where the cursor is now.
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

  std::timed_mutex _drawing;  // the terminal, and what follows
  std::string _drawn;
  std::size_t _drawn_lines = 0;    // of the frame that the cursor stands on; 0: none
  std::optional<termios> _before;  // the terminal's modes, while keys are not echoed
  std::atomic<bool> _paused = false;

  std::mutex _mutex;  // what follows
  std::condition_variable _woken;
  bool _stale = false;
  bool _anew = false;
  bool _ending = false;
  std::thread _thread;
};

}  // namespace anticrack::cli

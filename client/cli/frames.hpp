// SPDX-License-Identifier: GPL-3.0-or-later
//
// Frames shown on the terminal while a command waits.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "cli/session.hpp"
#include "cli/terminal.hpp"

namespace anticrack::cli {

/// Has a Painter if a user looks at the terminal (see shows_frames). It follows the terminal's
/// size, and leaves the screen when the command is stopped (Ctrl-Z) or ended. There may be one at a
/// time.
class Frames {
 public:
  /// `render` gives the lines of a frame; it is called on the painter's thread.
  Frames(Session& session, std::function<std::vector<std::string>(Size)> render)
      : _signals(session.signals()), _painter(people(session.globals()), std::move(render)) {
    _signals.tell_screen([this](Signals::Screen event) {
      switch (event) {
        case Signals::Screen::leaving:
          return _painter.pause();
        case Signals::Screen::back:
          return _painter.resume();
        case Signals::Screen::resized:
          return _painter.redraw();
      }
    });
  }
  /// Draws the last frame and leaves it.
  ~Frames() { _signals.tell_screen({}); }
  Frames(const Frames&) = delete;
  Frames& operator=(const Frames&) = delete;

  /// To be called when there is something new to draw.
  void refresh() { _painter.refresh(); }

 private:
  Signals& _signals;
  Painter _painter;
};

}  // namespace anticrack::cli

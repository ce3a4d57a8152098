// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/frames.hpp"

#include <utility>

namespace anticrack::cli {

Frames::Frames(Session& session, std::function<std::vector<std::string>(Size)> render)
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

Frames::~Frames() {
  _signals.tell_screen({});
}

}  // namespace anticrack::cli

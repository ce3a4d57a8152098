// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/terminal.hpp"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>
#include <utility>

#include "words/shown.hpp"

namespace anticrack::cli {
namespace {

constexpr std::chrono::milliseconds frame_time{67};

// If the terminal has shrunk since it was measured, lines are cut and not wrapped.
constexpr std::string_view cut_lines = "\x1b[?7l";
constexpr std::string_view wrap_lines = "\x1b[?7h";
constexpr std::string_view wipe_line = "\x1b[2K";  // the whole line, or tmux may join it to another
constexpr std::string_view wipe_below = "\x1b[J";

// The text that overwrites the lines; the cursor ends after the last one.
std::string joined(const std::vector<std::string>& lines) {
  std::string text = "\r";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    text += i > 0 ? "\n" : "";
    text += wipe_line;
    text += words::shown(lines[i]);
  }
  text += wipe_below;
  return text;
}

// Whether the process is in the background, where output would mix with what the user types, and
// changing the terminal's modes would stop the process.
bool in_background(std::FILE* terminal) {
  const pid_t group = tcgetpgrp(fileno(terminal));
  return group != -1 && group != getpgrp();
}

}  // namespace

bool redraws(const char* term, const char* no_color) noexcept {
  const bool plain = no_color != nullptr && *no_color != '\0';
  return !plain && term != nullptr && *term != '\0' && std::string_view(term) != "dumb";
}

bool takes_frames(std::FILE* stream) {
  return isatty(fileno(stream)) == 1 && redraws(std::getenv("TERM"), std::getenv("NO_COLOR"));
}

Size size_of(std::FILE* terminal) {
  winsize size{};
  if (ioctl(fileno(terminal), TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0)
    return {};
  return {size.ws_col, size.ws_row};
}

Painter::Painter(std::FILE* terminal, std::function<std::vector<std::string>(Size)> render,
                 std::chrono::milliseconds tick)
    : _terminal(terminal), _render(std::move(render)), _tick(tick), _thread([this] { work(); }) {}

Painter::~Painter() {
  {
    const std::lock_guard lock(_mutex);
    _ending = true;
  }
  _woken.notify_one();
  _thread.join();
  draw(Draw::last);
}

void Painter::refresh() {
  {
    const std::lock_guard lock(_mutex);
    _stale = true;
  }
  _woken.notify_one();
}

void Painter::redraw() {
  {
    const std::lock_guard lock(_mutex);
    _anew = true;
  }
  refresh();
}

void Painter::pause() {
  // While the terminal takes no text (Ctrl-S), a draw waits; the process waits only this long.
  constexpr std::chrono::milliseconds patience{500};
  _paused = true;
  const std::unique_lock lock(_drawing, patience);
  if (lock.owns_lock()) leave_frame();
}

void Painter::resume() {
  _paused = false;
  redraw();
}

void Painter::work() {
  std::unique_lock lock(_mutex);
  while (!_ending) {
    _woken.wait_for(lock, _tick, [this] { return _stale || _ending; });
    if (_ending) return;
    _stale = false;
    const Draw how = std::exchange(_anew, false) ? Draw::anew : Draw::if_new;
    lock.unlock();
    draw(how);
    lock.lock();
    _woken.wait_for(lock, frame_time, [this] { return _ending; });
  }
}

void Painter::draw(Draw how) {
  const std::lock_guard lock(_drawing);
  if (how != Draw::last && (_paused || in_background(_terminal))) return;
  const std::vector<std::string> lines = _render(size_of(_terminal));
  std::string frame = joined(lines);
  if (how != Draw::if_new || frame != _drawn) {
    hide_keys();
    const std::string up = lines.size() > 1 ? fmt::format("\x1b[{}A", lines.size() - 1) : "";
    write(std::string(cut_lines) + frame + std::string(wrap_lines) + "\r" + up);
    _drawn = std::move(frame);
    _drawn_lines = lines.size();
  }
  if (how == Draw::last) leave_frame();
}

void Painter::leave_frame() {
  write(std::string(_drawn_lines, '\n'));
  _drawn_lines = 0;
  show_keys();
}

void Painter::write(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), _terminal);
  std::fflush(_terminal);
}

// Switches the echo of keys off, as an echoed Enter would move the cursor off the frame.
void Painter::hide_keys() {
  termios modes{};
  if (in_background(_terminal) || tcgetattr(fileno(_terminal), &modes) != 0 ||
      (modes.c_lflag & ECHO) == 0)
    return;
  _before = modes;
  modes.c_lflag &= ~static_cast<tcflag_t>(ECHO | ECHONL);
  tcsetattr(fileno(_terminal), TCSANOW, &modes);
}

void Painter::show_keys() {
  if (_before && !in_background(_terminal)) tcsetattr(fileno(_terminal), TCSANOW, &*_before);
  _before.reset();
}

}  // namespace anticrack::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>
#include <utility>

namespace anticrack::cli {
namespace {

constexpr std::chrono::milliseconds frame_time{67};

}  // namespace

bool is_terminal(std::FILE* stream) {
  return isatty(fileno(stream)) == 1;
}

Size size_of(std::FILE* terminal) {
  winsize size{};
  if (ioctl(fileno(terminal), TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) {
    return {};
  }
  return {size.ws_col, size.ws_row};
}

Painter::Painter(std::FILE* terminal, std::function<std::vector<std::string>(Size)> render)
    : _terminal(terminal), _render(std::move(render)), _thread([this] { work(); }) {}

Painter::~Painter() {
  {
    const std::lock_guard lock(_mutex);
    _ending = true;
  }
  _woken.notify_one();
  _thread.join();
  draw();
}

void Painter::refresh() {
  {
    const std::lock_guard lock(_mutex);
    _stale = true;
  }
  _woken.notify_one();
}

void Painter::work() {
  std::unique_lock lock(_mutex);
  while (!_ending) {
    _woken.wait(lock, [this] { return _stale || _ending; });
    if (_ending) {
      return;
    }
    _stale = false;
    lock.unlock();
    draw();
    lock.lock();
    _woken.wait_for(lock, frame_time, [this] { return _ending; });
  }
}

void Painter::draw() {
  const std::vector<std::string> lines = _render(size_of(_terminal));
  std::string text;
  if (_drawn_lines > 0) {
    text += "\x1b[" + std::to_string(_drawn_lines) + "A\r";
  }
  for (const std::string& line : lines) {
    text += line + "\x1b[K\n";
  }
  text += "\x1b[J";  // what a longer frame left below
  _drawn_lines = lines.size();
  std::fwrite(text.data(), 1, text.size(), _terminal);
  std::fflush(_terminal);
}

}  // namespace anticrack::cli

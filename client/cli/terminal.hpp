// SPDX-License-Identifier: GPL-3.0-or-later
//
// A terminal that frames are drawn on, each over the one before.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace anticrack::cli {

/// Whether what is written goes to a terminal, not into a file or pipe.
bool is_terminal(std::FILE* stream);

struct Size {
  std::size_t width = 80;
  std::size_t height = 24;
};
/// As it is now; 80 by 24 where it cannot be told.
Size size_of(std::FILE* terminal);

/// Draws on a thread of its own, at most 15 times a second, so that a burst of events costs
/// nothing and the last of them is always seen.
class Painter {
 public:
  /// `render` gives the lines of a frame; it is called on the painter's thread.
  Painter(std::FILE* terminal, std::function<std::vector<std::string>(Size)> render);
  /// Draws the last frame and leaves it.
  ~Painter();
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  /// There is something new to draw.
  void refresh();

 private:
  void work();
  void draw();

  std::FILE* _terminal;
  std::function<std::vector<std::string>(Size)> _render;
  std::size_t _drawn_lines = 0;
  std::mutex _mutex;
  std::condition_variable _woken;
  bool _stale = false;
  bool _ending = false;
  std::thread _thread;
};

}  // namespace anticrack::cli

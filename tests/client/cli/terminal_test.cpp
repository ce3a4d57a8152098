// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/terminal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>

#include "support/eventually.hpp"

namespace anticrack::cli {
namespace {

using anticrack::testing::eventually;
using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File make_file() { return {std::tmpfile(), std::fclose}; }

std::string content_of(std::FILE* file) {
  std::rewind(file);
  std::string text;
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) {
    text += static_cast<char>(c);
  }
  return text;
}

constexpr std::chrono::hours never{1000};

// A frame whose lines are cut rather than wrapped, the cursor put back to its first character.
std::string drawn(const std::string& frame, const std::string& up) {
  return "\x1b[?7l" + frame + "\x1b[?7h\r" + up;
}

TEST(Painter, DrawsTheLastFrameOverTheOneBefore) {
  const File file = make_file();
  std::atomic<int> frames = 0;
  {
    Painter painter(
        file.get(),
        [&](Size) {
          ++frames;
          return std::vector<std::string>{"head", "frame " + std::to_string(frames.load())};
        },
        never);
    painter.refresh();
    EXPECT_TRUE(eventually([&] { return frames > 0; }));
  }
  EXPECT_EQ(frames, 2);
  EXPECT_EQ(content_of(file.get()), drawn("\r\x1b[2Khead\n\x1b[2Kframe 1\x1b[J", "\x1b[1A") +
                                        drawn("\r\x1b[2Khead\n\x1b[2Kframe 2\x1b[J", "\x1b[1A") +
                                        "\n\n")
      << "each over the one before, the cursor below in the end";
}

TEST(Painter, DrawsOnceWhereNothingHappens) {
  const File file = make_file();
  {
    Painter painter(
        file.get(), [](Size) { return std::vector<std::string>{"only"}; }, never);
  }
  EXPECT_EQ(content_of(file.get()), drawn("\r\x1b[2Konly\x1b[J", "") + "\n");
}

TEST(Painter, WritesTheSameFrameAgainOnlyForAnotherSize) {
  const File file = make_file();
  std::atomic<int> frames = 0;
  {
    Painter painter(
        file.get(),
        [&](Size) {
          ++frames;
          return std::vector<std::string>{"same"};
        },
        never);
    for (const int refreshes : {1, 2}) {
      painter.refresh();
      EXPECT_TRUE(eventually([&] { return frames >= refreshes; }));
    }
    const int before = frames;
    painter.redraw();
    EXPECT_TRUE(eventually([&] { return frames > before; }));
  }
  const std::string once = drawn("\r\x1b[2Ksame\x1b[J", "");
  EXPECT_EQ(content_of(file.get()), once + once + once + "\n") << "first, redrawn, last";
}

TEST(Painter, DrawsAlsoWithoutAnEvent) {
  const File file = make_file();
  std::atomic<int> frames = 0;
  const Painter painter(
      file.get(),
      [&](Size) {
        ++frames;
        return std::vector<std::string>{};
      },
      std::chrono::milliseconds(1));
  EXPECT_TRUE(eventually([&] { return frames > 1; }));
}

TEST(Painter, LeavesTheTerminalToOthersWhilePaused) {
  const File file = make_file();
  std::atomic<int> frames = 0;
  {
    Painter painter(
        file.get(),
        [&](Size) {
          ++frames;
          return std::vector<std::string>{"a", "b"};
        },
        never);
    painter.refresh();
    EXPECT_TRUE(eventually([&] { return frames > 0; }));
    painter.pause();
    std::fputs("others\n", file.get());
    painter.resume();
    EXPECT_TRUE(eventually([&] { return frames > 1; }));
  }
  const std::string once = drawn("\r\x1b[2Ka\n\x1b[2Kb\x1b[J", "\x1b[1A");
  EXPECT_EQ(content_of(file.get()), once + "\n\n" + "others\n" + once + once + "\n\n");
}

TEST(Terminal, TakesFramesUnlessItOrItsUserDoesNot) {
  EXPECT_TRUE(redraws("xterm", nullptr));
  EXPECT_TRUE(redraws("xterm", ""));
  EXPECT_FALSE(redraws("xterm", "1"));
  EXPECT_FALSE(redraws("dumb", nullptr));
  EXPECT_FALSE(redraws("", nullptr));
  EXPECT_FALSE(redraws(nullptr, nullptr));
}

TEST(Terminal, AFileIsNone) {
  const File file = make_file();
  EXPECT_FALSE(takes_frames(file.get()));
  EXPECT_EQ(size_of(file.get()).width, 80U);
  EXPECT_EQ(size_of(file.get()).height, 24U);
}

}  // namespace
}  // namespace anticrack::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/terminal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <memory>

#include "support/eventually.hpp"

namespace anticrack::cli {
namespace {

using anticrack::testing::eventually;
using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File make_file() {
  return {std::tmpfile(), std::fclose};
}

std::string content_of(std::FILE* file) {
  std::rewind(file);
  std::string text;
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) {
    text += static_cast<char>(c);
  }
  return text;
}

TEST(Painter, DrawsTheLastFrameOverTheOneBefore) {
  const File file = make_file();
  std::atomic<int> frames = 0;
  {
    Painter painter(file.get(), [&](Size) {
      ++frames;
      return std::vector<std::string>{"head", "frame " + std::to_string(frames.load())};
    });
    painter.refresh();
    EXPECT_TRUE(eventually([&] { return frames > 0; }));
  }
  EXPECT_EQ(frames, 2);
  EXPECT_EQ(content_of(file.get()),
            "head\x1b[K\nframe 1\x1b[K\n\x1b[J"
            "\x1b[2A\rhead\x1b[K\nframe 2\x1b[K\n\x1b[J");
}

TEST(Painter, DrawsOnceWhereNothingHappens) {
  const File file = make_file();
  {
    Painter painter(file.get(), [](Size) { return std::vector<std::string>{"only"}; });
  }
  EXPECT_EQ(content_of(file.get()), "only\x1b[K\n\x1b[J");
}

TEST(Terminal, AFileIsNone) {
  const File file = make_file();
  EXPECT_FALSE(is_terminal(file.get()));
  EXPECT_EQ(size_of(file.get()).width, 80U);
  EXPECT_EQ(size_of(file.get()).height, 24U);
}

}  // namespace
}  // namespace anticrack::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/drawing.hpp"

#include <gtest/gtest.h>

namespace anticrack::figures {
namespace {

TEST(WithoutEmptyGroups, drops_them_however_deep) {
  EXPECT_EQ(without_empty_groups("<svg>\n<g a=\"1\">\n\t<g b=\"2\" ><title>x</title>\n\t</g>\n"
                                 "</g>\n</svg>\n"),
            "<svg>\n</svg>\n");
}

TEST(WithoutEmptyGroups, keeps_everything_else) {
  const std::string svg =
      "<svg>\n<g a=\"1\">\n\t<path d='M0,0'/>\t<g "
      "b=\"2\">\n\t\t<text>a</text>\n\t</g>\n</g>\n</svg>";
  EXPECT_EQ(without_empty_groups(svg), svg);
  EXPECT_EQ(without_empty_groups(""), "");
}

}  // namespace
}  // namespace anticrack::figures

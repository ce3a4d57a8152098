// SPDX-License-Identifier: GPL-3.0-or-later
#include "log/escape.hpp"

#include <gtest/gtest.h>

namespace anticrack::log {
namespace {

TEST(Escape, LeavesWhatIsReadable) {
  EXPECT_EQ(escape("jobs/ab12 is done"), "jobs/ab12 is done");
  EXPECT_EQ(escape("Москва, 漢字, 🚀"), "Москва, 漢字, 🚀");
  EXPECT_EQ(escape(""), "");
}

TEST(Escape, KeepsAValueInItsQuotesAndItsLine) {
  EXPECT_EQ(escape("a\"b\\c"), R"(a\"b\\c)");
  EXPECT_EQ(escape("a\nb\r\tc"), R"(a\nb\u000d\tc)");
  EXPECT_EQ(escape(std::string_view("\0\x1b[31m\x7f", 7)), R"(\u0000\u001b[31m\u007f)");
}

TEST(Escape, ShowsWhatUnicodeHides) {
  EXPECT_EQ(escape("\u0085"), R"(\u0085)");
  EXPECT_EQ(escape("\u2028\u2029"), R"(\u2028\u2029)");
  EXPECT_EQ(escape("\u202etxt\u2069"), R"(\u202etxt\u2069)");
  EXPECT_EQ(escape("\ufeff"), R"(\ufeff)");
  EXPECT_EQ(escape("\u061c\u00ad\u200b"), R"(\u061c\u00ad\u200b)");
  EXPECT_EQ(escape("\U000e0041"), R"(\udb40\udc41)");
}

TEST(Escape, ReplacesWhatIsNoUtf8ByteByByte) {
  EXPECT_EQ(escape("a\xff"
                   "b"),
            R"(a\ufffdb)");
  EXPECT_EQ(escape("\xc0\xaf"), R"(\ufffd\ufffd)") << "overlong";
  EXPECT_EQ(escape("\xe0\x80\x80"), R"(\ufffd\ufffd\ufffd)") << "overlong";
  EXPECT_EQ(escape("\xed\xa0\x80"), R"(\ufffd\ufffd\ufffd)") << "surrogate";
  EXPECT_EQ(escape("\xf4\x90\x80\x80"), R"(\ufffd\ufffd\ufffd\ufffd)") << "beyond Unicode";
  EXPECT_EQ(escape("\xe6\xbc"), R"(\ufffd\ufffd)") << "cut off";
  EXPECT_EQ(escape("\xe6\"x"), R"(\ufffd\"x)") << "an eaten quote would end the string";
}

TEST(Escape, CutsWhatIsTooLong) {
  const std::string value(longest_value + 1, 'a');
  EXPECT_EQ(escape(value), value.substr(1) + "...");
  EXPECT_EQ(escape(value.substr(1)), value.substr(1));
}

TEST(Quotes, AreLeftOutOnlyWhereNothingIsAmbiguous) {
  EXPECT_EQ(quote_if_needed("jobs/ab12"), "jobs/ab12");
  EXPECT_EQ(quote_if_needed("127.0.0.1:7433"), "127.0.0.1:7433");
  EXPECT_EQ(quote_if_needed(""), R"("")");
  EXPECT_EQ(quote_if_needed("a b"), R"("a b")");
  EXPECT_EQ(quote_if_needed("a=b"), R"("a=b")");
  EXPECT_EQ(quote_if_needed("é"), "\"é\"");
}

}  // namespace
}  // namespace anticrack::log

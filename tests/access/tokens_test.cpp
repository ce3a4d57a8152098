// SPDX-License-Identifier: GPL-3.0-or-later
#include "access/tokens.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "digest/digest.hpp"
#include "errors/errors.hpp"

namespace anticrack::access {
namespace {

std::string hash_of(const std::string& token) { return digest::Sha256().add(token).finish(); }

std::string line(const std::string& name, const std::string& role, const std::string& token) {
  return std::string(name) + " " + role + " " + hash_of(token) + "\n";
}

/// The message of the error; empty where the text is accepted.
std::string refusal(const std::string& text) {
  try {
    TokenTable::parse(text, "tokens.txt");
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.reason(), errors::Reason::invalid_argument);
    return error.what();
  }
  return {};
}

TEST(Tokens, TellWhoseTheyAre) {
  const TokenTable table = TokenTable::parse(
      "# people\n\n" + line("ada", "user", "secret") + "\t" + line("root@site", "admin", "other"),
      "tokens.txt");
  EXPECT_EQ(table.find("secret"), (Identity{"ada", Role::user}));
  EXPECT_EQ(table.find("other"), (Identity{"root@site", Role::admin}));
  EXPECT_FALSE(table.empty());
}

TEST(Tokens, AreNotTheirHashesNorParts) {
  const TokenTable table = TokenTable::parse(line("ada", "user", "secret"), "tokens.txt");
  for (const std::string& wrong :
       {std::string(), std::string("secre"), std::string("secret "), std::string("SECRET"),
        hash_of("secret"), std::string("secret\0", 7)}) {
    EXPECT_FALSE(table.find(wrong)) << wrong;
  }
}

TEST(Tokens, NobodyHasAnyInAnEmptyTable) {
  EXPECT_FALSE(TokenTable().find(""));
  EXPECT_TRUE(TokenTable().empty());
  EXPECT_TRUE(TokenTable::parse("# nobody\n", "tokens.txt").empty());
}

TEST(Tokens, OnePersonMayHaveSeveral) {
  const TokenTable table =
      TokenTable::parse(line("ada", "user", "old") + line("ada", "user", "new"), "tokens.txt");
  EXPECT_EQ(table.find("old"), table.find("new"));
}

TEST(Tokens, LinesMayEndAsOnWindowsAndTheLastWithoutAnEnd) {
  const TokenTable table = TokenTable::parse(
      "ada user " + hash_of("a") + "  # since May\r\nbob user " + hash_of("b"), "tokens.txt");
  EXPECT_TRUE(table.find("a"));
  EXPECT_TRUE(table.find("b"));
}

TEST(Tokens, ExpireAtTheEndOfTheirLastDay) {
  std::string text = line("ada", "user", "secret");
  text.replace(text.size() - 1, 1, " 2027-02-28 # on loan\n");
  const TokenTable table = TokenTable::parse(text, "tokens.txt");
  using namespace std::chrono;
  const sys_days next = year(2027) / March / 1;
  EXPECT_EQ(table.find("secret", next - seconds(1)), (Identity{"ada", Role::user}));
  EXPECT_FALSE(table.find("other", next)) << "unknown, not expired";
  try {
    table.find("secret", next);
    FAIL() << "let in";
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.reason(), errors::Reason::unauthenticated);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("expired at the end of 2027-02-28"));
  }
  for (const char* day : {"2027-02-29", "2027-2-28", "28-02-2027", "2027-02-28Z", "never"}) {
    EXPECT_THAT(refusal("ada user " + hash_of("x") + " " + day), ::testing::HasSubstr("YYYY-MM-DD"))
        << day;
  }
}

TEST(Tokens, WhatCannotBeReadIsRefusedWithItsLine) {
  using ::testing::HasSubstr;
  const std::string good = line("ada", "user", "secret");
  EXPECT_THAT(refusal(good + "bob user\n"), HasSubstr("tokens.txt, line 2"));
  EXPECT_THAT(refusal("ada user " + hash_of("x") + " more\n"), HasSubstr("line 1"));
  EXPECT_THAT(refusal("\n\nada owner " + hash_of("x") + "\n"), HasSubstr("line 3"));
  EXPECT_THAT(refusal("ada user " + hash_of("x").substr(1) + "\n"), HasSubstr("SHA-256"));
  EXPECT_THAT(refusal("ada user " + std::string(64, 'A') + "\n"), HasSubstr("SHA-256"));
  EXPECT_THAT(refusal(line("-ada", "user", "x")), HasSubstr("name"));
  EXPECT_THAT(refusal(line("a/b", "user", "x")), HasSubstr("name"));
  EXPECT_THAT(refusal(line(std::string(65, 'a'), "user", "x")), HasSubstr("name"));
  EXPECT_EQ(refusal(line(std::string(64, 'a'), "user", "x")), "");
}

TEST(Tokens, ContradictionsAreRefused) {
  using ::testing::HasSubstr;
  EXPECT_THAT(refusal(line("ada", "user", "x") + line("ada", "admin", "y")),
              HasSubstr("another role"));
  EXPECT_THAT(refusal(line("ada", "user", "x") + line("bob", "user", "x")),
              HasSubstr("earlier line, for \"ada\""));
}

TEST(Tokens, NoErrorRepeatsWhatMayBeASecret) {
  EXPECT_THAT(refusal("ada user my-secret-token\n"),
              ::testing::Not(::testing::HasSubstr("my-secret")));
  EXPECT_THAT(refusal("my-secret/token\n"), ::testing::Not(::testing::HasSubstr("my-secret")));
}

}  // namespace
}  // namespace anticrack::access

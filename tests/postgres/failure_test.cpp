// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <map>

#include "postgres/failure.hpp"

namespace anticrack::postgres {
namespace {

using errors::Reason;

TEST(DatabaseFailure, HasAPolicyByItsSqlstate) {
  const std::map<Policy, std::vector<const char*>> policies{
      {Policy::retry, {"40001", "40P01", "55P03", "23503"}},
      {Policy::reconnect,
       {"", "08006", "08P01", "57P01", "57P02", "57P03", "57P05", "57014", "25P03", "25006"}},
      {Policy::refuse, {"53000", "53100", "53200", "53300"}},
      {Policy::report, {"23505", "28P01", "3D000", "42P01", "22021", "57000", "XX001"}}};
  for (const auto& [policy, states] : policies)
    for (const char* state : states) EXPECT_EQ(policy_of(state), policy) << state;
}

TEST(DatabaseFailure, TellsWhoHasToActAndWhen) {
  EXPECT_EQ(Failure("53100", "db", "full").reason(), Reason::disk_full);
  EXPECT_GT(Failure("53100", "db", "full").retry_delay().count(), 0);
  EXPECT_EQ(Failure("", "db", "gone").reason(), Reason::storage);
  EXPECT_GT(Failure("", "db", "gone").retry_delay().count(), 0);
  EXPECT_EQ(Failure("28P01", "db", "no").reason(), Reason::storage);
  EXPECT_EQ(Failure("28P01", "db", "no").retry_delay().count(), 0);
  EXPECT_THAT(Failure("28P01", "db", "no").what(), ::testing::HasSubstr("PGPASSFILE"));
  EXPECT_EQ(Failure("42P01", "db", "no table").reason(), Reason::internal);
}

}  // namespace
}  // namespace anticrack::postgres

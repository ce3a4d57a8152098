// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include "postgres/address.hpp"
#include "support/errors.hpp"

namespace anticrack::postgres {
namespace {

using anticrack::testing::error_of;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(DatabaseAddress, IsShownWithoutItsPassword) {
  for (const char* text : {"postgresql://ann:secret@db:5433/crack?sslmode=require",
                           "host=db port=5433 user=ann password=secret dbname=crack"}) {
    const Address address{text};
    EXPECT_EQ(address.shown(), "ann@db:5433/crack");
    EXPECT_EQ(address.servers().at(0).at("password"), "secret");
  }
}

TEST(DatabaseAddress, NamesServersToTryOneAfterAnother) {
  const Address address{"postgresql://one:1,two:2/crack"};
  ASSERT_EQ(address.servers().size(), 2U);
  EXPECT_EQ(address.servers()[1].at("host"), "two");
  EXPECT_EQ(address.servers()[1].at("port"), "2");
  EXPECT_EQ(address.servers()[1].at("dbname"), "crack");
  EXPECT_EQ(Address{"host=one,two port=7"}.servers()[1].at("port"), "7");
}

TEST(DatabaseAddress, IsRefusedWithoutBeingRepeated) {
  for (const char* text :
       {"postgresql://ann:sec%ret@db/crack", "secret", "host=one,two port=1,2,3 password=secret"}) {
    const auto error = error_of([&] { Address{text}; });
    ASSERT_TRUE(error) << text;
    EXPECT_EQ(error->reason(), errors::Reason::invalid_argument);
    EXPECT_THAT(error->what(), Not(HasSubstr("sec")));
  }
}

}  // namespace
}  // namespace anticrack::postgres

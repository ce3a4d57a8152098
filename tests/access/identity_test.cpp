// SPDX-License-Identifier: GPL-3.0-or-later
#include "access/identity.hpp"

#include <gtest/gtest.h>

#include "errors/errors.hpp"

namespace anticrack::access {
namespace {

TEST(Identity, SeesItsOwnAndAnAdministratorSeesAll) {
  const Identity ada{"ada", Role::user};
  EXPECT_TRUE(may_see(ada, "ada"));
  EXPECT_FALSE(may_see(ada, "bob"));
  EXPECT_FALSE(may_see(ada, ""));  // made when the server asked for no name
  EXPECT_FALSE(may_see(ada, "ada "));
  const Identity root{"root", Role::admin};
  EXPECT_TRUE(may_see(root, "ada"));
  EXPECT_TRUE(may_see(root, ""));
}

TEST(Identity, SaysWhatOnlyAdministratorsMay) {
  EXPECT_NO_THROW(require_admin({"root", Role::admin}, "evict a mesh"));
  try {
    require_admin({"ada", Role::user}, "evict a mesh");
    FAIL() << "allowed";
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.reason(), errors::Reason::permission_denied);
    EXPECT_NE(std::string(error.what()).find("evict a mesh"), std::string::npos);
  }
}

}  // namespace
}  // namespace anticrack::access

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "support/errors.hpp"

namespace anticrack::rpc {

/// The field and the reason of what is thrown.
inline void expect_refused(const std::function<void()>& call, errors::Reason reason,
                           const std::string& field) {
  const auto error = anticrack::testing::error_of(call);
  ASSERT_TRUE(error) << "accepted; expected " << field;
  EXPECT_EQ(error->reason(), reason) << error->what();
  ASSERT_EQ(error->fields().size(), 1u);
  EXPECT_EQ(error->fields().front().field, field);
}

}  // namespace anticrack::rpc

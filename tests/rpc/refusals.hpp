// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "errors/errors.hpp"

namespace anticrack::rpc {

/// The field and the reason of what is thrown.
inline void expect_refused(const std::function<void()>& call, errors::Reason reason,
                           const std::string& field) {
  try {
    call();
    ADD_FAILURE() << "accepted; expected " << field;
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.reason(), reason) << error.what();
    ASSERT_EQ(error.fields().size(), 1u);
    EXPECT_EQ(error.fields().front().field, field);
  }
}

}  // namespace anticrack::rpc

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gmock/gmock.h>

#include <string>

#include "ddm/decomposition.hpp"
#include "errors/errors.hpp"

namespace anticrack::testing {

inline void expect_refused(const mesh::Mesh& mesh, errors::Reason reason,
                           const std::string& part_of_message) {
  try {
    ddm::cut(mesh);
    ADD_FAILURE() << "accepted, but should have failed with: " << part_of_message;
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.reason(), reason) << error.what();
    EXPECT_THAT(error.what(), ::testing::HasSubstr(part_of_message));
  }
}

}  // namespace anticrack::testing

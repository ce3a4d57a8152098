// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "errors/errors.hpp"

namespace anticrack::testing {

/// The errors::Error a call throws; none where it throws nothing.
template <class Call>
std::optional<errors::Error> error_of(const Call& call) {
  try {
    call();
  } catch (const errors::Error& error) {
    return error;
  }
  return std::nullopt;
}

/// The call throws an errors::Error with this reason and, where one is given, this field first.
template <class Call>
::testing::AssertionResult throws(const Call& call, errors::Reason reason,
                                  const std::string& field = {}) {
  const std::optional<errors::Error> error = error_of(call);
  if (!error) {
    return ::testing::AssertionFailure() << "nothing was thrown";
  }
  if (error->reason() != reason) {
    return ::testing::AssertionFailure()
           << errors::name(error->reason()) << " was thrown: " << error->what();
  }
  const std::string first = error->fields().empty() ? "" : error->fields().front().field;
  if (!field.empty() && first != field) {
    return ::testing::AssertionFailure() << "the field at fault is \"" << first << "\"";
  }
  return ::testing::AssertionSuccess();
}

}  // namespace anticrack::testing

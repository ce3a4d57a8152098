// SPDX-License-Identifier: GPL-3.0-or-later
//
// The place of errors of a layer below in what was asked of the layer above.
#pragma once

#include <string_view>

#include "errors/errors.hpp"

namespace anticrack::errors {

/// Calls call() and returns its value; an Error that it throws gets the field at fault.
template <class Call>
auto at(std::string_view field, const Call& call) {
  try {
    return call();
  } catch (Error& error) {
    error.at(std::string(field));
    throw;
  }
}

/// Calls call() and returns its value; the fields of an Error that it throws lie below `prefix`.
template <class Call>
auto below(std::string_view prefix, const Call& call) {
  try {
    return call();
  } catch (Error& error) {
    error.below(prefix);
    throw;
  }
}

}  // namespace anticrack::errors

// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/value_type.hpp"

namespace anticrack::results {

const char* name_of(ValueType type) {
  switch (type) {
    case ValueType::float64:
      return "float64";
    case ValueType::int32:
      return "int32";
    case ValueType::uint8:
      return "uint8";
    case ValueType::text:
      return "variable-length text";
  }
  return "";
}

std::size_t bytes_of(ValueType type) {
  return type == ValueType::int32 ? 4 : type == ValueType::uint8 ? 1 : 8;
}

}  // namespace anticrack::results

// SPDX-License-Identifier: GPL-3.0-or-later
//
// Hash of structured data: equal values give equal hashes on every machine and in every version.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "digest/digest.hpp"
#include "fields/walk.hpp"

namespace anticrack::store {

static_assert(std::endian::native == std::endian::little, "hashes and blocks are little-endian");

/// Texts and lists are hashed after their length, so that no two different sequences of calls hash
/// the same bytes.
class CanonicalHash {
 public:
  /// Adds a value after those before.
  CanonicalHash& add(std::uint64_t value) {
    _hash.add(std::as_bytes(std::span(&value, 1)));
    return *this;
  }
  /// -0 counts as 0: they compare equal.
  CanonicalHash& add(double value) {
    return add(std::bit_cast<std::uint64_t>(value == 0 ? 0.0 : value));
  }
  /// Adds the length of the text, then the text.
  CanonicalHash& add(const std::string& text) {
    add(std::uint64_t{text.size()});
    _hash.add(text);
    return *this;
  }
  /// Adds every field of the value and, recursively, of what it holds.
  template <class T>
  CanonicalHash& add_all(const T& value) {
    fields::walk(value, [this](const auto& leaf) { this->add(leaf); });
    return *this;
  }
  /// 64 lower-case hexadecimal digits. The object must not be used afterwards.
  std::string finish() { return _hash.finish(); }

 private:
  digest::Sha256 _hash;
};

}  // namespace anticrack::store

// SPDX-License-Identifier: GPL-3.0-or-later
#include "digest/digest.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "store/canonical.hpp"

namespace anticrack::store {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

/// Bit by bit, as in the definition (RFC 3720).
std::uint32_t slow_crc32c(std::span<const std::byte> bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::byte byte : bytes) {
    crc ^= static_cast<std::uint32_t>(byte);
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc & 1U) != 0 ? (crc >> 1U) ^ 0x82F63B78U : crc >> 1U;
    }
  }
  return ~crc;
}

TEST(Sha256, OfKnownTexts) {
  EXPECT_EQ(digest::Sha256().finish(),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(digest::Sha256().add(std::string("abc")).finish(),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256, DoesNotDependOnThePieces) {
  EXPECT_EQ(
      digest::Sha256().add(std::string("ab")).add(std::string()).add(std::string("c")).finish(),
      digest::Sha256().add(std::string("abc")).finish());
}

TEST(Crc32c, OfTheCheckString) { EXPECT_EQ(digest::crc32c(bytes_of("123456789")), 0xE3069283U); }

TEST(Crc32c, AgreesWithItsDefinitionAtEveryLength) {
  std::string text;
  for (int length = 0; length < 600; ++length) {
    ASSERT_EQ(digest::crc32c(bytes_of(text)), slow_crc32c(bytes_of(text))) << length;
    text += static_cast<char>(length * 37 + 11);
  }
}

TEST(CanonicalHash, TellsValuesApartThatShareBytes) {
  const auto hash = [](const std::vector<std::string>& texts) {
    CanonicalHash result;
    for (const std::string& text : texts) {
      result.add(text);
    }
    return result.finish();
  };
  EXPECT_NE(hash({"ab", "c"}), hash({"a", "bc"}));
  EXPECT_NE(hash({"ab"}), hash({"ab", ""}));
}

TEST(CanonicalHash, TakesEqualNumbersForEqual) {
  EXPECT_EQ(CanonicalHash().add(-0.0).finish(), CanonicalHash().add(0.0).finish());
  EXPECT_NE(CanonicalHash().add(1.0).finish(), CanonicalHash().add(1.0 + 1e-15).finish());
}

}  // namespace
}  // namespace anticrack::store

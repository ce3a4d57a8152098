// SPDX-License-Identifier: GPL-3.0-or-later
#include "digest/digest.hpp"

#include <isa-l/crc.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

namespace anticrack::digest {

struct Sha256::Context {
  EVP_MD_CTX* evp = EVP_MD_CTX_new();

  Context() = default;
  ~Context() { EVP_MD_CTX_free(evp); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
};

namespace {

constexpr std::string_view digits = "0123456789abcdef";

void require(bool ok) {
  if (!ok) throw std::runtime_error("OpenSSL refused to compute a SHA-256");
}

}  // namespace

Sha256::Sha256() : _context(std::make_unique<Context>()) {
  require(_context->evp != nullptr && EVP_DigestInit_ex(_context->evp, EVP_sha256(), nullptr) == 1);
}

Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;

Sha256& Sha256::add(std::span<const std::byte> bytes) {
  require(EVP_DigestUpdate(_context->evp, bytes.data(), bytes.size()) == 1);
  return *this;
}

Sha256& Sha256::add(const std::string& text) { return add(std::as_bytes(std::span(text))); }

std::string Sha256::finish() {
  std::array<unsigned char, 32> hash{};
  require(EVP_DigestFinal_ex(_context->evp, hash.data(), nullptr) == 1);
  std::string text;
  text.reserve(2 * hash.size());
  for (const unsigned char byte : hash) {
    text += digits[byte >> 4U];
    text += digits[byte & 15U];
  }
  return text;
}

bool is_sha256(std::string_view text) noexcept {
  return text.size() == 64 && text.find_first_not_of(digits) == std::string_view::npos;
}

std::string sha256_of(
    std::uint64_t size,
    const std::function<void(std::uint64_t offset, std::span<std::byte> bytes)>& read) {
  constexpr std::uint64_t most = std::uint64_t{1} << 20U;
  std::vector<std::byte> piece(static_cast<std::size_t>(std::min(most, size)));
  Sha256 hash;
  for (std::uint64_t offset = 0; offset < size; offset += piece.size()) {
    piece.resize(static_cast<std::size_t>(std::min(most, size - offset)));
    read(offset, piece);
    hash.add(piece);
  }
  return hash.finish();
}

std::uint32_t crc32c(std::span<const std::byte> bytes) noexcept {
  // ISA-L works on the bare register and counts in int; CRC-32C starts from and ends with its
  // complement.
  constexpr std::size_t piece = std::size_t{1} << 30U;
  std::uint32_t crc = ~std::uint32_t{0};
  while (!bytes.empty()) {
    const std::span<const std::byte> head = bytes.first(std::min(piece, bytes.size()));
    // The parameter is not const in ISA-L 2.30, but nothing is written.
    auto* data = const_cast<unsigned char*>(reinterpret_cast<const unsigned char*>(head.data()));
    crc = crc32_iscsi(data, static_cast<int>(head.size()), crc);
    bytes = bytes.subspan(head.size());
  }
  return ~crc;
}

}  // namespace anticrack::digest

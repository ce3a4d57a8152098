// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace anticrack::digest {

/// SHA-256 over bytes that arrive in pieces (OpenSSL).
class Sha256 {
 public:
  /// Of nothing so far. Throws std::bad_alloc.
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;
  /// The next bytes.
  Sha256& add(std::span<const std::byte> bytes);
  Sha256& add(const std::string& text);
  /// 64 lower-case hexadecimal digits. The object may not be used after.
  std::string finish();

 private:
  struct Context;
  std::unique_ptr<Context> _context;
};

/// Whether a text is 64 lower-case hexadecimal digits, and nothing else, as it becomes part of
/// paths.
bool is_sha256(std::string_view text) noexcept;

/// Of the `size` bytes that read(offset, bytes) fills in, piece by piece.
std::string sha256_of(
    std::uint64_t size,
    const std::function<void(std::uint64_t offset, std::span<std::byte> bytes)>& read);

/// CRC-32C (Castagnoli), as in iSCSI (ISA-L).
std::uint32_t crc32c(std::span<const std::byte> bytes) noexcept;

}  // namespace anticrack::digest

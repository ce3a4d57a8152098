// SPDX-License-Identifier: GPL-3.0-or-later
//
// Resource names ("meshes/ID") and the ids behind them. Every function that reads one throws
// errors::Error (invalid_argument) with `field` at fault.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace anticrack::rpc {

/// The name of what has an id.
std::string mesh_name(const std::string& id);
std::string job_name(const std::string& id);
std::string upload_name(const std::string& sha256);

/// The id in a name.
std::string mesh_id(const std::string& name, std::string_view field);
std::string job_id(const std::string& name, std::string_view field);
/// The sha256 of "uploads/SHA256".
std::string upload_sha256(const std::string& name, std::string_view field);

/// 64 lower-case hexadecimal digits.
bool is_sha256(std::string_view text) noexcept;

/// One page of a list (AIP-158). The token is the id of the last resource of the page before.
struct Page {
  std::size_t size = 0;
  std::string after;
};
constexpr std::size_t default_page_size = 50;
constexpr std::size_t max_page_size = 1000;
/// A page is closed early when it grows past this: the client's limit is gRPC's 4 MiB.
constexpr std::size_t max_page_bytes = 2u << 20;

/// Of a request; size 0 is the default. Throws with "page_size" or "page_token" at fault.
Page to_page(std::int32_t page_size, const std::string& page_token);

}  // namespace anticrack::rpc

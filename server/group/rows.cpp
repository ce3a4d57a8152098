// SPDX-License-Identifier: GPL-3.0-or-later
#include "group/rows.hpp"

#include <fmt/core.h>

#include <charconv>
#include <span>
#include <utility>

#include "digest/digest.hpp"
#include "store/requests.hpp"

namespace anticrack::group {

std::string to_column(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    if (c > ' ' - 1 && c < 0x7f && c != '%')
      text += c;
    else
      text += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return text;
}

std::string of_column(std::string_view text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char byte = 0;
    const char* const digits = text.data() + i + 1;
    if (text[i] == '%' && text.size() - i > 2 &&
        std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
      bytes += static_cast<char>(byte);
      i += 2;
    } else {
      bytes += text[i];
    }
  }
  return bytes;
}

std::int64_t row_checksum(std::string_view id, std::string_view owner, std::string_view record) {
  std::string all(id);
  (all += '\0').append(owner);
  (all += '\0').append(record);
  return digest::crc32c(std::as_bytes(std::span(all)));
}

store::Row row_at(const postgres::Result& rows, std::size_t row) {
  std::string owner = of_column(rows.view(row, 1));
  const bool intact =
      row_checksum(rows.view(row, 0), owner, rows.view(row, 3)) == rows.integer(row, 2);
  return {rows.text(row, 0), std::move(owner), intact, rows.text(row, 3), {}};
}

std::vector<store::Row> rows_at(const postgres::Result& rows) {
  return rows.each([&](std::size_t row) { return row_at(rows, row); });
}

const std::string select_request = std::string("SELECT ") + row_columns +
                                   ", fingerprint FROM jobs "
                                   "WHERE owner = $1 AND request = $2 AND request <> ''";

std::optional<store::Row> same_request(const Result& rows, const std::string& request_id,
                                       const std::string& fingerprint) {
  if (rows.empty()) return std::nullopt;
  store::Row row = row_at(rows, 0);
  if (row.intact) store::require_same_request(request_id, row.id, rows.text(0, 4), fingerprint);
  return row;
}

}  // namespace anticrack::group

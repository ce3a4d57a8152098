// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rows of meshes and jobs in PostgreSQL.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "postgres/connection.hpp"
#include "store/rows.hpp"

namespace anticrack::group {

/// Bytes as a column has them, since PostgreSQL's texts have no zeros and are UTF-8: those that are
/// not printable ASCII, and %, as %XX. Equal texts are of equal bytes.
std::string to_column(std::string_view bytes);
/// The inverse.
std::string of_column(std::string_view text);

/// What the column `checksum` must be.
std::int64_t row_checksum(std::string_view id, std::string_view owner, std::string_view record);

/// SQL: the columns of a row, in this order.
constexpr const char* row_columns = "id, owner, checksum, record";
store::Row row_at(const postgres::Result& rows, std::size_t row);
std::vector<store::Row> rows_at(const postgres::Result& rows);

/// SQL: row_columns and fingerprint of the job that this owner ($1) made with this request id ($2).
extern const std::string select_request;
/// The row of such a statement; empty if there is none. Throws as require_same_request does.
std::optional<store::Row> same_request(const postgres::Result& rows, const std::string& request_id,
                                       const std::string& fingerprint);

}  // namespace anticrack::group

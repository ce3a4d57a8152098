// SPDX-License-Identifier: GPL-3.0-or-later
#include "postgres/failure.hpp"

#include <chrono>
#include <utility>

namespace anticrack::postgres {

namespace {

using errors::Error;
using errors::Reason;

/// The classes (first two characters) and conditions in which an administrator must do something.
struct Cure {
  std::string_view sqlstate;  ///< or its beginning
  const char* cure;
};
constexpr Cure cures[] = {
    {"28P01", "give the right password in ~/.pgpass, PGPASSFILE or PGPASSWORD"},
    {"28", "let the user in: pg_hba.conf of the database's server"},
    {"3D000", "make the database: createdb"},
    {"42501", "grant the user what is missing, or let it own the database"},
    {"XX", "check the logs of the database's server and restore it from a backup if it is damaged"},
};

Error error_of(std::string_view sqlstate, const std::string& place, const std::string& what) {
  const std::string message =
      fmt::format("the PostgreSQL database {}: {}{}", place, what,
                  sqlstate.empty() ? "" : fmt::format(" (SQLSTATE {})", sqlstate));
  constexpr std::chrono::seconds soon{1}, later{5};
  if (sqlstate == "53100")
    return Error(Reason::disk_full, "{}; try again when there is space", message)
        .retry_after(later);
  switch (policy_of(sqlstate)) {
    case Policy::retry:
      return Error(Reason::storage, "{}; try again", message).retry_after(soon);
    case Policy::refuse:
      return Error(Reason::storage, "{}; try again later, or give the database more room", message)
          .retry_after(later);
    case Policy::reconnect:
      return Error(Reason::storage, "{}; check that it runs and can be reached from here", message)
          .retry_after(soon);
    case Policy::report:
      break;
  }
  for (const Cure& cure : cures)
    if (sqlstate.starts_with(cure.sqlstate)) return {Reason::storage, "{}; {}", message, cure.cure};
  return {Reason::internal, message};
}

}  // namespace

Policy policy_of(std::string_view sqlstate) noexcept {
  const auto is_one_of = [&](auto... states) { return ((sqlstate == states) || ...); };
  if (is_one_of("40001", "40P01", "55P03", "23503")) return Policy::retry;
  if (sqlstate.empty() || sqlstate.starts_with("08") || sqlstate.starts_with("57P0") ||
      is_one_of("57014", "25P03", "25006"))
    return Policy::reconnect;
  if (sqlstate.starts_with("53")) return Policy::refuse;
  return Policy::report;
}

Failure::Failure(std::string sqlstate, const std::string& place, const std::string& what)
    : Error(error_of(sqlstate, place, what)), _sqlstate(std::move(sqlstate)) {}

}  // namespace anticrack::postgres

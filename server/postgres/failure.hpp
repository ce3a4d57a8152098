// SPDX-License-Identifier: GPL-3.0-or-later
//
// What went wrong in PostgreSQL, and what is to be done.
#pragma once

#include <string>
#include <string_view>

#include "errors/errors.hpp"

namespace anticrack::postgres {

/// What is to be done after an error.
enum class Policy {
  retry,      ///< the transaction had a conflict with another: run it again
  reconnect,  ///< the connection, or the server, is of no use any more: run it on another one
  refuse,     ///< there is no room now: tell the client to come back
  report,     ///< the same would happen again
};

/// The policy of a SQLSTATE, five characters (appendix A of PostgreSQL's manual); empty: the
/// connection was lost without one. 40001, 40P01, 55P03 and 23503 (a foreign key that another
/// transaction took away): retry; 08xxx, 57P0x, 57014 (timeout of a statement), 25P03 and 25006 (a
/// primary that has become a standby): reconnect; 53xxx: refuse.
Policy policy_of(std::string_view sqlstate) noexcept;

/// An error of PostgreSQL or of the connection to it. Its reason is disk_full (SQLSTATE 53100),
/// storage with a retry delay where the same call may succeed later, storage for what an
/// administrator must cure, and internal for a bug.
class Failure : public errors::Error {
 public:
  /// `place`: the shown address. `what`: the server's words.
  Failure(std::string sqlstate, const std::string& place, const std::string& what);
  const std::string& sqlstate() const noexcept { return _sqlstate; }
  Policy policy() const noexcept { return policy_of(_sqlstate); }

 private:
  std::string _sqlstate;
};

}  // namespace anticrack::postgres

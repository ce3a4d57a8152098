// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where a PostgreSQL database is.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace anticrack::postgres {

/// What libpq is told to connect: one server of those that an address names.
using Options = std::map<std::string, std::string>;

/// The address of a database, which may name several servers of which one can be written to.
class Address {
 public:
  /// "postgresql://user@host:port/database?option=value", with several hosts "host1,host2", or
  /// libpq's "host=... dbname=...". Throws errors::Error (invalid_argument); no message has what
  /// was given, as there may be a password in it.
  explicit Address(const std::string& text);

  /// One set of options for each server.
  const std::vector<Options>& servers() const noexcept { return _servers; }
  /// "user@host:port/database", without a password, for messages.
  const std::string& shown() const noexcept { return _shown; }

 private:
  std::vector<Options> _servers;
  std::string _shown;
};

}  // namespace anticrack::postgres

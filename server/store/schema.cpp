// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/schema.hpp"

#include <fmt/core.h>

#include <cstdint>
#include <string>

namespace anticrack::store {

namespace {

using errors::Error;
using errors::Reason;

/// Raised with every change of the tables or of what records are (records.proto), since a database
/// of another version is refused.
constexpr std::int64_t schema_version = 8;

/// Besides the record, tables have the columns by which rows are searched. `number` is the order of
/// creation; AUTOINCREMENT gives no number twice, so that pages stay where they are when records
/// are erased. `store` identifies the store that this database and the files beside it belong to
/// (identity.hpp); `stopped` is 0 while a server runs its jobs, and after a crash. `checksum` says
/// whether the row is as it was written (rows.hpp). A small result is not worth a file of its own;
/// the column has what would be in the file.
constexpr const char* tables = R"(
CREATE TABLE meshes (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  id TEXT NOT NULL UNIQUE,
  owner TEXT NOT NULL,
  sha256 TEXT NOT NULL,
  upload TEXT NOT NULL,
  record BLOB NOT NULL,
  checksum INTEGER NOT NULL
) STRICT;
CREATE INDEX meshes_owner ON meshes (owner, number);
CREATE INDEX meshes_sha256 ON meshes (sha256) WHERE sha256 <> '';
CREATE INDEX meshes_upload ON meshes (upload) WHERE upload <> '';

CREATE TABLE jobs (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  id TEXT NOT NULL UNIQUE,
  owner TEXT NOT NULL,
  request TEXT NOT NULL,
  fingerprint TEXT NOT NULL,
  ended INTEGER,
  result TEXT NOT NULL,
  result_bytes INTEGER NOT NULL,
  small_result BLOB,
  record BLOB NOT NULL,
  checksum INTEGER NOT NULL
) STRICT;
CREATE INDEX jobs_owner ON jobs (owner, number);
CREATE UNIQUE INDEX jobs_request ON jobs (owner, request) WHERE request <> '';
CREATE INDEX jobs_unfinished ON jobs (number) WHERE ended IS NULL;
CREATE INDEX jobs_ended ON jobs (ended) WHERE ended IS NOT NULL;
CREATE INDEX jobs_result ON jobs (result) WHERE result <> '';

CREATE TABLE uploads (
  sha256 TEXT NOT NULL,
  owner TEXT NOT NULL,
  created INTEGER NOT NULL,
  checksum INTEGER NOT NULL,
  PRIMARY KEY (sha256, owner)
) STRICT, WITHOUT ROWID;

CREATE TABLE job_uploads (
  job INTEGER NOT NULL,
  upload TEXT NOT NULL,
  PRIMARY KEY (job, upload)
) STRICT, WITHOUT ROWID;
CREATE INDEX job_uploads_upload ON job_uploads (upload);

CREATE TABLE store (identity TEXT NOT NULL, stopped INTEGER NOT NULL) STRICT;
INSERT INTO store VALUES (lower(hex(randomblob(16))), 1);
)";

}  // namespace

void make_tables(Connection& connection) {
  if (connection.integer("PRAGMA user_version") == 0) {
    Transaction transaction(connection);
    connection.execute(tables);
    connection.execute(fmt::format("PRAGMA user_version = {}", schema_version));
    transaction.commit();
  }
  require_version(connection);
}

void require_version(Connection& connection) {
  const std::int64_t version = connection.integer("PRAGMA user_version");
  if (version != schema_version) {
    throw Error(Reason::storage,
                "the database {} has version {}, this anticrack reads version {}: start the {} "
                "anticrack that made it, or move the data folder away to start anew",
                connection.path(), version, schema_version,
                version < schema_version ? "older" : "newer");
  }
}

void require_sound(Connection& connection) {
  Statement check = connection.prepare("PRAGMA quick_check(1)");
  const std::string answer = check.step() ? check.text(0) : "no answer";
  if (answer != "ok") {
    throw Error(Reason::storage,
                "the database {} is damaged ({}): stop the server and restore the data folder from "
                "a backup, recover the database with sqlite3's .recover, or move the folder away "
                "to start anew",
                connection.path(), answer);
  }
}

}  // namespace anticrack::store

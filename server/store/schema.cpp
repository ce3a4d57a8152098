// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/schema.hpp"

#include <array>
#include <filesystem>
#include <string>

#include "store/files.hpp"

namespace anticrack::store {

namespace {

using errors::Error;
using errors::Reason;

/// Columns beside a record are those that are searched for. `number` is the order of creation;
/// AUTOINCREMENT gives none twice, so that a page stays where it is when records are erased.
constexpr const char* first = R"(
CREATE TABLE meshes (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  id TEXT NOT NULL UNIQUE,
  owner TEXT NOT NULL,
  sha256 TEXT NOT NULL,
  upload TEXT NOT NULL,
  record BLOB NOT NULL
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
  record BLOB NOT NULL
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
  PRIMARY KEY (sha256, owner)
) STRICT, WITHOUT ROWID;

CREATE TABLE job_uploads (
  job INTEGER NOT NULL,
  upload TEXT NOT NULL,
  PRIMARY KEY (job, upload)
) STRICT, WITHOUT ROWID;
CREATE INDEX job_uploads_upload ON job_uploads (upload);
)";

/// A result too small for a file of its own, as it would be in one.
constexpr const char* second = "ALTER TABLE jobs ADD COLUMN small_result BLOB";

/// What says that this database and the files beside it are of one store (identity.hpp).
constexpr const char* third = R"(
CREATE TABLE store (identity TEXT NOT NULL) STRICT;
INSERT INTO store VALUES (lower(hex(randomblob(16))));
)";

constexpr std::array steps{first, second, third};

std::string copy_path(const Connection& connection, std::size_t version) {
  return connection.path() + ".before-" + std::to_string(version);
}

/// Also of migrations that were killed: the database is whole, as it was or as it is to be.
void remove_copies(const Connection& connection, std::size_t newest) {
  for (std::size_t version = 1; version <= newest; ++version) {
    std::error_code ignored;
    std::filesystem::remove(copy_path(connection, version), ignored);
  }
}

void copy(Connection& connection, std::size_t version) {
  const std::string path = copy_path(connection, version);
  connection.prepare("VACUUM INTO ?").bind(std::string_view(path)).run();
  flush(path);
}

void run(Connection& connection, std::span<const char* const> todo, std::size_t version) {
  Transaction transaction(connection);
  for (const char* step : todo) {
    connection.execute(step);
  }
  connection.execute("PRAGMA user_version = " + std::to_string(version));
  transaction.commit();
}

}  // namespace

std::span<const char* const> schema_steps() {
  return steps;
}

void migrate(Connection& connection, std::span<const char* const> all) {
  const auto version = static_cast<std::size_t>(connection.integer("PRAGMA user_version"));
  if (version > all.size()) {
    throw Error(Reason::storage, "the database " + connection.path() + " has version " +
                                     std::to_string(version) + ", this anticrack knows up to " +
                                     std::to_string(all.size()) +
                                     ": start the newer anticrack that made it");
  }
  remove_copies(connection, all.size());
  if (version == all.size()) {
    return;
  }
  if (version > 0) {
    copy(connection, all.size());
  }
  run(connection, all.subspan(version), all.size());
  remove_copies(connection, all.size());
}

void require_sound(Connection& connection) {
  Statement check = connection.prepare("PRAGMA quick_check(1)");
  const std::string answer = check.step() ? check.text(0) : "no answer";
  if (answer != "ok") {
    throw Error(Reason::storage,
                "the database " + connection.path() + " is damaged (" + answer +
                    "): stop the server and restore the data folder from a backup, or move it "
                    "away to start anew");
  }
}

}  // namespace anticrack::store

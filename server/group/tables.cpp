// SPDX-License-Identifier: GPL-3.0-or-later
#include "group/tables.hpp"

#include <array>

namespace anticrack::group {

namespace {

/// `queue` has the jobs that have not ended, and nothing else. `runner`: the epoch of the server
/// that has the job; `tried`: the epochs in which it began to run. A server that has died stays in
/// `servers` (dead) until its next start, which knows then that the process has ended.
///
/// Blobs are named by the SHA-256 of their content, results by that of what comes before their
/// bytes (result_file.hpp), and are shared by all rows that refer to them; `kind` is a FileKind.
/// Doubles do not get smaller by compression, so pieces and events are stored as they are.
/// `checksum` is that of id, owner and record (rows.hpp).
constexpr const char* first = R"(
CREATE TABLE servers (
  epoch bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  name text NOT NULL,
  beats bigint NOT NULL DEFAULT 0,
  dead boolean NOT NULL DEFAULT false
);
CREATE TABLE blobs (
  sha256 text PRIMARY KEY,
  kind smallint NOT NULL,
  bytes bigint NOT NULL
);
CREATE TABLE pieces (
  sha256 text NOT NULL REFERENCES blobs ON DELETE CASCADE,
  n integer NOT NULL,
  body bytea NOT NULL,
  PRIMARY KEY (sha256, n)
);
ALTER TABLE pieces ALTER body SET STORAGE EXTERNAL;
CREATE TABLE meshes (
  number bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  id text NOT NULL UNIQUE,
  owner text NOT NULL,
  sha256 text NOT NULL,
  upload text NOT NULL,
  blob text REFERENCES blobs,
  record bytea NOT NULL,
  checksum bigint NOT NULL
);
CREATE INDEX ON meshes (owner, number);
CREATE INDEX ON meshes (blob) WHERE blob IS NOT NULL;
CREATE INDEX ON meshes (owner, upload) WHERE upload <> '';
CREATE TABLE jobs (
  number bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  id text NOT NULL UNIQUE,
  owner text NOT NULL,
  request text NOT NULL,
  fingerprint text NOT NULL,
  uploads text[] NOT NULL,
  ended bigint,
  result text REFERENCES blobs,
  result_bytes bigint NOT NULL DEFAULT 0,
  record bytea NOT NULL,
  checksum bigint NOT NULL
);
CREATE INDEX ON jobs (owner, number);
CREATE UNIQUE INDEX ON jobs (owner, request) WHERE request <> '';
CREATE INDEX ON jobs (number) WHERE ended IS NULL;
CREATE INDEX ON jobs (ended) WHERE ended IS NOT NULL;
CREATE INDEX ON jobs (result) WHERE result IS NOT NULL;
CREATE TABLE uploads (
  owner text NOT NULL,
  sha256 text NOT NULL REFERENCES blobs,
  created bigint NOT NULL,
  is_array boolean NOT NULL,
  PRIMARY KEY (owner, sha256)
);
CREATE INDEX ON uploads (sha256);
CREATE TABLE queue (
  number bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  job text NOT NULL UNIQUE REFERENCES jobs (id) ON DELETE CASCADE,
  owner text NOT NULL,
  mesh text NOT NULL,
  class smallint NOT NULL,
  tag bigint NOT NULL,
  cases bigint NOT NULL,
  bytes bigint NOT NULL,
  queued timestamptz NOT NULL DEFAULT now(),
  claimed timestamptz,
  runner bigint,
  attempt integer NOT NULL DEFAULT 0,
  crashes integer NOT NULL DEFAULT 0,
  tried bigint[] NOT NULL DEFAULT '{}',
  cancelled boolean NOT NULL DEFAULT false
) WITH (fillfactor = 50);
CREATE INDEX ON queue (class, tag, number) WHERE runner IS NULL;
CREATE INDEX ON queue (mesh, class, tag, number) WHERE runner IS NULL;
CREATE INDEX ON queue (owner, class, tag);
CREATE INDEX ON queue (runner) WHERE runner IS NOT NULL;
CREATE TABLE events (
  job text NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  last bigint NOT NULL,
  written timestamptz NOT NULL DEFAULT now(),
  body bytea NOT NULL,
  PRIMARY KEY (job, last)
);
ALTER TABLE events ALTER body SET STORAGE EXTERNAL;
)";

/// Jobs that several servers solve: a row for each portion (store/queue.hpp), as long as the job is
/// in the queue. `runner`: the epoch of the server that has it, or solved it; `body`: its answers.
constexpr const char* second = R"(
CREATE TABLE portions (
  job text NOT NULL REFERENCES queue (job) ON DELETE CASCADE,
  n integer NOT NULL,
  first bigint NOT NULL,
  count bigint NOT NULL,
  runner bigint,
  body bytea,
  request bytea NOT NULL DEFAULT '',
  PRIMARY KEY (job, n)
);
ALTER TABLE portions ALTER body SET STORAGE EXTERNAL;
CREATE INDEX ON portions (job, n) WHERE runner IS NULL;
CREATE INDEX ON portions (runner, job) WHERE runner IS NOT NULL AND body IS NULL;
)";

}  // namespace

postgres::Tables tables() {
  static constexpr std::array steps{first, second};
  return {steps, 1};
}

}  // namespace anticrack::group

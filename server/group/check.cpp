// SPDX-License-Identifier: GPL-3.0-or-later
#include "group/check.hpp"

#include "digest/digest.hpp"
#include "group/blobs.hpp"
#include "group/rows.hpp"
#include "group/tables.hpp"
#include "records/job_record.hpp"
#include "records/mesh_record.hpp"
#include "store/records.pb.h"
#include "store/result_file.hpp"

namespace anticrack::group {

namespace {

using errors::Error;
using errors::Reason;
using postgres::Result;
using postgres::Transaction;
using store::FileKind;

class Check {
 public:
  explicit Check(Transaction& transaction) : _transaction(transaction) {
    look_at_rows("meshes", store::read_mesh);
    look_at_rows("jobs", store::read_job);
    const Result flawed = _transaction.run(
        std::string(
            "SELECT 'meshes/' || id || ': its triangulation is missing' FROM meshes "
            "WHERE sha256 <> '' AND blob IS DISTINCT FROM sha256 UNION ALL "
            "SELECT 'jobs/' || id || ': its result is missing' FROM jobs "
            "WHERE result IS NULL AND result_bytes > 0 UNION ALL "
            "SELECT 'jobs/' || id || ': it has not ended, but is not queued' FROM jobs j "
            "WHERE ended IS NULL AND NOT EXISTS (SELECT FROM queue WHERE job = j.id) "
            "UNION ALL SELECT 'jobs/' || job || ': portion ' || n || ' is out of place' FROM "
            "(SELECT job, n, count < 1 OR job NOT IN (SELECT job FROM queue) OR CASE request "
            "WHEN '' THEN n <> row_number() OVER w - 1 OR first <> lag(first + count, 1, "
            "0::bigint) OVER w ELSE (first, count) <> (n, 1) END AS "
            "odd FROM portions WINDOW w AS (PARTITION BY job ORDER BY n)) p WHERE odd "
            "UNION ALL SELECT sha256 || ' belongs to no record' FROM blobs b WHERE ") +
        unreferenced);
    std::ranges::move(flawed.texts(), std::back_inserter(found.flaws));
    found.records += _transaction.run("SELECT count(*) FROM uploads").count(0, 0);
    look_at_portions();
    look_at_blobs();
  }

  store::CheckedStore found;

 private:
  /// Calls `look` and notes what it throws as a flaw, but for failures of the connection.
  template <class Look>
  void attempt(const std::string& what, const Look& look) {
    try {
      look();
    } catch (const postgres::Failure&) {
      throw;
    } catch (const Error& error) {
      found.flaws.push_back(what + error.what());
    }
  }

  template <class Record>
  void look_at_rows(const std::string& table, Record (*read)(const store::Row&)) {
    const std::string select = std::string("SELECT ") + row_columns + ", number FROM " + table +
                               " WHERE number > $1 ORDER BY number LIMIT 500";
    for (std::int64_t last = 0;;) {
      const Result rows = _transaction.run(select, {last});
      if (rows.empty()) return;
      for (std::size_t row = 0; row < rows.rows(); ++row) {
        ++found.records;
        attempt("", [&] { read(row_at(rows, row)); });
        last = rows.integer(row, 4);
      }
    }
  }

  void look_at_portions() {
    const Result rows = _transaction.run(
        "SELECT job, n, count, 'jobs/' || job || ': the answers of portion ' || n || "
        "' are damaged' FROM portions WHERE body IS NOT NULL");
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      const Result body =
          _transaction.run("SELECT body, request FROM portions WHERE job = $1 AND n = $2",
                           {rows.text(row, 0), rows.integer(row, 1)});
      if (rows_in(body.text(0, 0), body.text(0, 1)) != rows.count(row, 2))
        found.flaws.push_back(rows.text(row, 3));
    }
  }

  /// How many rows a body answers; a position counts as one.
  static std::uint64_t rows_in(const std::string& body, const std::string& request) {
    store::disk::SolvedPortion portion;
    store::disk::SolvedPosition position;
    store::disk::PositionRequest asked;
    if (!request.empty())
      return position.ParseFromString(body) && asked.ParseFromString(request) &&
             position.energy_size() == asked.loads_size();
    std::uint64_t rows = 0;
    if (portion.ParseFromString(body))
      for (const store::disk::SolvedChunk& chunk : portion.chunks())
        rows += chunk.answer().converged() + chunk.answer().not_converged();
    return rows;
  }

  void look_at_blobs() {
    for (std::string last;;) {
      const Result rows = _transaction.run(
          "SELECT sha256, kind, bytes, (SELECT count(*) = (bytes + $2 - 1) / $2 "
          "AND coalesce(sum(octet_length(body)), 0) = bytes FROM pieces p WHERE p.sha256 = "
          "b.sha256) FROM blobs b WHERE sha256 > $1 ORDER BY sha256 LIMIT 100",
          {last, piece_bytes});
      if (rows.empty()) return;
      for (std::size_t row = 0; row < rows.rows(); ++row) {
        ++found.files;
        last = rows.text(row, 0);
        attempt(last + " in the database: ", [&] {
          if (rows.integer(row, 3) == 0) throw Error(Reason::storage, "pieces are missing");
          look_at_blob(last, static_cast<FileKind>(rows.integer(row, 1)), rows.count(row, 2));
        });
      }
    }
  }

  void look_at_blob(const std::string& name, FileKind kind, std::uint64_t size) {
    const ReadBytes read = reader_of_pieces(
        [&](std::uint64_t n) {
          return _transaction.run("SELECT body FROM pieces WHERE sha256 = $1 AND n = $2",
                                  {name, n});
        },
        name, size);
    std::string hash;
    if (kind == FileKind::result) {
      const auto block = store::open_result(read, size, name);
      store::require_whole(*block, name);
      hash = digest::Sha256().add(store::result_header(*block)).finish();
    } else {
      hash = digest::sha256_of(size, read);
    }
    if (hash != name) throw Error(Reason::storage, "its content has another hash");
  }

  Transaction& _transaction;
};

}  // namespace

store::CheckedStore check(Transaction& transaction) { return Check(transaction).found; }

store::CheckedStore check(postgres::Pool& pool) {
  store::CheckedStore found;
  postgres::transact(pool, [&](Transaction& transaction) {
    transaction.execute("SET TRANSACTION ISOLATION LEVEL REPEATABLE READ, READ ONLY");
    const auto ours = tables().steps.size();
    if (transaction.run("SELECT 1 WHERE to_regclass('anticrack.tables') IS NULL").rows() == 1 ||
        transaction.run("SELECT FROM tables WHERE version = $1", {ours}).empty())
      throw Error(Reason::storage,
                  "the PostgreSQL database {} has no tables of version {}, which this anticrack "
                  "reads",
                  pool.settings().address.shown(), ours);
    found = check(transaction);
  });
  return found;
}

}  // namespace anticrack::group

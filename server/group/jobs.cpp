// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstring>
#include <utility>

#include "group/blobs.hpp"
#include "group/rows.hpp"
#include "group/store.hpp"
#include "records/job_record.hpp"
#include "stop/stop.hpp"
#include "store/record_codec.hpp"
#include "store/requests.hpp"
#include "store/result_file.hpp"

namespace anticrack::group {

using errors::Error;
using errors::Reason;
using postgres::Result;
using postgres::Value;
using records::JobRecord;

JobRecord Store::create(const JobRecord& record, const std::string& fingerprint) {
  return _queue.create_here(record, fingerprint);
}

std::optional<store::Row> Store::row_of_request(const std::string& owner,
                                                const std::string& request_id,
                                                const std::string& fingerprint) const {
  return same_request(
      postgres::query(_pool, select_request, {to_column(owner), to_column(request_id)}), request_id,
      fingerprint);
}

void Store::put(const JobRecord& record) { _queue.put(record, store::encode(record)); }

void Store::finish(const JobRecord& record, std::shared_ptr<const records::BlockSource> result) {
  const std::string bytes = store::encode(record);
  const std::string header = result ? store::result_header(*result) : std::string();
  const std::string name = result ? store::name_of_result(header) : std::string();
  const auto read = [&](std::uint64_t offset, std::span<std::byte> to) {
    stop::look("writing a result");
    if (offset < header.size()) {
      const std::size_t count = std::min<std::size_t>(to.size(), header.size() - offset);
      std::memcpy(to.data(), header.data() + offset, count);
      offset += count;
      to = to.subspan(count);
    }
    if (!to.empty()) result->read(offset - header.size(), to);
  };
  transact(_pool, [&](postgres::Transaction& transaction) {
    if (!_queue.may_end(transaction, record, bytes)) return;
    if (result)
      write_blob(transaction, store::FileKind::result, name, header.size() + result->size(), read);
    _queue.end(transaction, record, bytes, name, result ? result->size() : 0);
  });
}

std::vector<store::Row> Store::unfinished_rows() const {
  return rows_at(postgres::query(_pool, std::string("SELECT ") + row_columns +
                                            " FROM jobs WHERE ended IS NULL ORDER BY number"));
}

bool Store::set_running(bool /*running*/) { return false; }  // the queue counts crashes

std::vector<store::EndedJob> Store::ended() const {
  const Result rows = postgres::query(_pool,
                                      "SELECT id, ended, result_bytes, owner FROM jobs "
                                      "WHERE ended IS NOT NULL ORDER BY ended, number");
  return rows.each([&](std::size_t row) {
    return store::EndedJob{rows.text(row, 0), store::time_of(rows.integer(row, 1)),
                           rows.count(row, 2), of_column(rows.view(row, 3))};
  });
}

std::shared_ptr<const records::BlockSource> Store::result(const std::string& job) const {
  // One statement, so that all of it is of one moment.
  const Result found = postgres::query(
      _pool,
      "SELECT j.id, j.owner, j.checksum, j.record, j.result, b.bytes, p.body, j.result_bytes "
      "FROM jobs j LEFT JOIN blobs b ON b.sha256 = j.result "
      "LEFT JOIN pieces p ON p.sha256 = j.result AND p.n = 0 WHERE j.id = $1",
      {job});
  if (found.empty()) return nullptr;
  store::read_job(row_at(found, 0));  // throws if the record is damaged
  const std::string place = "the rows of jobs/" + job;
  if (found.is_null(0, 4) || found.is_null(0, 6)) {
    if (found.is_null(0, 4) && found.integer(0, 7) == 0) return nullptr;
    throw Error(Reason::storage, "the result in {} is damaged: delete its job and run it again",
                place);
  }
  const std::uint64_t size = found.count(0, 5);
  if (size <= piece_bytes) return store::open_result(found.text(0, 6), place);
  return store::open_result(reader_of_blob(_pool, found.text(0, 4), size), size, place);
}

void Store::expire(const std::string& job, records::Clock::time_point now) {
  transact(_pool, [&](postgres::Transaction& transaction) {
    const Result found = transaction.run(
        std::string("SELECT ") + row_columns + ", result FROM jobs WHERE id = $1 FOR UPDATE",
        {job});
    if (found.empty()) throw store::unknown("jobs", job);
    const JobRecord record = store::expired_job(row_at(found, 0), now);
    const std::string bytes = store::encode(record);
    transaction.run(
        "UPDATE jobs SET record = $2, checksum = $3, result = NULL, result_bytes = 0 WHERE id = $1",
        {job, Value::bytes(bytes), row_checksum(record.id, record.owner, bytes)});
    remove_unreferenced(transaction, {found.text(0, 4)});
  });
}

void Store::erase_job(const std::string& id) { erase("jobs", "result", id); }

}  // namespace anticrack::group

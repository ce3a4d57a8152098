// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "records/job_record.hpp"
#include "stop/stop.hpp"
#include "store/durable_store.hpp"
#include "store/record_codec.hpp"
#include "store/requests.hpp"
#include "store/result_file.hpp"

namespace anticrack::store {

using errors::Error;
using errors::Reason;

namespace {

/// Header and bytes together. A result that fits needs no flush of a file and of its folder, each
/// of which takes as long as the flush of the database that follows; a few more pages cost the
/// latter nothing.
constexpr std::size_t most_small_result = std::size_t{32} << 10U;

std::optional<std::int64_t> end_of(const records::JobRecord& record) {
  if (!ended(record.state)) return std::nullopt;
  return to_disk(record.ended.value_or(record.created));
}

void insert(Connection& connection, const records::JobRecord& record,
            const std::string& fingerprint, const std::string& bytes) {
  connection.run(
      "INSERT INTO jobs (id, owner, request, fingerprint, ended, result, result_bytes, record, "
      "checksum) VALUES (?1, ?2, ?3, ?4, ?5, '', 0, ?6, crc32c(?1, ?2, ?3, ?4, ?5, '', 0, ?6))",
      record.id, record.owner, record.request_id, fingerprint, end_of(record), Blob{bytes});
  for (const std::string& upload : uploads_of(record.spec))
    connection.run("INSERT INTO job_uploads SELECT number, ? FROM jobs WHERE id = ?", upload,
                   record.id);
}

/// The job that the owner made with this request id before.
std::optional<Row> find_request(Connection& connection, const std::string& owner,
                                const std::string& request_id, const std::string& fingerprint) {
  if (request_id.empty()) return std::nullopt;
  Statement select = connection.prepare(
      "SELECT id, fingerprint FROM jobs WHERE owner = ? AND request = ? AND request <> ''");
  if (!select.bind(owner, request_id).step()) return std::nullopt;
  std::optional<Row> row = find_row(connection, FileKind::result, select.text(0));
  if (row && row->intact) require_same_request(request_id, row->id, select.text(1), fingerprint);
  return row;
}

/// The name of the result's file; empty if there is none.
std::string result_name(Connection& connection, const std::string& job) {
  Statement select = connection.prepare("SELECT result FROM jobs WHERE id = ?");
  if (!select.bind(job).step()) throw unknown("jobs", job);
  return select.text(0);
}

/// A result as the row of its job has it: the name of its file, or the content itself.
struct ResultColumns {
  std::string name{};
  std::string small{};
  std::uint64_t bytes = 0;  ///< bytes of the block
};

void end(Connection& connection, const records::JobRecord& record, const ResultColumns& result,
         const std::string& bytes) {
  connection.run(
      "UPDATE jobs SET ended = ?1, result = ?2, small_result = ?3, result_bytes = ?4, record = ?5, "
      "checksum = crc32c(?6, ?7, ?8, fingerprint, ?1, ?2, ?4, ?5) WHERE id = ?6",
      end_of(record), result.name, Blob{result.small}, static_cast<std::int64_t>(result.bytes),
      Blob{bytes}, record.id, record.owner, record.request_id);
}

}  // namespace

records::JobRecord DurableStore::create(const records::JobRecord& record,
                                        const std::string& fingerprint) {
  const std::string bytes = encode(record);
  std::optional<Row> existing;
  _writer.run([&](Connection& connection) {
    existing = find_request(connection, record.owner, record.request_id, fingerprint);
    if (!existing) insert(connection, record, fingerprint, bytes);
  });
  return existing ? job_of(*existing) : record;
}

std::optional<Row> DurableStore::row_of_request(const std::string& owner,
                                                const std::string& request_id,
                                                const std::string& fingerprint) const {
  return reading([&](Connection& connection) {
    return find_request(connection, owner, request_id, fingerprint);
  });
}

void DurableStore::put(const records::JobRecord& record) {
  const std::string bytes = encode(record);
  _writer.run(
      [&](Connection& connection) {
        connection.run(
            "UPDATE jobs SET ended = ?1, record = ?2, checksum = "
            "crc32c(?3, ?4, ?5, fingerprint, ?1, result, result_bytes, ?2) WHERE id = ?3",
            end_of(record), Blob{bytes}, record.id, record.owner, record.request_id);
        if (connection.changes() == 0) throw unknown("jobs", record.id);
      },
      GroupCommit::Flush::no);
}

void DurableStore::finish(const records::JobRecord& record,
                          std::shared_ptr<const records::BlockSource> result) {
  const std::string bytes = encode(record);
  std::optional<DiskUsage::Reservation> reservation;
  std::optional<Part> file;
  ResultColumns columns;
  if (result) {
    const std::string header = result_header(*result);
    columns.bytes = result->size();
    reservation.emplace(reserve(header.size() + columns.bytes));
    if (header.size() + columns.bytes <= most_small_result) {
      columns.small = header;
      columns.small.resize(header.size() + columns.bytes);
      result->read(0, std::as_writable_bytes(std::span(columns.small)).subspan(header.size()));
    } else {
      columns.name = name_of_result(header);
      file.emplace(_results.write(std::as_bytes(std::span(header)), columns.bytes,
                                  [&](std::uint64_t offset, std::span<std::byte> to) {
                                    stop::look("writing a result");
                                    result->read(offset, to);
                                  }));
    }
  }
  _writer.run([&](Connection& connection) {
    if (const std::string before = result_name(connection, record.id); !before.empty())
      _unreferenced.push_back({FileKind::result, before});
    if (file) {
      _unreferenced.push_back({FileKind::result, columns.name});
      _results.rename(file->path(), columns.name);
      file->release();
      _results.flush_names();
    }
    end(connection, record, columns, bytes);
  });
}

std::vector<Row> DurableStore::unfinished_rows() const {
  return reading([](Connection& connection) {
    return rows_at(
        connection.prepare(select_rows(FileKind::result) + " WHERE ended IS NULL ORDER BY number"));
  });
}

bool DurableStore::set_running(bool running) {
  bool before = false;
  _writer.run([&](Connection& connection) {
    before = connection.integer("SELECT stopped FROM store") == 0;
    connection.execute(running ? "UPDATE store SET stopped = 0" : "UPDATE store SET stopped = 1");
  });
  return before;
}

std::vector<EndedJob> DurableStore::ended() const {
  return reading([](Connection& connection) {
    Statement select = connection.prepare(
        "SELECT id, ended, result_bytes, owner FROM jobs WHERE ended IS NOT NULL "
        "ORDER BY ended, number");
    std::vector<EndedJob> jobs;
    while (select.step())
      jobs.push_back({select.text(0), time_of(select.integer(1)),
                      static_cast<std::uint64_t>(select.integer(2)), select.text(3)});
    return jobs;
  });
}

std::shared_ptr<const records::BlockSource> DurableStore::result(const std::string& job) const {
  const auto look = [&]() -> ResultColumns {
    return reading([&](Connection& connection) {
      if (const std::optional<Row> row = find_row(connection, FileKind::result, job))
        read_job(*row);  // throws if the record is damaged, as its columns of the result then are
      Statement select =
          connection.prepare("SELECT result, small_result, result_bytes FROM jobs WHERE id = ?");
      return select.bind(job).step() ? ResultColumns{select.text(0), select.text(1),
                                                     static_cast<std::uint64_t>(select.integer(2))}
                                     : ResultColumns{};
    });
  };
  ResultColumns found = look();
  while (!found.name.empty()) {
    const std::string path = _results.path(found.name);
    if (base::Descriptor file = open_to_read(path))
      return open_result(std::move(file), path, found.name);
    ResultColumns now = look();  // the result may have expired just now
    if (now.name == found.name) {
      throw Error(Reason::storage,
                  "the result of jobs/{} is not in {}: delete the job and run it again", job, path);
    }
    found = std::move(now);
  }
  return found.bytes == 0 && found.small.empty()
             ? nullptr
             : open_result(std::move(found.small), "the row of jobs/" + job);
}

void DurableStore::expire(const std::string& job, records::Clock::time_point now) {
  _writer.run([&](Connection& connection) {
    const std::string result = result_name(connection, job);
    const records::JobRecord record =
        expired_job(*find_row(connection, FileKind::result, job), now);
    end(connection, record, {}, encode(record));
    if (!result.empty()) _unreferenced.push_back({FileKind::result, result});
  });
}

void DurableStore::erase_job(const std::string& id) {
  _writer.run([&](Connection& connection) {
    if (const std::string result = result_name(connection, id); !result.empty())
      _unreferenced.push_back({FileKind::result, result});
    connection.run("DELETE FROM job_uploads WHERE job = (SELECT number FROM jobs WHERE id = ?)",
                   id);
    connection.run("DELETE FROM jobs WHERE id = ?", id);
  });
}

}  // namespace anticrack::store

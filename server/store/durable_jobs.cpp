// SPDX-License-Identifier: GPL-3.0-or-later
#include <set>
#include <utility>
#include <variant>

#include "store/digest.hpp"
#include "store/durable_store.hpp"
#include "store/record_codec.hpp"
#include "store/result_file.hpp"

namespace anticrack::store {

using errors::Error;
using errors::Reason;

namespace {

/// Of header and bytes together. What fits needs no flush of a file and of its folder, each as long
/// as the flush of the database that follows; a few pages more cost that one nothing.
constexpr std::size_t most_small_result = std::size_t{32} << 10U;

std::set<std::string> uploads_of(const JobSpec& spec) {
  std::set<std::string> uploads;
  for (const fem::Load& load : spec.loads) {
    if (const auto* array = std::get_if<fem::Array>(&load.force)) {
      uploads.insert(array->upload);
    }
  }
  if (spec.sweep) {
    uploads.insert(spec.sweep->upload);
  }
  return uploads;
}

void bind_end(Statement& statement, const JobRecord& record) {
  if (ended(record.state)) {
    statement.bind(to_disk(record.ended.value_or(record.created)));
  } else {
    statement.bind_null();
  }
}

void insert(Connection& connection, const JobRecord& record, const std::string& fingerprint,
            const std::string& bytes) {
  {
    Statement statement = connection.prepare(
        "INSERT INTO jobs (id, owner, request, fingerprint, ended, result, result_bytes, record) "
        "VALUES (?, ?, ?, ?, ?, '', 0, ?)");
    statement.bind(std::string_view(record.id))
        .bind(std::string_view(record.owner))
        .bind(std::string_view(record.request_id))
        .bind(std::string_view(fingerprint));
    bind_end(statement, record);
    statement.bind_blob(bytes).run();
  }
  for (const std::string& upload : uploads_of(record.spec)) {
    connection.prepare("INSERT INTO job_uploads SELECT number, ? FROM jobs WHERE id = ?")
        .bind(std::string_view(upload))
        .bind(std::string_view(record.id))
        .run();
  }
}

/// The job the owner made with this request id before.
std::optional<std::string> find_request(Connection& connection, const JobRecord& record,
                                        const std::string& fingerprint) {
  if (record.request_id.empty()) {
    return std::nullopt;
  }
  Statement select = connection.prepare(
      "SELECT fingerprint, id, record FROM jobs WHERE owner = ? AND request = ? AND request <> ''");
  if (!select.bind(std::string_view(record.owner))
           .bind(std::string_view(record.request_id))
           .step()) {
    return std::nullopt;
  }
  if (select.text(0) != fingerprint) {
    throw Error(Reason::request_id_reused,
                "request id \"" + record.request_id + "\" was used for jobs/" + select.text(1) +
                    ", which is another job: make a new request id for each job")
        .at("request_id");
  }
  return select.text(2);
}

/// Name of the result's file; empty: none.
std::string result_name(Connection& connection, const std::string& job) {
  Statement select = connection.prepare("SELECT result FROM jobs WHERE id = ?");
  if (!select.bind(std::string_view(job)).step()) {
    throw unknown("jobs", job);
  }
  return select.text(0);
}

/// A result as its job's row has it: the name of its file, or what would be in one.
struct ResultColumns {
  std::string name{};
  std::string small{};
  std::uint64_t bytes = 0;  ///< of the block
};

void end(Connection& connection, const JobRecord& record, const ResultColumns& result,
         const std::string& bytes) {
  Statement update = connection.prepare(
      "UPDATE jobs SET ended = ?, result = ?, small_result = ?, result_bytes = ?, record = ? "
      "WHERE id = ?");
  bind_end(update, record);
  update.bind(std::string_view(result.name));
  if (result.small.empty()) {
    update.bind_null();
  } else {
    update.bind_blob(result.small);
  }
  update.bind(static_cast<std::int64_t>(result.bytes))
      .bind_blob(bytes)
      .bind(std::string_view(record.id))
      .run();
}

std::vector<JobRecord> decoded(const std::vector<std::string>& rows) {
  std::vector<JobRecord> records;
  records.reserve(rows.size());
  for (const std::string& bytes : rows) {
    records.push_back(decode_job_record(bytes));
  }
  return records;
}

}  // namespace

JobRecord DurableStore::create(const JobRecord& record, const std::string& fingerprint) {
  const std::string bytes = encode(record);
  std::optional<std::string> existing;
  _writer.run([&](Connection& connection) {
    existing = find_request(connection, record, fingerprint);
    if (!existing) {
      insert(connection, record, fingerprint, bytes);
    }
  });
  return existing ? decode_job_record(*existing) : record;
}

std::optional<JobRecord> DurableStore::created_before(const JobRecord& record,
                                                      const std::string& fingerprint) const {
  const auto existing = reading(
      [&](Connection& connection) { return find_request(connection, record, fingerprint); });
  return existing ? std::optional(decode_job_record(*existing)) : std::nullopt;
}

void DurableStore::put(const JobRecord& record) {
  const std::string bytes = encode(record);
  _writer.run([&](Connection& connection) {
    Statement update = connection.prepare("UPDATE jobs SET ended = ?, record = ? WHERE id = ?");
    bind_end(update, record);
    update.bind_blob(bytes).bind(std::string_view(record.id)).run();
    if (connection.changes() == 0) {
      throw unknown("jobs", record.id);
    }
  });
}

void DurableStore::finish(const JobRecord& record, std::shared_ptr<const Block> result) {
  const std::string bytes = encode(record);
  std::optional<DiskUsage::Reservation> reservation;
  std::optional<Part> file;
  ResultColumns columns;
  if (result) {
    const std::string header = result_header(*result);
    const std::span<const std::byte> values = result->bytes;
    columns.bytes = values.size();
    reservation.emplace(reserve(header.size() + values.size()));
    if (header.size() + values.size() <= most_small_result) {
      columns.small = header;
      columns.small.append(reinterpret_cast<const char*>(values.data()), values.size());
    } else {
      columns.name = Sha256().add(header).finish();
      file.emplace(_results.write({std::as_bytes(std::span(header)), values}));
    }
  }
  _writer.run([&](Connection& connection) {
    if (const std::string before = result_name(connection, record.id); !before.empty()) {
      _unreferenced.push_back({FileKind::result, before});
    }
    if (file) {
      _unreferenced.push_back({FileKind::result, columns.name});
      _results.rename(file->path(), columns.name);
      file->release();
      _results.flush_names();
    }
    end(connection, record, columns, bytes);
  });
}

std::optional<JobRecord> DurableStore::job(const std::string& id) const {
  const auto bytes = record("SELECT record FROM jobs WHERE id = ?", id);
  return bytes ? std::optional(decode_job_record(*bytes)) : std::nullopt;
}

std::vector<JobRecord> DurableStore::jobs(const Page& asked) const {
  return decoded(page("jobs", asked));
}

std::vector<JobRecord> DurableStore::unfinished() const {
  return decoded(records("SELECT record FROM jobs WHERE ended IS NULL ORDER BY number"));
}

std::vector<EndedJob> DurableStore::ended() const {
  return reading([](Connection& connection) {
    Statement select = connection.prepare(
        "SELECT id, ended, result_bytes FROM jobs WHERE ended IS NOT NULL ORDER BY ended, number");
    std::vector<EndedJob> jobs;
    while (select.step()) {
      jobs.push_back({select.text(0), time_of(select.integer(1)),
                      static_cast<std::uint64_t>(select.integer(2))});
    }
    return jobs;
  });
}

std::shared_ptr<const BlockSource> DurableStore::result(const std::string& job) const {
  const auto look = [&]() -> ResultColumns {
    return reading([&](Connection& connection) {
      Statement select = connection.prepare("SELECT result, small_result FROM jobs WHERE id = ?");
      return select.bind(std::string_view(job)).step()
                 ? ResultColumns{select.text(0), select.text(1)}
                 : ResultColumns{};
    });
  };
  ResultColumns found = look();
  while (!found.name.empty()) {
    const std::string path = _results.path(found.name);
    if (Descriptor file = open_to_read(path)) {
      return open_result(std::move(file), path);
    }
    ResultColumns now = look();  // it may have expired just now
    if (now.name == found.name) {
      throw Error(Reason::storage, "the result of jobs/" + job + " is not in " + path +
                                       ": delete the job and run it again");
    }
    found = std::move(now);
  }
  return found.small.empty() ? nullptr
                             : open_result(std::move(found.small), "the row of jobs/" + job);
}

void DurableStore::expire(const std::string& job) {
  _writer.run([&](Connection& connection) {
    const std::string result = result_name(connection, job);
    std::string bytes;
    {
      Statement select = connection.prepare("SELECT record FROM jobs WHERE id = ?");
      select.bind(std::string_view(job)).step();
      bytes = select.text(0);
    }
    JobRecord record = decode_job_record(bytes);
    if (!store::ended(record.state)) {
      throw Error(Reason::in_use, "jobs/" + job + " has not ended: cancel it first");
    }
    record.state = JobState::expired;
    record.result_bytes = 0;
    end(connection, record, {}, encode(record));
    if (!result.empty()) {
      _unreferenced.push_back({FileKind::result, result});
    }
  });
}

void DurableStore::erase_job(const std::string& id) {
  _writer.run([&](Connection& connection) {
    if (const std::string result = result_name(connection, id); !result.empty()) {
      _unreferenced.push_back({FileKind::result, result});
    }
    connection.prepare("DELETE FROM job_uploads WHERE job = (SELECT number FROM jobs WHERE id = ?)")
        .bind(std::string_view(id))
        .run();
    connection.prepare("DELETE FROM jobs WHERE id = ?").bind(std::string_view(id)).run();
  });
}

}  // namespace anticrack::store

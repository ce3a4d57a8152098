// SPDX-License-Identifier: GPL-3.0-or-later
#include "group/store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>
#include <span>
#include <utility>

#include "group/tables.hpp"
#include "mesh/codec.hpp"
#include "records/job_record.hpp"
#include "records/mesh_record.hpp"
#include "stop/stop.hpp"
#include "store/array_upload.hpp"
#include "store/record_codec.hpp"
#include "store/requests.hpp"
#include "store/result_file.hpp"

namespace anticrack::group {

namespace {

using errors::Error;
using errors::Reason;
using postgres::Result;
using postgres::transact;
using postgres::Transaction;
using postgres::Value;
using records::JobRecord;
using records::MeshRecord;
using store::FileKind;

constexpr std::uint64_t piece = std::uint64_t{1} << 20U;

Error unknown(const std::string& collection, const std::string& id) {
  return {Reason::not_found, "there is no " + collection + "/" + id};
}

std::string_view chars(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Calls write(n, bytes) for the pieces of a blob that read(offset, bytes) gives.
void in_pieces(std::uint64_t size,
               const std::function<void(std::uint64_t, std::span<std::byte>)>& read,
               const std::function<void(int, std::string_view)>& write) {
  std::vector<std::byte> buffer(std::min(size, piece));
  int n = 0;
  for (std::uint64_t at = 0; at < size; at += piece) {
    const std::span part = std::span(buffer).first(std::min(piece, size - at));
    read(at, part);
    write(n++, chars(part));
  }
}

template <class Record>
Record record_of(const std::string& id, const std::string& owner, std::string_view bytes,
                 Record (*decode)(std::string_view)) {
  try {
    Record record = decode(bytes);
    if (record.id != id) throw store::damaged_record("it belongs to " + record.id);
    return record;
  } catch (const Error& error) {
    Record lost;
    lost.id = id;
    lost.owner = owner;
    lost.state = decltype(lost.state)::failed;
    lost.error = error;
    return lost;
  }
}

/// Rows of id, owner, record.
template <class Record>
std::vector<Record> records_of(const Result& rows, Record (*decode)(std::string_view)) {
  std::vector<Record> records;
  for (std::size_t row = 0; row < rows.rows(); ++row)
    records.push_back(record_of(rows.text(row, 0), rows.text(row, 1), rows.view(row, 2), decode));
  return records;
}

template <class Record>
std::optional<Record> first_of(const Result& rows, Record (*decode)(std::string_view)) {
  if (rows.empty()) return std::nullopt;
  return std::move(records_of(rows, decode).front());
}

postgres::Settings settings_of(const std::string& url) {
  postgres::Settings settings{postgres::Address(url)};
  return settings;
}

/// The name of the server of this data folder, made at its first start.
std::string name_of(const std::string& folder) {
  const std::string path = folder + "/server";
  std::string name;
  if (std::ifstream(path) >> name) return name;
  std::random_device random;
  name = fmt::format("{:08x}{:08x}", random(), random());
  store::replace_file(path, std::as_bytes(std::span(name)));
  return name;
}

/// A result in the database: the pieces are read as they are asked for, the last one is kept.
class Pieces {
 public:
  Pieces(std::function<std::string(int n)> fetch, std::uint64_t size)
      : _fetch(std::move(fetch)), _size(size) {}

  void read(std::uint64_t offset, std::span<std::byte> to) {
    const std::lock_guard lock(_mutex);
    if (offset > _size || to.size() > _size - offset)
      throw Error(Reason::offset_out_of_range, "the result has {} bytes", _size);
    while (!to.empty()) {
      const int n = static_cast<int>(offset / piece);
      if (n != _held) _bytes = _fetch(n);
      _held = n;
      const std::uint64_t at = offset % piece;
      if (at >= _bytes.size())
        throw Error(Reason::storage, "a piece of the result is missing: run the job again");
      const std::size_t count = std::min<std::uint64_t>(to.size(), _bytes.size() - at);
      std::memcpy(to.data(), _bytes.data() + at, count);
      offset += count;
      to = to.subspan(count);
    }
  }

 private:
  const std::function<std::string(int)> _fetch;
  const std::uint64_t _size;
  std::mutex _mutex;
  int _held = -1;
  std::string _bytes;
};

}  // namespace

Store::Store(const store::StoreOptions& options, const std::string& url)
    : _pool(settings_of(url)),
      _usage(options.disk_budget),
      _results(options.folder, FileKind::result, _usage),
      _uploads(options.folder, FileKind::upload, _usage),
      _queue((postgres::make_tables(_pool, tables()), _pool), name_of(options.folder)) {
  for (store::Files* files : {&_results, &_uploads})
    for (const std::string& name : files->sweep([](const std::string&) { return false; }))
      files->remove(name);
}

Result Store::page(const std::string& table, const store::Page& page) const {
  const std::string owner = page.owner.value_or("");
  const std::string of_owner = page.owner ? " AND owner = $2" : " AND $2 = ''";
  std::int64_t last = page.oldest_first ? 0 : std::numeric_limits<std::int64_t>::max();
  if (!page.after.empty()) {
    const Result after =
        ask("SELECT number FROM " + table + " WHERE id = $1" + of_owner, {page.after, owner});
    if (after.empty()) throw unknown(table, page.after);
    last = after.integer(0, 0);
  }
  constexpr std::size_t most = std::numeric_limits<std::int64_t>::max();
  return ask("SELECT id, owner, record FROM " + table + " WHERE number " +
                 (page.oldest_first ? ">" : "<") + " $1" + of_owner + " ORDER BY number " +
                 (page.oldest_first ? "" : "DESC ") + "LIMIT $3",
             {last, owner, static_cast<std::int64_t>(std::min(page.count, most))});
}

namespace {

constexpr const char* upsert_mesh =
    "INSERT INTO meshes (id, owner, sha256, upload, record) VALUES ($1, $2, $3, $4, $5) "
    "ON CONFLICT (id) DO UPDATE SET owner = excluded.owner, sha256 = excluded.sha256, "
    "upload = excluded.upload, record = excluded.record";

}  // namespace

void Store::put(const MeshRecord& record) {
  ask(upsert_mesh, {record.id, record.owner, record.sha256, store::upload_of(record),
                    Value::bytes(store::encode(record))});
}

void Store::put(const MeshRecord& record, const mesh::Mesh& triangulation) {
  const mesh::Bytes encoded = mesh::encode(triangulation);
  if (store::sha256_of(encoded) != record.sha256)
    throw Error(Reason::internal, "meshes/{} comes with another triangulation", record.id);
  const std::string bytes = store::encode(record);
  transact(_pool, [&](Transaction& transaction) {
    transaction.run(upsert_mesh, {record.id, record.owner, record.sha256, store::upload_of(record),
                                  Value::bytes(bytes)});
    transaction.run("DELETE FROM mesh_pieces WHERE mesh = $1", {record.id});
    for (std::uint64_t at = 0; at < encoded.size(); at += piece)
      transaction.run("INSERT INTO mesh_pieces VALUES ($1, $2, $3)",
                      {record.id, static_cast<int>(at / piece),
                       Value::bytes(chars(std::span(encoded).subspan(
                           at, std::min<std::uint64_t>(piece, encoded.size() - at))))});
  });
}

std::optional<MeshRecord> Store::mesh(const std::string& id) const {
  return first_of(ask("SELECT id, owner, record FROM meshes WHERE id = $1", {id}),
                  store::decode_mesh_record);
}

std::vector<MeshRecord> Store::meshes(const store::Page& asked) const {
  return records_of(page("meshes", asked), store::decode_mesh_record);
}

std::size_t Store::mesh_count() const {
  return static_cast<std::size_t>(ask("SELECT count(*) FROM meshes").integer(0, 0));
}

void Store::erase_mesh(const std::string& id) {
  if (ask("DELETE FROM meshes WHERE id = $1", {id}).affected() == 0) throw unknown("meshes", id);
}

std::shared_ptr<const mesh::Mesh> Store::triangulation(const std::string& sha256) const {
  if (!store::is_sha256(sha256)) return nullptr;
  if (auto held = _triangulations.find(sha256)) return held;
  const Result rows =
      ask("SELECT body FROM mesh_pieces WHERE mesh = (SELECT id FROM meshes WHERE sha256 = $1 "
          "ORDER BY number LIMIT 1) ORDER BY n",
          {sha256});
  if (rows.empty()) return nullptr;
  std::string bytes;
  for (std::size_t row = 0; row < rows.rows(); ++row) bytes += rows.text(row, 0);
  const std::span whole = std::as_bytes(std::span(bytes));
  if (store::sha256_of(whole) != sha256)
    throw Error(
        Reason::storage,
        "the triangulation {} in the database is damaged: delete its mesh and make it again",
        sha256);
  return _triangulations.share(sha256,
                               std::make_shared<const mesh::Mesh>(mesh::decode_mesh(whole)));
}

JobRecord Store::create(const JobRecord& record, const std::string& fingerprint) {
  return _queue.create(record, fingerprint, {record.spec.loads.size(), 0}, [](const auto&) {});
}

std::optional<JobRecord> Store::created_before(const std::string& owner,
                                               const std::string& request_id,
                                               const std::string& fingerprint) const {
  if (request_id.empty()) return std::nullopt;
  const Result rows =
      ask("SELECT id, owner, record, fingerprint FROM jobs WHERE owner = $1 AND request = $2",
          {owner, request_id});
  if (!rows.empty())
    store::require_same_request(request_id, rows.text(0, 0), rows.text(0, 3), fingerprint);
  return first_of(rows, store::decode_job_record);
}

void Store::put(const JobRecord& record) { _queue.put(record, store::encode(record)); }

std::shared_ptr<store::Spool> Store::new_spool() {
  return std::make_shared<store::Spool>([this] { return _results.nameless(); },
                                        [this](std::uint64_t bytes) { return reserve(bytes); });
}

void Store::finish(const JobRecord& record, std::shared_ptr<const records::BlockSource> result) {
  std::uint64_t bytes = 0;
  if (result) {
    const std::string header = store::result_header(*result);
    bytes = header.size() + result->size();
    in_pieces(
        bytes,
        [&](std::uint64_t at, std::span<std::byte> to) {
          stop::look("writing a result");
          if (at < header.size()) {
            const std::size_t count = std::min<std::size_t>(to.size(), header.size() - at);
            std::memcpy(to.data(), header.data() + at, count);
            to = to.subspan(count);
            at += count;
          }
          if (!to.empty()) result->read(at - header.size(), to);
        },
        [&](int n, std::string_view part) {
          ask("INSERT INTO results VALUES ($1, $2, $3, $4) ON CONFLICT (job, attempt, n) "
              "DO UPDATE SET body = excluded.body",
              {record.id, record.attempt, n, Value::bytes(part)});
        });
  }
  _queue.finish(record, store::encode(record), bytes);
}

std::optional<JobRecord> Store::job(const std::string& id) const {
  return first_of(ask("SELECT id, owner, record FROM jobs WHERE id = $1", {id}),
                  store::decode_job_record);
}

std::vector<JobRecord> Store::jobs(const store::Page& asked) const {
  return records_of(page("jobs", asked), store::decode_job_record);
}

std::vector<JobRecord> Store::unfinished() const {
  std::vector<JobRecord> found =
      records_of(ask("SELECT id, owner, record FROM jobs WHERE ended IS NULL ORDER BY number"),
                 store::decode_job_record);
  std::erase_if(found, [](const JobRecord& record) { return records::ended(record.state); });
  return found;
}

bool Store::set_running(bool /*running*/) { return false; }

std::vector<store::EndedJob> Store::ended() const {
  const Result rows =
      ask("SELECT id, ended, result_bytes, owner FROM jobs WHERE ended IS NOT NULL "
          "ORDER BY ended, number");
  std::vector<store::EndedJob> jobs;
  for (std::size_t row = 0; row < rows.rows(); ++row)
    jobs.push_back({rows.text(row, 0), store::time_of(rows.integer(row, 1)),
                    static_cast<std::uint64_t>(rows.integer(row, 2)), rows.text(row, 3)});
  return jobs;
}

std::shared_ptr<const records::BlockSource> Store::result(const std::string& job) const {
  const Result rows = ask("SELECT result, result_bytes FROM jobs WHERE id = $1", {job});
  if (rows.empty() || rows.integer(0, 1) == 0) return nullptr;
  const std::int64_t attempt = rows.integer(0, 0);
  const auto bytes = static_cast<std::uint64_t>(rows.integer(0, 1));
  const auto fetch = [this, job, attempt](int n) {
    const Result found = ask("SELECT body FROM results WHERE job = $1 AND attempt = $2 AND n = $3",
                             {job, attempt, n});
    return found.empty() ? std::string() : found.text(0, 0);
  };
  const auto pieces = std::make_shared<Pieces>(fetch, bytes);
  return store::open_result(
      [pieces](std::uint64_t offset, std::span<std::byte> to) { pieces->read(offset, to); }, bytes,
      "the rows of jobs/" + job);
}

void Store::expire(const std::string& job, records::Clock::time_point now) {
  transact(_pool, [&](Transaction& transaction) {
    const Result rows = transaction.run("SELECT record FROM jobs WHERE id = $1 FOR UPDATE", {job});
    if (rows.empty()) throw unknown("jobs", job);
    JobRecord record = store::decode_job_record(rows.text(0, 0));
    if (!records::ended(record.state))
      throw Error(Reason::in_use, "jobs/{} has not ended: cancel it first", job);
    record.expired = now;
    record.result_bytes = 0;
    transaction.run("UPDATE jobs SET record = $2, result_bytes = 0 WHERE id = $1",
                    {job, Value::bytes(store::encode(record))});
    transaction.run("DELETE FROM results WHERE job = $1", {job});
  });
}

void Store::erase_job(const std::string& id) {
  if (ask("DELETE FROM jobs WHERE id = $1", {id}).affected() == 0) throw unknown("jobs", id);
}

std::optional<std::string> Store::upload_path(const std::string& sha256,
                                              const std::string& owner) const {
  if (ask("SELECT FROM uploads WHERE sha256 = $1 AND owner = $2", {sha256, owner}).empty())
    return std::nullopt;
  const std::string path = _uploads.path(sha256);
  if (store::file_size(path)) return path;
  store::Part part(_uploads.new_part());
  {
    std::ofstream file(part.path(), std::ios::binary);
    for (int n = 0;; ++n) {
      const Result rows =
          ask("SELECT body FROM upload_pieces WHERE owner = $1 AND sha256 = $2 AND n = $3",
              {owner, sha256, n});
      if (rows.empty()) break;
      file << rows.text(0, 0);
    }
    if (!file.flush())
      throw Error(Reason::disk_full, "uploads/{} cannot be copied to {}", sha256, part.path());
  }
  _uploads.rename(part.path(), sha256);
  part.release();
  return path;
}

std::string Store::new_upload_path(std::uint64_t bytes) {
  _parts.forget_lost();
  store::DiskUsage::Reservation reservation = reserve(bytes);
  std::string path = _uploads.new_part();
  _parts.add(path, std::move(reservation));
  return path;
}

records::Clock::time_point Store::keep_uploads(const std::vector<store::Upload>& uploads,
                                               const std::string& owner) {
  for (const store::Upload& upload : uploads) {
    if (!store::is_sha256(upload.sha256))
      throw Error(Reason::invalid_argument,
                  "\"{}\" is not a sha256: give its 64 lower-case hexadecimal digits",
                  upload.sha256);
    if (!_uploads.is_part(upload.path))
      throw Error(Reason::internal, "{} is not an upload on its way", upload.path);
  }
  const records::Clock::time_point now = records::Clock::now();
  transact(_pool, [&](Transaction& transaction) {
    for (const store::Upload& upload : uploads) {
      const base::Descriptor file = store::open_to_read(upload.path);
      const std::uint64_t size = store::file_size(file, upload.path);
      std::array<std::byte, 16> buffer{};
      const std::span start = std::span(buffer).first(std::min<std::uint64_t>(buffer.size(), size));
      store::read_at(file, upload.path, 0, start);
      transaction.run(
          "INSERT INTO uploads VALUES ($1, $2, $3, $4, $5) ON CONFLICT (owner, sha256) "
          "DO UPDATE SET created = excluded.created",
          {upload.sha256, owner, store::to_disk(now), size, !store::begins_like_msh(start)});
      in_pieces(
          size,
          [&](std::uint64_t at, std::span<std::byte> to) {
            store::read_at(file, upload.path, at, to);
          },
          [&](int n, std::string_view part) {
            transaction.run(
                "INSERT INTO upload_pieces VALUES ($1, $2, $3, $4) ON CONFLICT (owner, sha256, n) "
                "DO UPDATE SET body = excluded.body",
                {owner, upload.sha256, n, Value::bytes(part)});
          });
    }
  });
  for (const store::Upload& upload : uploads) {
    _parts.forget(upload.path);
    const store::Part done(upload.path);
  }
  return now;
}

namespace {

std::vector<store::UploadRecord> uploads_of_rows(const Result& rows) {
  std::vector<store::UploadRecord> found;
  for (std::size_t row = 0; row < rows.rows(); ++row)
    found.push_back({rows.text(row, 0), rows.text(row, 1), store::time_of(rows.integer(row, 2)),
                     static_cast<std::uint64_t>(rows.integer(row, 3)), rows.integer(row, 4) != 0});
  return found;
}

/// Of the upload u: whether an unfinished job or an unmeshed mesh of its owner needs it.
constexpr const char* needed =
    "(EXISTS (SELECT FROM jobs j WHERE j.owner = u.owner AND j.ended IS NULL "
    "AND u.sha256 = ANY (j.uploads)) OR EXISTS (SELECT FROM meshes m WHERE m.owner = u.owner "
    "AND m.upload = u.sha256 AND m.sha256 = ''))";

}  // namespace

std::optional<store::UploadRecord> Store::upload(const std::string& sha256,
                                                 const std::string& owner) const {
  std::vector<store::UploadRecord> found = uploads_of_rows(
      ask("SELECT * FROM uploads WHERE sha256 = $1 AND owner = $2", {sha256, owner}));
  return found.empty() ? std::nullopt : std::optional(std::move(found.front()));
}

std::vector<store::UploadRecord> Store::uploads(const std::string& owner, const std::string& after,
                                                std::size_t count) const {
  return uploads_of_rows(
      ask("SELECT * FROM uploads WHERE owner = $1 AND sha256 > $2 ORDER BY sha256 LIMIT $3",
          {owner, after, static_cast<std::uint64_t>(count)}));
}

void Store::erase_upload(const std::string& sha256, const std::string& owner) {
  const std::string is_it = " FROM uploads u WHERE u.sha256 = $1 AND u.owner = $2";
  if (ask("DELETE" + is_it + " AND NOT " + needed, {sha256, owner}).affected() > 0) return;
  if (ask("SELECT" + is_it, {sha256, owner}).empty()) throw unknown("uploads", sha256);
  throw Error(Reason::in_use,
              "uploads/{} is needed by a job that has not ended or a mesh that is not meshed: "
              "delete it later, or cancel the job or delete the mesh first",
              sha256);
}

std::size_t Store::expire_uploads(records::Clock::time_point before) {
  return ask(std::string("DELETE FROM uploads u WHERE created < $1 AND NOT ") + needed,
             {store::to_disk(before)})
      .affected();
}

store::Usage Store::usage() const {
  const Result rows =
      ask("SELECT pg_database_size(current_database()), pg_total_relation_size('results'), "
          "pg_total_relation_size('mesh_pieces'), pg_total_relation_size('upload_pieces')");
  const auto bytes = [&](int column) {
    return static_cast<std::uint64_t>(rows.integer(0, column));
  };
  const std::uint64_t blobs = bytes(1) + bytes(2) + bytes(3);
  return {bytes(2), bytes(1), bytes(3), bytes(0) - std::min(bytes(0), blobs)};
}

std::vector<store::OwnerUsage> Store::owners() const {
  const Result rows =
      ask("SELECT owner, count(*), count(*) FILTER (WHERE ended IS NULL), "
          "coalesce(sum(result_bytes), 0)::bigint FROM jobs GROUP BY owner");
  std::vector<store::OwnerUsage> owners;
  for (std::size_t row = 0; row < rows.rows(); ++row)
    owners.push_back({rows.text(row, 0), static_cast<std::uint64_t>(rows.integer(row, 1)),
                      static_cast<std::uint64_t>(rows.integer(row, 2)),
                      static_cast<std::uint64_t>(rows.integer(row, 3))});
  return owners;
}

}  // namespace anticrack::group

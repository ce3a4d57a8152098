// SPDX-License-Identifier: GPL-3.0-or-later
#include "group/blobs.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <utility>

#include "errors/errors.hpp"
#include "stop/stop.hpp"

namespace anticrack::group {

namespace {

using errors::Error;
using errors::Reason;
using postgres::Result;
using postgres::Value;

/// A piece; empty if there is none.
Result piece_of(postgres::Pool& pool, const std::string& name, std::uint64_t n) {
  return postgres::query(pool, "SELECT body FROM pieces WHERE sha256 = $1 AND n = $2", {name, n});
}

/// The piece that was read last, and where more are.
struct Reader {
  std::mutex mutex;
  std::uint64_t n = 0;
  std::optional<Result> held{};
};

}  // namespace

const char* const unreferenced =
    "NOT EXISTS (SELECT FROM meshes WHERE blob = b.sha256) "
    "AND NOT EXISTS (SELECT FROM jobs WHERE result = b.sha256) "
    "AND NOT EXISTS (SELECT FROM uploads WHERE uploads.sha256 = b.sha256)";

void write_blob(postgres::Transaction& transaction, store::FileKind kind, const std::string& name,
                std::uint64_t size, const ReadBytes& read) {
  transaction.run(
      "INSERT INTO blobs (sha256, kind, bytes) VALUES ($1, $2, $3) "
      "ON CONFLICT (sha256) DO UPDATE SET bytes = excluded.bytes",
      {name, static_cast<int>(kind), size});
  transaction.run("DELETE FROM pieces WHERE sha256 = $1", {name});
  std::vector<std::byte> piece(std::min(size, piece_bytes));
  for (std::uint64_t at = 0; at < size; at += piece_bytes) {
    const std::span bytes = std::span(piece).first(std::min(size - at, piece_bytes));
    read(at, bytes);
    transaction.run("INSERT INTO pieces (sha256, n, body) VALUES ($1, $2, $3)",
                    {name, at / piece_bytes, Value::bytes(bytes)});
  }
}

std::vector<std::string> remove_unreferenced(postgres::Transaction& transaction,
                                             std::vector<std::string> names) {
  std::erase(names, "");
  if (names.empty()) return {};
  // Who refers to a blob anew holds its row. So the row is taken first, and the second statement
  // sees what others have committed until then.
  transaction.run("SELECT FROM blobs WHERE sha256 = ANY ($1) ORDER BY sha256 FOR UPDATE", {names});
  return transaction
      .run(std::string("DELETE FROM blobs b WHERE sha256 = ANY ($1) AND ") + unreferenced +
               " RETURNING sha256",
           {names})
      .texts();
}

void hold_uploads(postgres::Transaction& transaction, const std::string& owner,
                  const std::vector<std::string>& uploads) {
  if (uploads.empty()) return;
  transaction.run(
      "SELECT FROM uploads WHERE owner = $1 AND sha256 = ANY ($2) ORDER BY sha256 FOR KEY SHARE",
      {owner, uploads});
}

std::uint64_t read_blob(postgres::Pool& pool, store::FileKind kind, const std::string& name,
                        const std::function<void(std::span<const std::byte>)>& take) {
  const Result blob =
      postgres::query(pool, "SELECT bytes FROM blobs WHERE sha256 = $1 AND kind = $2",
                      {name, static_cast<int>(kind)});
  if (blob.empty()) return 0;
  const std::uint64_t size = blob.count(0, 0);
  for (std::uint64_t at = 0; at < size; at += piece_bytes) {
    stop::look("reading from the database");
    // With the blob in one statement: one that was removed meanwhile has no damage.
    const Result piece = postgres::query(
        pool,
        "SELECT body FROM blobs b LEFT JOIN pieces p ON p.sha256 = b.sha256 AND n = $2 "
        "WHERE b.sha256 = $1",
        {name, at / piece_bytes});
    if (piece.empty()) return 0;
    const std::string_view bytes = piece.view(0, 0);
    if (bytes.size() != std::min(size - at, piece_bytes)) {
      throw Error(Reason::storage,
                  "piece {} of {} in the database is missing or damaged: make it again, or restore "
                  "a backup",
                  at / piece_bytes, name);
    }
    take(std::as_bytes(std::span(bytes)));
  }
  return size;
}

ReadBytes reader_of_blob(postgres::Pool& pool, const std::string& name, std::uint64_t size) {
  return reader_of_pieces([&pool, name](std::uint64_t n) { return piece_of(pool, name, n); }, name,
                          size);
}

ReadBytes reader_of_pieces(std::function<Result(std::uint64_t n)> piece_of, const std::string& name,
                           std::uint64_t size) {
  return [piece_of = std::move(piece_of), name, size, reader = std::make_shared<Reader>()](
             std::uint64_t offset, std::span<std::byte> to) {
    if (offset > size || to.size() > size - offset)
      throw Error(Reason::storage, "{} in the database has no more than {} bytes", name, size);
    const std::lock_guard lock(reader->mutex);
    while (!to.empty()) {
      if (const std::uint64_t n = offset / piece_bytes; !reader->held || reader->n != n) {
        reader->held.reset();
        Result piece = piece_of(n);
        if (piece.empty())
          throw Error(Reason::result_expired, "the result was removed while it was being read");
        reader->held.emplace(std::move(piece));
        reader->n = n;
      }
      const std::string_view bytes = reader->held->view(0, 0);
      const std::uint64_t at = offset % piece_bytes;
      if (at >= bytes.size()) {
        throw Error(Reason::storage, "a piece of {} in the database is cut off: restore a backup",
                    name);
      }
      const std::size_t count = std::min<std::uint64_t>(to.size(), bytes.size() - at);
      std::memcpy(to.data(), bytes.data() + at, count);
      offset += count;
      to = to.subspan(count);
    }
  };
}

}  // namespace anticrack::group

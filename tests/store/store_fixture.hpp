// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <vector>

#ifdef ANTICRACK_POSTGRESQL
#include "group/store.hpp"
#endif
#include "store/sample_records.hpp"
#include "store/store.hpp"
#include "support/errors.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::store {

/// The store of the options, as the server makes it.
inline std::unique_ptr<Store> open_any(const StoreOptions& options) {
#ifdef ANTICRACK_POSTGRESQL
  if (!options.url.empty()) return std::make_unique<group::Store>(options);
#endif
  return open(options);
}

class StoreTest : public ::testing::Test {
 protected:
  /// `database`: the address of a PostgreSQL database; empty: SQLite.
  explicit StoreTest(std::string database = {}) : url(std::move(database)) {}
  void reopen(std::uint64_t disk_budget = 0) {
    store.reset();
    store = open_any({folder.path(), disk_budget, url});
  }
  records::JobRecord create(const std::string& id, const std::string& owner = {},
                            const std::string& request = {}, const std::string& fingerprint = {}) {
    records::JobRecord record = job_record(id, owner);
    record.request_id = request;
    return store->create(record, fingerprint);
  }
  /// A job that has ended with a result.
  void end(const std::string& id, std::shared_ptr<const records::BlockSource> result,
           int second = 1) {
    create(id);
    store->finish(ended_record(id, second), std::move(result));
  }
  std::string upload(const std::string& text, const std::string& owner = {}) {
    const std::string part = store->new_upload_path(text.size());
    std::ofstream(part, std::ios::binary) << text;
    const std::string sha256 = digest::Sha256().add(text).finish();
    store->keep_uploads({{part, sha256}}, owner);
    return sha256;
  }
  std::size_t files(const std::string& name) const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder / name)) {
      ++count;
    }
    return count;
  }
  std::vector<std::string> jobs(const Page& page) const {
    std::vector<std::string> ids;
    for (const records::JobRecord& record : store->jobs(page)) ids.push_back(record.id);
    return ids;
  }
  std::vector<std::string> meshes(const Page& page) const {
    std::vector<std::string> ids;
    for (const records::MeshRecord& record : store->meshes(page)) ids.push_back(record.id);
    return ids;
  }

  anticrack::testing::TemporaryFolder folder;
  const std::string url;
  std::unique_ptr<Store> store = open_any({folder.path(), 0, url});
};

}  // namespace anticrack::store

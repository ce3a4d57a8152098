// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>
#include <mutex>
#include <unordered_map>
#include <utility>

#include "errors/errors.hpp"
#include "store/store.hpp"
#include "store/uploads.hpp"

namespace anticrack::store {

namespace {

using errors::Error;
using errors::Reason;

Error unknown(const std::string& collection, const std::string& id) {
  return {Reason::not_found, "there is no " + collection + "/" + id};
}

/// Records of one type in the order they came, with what belongs to each. Records are shared, not
/// copied, so that a reader holds the store's lock for a moment only.
template <class Record, class Companion>
class Table {
 public:
  struct Row {
    std::uint64_t number = 0;
    std::shared_ptr<const Record> record;
    Companion companion;
  };

  explicit Table(std::string collection) : _collection(std::move(collection)) {}

  Row* find(const std::string& id) {
    const auto row = _rows.find(id);
    return row == _rows.end() ? nullptr : &row->second;
  }
  const Row* find(const std::string& id) const { return const_cast<Table*>(this)->find(id); }

  Row& get(const std::string& id) {
    Row* row = find(id);
    if (row == nullptr) {
      throw unknown(_collection, id);
    }
    return *row;
  }

  void insert(std::shared_ptr<const Record> record) {
    const std::string& id = record->id;
    const auto order = _order.emplace(++_last, id).first;
    try {
      _rows.insert_or_assign(id, Row{_last, record, {}});
    } catch (...) {
      _order.erase(order);
      throw;
    }
  }

  void erase(const std::string& id) {
    const Row& row = get(id);
    _order.erase(row.number);
    _rows.erase(id);
  }

  std::vector<std::shared_ptr<const Record>> page(const std::string& after,
                                                  std::size_t count) const {
    auto next = _order.begin();
    if (!after.empty()) {
      const Row* row = find(after);
      if (row == nullptr) {
        throw unknown(_collection, after);
      }
      next = _order.upper_bound(row->number);
    }
    std::vector<std::shared_ptr<const Record>> records;
    for (; next != _order.end() && records.size() < count; ++next) {
      records.push_back(_rows.at(next->second).record);
    }
    return records;
  }

 private:
  std::string _collection;
  std::uint64_t _last = 0;
  std::unordered_map<std::string, Row> _rows;
  std::map<std::uint64_t, std::string, std::greater<>> _order;  ///< newest first
};

template <class Record>
std::vector<Record> copies(const std::vector<std::shared_ptr<const Record>>& records) {
  std::vector<Record> result;
  result.reserve(records.size());
  for (const std::shared_ptr<const Record>& record : records) {
    result.push_back(*record);
  }
  return result;
}

struct Triangulation {
  std::shared_ptr<const mesh::Mesh> mesh;
  std::shared_ptr<const Block> block;
};

struct JobCompanion {
  std::string request_id;
  std::shared_ptr<const Block> result;
};

struct Request {
  std::string job;
  std::string fingerprint;
};

class MemoryStore final : public Store {
 public:
  explicit MemoryStore(const std::string& folder)
      : _uploads(std::filesystem::path(folder) / "uploads") {}

  void put(const MeshRecord& record) override {
    auto shared = std::make_shared<const MeshRecord>(record);
    const std::lock_guard lock(_mutex);
    if (auto* row = _meshes.find(record.id)) {
      std::swap(row->record, shared);
    } else {
      _meshes.insert(std::move(shared));
    }
  }

  std::optional<MeshRecord> mesh(const std::string& id) const override {
    return copy_of(_meshes, id);
  }

  std::vector<MeshRecord> meshes(const std::string& after, std::size_t count) const override {
    return page_of(_meshes, after, count);
  }

  void erase_mesh(const std::string& id) override {
    const std::lock_guard lock(_mutex);
    _meshes.erase(id);
  }

  void put_triangulation(const std::string& id, std::shared_ptr<const mesh::Mesh> mesh,
                         std::shared_ptr<const Block> block) override {
    const std::lock_guard lock(_mutex);
    _meshes.get(id).companion = {std::move(mesh), std::move(block)};
  }

  std::shared_ptr<const mesh::Mesh> triangulation(const std::string& id) const override {
    const std::lock_guard lock(_mutex);
    const auto* row = _meshes.find(id);
    return row == nullptr ? nullptr : row->companion.mesh;
  }

  std::shared_ptr<const Block> mesh_block(const std::string& id) const override {
    const std::lock_guard lock(_mutex);
    const auto* row = _meshes.find(id);
    return row == nullptr ? nullptr : row->companion.block;
  }

  JobRecord create(const JobRecord& record, const std::string& request_id,
                   const std::string& fingerprint) override {
    auto shared = std::make_shared<const JobRecord>(record);
    const std::lock_guard lock(_mutex);
    if (!request_id.empty()) {
      if (const auto request = _requests.find(request_id); request != _requests.end()) {
        if (request->second.fingerprint != fingerprint) {
          throw Error(Reason::request_id_reused,
                      "request id \"" + request_id + "\" was used for jobs/" + request->second.job +
                          ", which is another job: make a new request id for each job")
              .at("request_id");
        }
        return *_jobs.get(request->second.job).record;
      }
      _requests.emplace(request_id, Request{record.id, fingerprint});
    }
    _jobs.insert(std::move(shared));
    _jobs.get(record.id).companion.request_id = request_id;
    return record;
  }

  void put(const JobRecord& record) override {
    auto shared = std::make_shared<const JobRecord>(record);
    const std::lock_guard lock(_mutex);
    std::swap(_jobs.get(record.id).record, shared);
  }

  std::optional<JobRecord> job(const std::string& id) const override { return copy_of(_jobs, id); }

  std::vector<JobRecord> jobs(const std::string& after, std::size_t count) const override {
    return page_of(_jobs, after, count);
  }

  void erase_job(const std::string& id) override {
    const std::lock_guard lock(_mutex);
    _requests.erase(_jobs.get(id).companion.request_id);
    _jobs.erase(id);
  }

  void put_result(const std::string& job, std::shared_ptr<const Block> block) override {
    const std::lock_guard lock(_mutex);
    _jobs.get(job).companion.result = std::move(block);
  }

  std::shared_ptr<const Block> result(const std::string& job) const override {
    const std::lock_guard lock(_mutex);
    const auto* row = _jobs.find(job);
    return row == nullptr ? nullptr : row->companion.result;
  }

  std::optional<std::string> upload_path(const std::string& sha256) const override {
    return _uploads.path(sha256);
  }
  std::string new_upload_path() override { return _uploads.new_part(); }
  void keep_upload(const std::string& path, const std::string& sha256) override {
    _uploads.keep(path, sha256);
  }

 private:
  template <class Record, class Companion>
  std::optional<Record> copy_of(const Table<Record, Companion>& table,
                                const std::string& id) const {
    std::shared_ptr<const Record> record;
    {
      const std::lock_guard lock(_mutex);
      if (const auto* row = table.find(id)) {
        record = row->record;
      }
    }
    return record ? std::optional<Record>(*record) : std::nullopt;
  }

  template <class Record, class Companion>
  std::vector<Record> page_of(const Table<Record, Companion>& table, const std::string& after,
                              std::size_t count) const {
    std::vector<std::shared_ptr<const Record>> page;
    {
      const std::lock_guard lock(_mutex);
      page = table.page(after, count);
    }
    return copies(page);
  }

  Uploads _uploads;
  mutable std::mutex _mutex;
  Table<MeshRecord, Triangulation> _meshes{"meshes"};
  Table<JobRecord, JobCompanion> _jobs{"jobs"};
  std::unordered_map<std::string, Request> _requests;
};

}  // namespace

std::unique_ptr<Store> make_memory_store(const std::string& folder) {
  return std::make_unique<MemoryStore>(folder);
}

}  // namespace anticrack::store

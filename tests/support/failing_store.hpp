// SPDX-License-Identifier: GPL-3.0-or-later
//
// A store whose disk is full for a while.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "records/job_record.hpp"
#include "records/mesh_record.hpp"
#include "store/store.hpp"

namespace anticrack::testing {

/// Passes everything on to a real store, but for writes of jobs while they are to fail.
class FailingStore final : public store::Store {
 public:
  explicit FailingStore(store::Store& real) : _real(real) {}

  std::atomic<bool> put_fails{false};
  std::atomic<bool> finish_fails{false};
  std::atomic<int> failures{0};
  std::function<void()> reading_upload = {};  ///< called by whoever asks for one

  void put(const records::MeshRecord& record) override { _real.put(record); }
  void put(const records::MeshRecord& record, const mesh::Mesh& triangulation) override {
    _real.put(record, triangulation);
  }
  std::optional<records::MeshRecord> mesh(const std::string& id) const override {
    return _real.mesh(id);
  }
  std::vector<records::MeshRecord> meshes(const store::Page& page) const override {
    return _real.meshes(page);
  }
  std::size_t mesh_count() const override { return _real.mesh_count(); }
  void erase_mesh(const std::string& id) override { _real.erase_mesh(id); }
  std::shared_ptr<const mesh::Mesh> triangulation(const std::string& sha256) const override {
    return _real.triangulation(sha256);
  }

  records::JobRecord create(const records::JobRecord& record, const std::string& print) override {
    return _real.create(record, print);
  }
  std::optional<records::JobRecord> created_before(const std::string& owner,
                                                   const std::string& request,
                                                   const std::string& print) const override {
    return _real.created_before(owner, request, print);
  }
  void put(const records::JobRecord& record) override {
    fail(put_fails);
    _real.put(record);
  }
  std::shared_ptr<store::Spool> new_spool() override { return _real.new_spool(); }
  void finish(const records::JobRecord& record,
              std::shared_ptr<const records::BlockSource> result) override {
    fail(finish_fails);
    _real.finish(record, std::move(result));
  }
  std::optional<records::JobRecord> job(const std::string& id) const override {
    return _real.job(id);
  }
  std::vector<records::JobRecord> jobs(const store::Page& page) const override {
    return _real.jobs(page);
  }
  std::vector<records::JobRecord> unfinished() const override { return _real.unfinished(); }
  bool set_running(bool running) override {
    fail(put_fails);
    return _real.set_running(running);
  }
  std::vector<store::EndedJob> ended() const override { return _real.ended(); }
  std::shared_ptr<const records::BlockSource> result(const std::string& id) const override {
    return _real.result(id);
  }
  void expire(const std::string& id, records::Clock::time_point now) override {
    _real.expire(id, now);
  }
  void erase_job(const std::string& id) override { _real.erase_job(id); }

  std::optional<std::string> upload_path(const std::string& sha256,
                                         const std::string& owner) const override {
    if (reading_upload) reading_upload();
    return _real.upload_path(sha256, owner);
  }
  std::string new_upload_path(std::uint64_t bytes) override { return _real.new_upload_path(bytes); }
  records::Clock::time_point keep_uploads(const std::vector<store::Upload>& uploads,
                                          const std::string& owner) override {
    return _real.keep_uploads(uploads, owner);
  }
  std::optional<store::UploadRecord> upload(const std::string& sha256,
                                            const std::string& owner) const override {
    return _real.upload(sha256, owner);
  }
  std::vector<store::UploadRecord> uploads(const std::string& owner, const std::string& after,
                                           std::size_t count) const override {
    return _real.uploads(owner, after, count);
  }
  void erase_upload(const std::string& sha256, const std::string& owner) override {
    _real.erase_upload(sha256, owner);
  }
  std::size_t expire_uploads(records::Clock::time_point before) override {
    return _real.expire_uploads(before);
  }
  store::Usage usage() const override { return _real.usage(); }
  std::vector<store::OwnerUsage> owners() const override { return _real.owners(); }

 private:
  void fail(const std::atomic<bool>& fails) {
    if (fails) {
      ++failures;
      throw errors::Error(errors::Reason::disk_full, "no space left");
    }
  }

  store::Store& _real;
};

}  // namespace anticrack::testing

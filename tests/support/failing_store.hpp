// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "errors/errors.hpp"
#include "records/job_record.hpp"
#include "store/durable_store.hpp"

namespace anticrack::testing {

/// A store whose disk is full for jobs while writes of them are to fail.
class FailingStore final : public store::DurableStore {
 public:
  using DurableStore::DurableStore;
  using DurableStore::put;

  std::atomic<bool> put_fails{false};
  std::atomic<bool> finish_fails{false};
  std::atomic<int> failures{0};
  std::function<void()> reading_upload = {};  ///< called by whoever asks for one

  void put(const records::JobRecord& record) override {
    fail(put_fails);
    DurableStore::put(record);
  }
  bool set_running(bool running) override {
    fail(put_fails);
    return DurableStore::set_running(running);
  }
  void finish(const records::JobRecord& record,
              std::shared_ptr<const records::BlockSource> result) override {
    fail(finish_fails);
    DurableStore::finish(record, std::move(result));
  }
  std::optional<std::string> upload_path(const std::string& sha256,
                                         const std::string& owner) const override {
    if (reading_upload) reading_upload();
    return DurableStore::upload_path(sha256, owner);
  }

 private:
  void fail(const std::atomic<bool>& fails) {
    if (!fails) return;
    ++failures;
    throw errors::Error(errors::Reason::disk_full, "no space left");
  }
};

}  // namespace anticrack::testing

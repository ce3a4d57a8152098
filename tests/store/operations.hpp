// SPDX-License-Identifier: GPL-3.0-or-later
//
// Every way to write to a store, one after another, and all that can be read from it. What the
// driver does on a failing disk and what the test expects of it.
#pragma once

#include <cerrno>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "store/disk_errors.hpp"
#include "store/record_fields.hpp"
#include "store/sample_records.hpp"

namespace anticrack::store {

using Operation = std::function<void(Store&)>;

/// The driver opens the store anew before this one.
constexpr std::size_t second_start = 12;

inline void upload(Store& store, const std::string& text, const std::string& owner) {
  const std::string part = store.new_upload_path(text.size());
  std::ofstream file(part, std::ios::binary);
  file << text;
  if (!file.flush()) throw disk_error("write " + part, errno);
  file.close();
  store.keep_uploads({{part, digest::Sha256().add(text).finish()}}, owner);
}

inline std::vector<Operation> operations() {
  const auto job = [](const std::string& id) {
    records::JobRecord record = job_record(id, "ann");
    record.request_id = "request of " + id;
    if (id == "j1") record.spec.title = std::string(6000, 'x');  // more than a page
    return record;
  };
  const auto ended = [job](const std::string& id) {
    records::JobRecord record = job(id);
    record.state = records::JobState::succeeded;
    record.ended = records::Clock::time_point(std::chrono::seconds(7));
    return record;
  };
  const auto create = [job](const std::string& id) {
    return [=](Store& store) { store.create(job(id), "print"); };
  };
  const auto keep = [](const std::string& text, const std::string& owner) {
    return [=](Store& store) { upload(store, text, owner); };
  };
  const auto meshed = [](const std::string& id, int size) {
    return [=](Store& store) { store.put(meshed_record(id, strip(size)), strip(size)); };
  };
  return {
      keep("$MeshFormat", "ann"),
      keep("$MeshFormat", "bob"),
      keep("array", "ann"),
      [](Store& store) {
        records::MeshRecord record = mesh_record("m1", "ann");
        record.definition = records::UploadRef{digest::Sha256().add("$MeshFormat").finish(), {}};
        store.put(record);
      },
      meshed("m1", 3),
      meshed("m2", 3),
      meshed("m3", 40),
      create("j1"),
      create("j2"),
      [=](Store& store) {
        records::JobRecord record = job("j3");
        record.spec.loads.push_back(
            {"load", fem::Array{digest::Sha256().add("array").finish(), false, nullptr}});
        store.create(record, "print");
      },
      [=](Store& store) {
        records::JobRecord record = job("j1");
        record.state = records::JobState::running;
        store.put(record);
      },
      [=](Store& store) { store.finish(ended("j1"), block(1, 20'000)); },
      [=](Store& store) { store.finish(ended("j2"), spooled_block(store)); },
      [](Store& store) { store.expire_uploads(records::Clock::time_point::max()); },
      [=](Store& store) { store.finish(ended("j3"), block(3)); },
      [](Store& store) { store.expire("j1", records::Clock::time_point(std::chrono::seconds(9))); },
      [](Store& store) { store.erase_job("j2"); },
      meshed("m3", 41),
      [](Store& store) { store.erase_mesh("m1"); },
      [](Store& store) { store.erase_mesh("m2"); },
      create("j4"),
      [=](Store& store) { store.finish(ended("j4"), nullptr); },
      [](Store& store) { store.expire_uploads(records::Clock::time_point::max()); },
  };
}

/// Throws std::runtime_error where what was read has not the hash it should have.
inline void require(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error(what);
}

/// All that is in the store, as text; reads every file.
inline std::string content(const Store& store) {
  std::string text;
  for (const records::MeshRecord& mesh : store.meshes({"", 100, {}})) {
    text += anticrack::testing::Listing::of(mesh) + '\n';
    // Reading compares the hash.
    require(mesh.sha256.empty() || store.triangulation(mesh.sha256) != nullptr, "no triangulation");
  }
  for (const records::JobRecord& job : store.jobs({"", 100, {}})) {
    text += anticrack::testing::Listing::of(job) + '\n';
    if (const auto result = store.result(job.id)) {
      std::vector<std::byte> bytes(result->size());
      result->read(0, bytes);
      require(digest::Sha256().add(bytes).finish() == result->sha256(), "a result has changed");
      text += "result " + result->sha256() + '\n';
    }
  }
  for (const records::JobRecord& job : store.unfinished()) text += "unfinished " + job.id + '\n';
  for (const EndedJob& job : store.ended()) {
    text += "ended " + job.id + ' ' + std::to_string(job.result_bytes) + '\n';
  }
  for (const std::string upload : {"$MeshFormat", "array"}) {
    const std::string sha256 = digest::Sha256().add(upload).finish();
    for (const char* owner : {"ann", "bob"}) {
      if (const auto path = store.upload_path(sha256, owner)) {
        std::ifstream file(*path, std::ios::binary);
        require(std::string(std::istreambuf_iterator<char>(file), {}) == upload,
                "an upload has changed");
        text += "upload " + upload + " of " + owner + '\n';
      }
    }
  }
  return text;
}

}  // namespace anticrack::store

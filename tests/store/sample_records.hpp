// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "digest/digest.hpp"
#include "mesh/codec.hpp"
#include "records/case_record.hpp"
#include "records/job_record.hpp"
#include "records/mesh_record.hpp"
#include "store/store.hpp"
#include "support/grid_mesh.hpp"

namespace anticrack::store {

inline records::JobRecord job_record(const std::string& id, const std::string& owner = {}) {
  records::JobRecord record;
  record.id = id;
  record.owner = owner;
  return record;
}

inline records::JobRecord ended_record(const std::string& id, int second = 1) {
  records::JobRecord record = job_record(id);
  record.state = records::JobState::succeeded;
  record.ended = records::Clock::time_point(std::chrono::seconds(second));
  return record;
}

inline records::MeshRecord mesh_record(const std::string& id, const std::string& owner = {}) {
  records::MeshRecord record;
  record.id = id;
  record.owner = owner;
  return record;
}

/// n x 1 squares.
inline mesh::Mesh strip(int n) {
  return anticrack::testing::GridMesh(n, 1, {"strip"}, [](int, int) { return 0; }).mesh;
}

inline records::MeshRecord meshed_record(const std::string& id, const mesh::Mesh& mesh) {
  records::MeshRecord record = mesh_record(id);
  record.sha256 = digest::Sha256().add(mesh::encode(mesh)).finish();
  return record;
}

/// Values of a result that has a file of its own.
constexpr std::size_t many = 5'000;

inline std::shared_ptr<const records::BlockSource> block(double value, std::size_t count = 5,
                                                         const std::string& name = "u") {
  records::BlockBuilder builder;
  builder.add(name, std::vector<double>(count, value));
  return records::in_memory(std::make_shared<const records::Block>(builder.finish()));
}

/// A block that was too large for the memory of its spool.
inline std::shared_ptr<const records::BlockSource> spooled_block(Store& store) {
  const std::shared_ptr<Spool> spool = store.new_spool();
  records::BlockBuilder builder;
  builder.add("u", std::vector<double>(140'000, 2));
  const records::Block part = builder.take();
  SpooledBlock joined(spool);
  joined.add(part.arrays, spool->append(part.bytes));
  return joined.finish();
}

inline std::vector<double> values(const records::BlockSource& source) {
  std::vector<double> read(source.size() / sizeof(double));
  source.read(0, std::as_writable_bytes(std::span(read)));
  return read;
}

}  // namespace anticrack::store

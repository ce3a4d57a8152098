// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mesh/codec.hpp"
#include "store/digest.hpp"
#include "store/store.hpp"
#include "support/grid_mesh.hpp"

namespace anticrack::store {

inline JobRecord job_record(const std::string& id, const std::string& owner = {}) {
  JobRecord record;
  record.id = id;
  record.owner = owner;
  return record;
}

inline JobRecord ended_record(const std::string& id, int second = 1) {
  JobRecord record = job_record(id);
  record.state = JobState::succeeded;
  record.ended = Clock::time_point(std::chrono::seconds(second));
  return record;
}

inline MeshRecord mesh_record(const std::string& id, const std::string& owner = {}) {
  MeshRecord record;
  record.id = id;
  record.owner = owner;
  return record;
}

/// n x 1 squares.
inline mesh::Mesh strip(int n) {
  return anticrack::testing::GridMesh(n, 1, {"strip"}, [](int, int) { return 0; }).mesh;
}

inline MeshRecord meshed_record(const std::string& id, const mesh::Mesh& mesh) {
  MeshRecord record = mesh_record(id);
  record.sha256 = Sha256().add(mesh::encode(mesh)).finish();
  return record;
}

/// Values of a result that has a file of its own.
constexpr std::size_t many = 5'000;

inline std::shared_ptr<const BlockSource> block(double value, std::size_t count = 5,
                                                const std::string& name = "u") {
  BlockBuilder builder;
  builder.add(name, std::vector<double>(count, value));
  return in_memory(std::make_shared<const Block>(builder.finish()));
}

/// A block that was too large for the memory of its spool.
inline std::shared_ptr<const BlockSource> spooled_block(Store& store) {
  const std::shared_ptr<Spool> spool = store.new_spool();
  BlockBuilder builder;
  builder.add("u", std::vector<double>(140'000, 2));
  const Block part = builder.take();
  SpooledBlock joined(spool);
  joined.add(part.arrays, spool->append(part.bytes));
  return joined.finish();
}

inline std::vector<double> values(const BlockSource& source) {
  std::vector<double> read(source.size() / sizeof(double));
  source.read(0, std::as_writable_bytes(std::span(read)));
  return read;
}

}  // namespace anticrack::store

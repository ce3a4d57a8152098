// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "jobs/engine_support.hpp"

namespace anticrack::jobs {

constexpr double mesh_size = 0.25;
/// LoadCaseAnswer.Status
constexpr std::int32_t converged = 3, not_converged = 4, failed = 5, cancelled = 6;

/// Uploads the values as a client would; returns the sha256.
inline std::string upload(anticrack::testing::Backend& backend, const std::vector<double>& values,
                          const std::string& owner = {}) {
  const std::string bytes(reinterpret_cast<const char*>(values.data()),
                          values.size() * sizeof(double));
  return backend.upload(bytes, owner).sha256;
}

/// Eighths between -2 and 2, which are decimal numbers too: loads of both signs open and close the
/// cracks.
inline std::vector<double> eighths(std::size_t count, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::vector<double> values(count);
  for (double& value : values) {
    value = (static_cast<double>(random() % 33) - 16) / 8;
  }
  return values;
}

inline std::size_t node_count(const anticrack::testing::Backend& backend, const std::string& mesh) {
  return static_cast<std::size_t>(backend.catalogue.get(mesh).node_count);
}

/// 1, x and y, combined by a matrix with three columns.
inline records::JobSpec combinations(const std::string& mesh, const std::string& matrix) {
  records::JobSpec spec;
  spec.mesh = mesh;
  spec.loads = {{"one", 1.0}, {"x", fem::Expression{"x"}}, {"y", fem::Expression{"y"}}};
  spec.solver = contact::ActiveSetOptions{};
  spec.sweep.emplace().upload = matrix;
  return spec;
}

inline records::JobSpec nodal_forces(const std::string& mesh, const std::string& matrix) {
  records::JobSpec spec = combinations(mesh, matrix);
  spec.loads.clear();
  spec.sweep->cases = records::SweepSpec::Cases::nodal_forces;
  return spec;
}

/// The same loads as load cases of a plain job.
inline records::JobSpec one_by_one(const std::string& mesh, const std::vector<double>& matrix) {
  records::JobSpec spec;
  spec.mesh = mesh;
  spec.solver = contact::ActiveSetOptions{};
  for (std::size_t row = 0; row < matrix.size() / 3; ++row) {
    const auto number = [&](std::size_t j) { return std::to_string(matrix[3 * row + j]); };
    const std::string text = "(" + number(0) + ") + (" + number(1) + ")*x + (" + number(2) + ")*y";
    spec.loads.push_back({std::to_string(row), fem::Expression{text}});
  }
  return spec;
}

inline const records::ArrayLayout* layout(const records::BlockSource& block,
                                          const std::string& name) {
  for (const records::ArrayLayout& array : block.arrays()) {
    if (array.name == name) {
      return &array;
    }
  }
  return nullptr;
}

/// Of the events a log has: those that tell of rows.
inline std::vector<RowsEvent> rows_told(const EventLog& log) {
  std::vector<RowsEvent> rows;
  for (const NumberedEvent& event : log.read(log.earliest() - 1, SIZE_MAX)) {
    if (const auto* told = std::get_if<RowsEvent>(&event.event)) {
      rows.push_back(*told);
    }
  }
  return rows;
}

}  // namespace anticrack::jobs

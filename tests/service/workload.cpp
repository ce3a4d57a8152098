// SPDX-License-Identifier: GPL-3.0-or-later
#include "service/workload.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "service/processes.hpp"
#include "support/case_file.hpp"

namespace anticrack::service_test {
namespace {

constexpr double tolerance = 1e-12;

std::vector<double> values(const client::Block& block, const v1::ArrayLayout& array) {
  std::size_t count = 1;
  for (const std::uint64_t extent : array.shape()) count *= extent;
  std::vector<double> result(count);
  const std::byte* begin = block.bytes.data() + array.offset();
  if (array.type() == v1::ArrayLayout::TYPE_FLOAT64) {
    std::memcpy(result.data(), begin, count * sizeof(double));
    return result;
  }
  std::vector<std::int32_t> integers(count);
  std::memcpy(integers.data(), begin, count * sizeof(std::int32_t));
  std::copy(integers.begin(), integers.end(), result.begin());
  return result;
}

bool close(const std::vector<double>& a, const std::vector<double>& b) {
  double scale = 0;
  for (const double value : b) scale = std::max(scale, std::abs(value));
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](double x, double y) {
    return std::abs(x - y) <= tolerance * scale || (std::isnan(x) && std::isnan(y));
  });
}

// Residuals near rounding differ in every digit; the numbers of iterations do not.
bool compared(const std::string& name) {
  return name.find("/history/") == std::string::npos || name.ends_with("/iteration");
}

}  // namespace

Work work(const std::string& name, const std::vector<std::string>& overrides) {
  const casefile::Case the_case = testing::read_case_file(example(name), overrides);
  return {name, the_case.mesh, the_case.spec};
}

std::vector<std::string> iterations(int count) {
  return {"solver.method=uzawa", "solver.theta=1e-4", "solver.epsilon=1e-300",
          "solver.max_iterations=" + std::to_string(count)};
}

/// Half a dozen stages.
Work in_stages() {
  Work accurate = work("several-inclusions.toml");
  accurate.name += " (accuracy)";
  accurate.mesh.mutable_options()->set_preset(v1::MESH_PRESET_COARSE);
  accurate.spec.mutable_accuracy()->set_energy(2e-3);
  return accurate;
}

std::vector<Work> mixed_work() {
  const std::vector<std::string> coarse{"mesh.preset=uniform", "mesh.size=0.1"};
  return {work("paper.toml", iterations(200)),
          work("paper-3.toml", iterations(20'000)),
          work("slit.toml", coarse),
          work("slit.toml"),
          work("arc.toml", coarse),
          work("several-inclusions.toml", coarse),
          in_stages()};
}

v1::Job submit(client::Connection& connection, const Work& work, const std::string& request_id) {
  v1::JobSpec spec = work.spec;
  spec.set_mesh(client::create_mesh(connection, work.mesh).name());
  if (!work.array.empty()) {
    spec.mutable_load_cases(0)->mutable_force()->mutable_array()->set_upload(
        client::upload_array(connection, work.array));
  }
  return client::create_job(connection, spec, request_id);
}

v1::Job wait_for_end(client::Connection& connection, const std::string& name) {
  return client::watch_job(connection, name, 0, [](const v1::WatchJobResponse&) {});
}

bool ran_to_its_end(const v1::Job& job) {
  return job.status().state() == v1::JobStatus::STATE_SUCCEEDED ||
         (job.status().state() == v1::JobStatus::STATE_NOT_CONVERGED && !job.status().has_error());
}

std::string difference(const client::Block& result, const client::Block& reference) {
  if (result.layout.arrays_size() != reference.layout.arrays_size()) return "other arrays";
  for (int i = 0; i < result.layout.arrays_size(); ++i) {
    const v1::ArrayLayout& array = result.layout.arrays(i);
    const v1::ArrayLayout& other = reference.layout.arrays(i);
    const bool same_shape = std::equal(array.shape().begin(), array.shape().end(),
                                       other.shape().begin(), other.shape().end());
    if (array.name() != other.name() || !same_shape) return array.name() + " has another shape";
    if (compared(array.name()) && !close(values(result, array), values(reference, other))) {
      return array.name() + " has other values";
    }
  }
  return "";
}

}  // namespace anticrack::service_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>
#include <utility>

#include "rpc/names.hpp"
#include "rpc/to_domain.hpp"
#include "store/digest.hpp"

namespace anticrack::rpc {
namespace {

using errors::Error;
using errors::Reason;

std::string packed_sha256(const std::string& packed, const std::string& field) {
  if (packed.size() > max_packed_bytes) {
    throw Error(Reason::limit_exceeded,
                "a matrix of " + std::to_string(packed.size()) + " bytes: at most " +
                    std::to_string(max_packed_bytes) +
                    " come with a job; upload it with UploadMesh as CONTENT_ARRAY and name it in "
                    "`upload`")
        .at(field);
  }
  if (packed.empty() || packed.size() % sizeof(double) != 0) {
    throw Error(Reason::invalid_argument, "a matrix of " + std::to_string(packed.size()) +
                                              " bytes: give at least one value, and for each 8 "
                                              "(f64, little-endian)")
        .at(field);
  }
  return store::Sha256().add(packed).finish();
}

std::string matrix_sha256(const v1::Sweep::Matrix& matrix, const std::string& field) {
  switch (matrix.source_case()) {
    case v1::Sweep::Matrix::kPacked:
      return packed_sha256(matrix.packed(), field + ".packed");
    case v1::Sweep::Matrix::kUpload:
      return upload_sha256(matrix.upload(), field + ".upload");
    case v1::Sweep::Matrix::SOURCE_NOT_SET:
      break;
  }
  throw Error(Reason::invalid_argument, "the matrix has no values; set packed or upload").at(field);
}

}  // namespace

MatrixOf matrix_of(const v1::Sweep& sweep) {
  switch (sweep.cases_case()) {
    case v1::Sweep::kCoefficients:
      return {&sweep.coefficients(), "sweep.coefficients"};
    case v1::Sweep::kNodalForces:
      return {&sweep.nodal_forces(), "sweep.nodal_forces"};
    case v1::Sweep::CASES_NOT_SET:
      break;
  }
  return {nullptr, "sweep"};
}

store::SweepSpec to_sweep(const v1::Job& job, const JobLimits& limits) {
  const v1::Sweep& sweep = job.sweep();
  const auto [matrix, path] = matrix_of(sweep);
  const std::string field = std::string("job.") + path;
  if (matrix == nullptr) {
    throw Error(Reason::invalid_argument,
                "the sweep has no cases; set coefficients or nodal_forces")
        .at(field);
  }
  if (sweep.traces_size() > limits.load_cases) {
    throw Error(Reason::limit_exceeded, "traces of " + std::to_string(sweep.traces_size()) +
                                            " rows: at most " + std::to_string(limits.load_cases) +
                                            " are kept (see GetServerInfo)")
        .at("job.sweep.traces");
  }
  store::SweepSpec spec;
  spec.cases = sweep.has_coefficients() ? store::SweepSpec::Cases::combinations
                                        : store::SweepSpec::Cases::nodal_forces;
  spec.upload = matrix_sha256(*matrix, field);
  spec.traces = {sweep.traces().begin(), sweep.traces().end()};
  return spec;
}

}  // namespace anticrack::rpc

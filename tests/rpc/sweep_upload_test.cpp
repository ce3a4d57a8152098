// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/sweep_upload.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "api/requests.hpp"
#include "rpc/refusals.hpp"
#include "rpc/requests.hpp"
#include "store/array_upload.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::opening_job;
using anticrack::testing::packed;
using anticrack::testing::sweep_job;
using api::max_packed_bytes;
using api::to_spec;
using errors::Reason;

class SweepUpload : public ::testing::Test {
 protected:
  std::size_t files() const {
    const std::filesystem::directory_iterator folder(_folder / "uploads");
    return static_cast<std::size_t>(std::distance(begin(folder), end(folder)));
  }

  anticrack::testing::TemporaryFolder _folder;
  std::unique_ptr<store::Store> _store = store::open({_folder.path()});
};

TEST_F(SweepUpload, KeepsTheMatrixUnderTheNameTheJobGivesIt) {
  const v1::JobSpec job = sweep_job("meshes/a", {1, 2.5, -3}).spec();
  keep_packed_matrix(job, *_store, "ada");
  const std::string sha256 = to_spec(job, {10}).sweep->upload;
  const auto path = _store->upload_path(sha256, "ada");
  ASSERT_TRUE(path);
  EXPECT_EQ(store::read_array(*path), (std::vector<double>{1, 2.5, -3}));
  EXPECT_FALSE(_store->upload_path(sha256, "bob"));
}

TEST_F(SweepUpload, OfTheSameMatrixIsOne) {
  const v1::JobSpec job = sweep_job("meshes/a", {1, 2.5, -3}).spec();
  keep_packed_matrix(job, *_store, "ada");
  keep_packed_matrix(job, *_store, "ada");
  keep_packed_matrix(job, *_store, "bob");
  EXPECT_EQ(files(), 1u);
}

TEST_F(SweepUpload, KeepsAMatrixOfAMegabyte) {
  v1::JobSpec job = sweep_job("meshes/a", {}).spec();
  job.mutable_sweep()->mutable_nodal_forces()->set_packed(std::string(max_packed_bytes, '\0'));
  keep_packed_matrix(job, *_store, "ada");
  EXPECT_EQ(files(), 1u);
}

TEST_F(SweepUpload, OfWhatIsNoMatrixLeavesNothing) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    expect_refused(
        [&] {
          keep_packed_matrix(sweep_job("meshes/a", {1, bad}).spec(), *_store, "ada");
        },
        Reason::invalid_argument, "sweep.coefficients.packed");
  }
  v1::JobSpec job = sweep_job("meshes/a", {}).spec();
  job.mutable_sweep()->mutable_nodal_forces()->set_packed("$MeshFormat\n2.2 ");
  expect_refused([&] { keep_packed_matrix(job, *_store, "ada"); }, Reason::invalid_argument,
                 "sweep.nodal_forces.packed");
  EXPECT_EQ(files(), 0u);
}

TEST(HasPackedMatrix, IsTrueOfWhatCameWithTheJobAlone) {
  v1::JobSpec job = opening_job("meshes/a").spec();
  EXPECT_FALSE(has_packed_matrix(job));
  job.mutable_sweep();
  EXPECT_FALSE(has_packed_matrix(job));
  job.mutable_sweep()->mutable_coefficients()->set_upload("uploads/a");
  EXPECT_FALSE(has_packed_matrix(job));
  job.mutable_sweep()->mutable_nodal_forces()->set_packed("12345678");
  EXPECT_TRUE(has_packed_matrix(job));
}

}  // namespace
}  // namespace anticrack::rpc

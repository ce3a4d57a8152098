// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "client/sample_sweep.hpp"
#include "results/file.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::results {
namespace {

using anticrack::testing::same;
using anticrack::testing::sample_sweep;
using anticrack::testing::TemporaryFolder;
using anticrack::testing::tilting_sweep;
using ::testing::HasSubstr;

Result written_and_read(const Result& result) {
  const TemporaryFolder folder;
  write(folder / "a.h5", result);
  return read(folder / "a.h5");
}

TEST(SweepFile, ComesBackAsItWasWritten) {
  Result result = sample_sweep(3000);  // large enough for compressed datasets
  result.sweep->error = "row 7: the load is not finite";
  const Result back = written_and_read(result);
  ASSERT_TRUE(back.sweep);
  EXPECT_TRUE(same(*back.sweep, *result.sweep));
  ASSERT_EQ(back.loads.size(), 2U);
  EXPECT_EQ(back.loads[1].name(), "row-2999");
  EXPECT_EQ(back.loads[1].traces[0].jump, result.loads[1].traces[0].jump);
}

TEST(SweepFile, HasSlopesInThreeDimensions) {
  for (const std::size_t rows : {5, 3000}) {  // in a header, and compressed
    Result result = tilting_sweep(rows);
    Sweep& sweep = *result.sweep;
    sweep.inclusions.emplace_back("other");
    sweep.displacement.insert(sweep.displacement.end(), rows, 0.0);
    sweep.slope.insert(sweep.slope.end(), 2 * rows, 0.75);
    const TemporaryFolder folder;
    write(folder / "a.h5", result);
    EXPECT_TRUE(same(*read(folder / "a.h5").sweep, sweep));
    const hid_t file = H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t set = H5Dopen2(file, "/sweep/slope", H5P_DEFAULT);
    const hid_t space = H5Dget_space(set);
    std::array<hsize_t, 3> shape{};
    ASSERT_EQ(H5Sget_simple_extent_ndims(space), 3);
    H5Sget_simple_extent_dims(space, shape.data(), nullptr);
    EXPECT_EQ(shape, (std::array<hsize_t, 3>{rows, 2, 2}));
    H5Sclose(space);
    H5Dclose(set);
    H5Fclose(file);
  }
}

TEST(SweepFile, HasBoundsWhereTheyWereAskedFor) {
  Result result = anticrack::testing::bounded_sweep(5);
  const Sweep back = *written_and_read(result).sweep;
  EXPECT_TRUE(std::isnan(back.energy_lower.back()) && std::isnan(back.displacement_upper.back()));
  for (const auto& [name, member] : std::map<std::string, std::vector<double> Sweep::*>{
           {"energy_lower", &Sweep::energy_lower},
           {"energy_upper", &Sweep::energy_upper},
           {"energy_mesh", &Sweep::energy_mesh},
           {"displacement_lower", &Sweep::displacement_lower},
           {"displacement_upper", &Sweep::displacement_upper},
           {"displacement_mesh", &Sweep::displacement_mesh}}) {
    std::vector<double> read = back.*member, wanted = (*result.sweep).*member;
    read.pop_back();
    wanted.pop_back();
    EXPECT_EQ(read, wanted) << name;
    Result other = result;
    ((*other.sweep).*member).clear();
    EXPECT_THAT(first_fault(other), HasSubstr("sweep has some of its bounds")) << name;
    ((*other.sweep).*member).assign(4, 0.0);
    EXPECT_THAT(first_fault(other), HasSubstr("sweep." + name + " has 4 entries instead of 5"));
  }
  EXPECT_TRUE(written_and_read(sample_sweep(5)).sweep->energy_lower.empty());
}

TEST(SweepFile, RefusesSlopesOfAnotherShape) {
  const TemporaryFolder folder;
  write(folder / "a.h5", tilting_sweep(5));
  const hid_t file = H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(H5Ldelete(file, "/sweep/slope", H5P_DEFAULT), 0);
  ASSERT_GE(H5Lcopy(file, "/sweep/displacement", file, "/sweep/slope", H5P_DEFAULT, H5P_DEFAULT),
            0);
  H5Fclose(file);
  try {
    read(folder / "a.h5");
    ADD_FAILURE() << "was read";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("dataset slope is not of shape (n,1,2)"));
  }
}

TEST(SweepFile, HoldsASweepWithoutCoefficientsInclusionsAndCracks) {
  Result result = sample_sweep(3);
  Sweep& sweep = *result.sweep;
  sweep.coefficients.clear();
  sweep.loads.clear();
  sweep.inclusions.clear();
  sweep.displacement.clear();
  sweep.contact.clear();
  sweep.contact_nodes.clear();
  sweep.kept.clear();
  result.loads.clear();
  const Result back = written_and_read(result);
  ASSERT_TRUE(back.sweep);
  EXPECT_TRUE(same(*back.sweep, sweep));
}

using Spoil = std::function<void(Result&)>;

TEST(Sweep, IsNotWrittenFromWhatDoesNotFitTogether) {
  const std::vector<std::pair<std::string, Spoil>> table{
      {"sweep.steps has 20 entries instead of 21", [](Result& r) { r.sweep->steps.pop_back(); }},
      {"sweep.energy", [](Result& r) { r.sweep->energy.pop_back(); }},
      {"sweep.contact_length", [](Result& r) { r.sweep->contact_length.pop_back(); }},
      {"sweep.kkt", [](Result& r) { r.sweep->kkt.pop_back(); }},
      {"sweep.displacement", [](Result& r) { r.sweep->inclusions.emplace_back("other"); }},
      {"sweep.slope has 40 entries instead of 42",
       [](Result& r) { r.sweep->slope.assign(40, 0.0); }},
      {"sweep.contact has", [](Result& r) { r.sweep->contact.pop_back(); }},
      {"sweep.contact_nodes has", [](Result& r) { r.sweep->contact_nodes.push_back(0); }},
      {"sweep.coefficients", [](Result& r) { r.sweep->coefficients.pop_back(); }},
      {"sweep.status[3] is 9, no status", [](Result& r) { r.sweep->status[3] = 9; }},
      {"sweep counts other rows than its 21", [](Result& r) { r.sweep->answer.set_rows(20); }},
      {"sweep counts other rows than its 21",
       [](Result& r) { r.sweep->answer.set_failed(std::uint64_t{1} << 63); }},
      {"sweep.kept[1] is 21", [](Result& r) { r.sweep->kept[1] = 21; }},
      {"sweep.kept[1] is 0", [](Result& r) { r.sweep->kept[1] = 0; }},
      {"sweep.kept[0] is -1", [](Result& r) { r.sweep->kept[0] = -1; }},
      {"loads has 1 entries for 2 kept rows", [](Result& r) { r.loads.pop_back(); }},
  };
  EXPECT_EQ(first_fault(sample_sweep()), "");
  for (const auto& [fault, spoil] : table) {
    Result result = sample_sweep();
    spoil(result);
    EXPECT_THAT(first_fault(result), HasSubstr(fault));
    const TemporaryFolder folder;
    EXPECT_THROW(write(folder / "a.h5", result), Error) << fault;
  }
}

TEST(SweepSummary, SpansTheConvergedRows) {
  Result result = sample_sweep(5);  // row 3 did not converge
  result.sweep->status[2] = v1::LoadCaseAnswer::STATUS_FAILED;
  result.sweep->status[1] = v1::LoadCaseAnswer::STATUS_CANCELLED;
  const SweepSummary counts = summary(*result.sweep);
  EXPECT_DOUBLE_EQ(counts.displacement.at(0).low, -0.1);
  EXPECT_DOUBLE_EQ(counts.displacement.at(0).high, 0.1);
  EXPECT_FALSE(counts.tilted());
  EXPECT_DOUBLE_EQ(counts.energy.low, -2);
}

TEST(SweepSummary, TellsTheWidestBounds) {
  const SweepSummary counts = summary(*anticrack::testing::bounded_sweep(5).sweep);
  EXPECT_EQ(counts.bounded, 3U) << "a row did not converge, another has none";
  EXPECT_NEAR(counts.energy_width, 0.005, 1e-12);
  EXPECT_NEAR(counts.displacement_error, 0.01, 1e-12);
  EXPECT_TRUE(std::isnan(summary(*sample_sweep(5).sweep).energy_width));
}

TEST(SweepSummary, SpansTheSlopes) {
  const SweepSummary counts = summary(*tilting_sweep(5).sweep);  // row 3 did not converge
  EXPECT_TRUE(counts.tilted());
  EXPECT_DOUBLE_EQ(counts.slope.at(0)[0].low, -0.2);
  EXPECT_DOUBLE_EQ(counts.slope.at(0)[0].high, 0.2);
  EXPECT_EQ(counts.slope.at(0)[1].high, -0.5);
}

TEST(SweepSummary, KnowsNoRangeWhereNothingConverged) {
  Result result = sample_sweep(3);
  result.sweep->status.assign(3, v1::LoadCaseAnswer::STATUS_FAILED);
  const SweepSummary counts = summary(*result.sweep);
  EXPECT_TRUE(std::isnan(counts.energy.low));
  EXPECT_TRUE(std::isnan(counts.displacement.at(0).high));
}

}  // namespace
}  // namespace anticrack::results

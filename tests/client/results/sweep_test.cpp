// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <array>
#include <cmath>
#include <functional>
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
using anticrack::testing::values_of;
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
  EXPECT_EQ(back.arrays.count("loads/row-2999/traces/0/u_plus"), 1U);
}

TEST(SweepFile, HasSlopesInThreeDimensions) {
  for (const std::size_t rows : {5, 3000}) {  // in a header, and compressed
    Result result = tilting_sweep(rows);
    Sweep& sweep = *result.sweep;
    sweep.inclusions.emplace_back("other");
    sweep.columns["displacement"] = array_of(std::vector<double>(2 * rows, 0.5), {2});
    sweep.columns["slope"] = array_of(std::vector<double>(4 * rows, 0.75), {2, 2});
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

TEST(SweepFile, HasBoundsAndTipsWhereTheyWereAskedFor) {
  Result result = anticrack::testing::bounded_sweep(5);
  for (const char* of_tips : {"intensity", "energy_release_rate", "energy_release_rate_spread"})
    result.sweep->columns[of_tips] = array_of(std::vector<double>(10, 0.5), {2});
  EXPECT_TRUE(same(*written_and_read(result).sweep, *result.sweep));
  for (const char* name : {"energy_lower", "energy_upper", "energy_mesh", "displacement_lower",
                           "displacement_upper", "displacement_mesh"}) {
    Result other = result;
    other.sweep->columns.erase(name);
    EXPECT_THAT(first_fault(other), HasSubstr("sweep has some of its bounds")) << name;
  }
  EXPECT_TRUE(written_and_read(sample_sweep(5)).sweep->numbers("energy_lower").empty());
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
    EXPECT_THAT(error.what(),
                HasSubstr("dataset slope is not of shape (rows,inclusions,2) but (5,1)"));
  }
}

TEST(SweepFile, HoldsASweepWithoutCoefficientsInclusionsAndCracks) {
  Result result = sample_sweep(3);
  Sweep& sweep = *result.sweep;
  sweep.loads.clear();
  sweep.inclusions.clear();
  for (const char* name : {"coefficients", "displacement", "contact"}) sweep.columns.erase(name);
  sweep.columns["contact_nodes"] = array_of(std::vector<std::int32_t>(), {2});
  sweep.columns["kept"] = array_of(std::vector<std::int32_t>());
  result.loads.clear();
  const Result back = written_and_read(result);
  ASSERT_TRUE(back.sweep);
  EXPECT_TRUE(same(*back.sweep, sweep));
}

using Spoil = std::function<void(Result&)>;

TEST(Sweep, IsNotWrittenFromWhatDoesNotFitTogether) {
  const std::vector<std::pair<std::string, Spoil>> table{
      {"sweep.status[3] is 9, no status",
       [](Result& r) { values_of<std::int32_t>(r.sweep->columns, "status")[3] = 9; }},
      {"sweep counts other rows than its 21", [](Result& r) { r.sweep->answer.set_rows(20); }},
      {"sweep counts other rows than its 21",
       [](Result& r) { r.sweep->answer.set_failed(std::uint64_t{1} << 63); }},
      {"sweep.kept[1] is 21",
       [](Result& r) { values_of<std::int32_t>(r.sweep->columns, "kept")[1] = 21; }},
      {"sweep.kept[1] is 0",
       [](Result& r) { values_of<std::int32_t>(r.sweep->columns, "kept")[1] = 0; }},
      {"sweep.kept[0] is -1",
       [](Result& r) { values_of<std::int32_t>(r.sweep->columns, "kept")[0] = -1; }},
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

TEST(RangeOf, SpansTheConvergedRows) {
  Result result = sample_sweep(5);  // row 3 did not converge
  const auto status = values_of<std::int32_t>(result.sweep->columns, "status");
  status[2] = v1::LoadCaseAnswer::STATUS_FAILED;
  status[1] = v1::LoadCaseAnswer::STATUS_CANCELLED;
  EXPECT_DOUBLE_EQ(range_of(*result.sweep, "displacement").low, -0.1);
  EXPECT_DOUBLE_EQ(range_of(*result.sweep, "displacement").high, 0.1);
  EXPECT_FALSE(slope_range(*result.sweep, 0, 0).nonzero());
  EXPECT_DOUBLE_EQ(range_of(*result.sweep, "energy").low, -2);
}

TEST(WidthsOf, AreTheWidestBounds) {
  const Widths widths = widths_of(*anticrack::testing::bounded_sweep(5).sweep);
  EXPECT_EQ(widths.rows, 3U) << "a row did not converge, another has none";
  EXPECT_NEAR(widths.energy, 0.005, 1e-12);
  EXPECT_NEAR(widths.displacement, 0.01, 1e-12);
  EXPECT_TRUE(std::isnan(widths_of(*sample_sweep(5).sweep).energy));
}

TEST(RangeOf, SpansTheSlopes) {
  const Result result = tilting_sweep(5);  // row 3 did not converge
  EXPECT_DOUBLE_EQ(slope_range(*result.sweep, 0, 0).low, -0.2);
  EXPECT_DOUBLE_EQ(slope_range(*result.sweep, 0, 0).high, 0.2);
  EXPECT_EQ(slope_range(*result.sweep, 0, 1).high, -0.5);
}

TEST(RangeOf, IsUnknownWhereNothingConverged) {
  Result result = sample_sweep(3);
  std::ranges::fill(values_of<std::int32_t>(result.sweep->columns, "status"),
                    v1::LoadCaseAnswer::STATUS_FAILED);
  EXPECT_TRUE(std::isnan(range_of(*result.sweep, "energy").low));
  EXPECT_TRUE(std::isnan(range_of(*result.sweep, "displacement").high));
}

}  // namespace
}  // namespace anticrack::results

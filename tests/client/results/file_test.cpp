// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <thread>

#include "client/sample_sweep.hpp"
#include "results/entries.hpp"
#include "results/tables.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::results {
namespace {

namespace fs = std::filesystem;
using anticrack::testing::same;
using anticrack::testing::sample_result;
using anticrack::testing::TemporaryFolder;
using anticrack::testing::with_stages;
using ::testing::HasSubstr;

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t files_in(const std::string& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// The same bits, of NaN too.
std::string bits(const google::protobuf::Message& message) { return message.SerializeAsString(); }

/// What is read, each number and array on its own for the message. Python's tests compare the rest
/// of a file with what the server tells.
void expect_same(const Result& a, const Result& b) {
  const auto expect_same_rows = [](const auto& x, const auto& y, const auto&... table) {
    arrays::for_each(
        [&](const auto& row) {
          const auto &one = std::invoke(row.member, x), &other = std::invoke(row.member, y);
          EXPECT_TRUE(one == other || (one != one && other != other)) << row.name;
        },
        table...);
  };
  expect_same_rows(a, b, tables::result);
  EXPECT_EQ(a.mesh.DebugString(), b.mesh.DebugString());
  EXPECT_EQ(a.solver.DebugString(), b.solver.DebugString());
  // Of the arrays those that are shown.
  for (const auto& [path, array] : a.arrays) EXPECT_TRUE(b.arrays.contains(path)) << path;
  for (const auto& [path, array] : b.arrays) {
    const bool read = path == "mesh/nodes" || path.find("/u") != path.npos;
    EXPECT_EQ(a.arrays.contains(path), read) << path;
    if (read) {
      EXPECT_TRUE(same({{path, a.arrays.at(path)}}, {{path, array}})) << path;
    }
  }
  ASSERT_EQ(a.loads.size(), b.loads.size());
  for (std::size_t i = 0; i < a.loads.size(); ++i) {
    const Load &one = a.loads[i], &other = b.loads[i];
    EXPECT_EQ(bits(one.answer), bits(other.answer))
        << one.answer.DebugString() << other.answer.DebugString();
    EXPECT_TRUE(std::ranges::equal(one.stages, other.stages, {}, bits, bits));
  }
  EXPECT_EQ(a.sweep.has_value(), b.sweep.has_value());
}

TEST(File, comes_back_as_it_was_written) {
  const TemporaryFolder folder;
  const Result result = sample_result(40);  // large enough for compressed datasets
  write(folder / "a.h5", result);
  expect_same(read(folder / "a.h5"), result);
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(File, keeps_the_order_of_the_loads) {
  const TemporaryFolder folder;
  Result result = sample_result(2);
  result.arrays.clear();
  result.loads[0].answer.set_name("z");
  result.loads[1].answer.set_name("10");
  result.loads.push_back(result.loads[0]);
  result.loads[2].answer.set_name("2");
  write(folder / "a.h5", result);
  const Result back = read(folder / "a.h5");
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(back.loads[i].name(), result.loads[i].name());
}

TEST(File, holds_a_failed_load_and_an_empty_result) {
  const TemporaryFolder folder;
  Result result = sample_result(2);
  v1::LoadCaseAnswer& failed = result.loads[0].answer;
  failed.set_status(v1::LoadCaseAnswer::STATUS_FAILED);
  failed.mutable_error()->set_message("f is not finite at (0, 0)");
  failed.clear_inclusions();
  forget_numbers(failed);
  std::erase_if(result.arrays,
                [](const auto& item) { return item.first.starts_with("loads/opening/"); });
  write(folder / "a.h5", result);
  expect_same(read(folder / "a.h5"), result);
  write(folder / "b.h5", Result{});
  EXPECT_TRUE(read(folder / "b.h5").loads.empty());
}

TEST(File, keeps_how_inclusions_tilt) {
  const TemporaryFolder folder;
  Result result = sample_result(2);
  v1::InclusionAnswer& inclusion = *result.loads[1].answer.mutable_inclusions(0);
  inclusion.set_slope_x(0.25);
  inclusion.set_slope_y(-1e-17);
  inclusion.set_slope_x_lower(0.2);
  write(folder / "a.h5", result);
  expect_same(read(folder / "a.h5"), result);
}

TEST(File, keeps_stages) {
  const TemporaryFolder folder;
  Result result = with_stages(sample_result(40));
  result.loads[1].stages = {};
  result.loads[0].stages.back().set_triangles(std::uint64_t{1} << 40);
  result.loads[0].stages[1].mutable_answers(0)->clear_displacement_error();
  write(folder / "a.h5", result);
  expect_same(read(folder / "a.h5"), result);
}

TEST(File, holds_a_case_larger_than_an_attribute_of_hdf5) {
  const TemporaryFolder folder;
  Result result = sample_result(2);
  result.case_text = std::string(300'000, '#');
  write(folder / "a.h5", result);
  EXPECT_EQ(read(folder / "a.h5").case_text, result.case_text);
}

TEST(File, of_the_same_result_has_the_same_bytes) {
  const TemporaryFolder folder;
  const Result result = sample_result(8);
  write(folder / "a.h5", result);
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5's times are in seconds
  write(folder / "b.h5", result);
  EXPECT_EQ(bytes_of(folder / "a.h5"), bytes_of(folder / "b.h5"));
}

TEST(File, is_not_written_from_an_inconsistent_result) {
  const TemporaryFolder folder;
  Result result = sample_result(2);
  result.loads[1].answer.set_name("../x");
  EXPECT_THROW(write(folder / "a.h5", result), Error);
  result.loads[1].answer.set_name(result.loads[0].name());
  EXPECT_THROW(write(folder / "a.h5", result), Error);
  result = with_stages(sample_result(2));
  result.loads[1].stages.back().clear_answers();
  EXPECT_EQ(first_fault(result), "loads[1].stages has one without an answer");
  EXPECT_THROW(write(folder / "a.h5", result), Error);
  EXPECT_EQ(files_in(folder.path()), 0u);
}

TEST(File, of_another_case_is_kept) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  Result result = sample_result();
  result.case_text = "one";
  EXPECT_EQ(write(path, result), "");
  const std::string first = bytes_of(path);
  result.job_name = "jobs/fedcba9876543210";
  EXPECT_EQ(write(path, result), "") << "the same case again";
  result.job_name = "jobs/0000000000000000";
  result.case_text = "two";
  EXPECT_EQ(write(path, result), "Kept: " + path + "~, what a.h5 was before");
  EXPECT_EQ(read(path + "~").case_text, "one");
  EXPECT_EQ(read(path).case_text, "two");
  EXPECT_EQ(write(path, result), "");
  EXPECT_EQ(read(path + "~").case_text, "one") << "two runs of two do not lose it";
  result.case_text.clear();
  EXPECT_EQ(write(path, result), "") << "the same job, fetched";
  result.job_name = "jobs/1111111111111111";
  EXPECT_THAT(write(path, result), HasSubstr("Kept")) << "two fetched jobs have no case to compare";
}

TEST(File, that_is_no_result_is_kept) {
  const TemporaryFolder folder;
  const std::string path = folder / "notes.txt";
  std::ofstream(path) << "of a year";
  EXPECT_THAT(write(path, sample_result()), HasSubstr("Kept"));
  EXPECT_EQ(bytes_of(path + "~"), "of a year");
}

TEST(File, of_another_sweep_is_kept) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  Result result = sample_result();
  result.case_text = "one";
  write(path, result);
  result.job_name = "jobs/fedcba9876543210";
  result.sweep.emplace();
  result.loads.clear();
  EXPECT_THAT(write(path, result), HasSubstr("Kept"));
  result.job_name = "jobs/0000000000000000";
  EXPECT_THAT(write(path, result), HasSubstr("Kept")) << "its coefficients may be others";
}

}  // namespace
}  // namespace anticrack::results

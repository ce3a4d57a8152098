// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep_input.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "client/sample_sweep.hpp"
#include "results/file.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::cli {
namespace {

using anticrack::testing::TemporaryFolder;
using ::testing::ElementsAre;

Case two_load_case() {
  Case the_case;
  the_case.spec.add_load_cases()->set_name("skew");
  the_case.spec.add_load_cases()->set_name("opening");
  the_case.spec.add_outputs(v1::OUTPUT_FIELDS);
  the_case.spec.mutable_solver()->mutable_active_set();
  return the_case;
}

std::string written(const TemporaryFolder& folder, const std::string& name,
                    const std::string& text) {
  std::ofstream(folder / name) << text;
  return folder / name;
}

TEST(SweepInput, ReadsTextAndDatasetsAlike) {
  const TemporaryFolder folder;
  const results::Result result = anticrack::testing::sample_sweep(5);
  results::write(folder / "a.h5", result);
  const SweepInput set =
      read_sweep_input({folder / "a.h5:/sweep/coefficients", "", "none"}, two_load_case());
  EXPECT_THAT(set.values, ::testing::ElementsAreArray(result.sweep->numbers("coefficients")));
  EXPECT_EQ(set.rows, 5U);
  EXPECT_EQ(set.columns, 2U);
  const SweepInput text = read_sweep_input(
      {written(folder, "c.csv", "opening,skew\n1,2\n"), "", "all"}, two_load_case());
  EXPECT_THAT(text.values, ElementsAre(2, 1));
  EXPECT_EQ(text.rows, 1U);
  EXPECT_EQ(text.files.traces, "all");
  const SweepInput nodal =
      read_sweep_input({"", folder / "a.h5:/sweep/coefficients", "none"}, two_load_case());
  EXPECT_TRUE(nodal.nodal());
  EXPECT_EQ(nodal.columns, 2U);
}

TEST(SweepInput, LeavesOutTheAccuracyAndItsCoarseMesh) {
  Case the_case = two_load_case();
  EXPECT_FALSE(leave_out_accuracy(the_case));
  for (const bool given : {false, true}) {
    the_case.spec.mutable_accuracy()->set_energy(1e-3);
    the_case.mesh.mutable_options()->set_preset(v1::MESH_PRESET_COARSE);
    if (given) the_case.places["options.preset"].set_where("plate.toml:7");
    EXPECT_TRUE(leave_out_accuracy(the_case));
    EXPECT_FALSE(the_case.spec.has_accuracy());
    EXPECT_EQ(the_case.mesh.options().preset(),
              given ? v1::MESH_PRESET_COARSE : v1::MESH_PRESET_GRADED);
  }
}

SweepInput rows_of_two(std::size_t rows) {
  SweepInput input;
  input.files.coefficients = "c.csv";
  input.files.traces = "none";
  input.rows = rows;
  input.columns = 2;
  input.values.assign(2 * rows, 1.0);
  return input;
}

TEST(MakeSweep, LeavesAJobWithoutFieldsAndWithTheRowsToKeep) {
  Case the_case = two_load_case();
  SweepInput input = rows_of_two(10);
  input.files.traces = "7,1-2";
  input.files.bounds = true;
  make_sweep(input, the_case);
  EXPECT_TRUE(the_case.spec.sweep().bounds());
  EXPECT_THAT(the_case.spec.sweep().traces(), ElementsAre(1, 2, 7));
  EXPECT_TRUE(the_case.spec.sweep().has_coefficients());
  EXPECT_TRUE(the_case.spec.outputs().empty());
  EXPECT_EQ(the_case.spec.load_cases_size(), 2);
  EXPECT_EQ(the_case.locate("spec.sweep.coefficients.upload")->where(), "c.csv");
  EXPECT_EQ(the_case.locate("spec.sweep.traces[3]")->where(), "--traces 7,1-2");
}

TEST(MakeSweep, OfNodalForcesHasNoLoads) {
  Case the_case = two_load_case();
  the_case.force_files.push_back({0, "f.h5", "/f"});
  SweepInput input = rows_of_two(10);
  input.files.nodal = "f.h5:/f";
  make_sweep(input, the_case);
  EXPECT_TRUE(the_case.spec.sweep().has_nodal_forces());
  EXPECT_EQ(the_case.spec.load_cases_size(), 0);
  EXPECT_TRUE(the_case.force_files.empty());
}

}  // namespace
}  // namespace anticrack::cli

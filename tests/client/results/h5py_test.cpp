// SPDX-License-Identifier: GPL-3.0-or-later
//
// The layout as a stranger reads it: h5py, three lines.
#include <gtest/gtest.h>

#include <chrono>

#include "results/file.hpp"
#include "support/process.hpp"
#include "support/sample_result.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::results {
namespace {

using anticrack::testing::Process;
using anticrack::testing::sample_result;
using anticrack::testing::TemporaryFolder;
using anticrack::testing::with_stages;

std::string python(const std::string& program) {
  Process process({"/usr/bin/python3", "-c", program});
  EXPECT_EQ(process.wait(), 0) << process.error();
  return process.output();
}

class H5py : public ::testing::Test {
 protected:
  void SetUp() override {
    Process process({"/usr/bin/python3", "-c", "import h5py"});
    if (process.wait() != 0) GTEST_SKIP() << "python3-h5py is not installed";
    Result result = with_stages(sample_result(20));
    result.units = anticrack::testing::units_of("mm", "N");
    write(path, result);
  }

  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
};

TEST_F(H5py, reads_the_traces_in_three_lines) {
  EXPECT_EQ(
      python("import h5py\n"
             "f = h5py.File('" +
             path +
             "')\n"
             "print(f['interfaces/0/x'][20], round(f['loads/opening/traces/0/jump'][20], 6))"),
      "0.0 0.15\n");
}

TEST_F(H5py, sees_attributes_units_and_text) {
  EXPECT_EQ(
      python("import h5py\n"
             "f = h5py.File('" +
             path +
             "')\n"
             "load = f['loads/partly closed']\n"
             "print(f.attrs['format'], f.attrs['title'])\n"
             "print(load.attrs['status'], load.attrs['iterations'], load.attrs['theta_star'])\n"
             "print(load['inclusions/name'].asstr()[0], load['inclusions/A'][0])\n"
             "print(f['mesh/nodes'].shape, f['mesh/nodes'].attrs['units'],\n"
             "      f['mesh/triangles'].dtype, f['mesh/nodes'].compression)\n"
             "print(ascii(f.attrs['case'].splitlines()[1]))\n"),
      "anticrack-result/2 A made-up membrane\n"
      "converged 180 1.74\n"
      "fibre 0.0863\n"
      "(1681, 2) mm int32 gzip\n"
      "'# \\xe9'\n");
}

TEST_F(H5py, sees_which_inclusion_lies_where) {
  EXPECT_EQ(python("import h5py\n"
                   "f = h5py.File('" +
                   path +
                   "')\n"
                   "line = f['interfaces/0']\n"
                   "names = f['mesh/inclusions'].asstr()[:]\n"
                   "print(names[line['edge_inclusion'][20]], line['edge_kind'][20], len(names))\n"
                   "print(line['edge_inclusion'][0], line['edge_inclusion'].attrs['meaning'])\n"),
            "fibre 4 1\n"
            "-1 index into /mesh/inclusions, -1 none\n");
}

TEST_F(H5py, sees_stages_and_indicators) {
  EXPECT_EQ(python("import h5py\n"
                   "f = h5py.File('" +
                   path +
                   "')\n"
                   "load = f['loads/opening']\n"
                   "stages = load['stages']\n"
                   "print(stages['triangles'][:], stages['triangles'].dtype)\n"
                   "print(round(stages['energy_upper'][4], 5), stages['seconds'].attrs['units'],\n"
                   "      stages['energy'].attrs['units'], f['interfaces/0/kind'].attrs['units'])\n"
                   "print(load['indicator'].shape == f['mesh/subdomain'].shape)\n"
                   "print(f.attrs['not_reached'])"),
            "[ 293  532  968 1760 3200] int64\n"
            "-0.16785 s N mm -\n"
            "True\n"
            "energy to 0.0001: the mesh has max_triangles\n");
}

TEST_F(H5py, finds_units_on_every_dataset) {
  EXPECT_EQ(python("import h5py\n"
                   "f = h5py.File('" +
                   path +
                   "')\n"
                   "seen = []\n"
                   "f.visititems(lambda n, o: seen.append('units' in o.attrs)\n"
                   "             if isinstance(o, h5py.Dataset) else None)\n"
                   "print(len(seen) > 100, all(seen))"),
            "True True\n");
}

}  // namespace
}  // namespace anticrack::results

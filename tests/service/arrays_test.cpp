// SPDX-License-Identifier: GPL-3.0-or-later
//
// Many arrays of one job, through the real processes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "client/jobs.hpp"
#include "client/meshes.hpp"
#include "service/daemon.hpp"
#include "service/stored_data.hpp"
#include "service/workload.hpp"
#include "support/eventually.hpp"

namespace anticrack::service_test {
namespace {

namespace fs = std::filesystem;
using anticrack::testing::eventually;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int count = 40;

/// Datasets f0, f1, ... of constants 1, 2, ..., of so many values each.
void write_arrays(const std::string& file, const std::vector<std::size_t>& lengths) {
  const hid_t id = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const std::vector<double> values(lengths[i], static_cast<double>(i + 1));
    const hsize_t length = values.size();
    const hid_t space = H5Screate_simple(1, &length, nullptr);
    const hid_t set = H5Dcreate2(id, ("f" + std::to_string(i)).c_str(), H5T_IEEE_F64LE, space,
                                 H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(set);
    H5Sclose(space);
  }
  H5Fclose(id);
}

const std::string membrane = R"([geometry]
boundary  = [[-1,-1], [1,-1], [1,1], [-1,1]]
interface = [[-1,0], [1,0]]
[[geometry.inclusion]]
name = "fibre"
from = [-0.5, 0]
to   = [0.5, 0]
delaminated = true
[mesh]
preset = "uniform"
)";

std::string case_of_arrays(const anticrack::testing::TemporaryFolder& folder,
                           const std::string& mesh) {
  std::string text = membrane + mesh;
  for (int i = 0; i < count; ++i) {
    text += "[[load]]\nname = 'load-" + std::to_string(i) + "'\nf = { file = '" +
            (folder / "f.h5").string() + "', dataset = '/f" + std::to_string(i) +
            "', per = 'node' }\n";
  }
  return write_file(folder, "arrays.toml", text);
}

std::string case_of_constants(const anticrack::testing::TemporaryFolder& folder,
                              const std::string& mesh) {
  std::string text = membrane + mesh;
  for (int i = 0; i < count; ++i) {
    text +=
        "[[load]]\nname = 'load-" + std::to_string(i) + "'\nf = " + std::to_string(i + 1) + "\n";
  }
  return write_file(folder, "constants.toml", text);
}

std::size_t nodes_of(Daemon& daemon, const std::string& case_file) {
  const Ended made =
      daemon.client({"run", case_file, "-o", (daemon.folder() / "constants.h5").string()});
  EXPECT_EQ(made.code, 0) << made.error;
  client::Connection connection(daemon.connection());
  return client::list_meshes(connection, {}).meshes(0).node_count();
}

/// Energies of a document of --json.
std::vector<double> energies(const std::string& json) {
  std::vector<double> values;
  const google::protobuf::Struct document = parse_json(json);
  for (const auto& answer : document.fields().at("answers").list_value().values()) {
    values.push_back(answer.struct_value().fields().at("energy").number_value());
  }
  return values;
}

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(Arrays, OfOneJobArriveTogetherAndGiveWhatTheirConstantsGive) {
  Daemon daemon;
  const std::string mesh = "size = 0.1\n";
  const std::string constants = case_of_constants(daemon.folder(), mesh);
  write_arrays((daemon.folder() / "f.h5").string(),
               std::vector<std::size_t>(count, nodes_of(daemon, constants)));
  const Ended run = daemon.client({"--json", "run", case_of_arrays(daemon.folder(), mesh), "-o",
                                   (daemon.folder() / "arrays.h5").string()});
  ASSERT_EQ(run.code, 0) << run.error;
  const Ended expected =
      daemon.client({"--json", "show", (daemon.folder() / "constants.h5").string()});
  const std::vector<double> got = energies(run.output), want = energies(expected.output);
  ASSERT_EQ(got.size(), static_cast<std::size_t>(count));
  ASSERT_EQ(want.size(), got.size());
  for (std::size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i] / want[i], 1, 1e-11) << i;
  EXPECT_EQ(files_in(fs::path(daemon.data()) / "uploads"), static_cast<std::size_t>(count));
}

TEST(Arrays, OneThatIsRefusedAmongManyNamesItsLoadAndNoneIsKept) {
  Daemon daemon({"--upload-limit", "64KiB"});
  std::vector<std::size_t> lengths(count, 1'000);
  lengths[17] = 10'000;
  write_arrays((daemon.folder() / "f.h5").string(), lengths);
  const Ended run = daemon.client({"run", case_of_arrays(daemon.folder(), "size = 0.1\n"), "-o",
                                   (daemon.folder() / "arrays.h5").string()});
  EXPECT_EQ(run.code, 2) << run.error;
  EXPECT_THAT(run.error, AllOf(HasSubstr("load.load-17.f"), HasSubstr("80000 bytes")));
  EXPECT_TRUE(eventually([&] { return files_in(fs::path(daemon.data()) / "uploads") == 0; }));
}

TEST(Arrays, WhoseServerIsKilledWhileTheyArriveAreSentAgain) {
  Daemon daemon;
  const std::string mesh = "size = 0.1\n";
  const std::size_t nodes = nodes_of(daemon, case_of_constants(daemon.folder(), mesh));
  // Long ones: the server refuses them in the end, but has to take them all first.
  write_arrays((daemon.folder() / "f.h5").string(),
               std::vector<std::size_t>(count, nodes + 500'000));
  const std::string case_file = case_of_arrays(daemon.folder(), mesh);
  const auto run = start_client(daemon.address(),
                                {"run", case_file, "-o", (daemon.folder() / "arrays.h5").string()});
  const fs::path uploads = fs::path(daemon.data()) / "uploads";
  ASSERT_TRUE(eventually([&] { return files_in(uploads) > 3; }));
  daemon.kill();
  daemon.start();
  ASSERT_TRUE(run->wait().has_value());
  EXPECT_THAT(run->error(), HasSubstr("load.load-0.f"));
  EXPECT_EQ(files_in(uploads), static_cast<std::size_t>(count)) << "all are kept in the end";
  EXPECT_EQ(daemon.stop(), 0);
  EXPECT_THAT(flaws_of(daemon.data()), IsEmpty());
}

}  // namespace
}  // namespace anticrack::service_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "support/sample_result.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::results {
namespace {

namespace fs = std::filesystem;
using anticrack::testing::sample_pair;
using anticrack::testing::sample_result;
using anticrack::testing::set_edges;
using anticrack::testing::TemporaryFolder;
using ::testing::HasSubstr;

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t files_in(const std::string& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

void expect_same(const Kkt& a, const Kkt& b) {
  EXPECT_EQ(a.equilibrium, b.equilibrium);
  EXPECT_EQ(a.gap, b.gap);
  EXPECT_EQ(a.sign, b.sign);
  EXPECT_EQ(a.complementarity, b.complementarity);
}

void expect_same(const Load& a, const Load& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.error, b.error);
  EXPECT_EQ(a.method, b.method);
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.epsilon, b.epsilon);
  EXPECT_EQ(a.p, b.p);
  EXPECT_EQ(a.weakly_active, b.weakly_active);
  EXPECT_EQ(a.warnings, b.warnings);
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_EQ(a.criterion, b.criterion);
  EXPECT_EQ(a.theta, b.theta);
  EXPECT_EQ(a.theta_star, b.theta_star);
  EXPECT_EQ(a.energy, b.energy);
  EXPECT_EQ(a.contact_length, b.contact_length);
  EXPECT_EQ(a.solve_seconds, b.solve_seconds);
  expect_same(a.kkt, b.kkt);
  expect_same(a.kkt_relative, b.kkt_relative);
  ASSERT_EQ(a.inclusions.size(), b.inclusions.size());
  for (std::size_t i = 0; i < a.inclusions.size(); ++i) {
    EXPECT_EQ(a.inclusions[i].name, b.inclusions[i].name);
    EXPECT_EQ(a.inclusions[i].displacement, b.inclusions[i].displacement);
    EXPECT_EQ(a.inclusions[i].resultant, b.inclusions[i].resultant);
    EXPECT_EQ(a.inclusions[i].contact_length, b.inclusions[i].contact_length);
  }
  ASSERT_EQ(a.contact_intervals.size(), b.contact_intervals.size());
  for (std::size_t i = 0; i < a.contact_intervals.size(); ++i) {
    EXPECT_EQ(a.contact_intervals[i].interface, b.contact_intervals[i].interface);
    EXPECT_EQ(a.contact_intervals[i].begin, b.contact_intervals[i].begin);
    EXPECT_EQ(a.contact_intervals[i].end, b.contact_intervals[i].end);
  }
  ASSERT_EQ(a.traces.size(), b.traces.size());
  for (std::size_t i = 0; i < a.traces.size(); ++i) {
    EXPECT_EQ(a.traces[i].u_minus, b.traces[i].u_minus);
    EXPECT_EQ(a.traces[i].u_plus, b.traces[i].u_plus);
    EXPECT_EQ(a.traces[i].jump, b.traces[i].jump);
    EXPECT_EQ(a.traces[i].pressure, b.traces[i].pressure);
    EXPECT_EQ(a.traces[i].contact, b.traces[i].contact);
  }
  EXPECT_EQ(a.history.iteration, b.history.iteration);
  EXPECT_EQ(a.history.criterion, b.history.criterion);
  EXPECT_EQ(a.history.energy, b.history.energy);
  EXPECT_EQ(a.history.contact_count, b.history.contact_count);
  EXPECT_EQ(a.history.kkt_equilibrium, b.history.kkt_equilibrium);
  EXPECT_EQ(a.history.kkt_gap, b.history.kkt_gap);
  EXPECT_EQ(a.history.kkt_sign, b.history.kkt_sign);
  EXPECT_EQ(a.history.kkt_complementarity, b.history.kkt_complementarity);
  ASSERT_EQ(a.fields.size(), b.fields.size());
  for (std::size_t i = 0; i < a.fields.size(); ++i) {
    EXPECT_EQ(a.fields[i].nodes, b.fields[i].nodes);
    EXPECT_EQ(a.fields[i].triangles, b.fields[i].triangles);
    EXPECT_EQ(a.fields[i].u, b.fields[i].u);
  }
}

void expect_same(const Result& a, const Result& b) {
  EXPECT_EQ(a.title, b.title);
  EXPECT_EQ(a.case_text, b.case_text);
  EXPECT_EQ(a.client_version, b.client_version);
  EXPECT_EQ(a.server_version, b.server_version);
  EXPECT_EQ(a.mesh_name, b.mesh_name);
  EXPECT_EQ(a.job_name, b.job_name);
  EXPECT_EQ(a.mesh_sha256, b.mesh_sha256);
  EXPECT_EQ(a.timings.mesh_seconds, b.timings.mesh_seconds);
  EXPECT_EQ(a.timings.factorize_seconds, b.timings.factorize_seconds);
  EXPECT_EQ(a.timings.solve_seconds, b.timings.solve_seconds);
  EXPECT_EQ(a.timings.total_seconds, b.timings.total_seconds);
  EXPECT_EQ(a.mesh.xy, b.mesh.xy);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_EQ(a.mesh.subdomain, b.mesh.subdomain);
  EXPECT_EQ(a.mesh.boundary, b.mesh.boundary);
  EXPECT_EQ(a.mesh.subdomains, b.mesh.subdomains);
  EXPECT_EQ(a.mesh.tension, b.mesh.tension);
  EXPECT_EQ(a.mesh.inclusions, b.mesh.inclusions);
  ASSERT_EQ(a.interfaces.size(), b.interfaces.size());
  for (std::size_t i = 0; i < a.interfaces.size(); ++i) {
    EXPECT_EQ(a.interfaces[i].name, b.interfaces[i].name);
    EXPECT_EQ(a.interfaces[i].s, b.interfaces[i].s);
    EXPECT_EQ(a.interfaces[i].x, b.interfaces[i].x);
    EXPECT_EQ(a.interfaces[i].y, b.interfaces[i].y);
    EXPECT_EQ(a.interfaces[i].kind, b.interfaces[i].kind);
    EXPECT_EQ(a.interfaces[i].edges.kind, b.interfaces[i].edges.kind);
    EXPECT_EQ(a.interfaces[i].edges.inclusion, b.interfaces[i].edges.inclusion);
  }
  ASSERT_EQ(a.loads.size(), b.loads.size());
  for (std::size_t i = 0; i < a.loads.size(); ++i) expect_same(a.loads[i], b.loads[i]);
}

TEST(File, comes_back_as_it_was_written) {
  const TemporaryFolder folder;
  const Result result = sample_result(40);  // large enough for compressed datasets
  write(folder / "a.h5", result);
  expect_same(read(folder / "a.h5"), result);
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(File, keeps_which_inclusion_lies_where) {
  const TemporaryFolder folder;
  const Result result = sample_pair(4);
  write(folder / "a.h5", result);
  expect_same(read(folder / "a.h5"), result);
}

TEST(File, keeps_the_order_of_the_loads) {
  const TemporaryFolder folder;
  Result result = sample_result(2);
  result.loads[0].name = "z";
  result.loads[1].name = "10";
  result.loads.push_back(result.loads[0]);
  result.loads[2].name = "2";
  write(folder / "a.h5", result);
  expect_same(read(folder / "a.h5"), result);
}

TEST(File, holds_a_failed_load_and_an_empty_result) {
  const TemporaryFolder folder;
  Result result = sample_result(2);
  result.loads[0].status = Status::failed;
  result.loads[0].error = "f is not finite at (0, 0)";
  result.loads[0].traces.clear();
  result.loads[0].history = {};
  result.loads[0].fields.clear();
  result.loads[0].inclusions.clear();
  write(folder / "a.h5", result);
  expect_same(read(folder / "a.h5"), result);
  write(folder / "b.h5", Result{});
  expect_same(read(folder / "b.h5"), Result{});
}

/// What clients before the active set wrote.
void take_away_later_additions(const std::string& path) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  for (const char* dataset : {"/mesh/tension", "/mesh/inclusions", "/interfaces/0/edge_kind",
                              "/interfaces/0/edge_inclusion"}) {
    H5Ldelete(file, dataset, H5P_DEFAULT);
  }
  for (const std::string load : {"/loads/opening", "/loads/partly closed"}) {
    for (const char* attribute : {"weakly_active", "tolerance", "kkt_tolerance"}) {
      H5Adelete_by_name(file, load.c_str(), attribute, H5P_DEFAULT);
    }
    H5Ldelete(file, (load + "/warnings").c_str(), H5P_DEFAULT);
    for (const char* triangles : {"/fields/0/triangles", "/fields/1/triangles"}) {
      H5Ldelete(file, (load + triangles).c_str(), H5P_DEFAULT);
    }
  }
  H5Fclose(file);
}

TEST(File, of_an_earlier_client_is_read) {
  const TemporaryFolder folder;
  Result result = sample_result(4);
  write(folder / "a.h5", result);
  take_away_later_additions(folder / "a.h5");
  result.mesh.tension = {1, 1};
  for (Load& load : result.loads) {
    load.weakly_active = 0;
    load.warnings.clear();
  }
  expect_same(read(folder / "a.h5"), result);
}

TEST(File, of_an_earlier_client_tells_what_lies_along_an_interface_from_its_nodes) {
  const TemporaryFolder folder;
  Result result = sample_result(10);
  auto& line = result.interfaces[0];
  // "fibre" from x = -0.5 to 0.5, bonded right of 0; a crack from 0.7 to 0.9.
  for (std::size_t i = 10; i <= 15; ++i) line.kind[i] = Kind::inclusion;
  line.kind[18] = Kind::crack;
  write(folder / "a.h5", result);
  take_away_later_additions(folder / "a.h5");
  set_edges(line, 10, 15, Kind::inclusion, 0);
  set_edges(line, 17, 19, Kind::crack, -1);
  const Result seen = read(folder / "a.h5");
  EXPECT_EQ(seen.interfaces[0].edges.kind, line.edges.kind);
  EXPECT_EQ(seen.interfaces[0].edges.inclusion, line.edges.inclusion);
  EXPECT_EQ(seen.mesh.inclusions, std::vector<std::string>{"fibre"});
}

TEST(File, of_an_earlier_client_does_not_tell_two_inclusions_apart) {
  const TemporaryFolder folder;
  Result result = sample_pair(10);
  write(folder / "a.h5", result);
  take_away_later_additions(folder / "a.h5");
  const Result seen = read(folder / "a.h5");
  EXPECT_EQ(seen.mesh.inclusions, result.mesh.inclusions);
  EXPECT_EQ(seen.interfaces[0].edges.kind, result.interfaces[0].edges.kind);
  EXPECT_EQ(seen.interfaces[0].edges.inclusion, std::vector<std::int32_t>(20, -1));
}

/// The upper half of the sample with one node of the interface there twice, as inside a slit.
Result with_a_doubled_node() {
  Result result = sample_result(4);
  for (Load& load : result.loads) {
    Field& field = load.fields[1];
    field.nodes.push_back(field.nodes[4]);
    field.u.push_back(field.u[4] + 1);
    for (std::int32_t& corner : field.triangles) {
      if (corner == 4) {
        corner = static_cast<std::int32_t>(field.nodes.size()) - 1;
        break;
      }
    }
  }
  return result;
}

TEST(File, keeps_both_faces_of_a_slit) {
  const TemporaryFolder folder;
  const Result result = with_a_doubled_node();
  write(folder / "a.h5", result);
  expect_same(read(folder / "a.h5"), result);
}

TEST(File, of_an_earlier_client_cannot_have_a_slit) {
  const TemporaryFolder folder;
  write(folder / "a.h5", with_a_doubled_node());
  take_away_later_additions(folder / "a.h5");
  EXPECT_THROW(read(folder / "a.h5"), Error);
}

TEST(File, keeps_unknown_numbers_as_nan) {
  const TemporaryFolder folder;
  Result result = sample_result(2);
  result.loads[0].epsilon = unknown;
  write(folder / "a.h5", result);
  EXPECT_TRUE(std::isnan(read(folder / "a.h5").loads[0].epsilon));
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

TEST(File, has_the_permissions_of_the_umask) {
  const TemporaryFolder folder;
  const mode_t before = umask(027);
  write(folder / "a.h5", sample_result(2));
  umask(before);
  struct stat status {};
  ASSERT_EQ(stat((folder / "a.h5").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST(File, is_not_written_from_an_inconsistent_result) {
  const TemporaryFolder folder;
  Result result = sample_result(2);
  result.loads[1].traces[0].jump.pop_back();
  EXPECT_THROW(write(folder / "a.h5", result), Error);
  result = sample_result(2);
  result.loads[1].name = "../x";
  EXPECT_THROW(write(folder / "a.h5", result), Error);
  result.loads[1].name = result.loads[0].name;
  EXPECT_THROW(write(folder / "a.h5", result), Error);
  EXPECT_EQ(files_in(folder.path()), 0u);
}

/// Files of this process may not grow past `bytes`, as on a full disk, until the end of the scope.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &_limit);
    _handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{bytes, _limit.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallDisk() {
    setrlimit(RLIMIT_FSIZE, &_limit);
    std::signal(SIGXFSZ, _handler);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  rlimit _limit{};
  void (*_handler)(int) = nullptr;
};

TEST(File, an_interrupted_write_keeps_the_old_file_and_leaves_nothing_else) {
  const TemporaryFolder folder;
  write(folder / "a.h5", sample_result(4));
  const std::string before = bytes_of(folder / "a.h5");
  {
    const SmallDisk disk(10'000);
    EXPECT_THROW(write(folder / "a.h5", sample_result(40)), Error);
    EXPECT_THROW(write(folder / "new.h5", sample_result(40)), Error);
  }
  EXPECT_EQ(bytes_of(folder / "a.h5"), before);
  EXPECT_EQ(files_in(folder.path()), 1u);
}

void expect_unwritable(const std::string& path, const std::string& cause) {
  for (const bool only_check : {true, false}) {
    try {
      if (only_check) {
        check_writable(path);
      } else {
        write(path, sample_result(2));
      }
      FAIL() << "accepted " << path;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(path));
      if (only_check) {
        EXPECT_THAT(error.cause(), HasSubstr(cause));
      }
      EXPECT_THAT(error.cure(), HasSubstr("-o"));
    }
  }
}

TEST(Writable, says_what_is_wrong_with_a_path) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  expect_unwritable(folder / "missing/a.h5", "No such file or directory");
  expect_unwritable(folder / "file/a.h5", "Not a directory");
  expect_unwritable(folder.path(), "is a folder");
  expect_unwritable("/proc/a.h5", "cannot create a file in this folder");
  EXPECT_THROW(check_writable(""), Error);
  EXPECT_THROW(check_writable(folder / ""), Error);
  EXPECT_THROW(check_writable("/dev/null"), Error);
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(Writable, says_so_of_a_read_only_folder_and_file) {
  if (geteuid() == 0) GTEST_SKIP() << "permissions do not hold for root";
  const TemporaryFolder folder;
  write(folder / "a.h5", sample_result(2));
  chmod((folder / "a.h5").c_str(), 0444);
  EXPECT_THROW(check_writable(folder / "a.h5"), Error);
  chmod(folder.path().c_str(), 0555);
  expect_unwritable(folder / "b.h5", "Permission denied");
  chmod(folder.path().c_str(), 0755);
}

TEST(Writable, leaves_nothing_behind) {
  const TemporaryFolder folder;
  check_writable(folder / "a.h5");
  EXPECT_EQ(files_in(folder.path()), 0u);
  write(folder / "a.h5", sample_result(2));
  check_writable(folder / "a.h5");
  EXPECT_EQ(files_in(folder.path()), 1u);
}

}  // namespace
}  // namespace anticrack::results

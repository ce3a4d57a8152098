// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files that are no good result: every one is refused with a clear error, none crashes the reader.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

#include <array>
#include <fstream>
#include <functional>
#include <iterator>

#include "results/file.hpp"
#include "support/sample_result.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::results {
namespace {

using anticrack::testing::sample_result;
using anticrack::testing::TemporaryFolder;
using anticrack::testing::with_stages;
using ::testing::HasSubstr;

void expect_refused(const std::string& path, const std::string& cause) {
  try {
    read(path);
    FAIL() << "accepted; expected: " << cause;
  } catch (const Error& error) {
    EXPECT_EQ(error.subject(), path);
    EXPECT_THAT(error.cause(), HasSubstr(cause));
    EXPECT_FALSE(error.cure().empty());
  }
}

void save(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

std::string good_bytes(int n) {
  const TemporaryFolder folder;
  write(folder / "a.h5", sample_result(n));
  std::ifstream file(folder / "a.h5", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(MalformedFile, truncated_anywhere) {
  const TemporaryFolder folder;
  const std::string bytes = good_bytes(8);
  for (std::size_t part = 1; part < 20; ++part) {
    save(folder / "a.h5", bytes.substr(0, bytes.size() * part / 20));
    expect_refused(folder / "a.h5", "is truncated or damaged");
  }
  save(folder / "a.h5", bytes.substr(0, bytes.size() - 1));
  expect_refused(folder / "a.h5", "is truncated or damaged");
}

/// Where the values of a dataset lie in the file: in its first chunk, or in its own header.
std::size_t data_address(const std::string& bytes, const std::string& path, const char* dataset) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t id = H5Dopen2(file, dataset, H5P_DEFAULT);
  const hid_t space = H5Dget_space(id), type = H5Dget_type(id);
  const hid_t creation = H5Dget_create_plist(id);
  std::size_t at = std::string::npos;
  if (H5Pget_layout(creation) == H5D_CHUNKED) {
    std::array<hsize_t, 2> offset{};
    unsigned mask = 0;
    haddr_t address = HADDR_UNDEF;
    hsize_t size = 0;
    H5Dget_chunk_info(id, space, 0, offset.data(), &mask, &address, &size);
    at = address;
  } else {
    std::string values(
        H5Tget_size(type) * static_cast<hsize_t>(H5Sget_simple_extent_npoints(space)), '\0');
    H5Dread(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5O_info_t header;
    H5Oget_info2(id, &header, H5O_INFO_BASIC);
    at = bytes.find(values, header.addr);
  }
  H5Pclose(creation);
  H5Tclose(type);
  H5Sclose(space);
  H5Dclose(id);
  H5Fclose(file);
  return at;
}

TEST(MalformedFile, a_flipped_bit_in_any_dataset_is_noticed) {
#ifdef __SANITIZE_ADDRESS__
  const __lsan::ScopedDisabler leaks;  // HDF5 1.10 loses 2 kB for each damaged header
#endif
  for (const char* dataset : {"/mesh/nodes", "/loads/opening/traces/0/u_plus",
                              "/loads/opening/inclusions/A", "/loads/opening/fields/1/u"}) {
    const TemporaryFolder folder;
    std::string bytes = good_bytes(40);
    save(folder / "good.h5", bytes);
    const std::size_t at = data_address(bytes, folder / "good.h5", dataset);
    ASSERT_LT(at, bytes.size()) << dataset;
    bytes[at + 3] = static_cast<char>(bytes[at + 3] ^ 0x10);
    save(folder / "a.h5", bytes);
    expect_refused(folder / "a.h5", "is damaged");
  }
}

/// A change to a good file through HDF5, and what the reader must say of it.
struct Damage {
  std::string name;
  std::function<void(hid_t file)> inflict;
  std::string complaint;
};

void replace_text(hid_t file, const char* object, const char* attribute, const char* value) {
  const hid_t id = H5Oopen(file, object, H5P_DEFAULT);
  H5Adelete(id, attribute);
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t made = H5Acreate2(id, attribute, type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(made, type, &value);
  H5Aclose(made);
  H5Sclose(space);
  H5Tclose(type);
  H5Oclose(id);
}

void replace_int(hid_t file, const char* object, const char* attribute, int value) {
  const hid_t id = H5Oopen(file, object, H5P_DEFAULT);
  H5Adelete(id, attribute);
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t made = H5Acreate2(id, attribute, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(made, H5T_NATIVE_INT, &value);
  H5Aclose(made);
  H5Sclose(space);
  H5Oclose(id);
}

/// A dataset that was never written: all zero, of any claimed size.
void replace_dataset(hid_t file, const char* path, hid_t type, std::vector<hsize_t> shape) {
  H5Ldelete(file, path, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  if (!shape.empty()) {
    const std::vector<hsize_t> chunk(shape.size(), 1);
    H5Pset_chunk(properties, static_cast<int>(shape.size()), chunk.data());
  }
  H5Dclose(H5Dcreate2(file, path, type, space, H5P_DEFAULT, properties, H5P_DEFAULT));
  H5Pclose(properties);
  H5Sclose(space);
}

void move_outside(hid_t file, const char* path, hsize_t count, const char* other) {
  H5Ldelete(file, path, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(1, &count, nullptr);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_external(properties, other, 0, count * 8);
  H5Dclose(H5Dcreate2(file, path, H5T_IEEE_F64LE, space, H5P_DEFAULT, properties, H5P_DEFAULT));
  H5Pclose(properties);
  H5Sclose(space);
}

class Damaged : public ::testing::TestWithParam<Damage> {};

TEST_P(Damaged, is_refused) {
  const TemporaryFolder folder;
  // 81 nodes, 128 triangles, 9 interface nodes, 5 stages
  write(folder / "a.h5", with_stages(sample_result(4)));
  const hid_t file = H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  GetParam().inflict(file);
  H5Fclose(file);
  expect_refused(folder / "a.h5", GetParam().complaint);
}

const std::array<Damage, 26> damages{{
    {"format_foreign", [](hid_t f) { replace_text(f, "/", "format", "netcdf"); },
     "has format \"netcdf\""},
    {"format_older", [](hid_t f) { replace_text(f, "/", "format", "anticrack-result/1"); },
     "this client reads \"anticrack-result/2\""},
    {"format_no_text", [](hid_t f) { replace_int(f, "/", "format", 1); },
     "attribute format is not one variable-length text"},
    {"attribute_missing", [](hid_t f) { H5Adelete(f, "server_version"); },
     "attribute server_version is missing"},
    {"attribute_of_another_type", [](hid_t f) { replace_int(f, "/mesh", "mesh_seconds", 1); },
     "attribute mesh_seconds is not one float64"},
    {"status_unknown", [](hid_t f) { replace_text(f, "/loads/opening", "status", "fine"); },
     "unknown status \"fine\""},
    {"index_out_of_range", [](hid_t f) { replace_int(f, "/loads/opening", "index", 2); },
     "index of another or none"},
    {"index_negative", [](hid_t f) { replace_int(f, "/loads/opening", "index", -1); },
     "index of another or none"},
    {"index_twice", [](hid_t f) { replace_int(f, "/loads/opening", "index", 1); },
     "index of another or none"},
    {"group_missing", [](hid_t f) { H5Ldelete(f, "/mesh", H5P_DEFAULT); }, "\"mesh\" is missing"},
    {"dataset_missing", [](hid_t f) { H5Ldelete(f, "/mesh/nodes", H5P_DEFAULT); },
     "\"nodes\" is missing"},
    {"group_for_a_dataset",
     [](hid_t f) {
       H5Ldelete(f, "/mesh/nodes", H5P_DEFAULT);
       H5Gclose(H5Gcreate2(f, "/mesh/nodes", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
     },
     "\"nodes\" is a group, not a dataset"},
    {"dataset_for_a_group",
     [](hid_t f) { replace_dataset(f, "/loads/opening/fields", H5T_STD_I32LE, {3}); },
     "\"fields\" is not a group"},
    {"wrong_type",
     [](hid_t f) {
       replace_dataset(f, "/mesh/nodes", H5T_IEEE_F32LE, {81, 2});
     },
     "dataset nodes is not float64"},
    {"wrong_rank", [](hid_t f) { replace_dataset(f, "/mesh/nodes", H5T_IEEE_F64LE, {162}); },
     "dataset nodes is not of shape (n,2)"},
    {"wrong_columns",
     [](hid_t f) {
       replace_dataset(f, "/mesh/nodes", H5T_IEEE_F64LE, {54, 3});
     },
     "dataset nodes is not of shape (n,2)"},
    {"wrong_length_of_inclusions",
     [](hid_t f) { replace_dataset(f, "/loads/opening/inclusions/A", H5T_IEEE_F64LE, {4}); },
     "inclusions has datasets of different lengths"},
    {"wrong_length_of_stages",
     [](hid_t f) { replace_dataset(f, "/loads/opening/stages/energy", H5T_IEEE_F64LE, {4}); },
     "stages has datasets of different lengths"},
    {"stages_of_another_type",
     [](hid_t f) { replace_dataset(f, "/loads/opening/stages/triangles", H5T_STD_I32LE, {5}); },
     "dataset triangles is not int64"},
    {"stages_without_their_times",
     [](hid_t f) { H5Ldelete(f, "/loads/opening/stages/seconds", H5P_DEFAULT); },
     "\"seconds\" is missing"},
    {"claims_more_than_the_file_holds",
     [](hid_t f) {
       replace_dataset(f, "/mesh/nodes", H5T_IEEE_F64LE, {hsize_t{1} << 40, 2});
     },
     "more than the file can hold"},
    {"of_a_client_that_knew_no_inclusions",
     [](hid_t f) { H5Ldelete(f, "/mesh/inclusions", H5P_DEFAULT); },
     "\"inclusions\" is missing, in a file of anticrack 0.1.0"},
    {"of_a_client_that_knew_one_method",
     [](hid_t f) { H5Adelete_by_name(f, "/loads/opening", "weakly_active", H5P_DEFAULT); },
     "attribute weakly_active is missing"},
    {"names_of_inclusions_of_another_type",
     [](hid_t f) { replace_dataset(f, "/mesh/inclusions", H5T_STD_I32LE, {1}); },
     "dataset inclusions is not variable-length text"},
    {"external_link",
     [](hid_t f) {
       H5Ldelete(f, "/mesh", H5P_DEFAULT);
       H5Lcreate_external("other.h5", "/mesh", f, "mesh", H5P_DEFAULT, H5P_DEFAULT);
     },
     "\"mesh\" is a link, not data"},
    {"external_data",
     [](hid_t f) { move_outside(f, "/loads/opening/traces/0/u_plus", 9, "/etc/passwd"); },
     "dataset u_plus lies in another file"},
}};

INSTANTIATE_TEST_SUITE_P(MalformedFile, Damaged, ::testing::ValuesIn(damages),
                         [](const auto& each) { return each.param.name; });

}  // namespace
}  // namespace anticrack::results

// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstdint>
#include <fstream>
#include <limits>
#include <utility>

#include "results/result.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::results {
namespace {

using anticrack::testing::TemporaryFolder;
using ::testing::HasSubstr;

void put(hid_t parent, const char* name, hid_t type, const std::vector<hsize_t>& shape,
         const std::vector<double>& values) {
  const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  const hid_t set = H5Dcreate2(parent, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (!values.empty()) {
    H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }
  H5Dclose(set);
  H5Sclose(space);
}

/// A dataset packed by a filter that is not there any more when it is read.
void put_packed(hid_t parent, const char* name, H5Z_filter_t filter, const char* filter_name) {
  const H5Z_class2_t own{H5Z_CLASS_T_VERS,
                         filter,
                         1,
                         1,
                         filter_name,
                         nullptr,
                         nullptr,
                         [](unsigned, std::size_t, const unsigned*, std::size_t bytes, std::size_t*,
                            void**) { return bytes; }};
  ASSERT_GE(H5Zregister(&own), 0);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t rows = 3;
  H5Pset_chunk(properties, 1, &rows);
  H5Pset_filter(properties, filter, 0, 0, nullptr);
  const hid_t space = H5Screate_simple(1, &rows, nullptr);
  const hid_t set =
      H5Dcreate2(parent, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, properties, H5P_DEFAULT);
  const std::vector<double> values{1, 2, 3};
  EXPECT_GE(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  H5Dclose(set);
  H5Sclose(space);
  H5Pclose(properties);
  ASSERT_GE(H5Zunregister(filter), 0);
}

/// What is not float64 or no list, as other programs write it.
void put_other_kinds(hid_t file) {
  const hid_t flags = H5Tenum_create(H5T_STD_I8LE);
  const std::int8_t no = 0, yes = 1;
  H5Tenum_insert(flags, "FALSE", &no);
  H5Tenum_insert(flags, "TRUE", &yes);
  put(file, "flags", flags, {2}, {});
  H5Tcommit2(file, "type", flags, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Tclose(flags);
  const hid_t complex = H5Tcreate(H5T_COMPOUND, 16);
  H5Tinsert(complex, "r", 0, H5T_IEEE_F64LE);
  H5Tinsert(complex, "i", 8, H5T_IEEE_F64LE);
  put(file, "complex", complex, {2}, {});
  H5Tclose(complex);
  put(file, "words", H5T_C_S1, {2}, {});
  const std::pair<const char*, H5S_class_t> kinds[]{{"scalar", H5S_SCALAR}, {"void", H5S_NULL}};
  for (const auto& [name, kind] : kinds) {
    const hid_t space = H5Screate(kind);
    H5Dclose(H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Sclose(space);
  }
}

class ArrayFile : public ::testing::Test {
 protected:
  void SetUp() override {
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    ASSERT_GE(file, 0);
    put(file, "f", H5T_IEEE_F64LE, {3}, {1, -2.5, 3});
    put(file, "big", H5T_IEEE_F64BE, {2}, {1.5, 2});
    put(file, "single", H5T_IEEE_F32LE, {2}, {1, 2});
    put(file, "whole", H5T_STD_I32LE, {2}, {1, 2});
    put(file, "plane", H5T_IEEE_F64LE, {2, 2}, {1, 2, 3, 4});
    put(file, "wide", H5T_IEEE_F64BE, {2, 3}, {1, 2, 3, 4, 5, 6});
    put(file, "no rows", H5T_IEEE_F64LE, {0, 3}, {});
    put(file, "no columns", H5T_IEEE_F64LE, {3, 0}, {});
    put(file, "odd", H5T_IEEE_F64LE, {2, 2}, {1, 2, 3, std::numeric_limits<double>::infinity()});
    put(file, "huge plane", H5T_IEEE_F64LE, {hsize_t{1} << 40, hsize_t{1} << 40}, {});
    put(file, "none", H5T_IEEE_F64LE, {0}, {});
    put(file, "nan", H5T_IEEE_F64LE, {2}, {1, std::numeric_limits<double>::quiet_NaN()});
    put(file, "huge", H5T_IEEE_F64LE, {hsize_t{1} << 45}, {});
    put_packed(file, "lzf", 32000, "lzf");
    put_packed(file, "own", 511, "");
    put_other_kinds(file);
    const hid_t group = H5Gcreate2(file, "a", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    put(group, "f", H5T_IEEE_F64LE, {1}, {7});
    H5Lcreate_external("other.h5", "/f", group, "link", H5P_DEFAULT, H5P_DEFAULT);
    H5Gclose(group);
    H5Fclose(file);
  }

  std::string complaint(const std::string& dataset) const {
    try {
      array_reader()(path, dataset);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }

  std::string matrix_complaint(const std::string& dataset) const {
    try {
      read_matrix(path, dataset);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }

  const TemporaryFolder folder;
  const std::string path = folder / "f.h5";
};

TEST_F(ArrayFile, gives_the_values) {
  const ReadArray read = array_reader();
  EXPECT_EQ(read(path, "/f"), (std::vector<double>{1, -2.5, 3}));
  EXPECT_EQ(read(path, "f"), (std::vector<double>{1, -2.5, 3}));
  EXPECT_EQ(read(path, "/a/f"), std::vector<double>{7});
  EXPECT_EQ(read(path, "big"), (std::vector<double>{1.5, 2}));
}

TEST_F(ArrayFile, goes_from_file_to_file) {
  const std::string other = folder / "other.h5";
  std::filesystem::copy_file(path, other);
  const ReadArray read = array_reader();
  EXPECT_EQ(read(path, "/a/f"), std::vector<double>{7});
  EXPECT_THROW(read(folder / "missing.h5", "/a/f"), Error);
  EXPECT_EQ(read(other, "/f"), (std::vector<double>{1, -2.5, 3}));
  EXPECT_EQ(read(path, "/f"), (std::vector<double>{1, -2.5, 3}));
}

TEST_F(ArrayFile, refuses_what_is_no_list_of_finite_numbers) {
  EXPECT_THAT(complaint("/single"), HasSubstr("single is not float64 but float32"));
  EXPECT_THAT(complaint("/whole"), HasSubstr("whole is not float64 but int32"));
  EXPECT_THAT(complaint("/plane"), HasSubstr("plane is not of shape (n) but ("));
  EXPECT_THAT(complaint("/none"), HasSubstr("/none has no values"));
  EXPECT_THAT(complaint("/nan"), HasSubstr("value 1 of dataset /nan is not finite"));
  EXPECT_THAT(complaint("/huge"), HasSubstr("more than the file can hold"));
  EXPECT_THAT(complaint("/g"), HasSubstr("\"g\" is missing"));
  EXPECT_THAT(complaint("/b/f"), HasSubstr("\"b\" is missing"));
  EXPECT_THAT(complaint("/a"), HasSubstr("\"a\" is a group, not a dataset; it has f, link"));
  EXPECT_THAT(complaint("/type"), HasSubstr("\"type\" is a named type, not a dataset"));
  EXPECT_THAT(complaint("/lzf"), HasSubstr("lzf is packed with lzf (filter 32000)"));
  EXPECT_THAT(complaint("/own"), HasSubstr("own is packed with filter 511, which"));
  EXPECT_THAT(complaint("/flags"), HasSubstr("flags is not float64 but an enumeration"));
  EXPECT_THAT(complaint("/complex"), HasSubstr("complex is not float64 but a compound"));
  EXPECT_THAT(complaint("/words"), HasSubstr("words is not float64 but text"));
  EXPECT_THAT(complaint("/scalar"), HasSubstr("scalar is not of shape (n) but ()"));
  EXPECT_THAT(complaint("/void"), HasSubstr("void is not of shape (n) but empty"));
  EXPECT_THAT(complaint("/a/link"), HasSubstr("is a link, not data"));
  EXPECT_THAT(complaint("/"), HasSubstr("names no dataset"));
}

TEST_F(ArrayFile, gives_matrices) {
  const Matrix wide = read_matrix(path, "/wide");
  EXPECT_EQ(wide.rows, 2U);
  EXPECT_EQ(wide.columns, 3U);
  EXPECT_EQ(wide.values, (std::vector<double>{1, 2, 3, 4, 5, 6}));
}

TEST_F(ArrayFile, refuses_what_is_no_matrix_of_finite_numbers) {
  EXPECT_THAT(matrix_complaint("/f"), HasSubstr("f is not of shape (rows,columns)"));
  EXPECT_THAT(matrix_complaint("/single"), HasSubstr("single is not float64"));
  EXPECT_THAT(matrix_complaint("/no rows"), HasSubstr("/no rows has no values"));
  EXPECT_THAT(matrix_complaint("/no columns"), HasSubstr("/no columns has no values"));
  EXPECT_THAT(matrix_complaint("/odd"),
              HasSubstr("the value in row 1, column 1 (from 0) of dataset /odd is not finite"));
  EXPECT_THAT(matrix_complaint("/huge plane"), HasSubstr("more than the file can hold"));
  EXPECT_THAT(matrix_complaint("/missing"), HasSubstr("\"missing\" is missing"));
  EXPECT_THAT(matrix_complaint("/missing"),
              HasSubstr("name a two-dimensional dataset of float64 in an HDF5 file"));
  EXPECT_THAT(matrix_complaint("/"), HasSubstr("names no dataset"));
}

TEST_F(ArrayFile, refuses_what_is_no_file) {
  std::ofstream(folder / "text.h5") << "not HDF5";
  EXPECT_THROW(array_reader()(folder / "text.h5", "/f"), Error);
  EXPECT_THROW(array_reader()(folder / "missing.h5", "/f"), Error);
  EXPECT_THROW(array_reader()(folder.path(), "/f"), Error);
}

}  // namespace
}  // namespace anticrack::results

// SPDX-License-Identifier: GPL-3.0-or-later
//
// Large datasets, whose chunks we filter ourselves, are stored as HDF5 stores them.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <array>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "results/hdf5.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::results {
namespace {

using anticrack::testing::TemporaryFolder;
using Chunks = std::vector<std::vector<unsigned char>>;

/// The chunks of dataset "a" as they are in the file, each after the place of its first entry.
Chunks chunks_of(const std::string& path) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t id = H5Dopen2(file, "a", H5P_DEFAULT), space = H5Dget_space(id);
  hsize_t count = 0;
  H5Dget_num_chunks(id, space, &count);
  Chunks chunks(count);
  for (hsize_t k = 0; k < count; ++k) {
    std::array<hsize_t, 2> place{};
    unsigned skipped = 0;
    haddr_t address = HADDR_UNDEF;
    hsize_t size = 0;
    H5Dget_chunk_info(id, space, k, place.data(), &skipped, &address, &size);
    EXPECT_EQ(skipped, 0U);
    chunks[k].resize(size);
    std::uint32_t mask = 0;
    EXPECT_GE(H5Dread_chunk(id, H5P_DEFAULT, place.data(), &mask, chunks[k].data()), 0);
    chunks[k].insert(chunks[k].begin(), reinterpret_cast<const unsigned char*>(place.data()),
                     reinterpret_cast<const unsigned char*>(place.data() + place.size()));
  }
  H5Sclose(space);
  H5Dclose(id);
  H5Fclose(file);
  return chunks;
}

/// Writes the values by HDF5 alone into a dataset with the properties of that in the other file.
void write_alike(const std::string& other, const std::string& path, const void* values) {
  const hid_t from = H5Fopen(other.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
              file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t like = H5Dopen2(from, "a", H5P_DEFAULT), space = H5Dget_space(like),
              type = H5Dget_type(like), properties = H5Dget_create_plist(like);
  const hid_t id = H5Dcreate2(file, "a", type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
  EXPECT_GE(H5Dwrite(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), 0);
  H5Dclose(id);
  H5Pclose(properties);
  H5Tclose(type);
  H5Sclose(space);
  H5Dclose(like);
  H5Fclose(file);
  H5Fclose(from);
}

template <class T>
void expect_as_by_hdf5(const Shape& shape) {
  SCOPED_TRACE(std::to_string(shape[0]) + " rows of " + name_of(value_type<T>));
  std::vector<T> values(count_of(shape));
  std::mt19937 random(7);
  for (std::size_t i = 0; i < values.size(); ++i)  // noise, and what can be compressed
    values[i] = static_cast<T>(i < values.size() / 2 ? static_cast<T>(random() % 251) / 3 : 5);
  const TemporaryFolder folder;
  const std::string ours = folder / "ours.h5", its = folder / "its.h5";
  const std::vector<std::byte> bytes = hdf5::file_image([&](const hdf5::Handle& root) {
    hdf5::put_array(root, "a", value_type<T>, values.data(), shape);
  });
  std::ofstream(ours, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  write_alike(ours, its, values.data());
  const Chunks chunks = chunks_of(ours);
  EXPECT_GT(chunks.size(), 1U);
  EXPECT_EQ(chunks, chunks_of(its));
}

TEST(LargeDataset, IsStoredAsByHdf5) {
  const hdf5::Quiet quiet;  // before all other calls
  expect_as_by_hdf5<double>({300'001});
  expect_as_by_hdf5<double>({70'000, 2});
  expect_as_by_hdf5<std::int32_t>({50'001, 3});
  expect_as_by_hdf5<std::uint8_t>({131'073});
  expect_as_by_hdf5<std::int64_t>({2, 65'537});
}

}  // namespace
}  // namespace anticrack::results

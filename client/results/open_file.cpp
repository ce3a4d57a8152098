// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/open_file.hpp"

#include "results/error.hpp"

namespace anticrack::results::hdf5 {

namespace fs = std::filesystem;

Handle open_file(const fs::path& path, const std::string& cure) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw Error(path.string(), "no such file", cure);
  if (status.type() != fs::file_type::regular) {
    throw Error(path.string(), error ? error.message() : "is not a regular file", cure);
  }
  const htri_t is_hdf5 = H5Fis_hdf5(path.c_str());
  if (is_hdf5 < 0) throw Error(path.string(), "cannot be opened", "check its permissions");
  if (is_hdf5 == 0) throw Error(path.string(), "is not an HDF5 file", cure);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "HDF5 does not start");
  // Reading needs no lock, and some network file systems have none.
  H5Pset_file_locking(access.get(), false, true);
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose, "is truncated or damaged"};
}

std::uint64_t memory_budget(const fs::path& path) {
  constexpr std::uint64_t largest_ratio = 1032;  // deflate packs at most so many to 1
  return fs::file_size(path) * largest_ratio;
}

}  // namespace anticrack::results::hdf5

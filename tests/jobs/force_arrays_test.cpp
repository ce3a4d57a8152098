// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/force_arrays.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "store/files.hpp"
#include "support/errors.hpp"
#include "support/flip.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::throws;
using errors::Reason;

class Arrays : public ::testing::Test {
 protected:
  /// An upload of `count` values.
  std::string upload(std::size_t count) {
    const std::string part = store->new_upload_path(count * sizeof(double));
    const std::vector<double> values(count, 1.5);
    std::ofstream(part, std::ios::binary)
        .write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(count * sizeof(double)));
    const std::string hash = store::sha256_of(part);
    store->keep_uploads({{part, hash}}, owner);
    return hash;
  }
  static fem::Load of(const std::string& hash) {
    fem::Load load;
    load.force = fem::Array{hash, true};
    return load;
  }
  static std::shared_ptr<const std::vector<double>> values(const fem::Load& load) {
    return std::get<fem::Array>(load.force).values;
  }

  const std::string owner = "alice";
  anticrack::testing::TemporaryFolder folder;
  std::unique_ptr<store::Store> store = store::open({(folder / "data").string(), 0});
};

TEST_F(Arrays, AreReadOnceAndGoWithTheLastCase) {
  const std::string hash = upload(5);
  const std::vector<fem::Load> loads{of(hash), fem::Load{}, of(hash), of(hash)};
  ForceArrays arrays(loads, owner);
  const fem::Load first = arrays.resolve(loads[0], *store);
  ASSERT_TRUE(values(first));
  EXPECT_EQ(*values(first), std::vector<double>(5, 1.5));
  std::filesystem::remove(
      *store->upload_path(hash, owner));  // would be missed if it were read again
  EXPECT_EQ(values(arrays.resolve(loads[2], *store)), values(first));
  EXPECT_EQ(std::get<double>(arrays.resolve(loads[1], *store).force), 0.0);
  const std::weak_ptr<const std::vector<double>> left = values(arrays.resolve(loads[3], *store));
  EXPECT_EQ(left.use_count(), 1);  // that of `first`
}

TEST_F(Arrays, AreLookedForBeforeTheyAreNeeded) {
  const std::string good = upload(1), empty = upload(0);
  EXPECT_NO_THROW(require_arrays({of(good), fem::Load{}}, *store, owner));
  EXPECT_TRUE(throws(
      [&] {
        require_arrays({of(good), of(std::string(64, 'b'))}, *store, owner);
      },
      Reason::not_found, "load_cases[1].force.array"));
  EXPECT_TRUE(throws([&] { require_arrays({of(empty)}, *store, owner); }, Reason::invalid_argument,
                     "load_cases[0].force.array"));
  EXPECT_TRUE(throws([&] { require_arrays({of(good)}, *store, "bob"); }, Reason::not_found,
                     "load_cases[0].force.array"));
}

TEST_F(Arrays, ThatWentMeanwhileFailTheirCase) {
  const std::string hash = upload(1);
  const std::vector<fem::Load> loads{of(hash)};
  ForceArrays arrays(loads, owner);
  std::filesystem::remove(*store->upload_path(hash, owner));
  EXPECT_TRUE(throws([&] { arrays.resolve(loads[0], *store); }, Reason::storage, "force.array"));
}

TEST_F(Arrays, ThatHaveChangedOnTheDiskFailTheirCase) {
  const std::string hash = upload(5);
  const std::vector<fem::Load> loads{of(hash), of(hash)};
  ForceArrays arrays(loads, owner);
  const std::string path = *store->upload_path(hash, owner);
  anticrack::testing::flip(path, 17);
  EXPECT_TRUE(throws([&] { arrays.resolve(loads[0], *store); }, Reason::storage, "force.array"));
  EXPECT_EQ(upload(5), hash);  // again
  EXPECT_EQ(*values(arrays.resolve(loads[1], *store)), std::vector<double>(5, 1.5));
}

}  // namespace
}  // namespace anticrack::jobs

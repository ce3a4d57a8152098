// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "store/digest.hpp"
#include "store/store.hpp"
#include "support/errors.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::TemporaryFolder;
using anticrack::testing::throws;
using errors::Reason;

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Uploads, AreFoundUnderTheirHash) {
  const TemporaryFolder folder;
  const auto store = make_memory_store(folder.path());
  const std::string text = "$MeshFormat";
  const std::string hash = Sha256().add(text).finish();
  EXPECT_FALSE(store->upload_path(hash));

  const std::string part = store->new_upload_path();
  std::ofstream(part, std::ios::binary) << text;
  EXPECT_FALSE(store->upload_path(hash));
  store->keep_upload(part, hash);
  ASSERT_TRUE(store->upload_path(hash));
  EXPECT_EQ(content(*store->upload_path(hash)), text);
  EXPECT_FALSE(std::filesystem::exists(part));
}

TEST(Uploads, OutliveTheStoreAndLeftOverPartsDoNot) {
  const TemporaryFolder folder;
  const std::string hash(64, 'a');
  std::string part;
  {
    const auto store = make_memory_store(folder.path());
    store->keep_upload(store->new_upload_path(), hash);
    part = store->new_upload_path();
    ASSERT_TRUE(std::filesystem::exists(part));
  }
  const auto store = make_memory_store(folder.path());
  EXPECT_TRUE(store->upload_path(hash));
  EXPECT_FALSE(std::filesystem::exists(part));
}

TEST(Uploads, NeverLeaveTheirFolder) {
  const TemporaryFolder folder;
  const auto store = make_memory_store(folder.path());
  std::ofstream(folder / "secret") << "x";
  EXPECT_FALSE(store->upload_path("../secret"));
  EXPECT_FALSE(store->upload_path(""));
  EXPECT_FALSE(store->upload_path(std::string(64, 'A')));
  const std::string part = store->new_upload_path();
  EXPECT_TRUE(throws([&] { store->keep_upload(part, "../stolen"); }, Reason::invalid_argument));
  EXPECT_FALSE(std::filesystem::exists(folder / "stolen"));
}

TEST(Uploads, GetFreshFiles) {
  const TemporaryFolder folder;
  const auto store = make_memory_store(folder.path());
  EXPECT_NE(store->new_upload_path(), store->new_upload_path());
}

TEST(Uploads, SayWhenTheFolderCannotBeWritten) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  EXPECT_TRUE(throws([&] { make_memory_store((folder / "file").string()); }, Reason::storage));
  const auto store = make_memory_store(folder.path());
  EXPECT_TRUE(
      throws([&] { store->keep_upload((folder / "nothing").string(), std::string(64, 'a')); },
             Reason::storage));
  std::filesystem::remove_all(folder / "uploads");
  EXPECT_TRUE(throws([&] { store->new_upload_path(); }, Reason::storage));
}

}  // namespace
}  // namespace anticrack::store

// SPDX-License-Identifier: GPL-3.0-or-later
#include <iterator>

#include "store/contract_fixture.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::throws;
using errors::Reason;

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class StoredUploads : public ContractTest {
 protected:
  static constexpr records::Clock::time_point for_ever = records::Clock::time_point::max();
};

TEST_P(StoredUploads, AreFoundByWhoMadeThem) {
  const std::string hash = upload("$MeshFormat", "ann");
  ASSERT_TRUE(store->upload_path(hash, "ann"));
  EXPECT_EQ(content(*store->upload_path(hash, "ann")), "$MeshFormat");
  EXPECT_FALSE(store->upload_path(hash, "bob"));
  EXPECT_FALSE(store->upload_path(hash, ""));
  EXPECT_EQ(upload("$MeshFormat", "bob"), hash);
  EXPECT_TRUE(store->upload_path(hash, "bob"));
  EXPECT_EQ(blobs(FileKind::upload), 1U);
  reopen();
  EXPECT_TRUE(store->upload_path(hash, "ann"));
  EXPECT_EQ(store->usage().uploads, 11U);
}

TEST_P(StoredUploads, LoseTheirPartsAtTheNextStart) {
  const std::string part = store->new_upload_path(10);
  EXPECT_NE(part, store->new_upload_path(10));
  ASSERT_TRUE(std::filesystem::exists(part));
  reopen();
  EXPECT_FALSE(std::filesystem::exists(part));
}

TEST_P(StoredUploads, NeverLeaveTheirFolder) {
  std::ofstream(folder / "secret") << "x";
  EXPECT_FALSE(store->upload_path("../secret", ""));
  const std::string part = store->new_upload_path(1);
  EXPECT_TRUE(throws(
      [&] {
        store->keep_uploads({{part, "../stolen"}}, "");
      },
      Reason::invalid_argument));
  const std::string hash(64, 'a');
  EXPECT_TRUE(throws(
      [&] {
        store->keep_uploads({{(folder / "secret").string(), hash}}, "");
      },
      Reason::internal));
  EXPECT_TRUE(throws(
      [&] {
        store->keep_uploads({{part + "/../../../secret", hash}}, "");
      },
      Reason::internal));
  EXPECT_FALSE(std::filesystem::exists(folder / "stolen"));
  EXPECT_TRUE(std::filesystem::exists(folder / "secret"));
}

TEST_P(StoredUploads, SayWhenTheirPartIsGone) {
  const std::string part = store->new_upload_path(1);
  std::filesystem::remove(part);
  EXPECT_TRUE(throws(
      [&] {
        store->keep_uploads({{part, std::string(64, 'a')}}, "");
      },
      Reason::storage));
  EXPECT_FALSE(store->upload_path(std::string(64, 'a'), ""));
}

TEST_P(StoredUploads, ExpireByAge) {
  const std::string hash = upload("old", "ann");
  upload("old", "bob");
  EXPECT_EQ(store->expire_uploads(records::Clock::time_point{}), 0U);
  EXPECT_EQ(store->expire_uploads(for_ever), 2U);
  EXPECT_FALSE(store->upload_path(hash, "ann"));
  EXPECT_EQ(blobs(FileKind::upload), 0U);
  EXPECT_EQ(store->usage().uploads, 0U);
}

TEST_P(StoredUploads, StayWhileAJobNeedsThem) {
  const std::string hash = upload("array");
  records::JobRecord record = job_record("j");
  record.spec.loads.push_back({"load", fem::Array{hash, false, nullptr}});
  record.spec.loads.push_back({"again", fem::Array{hash, true, nullptr}});
  store->create(record, "");
  reopen();
  EXPECT_EQ(store->expire_uploads(for_ever), 0U);
  end_later("j");
  EXPECT_EQ(store->expire_uploads(for_ever), 1U);

  upload("array");
  record.id = "k";
  store->create(record, "");
  store->erase_job("k");
  EXPECT_EQ(store->expire_uploads(for_ever), 1U);
}

TEST_P(StoredUploads, StayWhileASweepNeedsThem) {
  const std::string matrix = upload("matrix");
  records::JobRecord record = job_record("j");
  record.spec.sweep.emplace().upload = matrix;
  store->create(record, "");
  reopen();
  EXPECT_EQ(store->expire_uploads(for_ever), 0U);
  end_later("j");
  EXPECT_EQ(store->expire_uploads(for_ever), 1U);
  EXPECT_FALSE(store->upload_path(matrix, ""));
}

TEST_P(StoredUploads, AreErasedByWhoMadeThemUnlessNeeded) {
  const std::string hash = upload("$MeshFormat", "ann");
  upload("$MeshFormat", "bob");
  EXPECT_TRUE(throws([&] { store->erase_upload(hash, "eve"); }, Reason::not_found));
  records::JobRecord record = job_record("j");
  record.owner = "ann";
  record.spec.sweep.emplace().upload = hash;
  store->create(record, "");
  records::MeshRecord mesh = meshed_record("m", strip(2));
  mesh.sha256.clear();
  mesh.owner = "ann";
  mesh.definition = records::UploadRef{hash, {}};
  store->put(mesh);
  EXPECT_TRUE(throws([&] { store->erase_upload(hash, "ann"); }, Reason::in_use));
  store->erase_job("j");
  EXPECT_TRUE(throws([&] { store->erase_upload(hash, "ann"); }, Reason::in_use));
  store->erase_upload(hash, "bob");  // the file stays while another has it
  EXPECT_EQ(blobs(FileKind::upload), 1U);
  ASSERT_EQ(store->uploads("ann", "", 10).size(), 1U);
  EXPECT_EQ(store->uploads("ann", "", 10)[0].bytes, 11U);
  EXPECT_FALSE(store->uploads("ann", "", 10)[0].array);
  EXPECT_TRUE(store->uploads("ann", hash, 10).empty());
  EXPECT_FALSE(store->upload(hash, "bob"));
  store->erase_mesh("m");
  store->erase_upload(hash, "ann");
  EXPECT_EQ(blobs(FileKind::upload), 0U);
}

TEST_P(StoredUploads, StayUntilTheirMeshIsMade) {
  const std::string hash = upload("msh");
  records::MeshRecord record = meshed_record("m", strip(2));
  const std::string sha256 = std::exchange(record.sha256, "");
  record.definition = records::UploadRef{hash, {}};
  store->put(record);
  EXPECT_EQ(store->expire_uploads(for_ever), 0U);
  record.sha256 = sha256;
  store->put(record, strip(2));
  EXPECT_EQ(store->expire_uploads(for_ever), 1U);
}

INSTANTIATE_TEST_SUITE_P(All, StoredUploads, stores, name_of_store);

}  // namespace
}  // namespace anticrack::store

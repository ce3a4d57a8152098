// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "client/jobs.hpp"
#include "client/lib/sample_block.hpp"
#include "client/lib/scripted_server.hpp"
#include "client/meshes.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::client {
namespace {

const std::string sent = sample_bytes(1000);

v1::ReadResultResponse layout_message() {
  v1::ReadResultResponse message;
  *message.mutable_layout() = sample_layout(sent);
  return message;
}

v1::ReadResultResponse chunk_message(std::size_t offset, std::size_t size) {
  v1::ReadResultResponse message;
  *message.mutable_chunk() = sample_chunk(sent, offset, size);
  return message;
}

v1::ReadResultResponse damaged_message(std::size_t offset, std::size_t size) {
  v1::ReadResultResponse message = chunk_message(offset, size);
  message.mutable_chunk()->set_crc32c(message.chunk().crc32c() + 1);
  return message;
}

std::vector<std::uint64_t> offsets(const ScriptedServer& server) {
  std::vector<std::uint64_t> result;
  for (const v1::ReadResultRequest& request : server.read()) {
    result.push_back(request.offset());
  }
  return result;
}

void expect_whole(const Block& block) {
  ASSERT_EQ(block.bytes.size(), sent.size());
  EXPECT_EQ(std::memcmp(block.bytes.data(), sent.data(), sent.size()), 0);
}

TEST(ReadResult, GoesOnWhereItWasInterrupted) {
  ScriptedServer server;
  server.reads = {{{layout_message(), chunk_message(0, 300)}, {Code::unavailable, "gone"}},
                  {{layout_message(), chunk_message(300, 300)}, {Code::ok, ""}},
                  {{layout_message(), chunk_message(600, 400)}, {}}};
  Connection connection(server.options());
  expect_whole(read_result(connection, "jobs/1"));
  EXPECT_THAT(offsets(server), ::testing::ElementsAre(0, 300, 600));
}

TEST(ReadResult, AsksAgainForADamagedChunk) {
  ScriptedServer server;
  server.reads = {{{layout_message(), chunk_message(0, 300), damaged_message(300, 300)}, {}},
                  {{layout_message(), chunk_message(300, 700)}, {}}};
  Connection connection(server.options());
  expect_whole(read_result(connection, "jobs/1"));
  EXPECT_THAT(offsets(server), ::testing::ElementsAre(0, 300));
}

TEST(ReadResult, GivesUpOnAChunkThatIsDamagedEveryTime) {
  ScriptedServer server;
  server.reads = {{{layout_message(), damaged_message(0, 300)}, {}}};
  Connection connection(server.options());
  try {
    read_result(connection, "jobs/1");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Code::data_loss);
  }
  EXPECT_EQ(server.read().size(), 3U);
}

TEST(ReadResult, GivesUpOnABlockWhoseBytesNeverCome) {
  ScriptedServer server;
  v1::ReadResultResponse huge = layout_message();
  huge.mutable_layout()->set_size(std::uint64_t{1} << 63U);
  server.reads = {{{huge}, {}}};
  ConnectionOptions options = server.options();
  options.retry.patience = std::chrono::milliseconds(100);
  Connection connection(options);
  try {
    read_result(connection, "jobs/1");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Code::unavailable);
  }
}

TEST(ReadResult, ReportsARefusal) {
  ScriptedServer server;
  server.reads = {{{}, {Code::failed_precondition, "not ended"}}};
  Connection connection(server.options());
  try {
    read_result(connection, "jobs/1");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Code::failed_precondition);
  }
}

TEST(Upload, SendsTheWholeFileInChunksUnderItsHash) {
  ScriptedServer server;
  const testing::TemporaryFolder folder;
  const std::string content = sample_bytes((2u << 20) + 12345);
  const auto path = folder / "plate.msh";
  std::ofstream(path, std::ios::binary) << content;
  Connection connection(server.options());
  const std::string sha256 = digest::Sha256().add(content).finish();
  EXPECT_EQ(upload_mesh(connection, path), "uploads/" + sha256);
  EXPECT_EQ(server.upload_header().sha256(), sha256);
  EXPECT_EQ(server.upload_header().size(), content.size());
  EXPECT_EQ(server.upload_header().kind(), v1::Upload::KIND_MSH);
  EXPECT_TRUE(server.uploaded() == content);
  EXPECT_EQ(server.largest_upload_chunk(), 1u << 20);
}

TEST(Upload, SendsValuesAsTheyAre) {
  ScriptedServer server;
  std::vector<double> values(200'000);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = 0.5 * static_cast<double>(i) - 7;
  }
  Connection connection(server.options());
  const std::string upload = upload_array(connection, values);
  const std::string sent = server.uploaded();
  EXPECT_EQ(server.upload_header().kind(), v1::Upload::KIND_ARRAY);
  EXPECT_EQ(server.upload_header().size(), 1'600'000U);
  ASSERT_EQ(sent.size(), 1'600'000U);
  EXPECT_EQ(std::memcmp(sent.data(), values.data(), sent.size()), 0);
  EXPECT_EQ(upload, "uploads/" + digest::Sha256().add(sent).finish());
}

TEST(Upload, IsShownListedAndDeleted) {
  ScriptedServer server;
  Connection connection(server.options());
  const std::string name = upload_array(connection, std::vector<double>{1, 2, 3});
  EXPECT_EQ(get_upload(connection, name).size(), 24U);
  const v1::ListUploadsResponse list = list_uploads(connection, {});
  ASSERT_EQ(list.uploads_size(), 1);
  EXPECT_EQ(list.uploads(0).name(), name);
  delete_upload(connection, name);
  try {
    get_upload(connection, name);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Code::not_found);
  }
}

TEST(Upload, OfWhatCannotBeReadNamesThePath) {
  ScriptedServer server;
  const testing::TemporaryFolder folder;
  Connection connection(server.options());
  for (const auto& path : {folder / "missing.msh", std::filesystem::path(folder.path())}) {
    try {
      upload_mesh(connection, path);
      FAIL() << path;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(path.string()));
    }
  }
}

}  // namespace
}  // namespace anticrack::client

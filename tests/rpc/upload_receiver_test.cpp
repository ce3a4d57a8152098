// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/upload_receiver.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "errors/errors.hpp"
#include "rpc/refusals.hpp"
#include "rpc/requests.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::packed;
using anticrack::testing::small_msh;
using errors::Error;
using errors::Reason;

v1::CreateUploadsRequest header_of(const std::string& content,
                                   v1::Upload::Kind kind = v1::Upload::KIND_UNSPECIFIED) {
  v1::CreateUploadsRequest request;
  *request.mutable_header() = anticrack::testing::upload_header(content, kind);
  return request;
}

v1::CreateUploadsRequest chunk_of(const std::string& content) {
  v1::CreateUploadsRequest request;
  request.set_chunk(content);
  return request;
}

class UploadReceiverTest : public ::testing::Test {
 protected:
  std::size_t files() const {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(_folder / "uploads")) {
      if (entry.is_regular_file()) ++count;
    }
    return count;
  }

  /// The requests, then complete(); expects the error, and no file left.
  void expect_refused(const std::vector<v1::CreateUploadsRequest>& requests, Reason reason,
                      const std::string& field) {
    rpc::expect_refused(
        [&] {
          UploadReceiver receiver(*_store, "ada", 10'000);
          for (const auto& request : requests) receiver.accept(request);
          receiver.complete();
        },
        reason, field);
    EXPECT_EQ(files(), 0u);
  }

  anticrack::testing::TemporaryFolder _folder;
  std::unique_ptr<store::Store> _store = store::open({_folder.path()});
};

TEST_F(UploadReceiverTest, KeepsWhatWasSent) {
  const std::string content = small_msh();
  UploadReceiver receiver(*_store, "ada", 10'000);
  receiver.accept(header_of(content));
  receiver.accept(chunk_of(content.substr(0, 20)));
  receiver.accept(chunk_of(content.substr(20)));
  const std::string sha256 = receiver.complete().front().id;
  EXPECT_EQ(sha256, digest::Sha256().add(content).finish());
  const auto path = _store->upload_path(sha256, "ada");
  ASSERT_TRUE(path);
  EXPECT_FALSE(_store->upload_path(sha256, "bob"));
  std::ostringstream kept;
  kept << std::ifstream(*path).rdbuf();
  EXPECT_EQ(kept.str(), content);
  EXPECT_EQ(files(), 1u);
}

TEST_F(UploadReceiverTest, LeavesNothingBehindWhenItIsDropped) {
  {
    UploadReceiver receiver(*_store, "ada", 10'000);
    receiver.accept(header_of(small_msh()));
    receiver.accept(chunk_of("$Mesh"));
    EXPECT_EQ(files(), 1u);
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(UploadReceiverTest, StoresNothingBeforeAHeaderWithinTheLimits) {
  expect_refused({chunk_of("$MeshFormat")}, Reason::invalid_argument, "header");
  expect_refused({}, Reason::invalid_argument, "header");
  expect_refused({v1::CreateUploadsRequest()}, Reason::invalid_argument, "chunk");
  expect_refused({header_of(std::string(10'001, 'x'))}, Reason::limit_exceeded, "header.size");
  expect_refused({header_of("")}, Reason::mesh_invalid, "header.size");
  v1::CreateUploadsRequest upper = header_of(small_msh());
  upper.mutable_header()->set_sha256(std::string(64, 'A'));
  expect_refused({upper}, Reason::invalid_argument, "header.sha256");
  expect_refused({header_of("x"), header_of("x")}, Reason::invalid_argument, "header");
}

TEST_F(UploadReceiverTest, ComparesWithTheHeader) {
  const std::string content = small_msh();
  expect_refused({header_of(content), chunk_of(content + "x")}, Reason::invalid_argument,
                 "header.size");
  expect_refused({header_of(content), chunk_of(content.substr(1))}, Reason::invalid_argument,
                 "header.size");
  std::string other = content;
  other.back() = '?';
  expect_refused({header_of(content), chunk_of(other)}, Reason::invalid_argument, "header.sha256");
}

TEST_F(UploadReceiverTest, LetsNothingPassThatGmshWouldRun) {
  for (const std::string content : {"SystemCall \"touch /nowhere\";\n", "// $MeshFormat\n",
                                    "\x7f"
                                    "ELF"}) {
    expect_refused({header_of(content), chunk_of(content)}, Reason::mesh_invalid, "chunk");
  }
}

v1::CreateUploadsRequest array_header_of(const std::string& content) {
  return header_of(content, v1::Upload::KIND_ARRAY);
}

TEST_F(UploadReceiverTest, KeepsArrays) {
  const std::string content = packed({1, -2.5, 1e300});
  UploadReceiver receiver(*_store, "ada", 10'000);
  receiver.accept(array_header_of(content));
  receiver.accept(chunk_of(content.substr(0, 5)));
  receiver.accept(chunk_of(content.substr(5)));
  EXPECT_TRUE(_store->upload_path(receiver.complete().front().id, "ada"));
}

TEST_F(UploadReceiverTest, TakesNothingElseForAnArray) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused({array_header_of("")}, Reason::invalid_argument, "header.size");
  expect_refused({array_header_of("123456789")}, Reason::invalid_argument, "header.size");
  const std::string bad = packed({1, nan});
  expect_refused({array_header_of(bad), chunk_of(bad)}, Reason::invalid_argument, "chunk");
  const std::string msh = "$MeshFormat\n2.2 ";
  expect_refused({array_header_of(msh), chunk_of(msh)}, Reason::invalid_argument, "chunk");
  const std::string array = packed({1, 2});
  expect_refused({header_of(array), chunk_of(array)}, Reason::mesh_invalid, "chunk");
  v1::CreateUploadsRequest unknown = header_of(array);
  unknown.mutable_header()->set_kind(static_cast<v1::Upload::Kind>(9));
  expect_refused({unknown}, Reason::invalid_argument, "header.kind");
}

TEST_F(UploadReceiverTest, RefusesLargeChunks) {
  UploadReceiver receiver(*_store, "ada", 10'000'000);
  v1::CreateUploadsRequest header = header_of(small_msh());
  header.mutable_header()->set_size(5'000'000);
  receiver.accept(header);
  EXPECT_THROW(receiver.accept(chunk_of(std::string((1u << 20) + 1, 'x'))), Error);
  EXPECT_EQ(files(), 0u);
}

TEST_F(UploadReceiverTest, KeepsFilesOfOneStreamInTheirOrder) {
  UploadReceiver receiver(*_store, "ada", 10'000);
  const std::vector<std::string> contents = {std::string(8, '1'), small_msh(), std::string(16, '2'),
                                             std::string(8, '1')};
  std::vector<std::string> expected;
  for (const std::string& content : contents) {
    receiver.accept(content == small_msh() ? header_of(content) : array_header_of(content));
    receiver.accept(chunk_of(content));
    expected.push_back(digest::Sha256().add(content).finish());
  }
  std::vector<std::string> kept;
  for (const store::UploadRecord& record : receiver.complete()) {
    kept.push_back(record.id);
    EXPECT_EQ(record.array, record.bytes != small_msh().size());
    const auto stored = _store->upload(record.id, "ada");
    ASSERT_TRUE(stored);
    EXPECT_EQ(record.bytes, stored->bytes);
    EXPECT_EQ(record.array, stored->array);
    EXPECT_EQ(record.created, stored->created);
  }
  EXPECT_EQ(kept, expected);
  for (const std::string& sha256 : expected) EXPECT_TRUE(_store->upload_path(sha256, "ada"));
  EXPECT_EQ(files(), 3u) << "equal files are one";
}

TEST_F(UploadReceiverTest, NamesTheFileAtFaultAndKeepsNone) {
  const std::string good(8, '1');
  const std::string infinite("\0\0\0\0\0\0\xf0\x7f", 8);
  using Requests = std::vector<v1::CreateUploadsRequest>;
  const Requests head = {array_header_of(good), chunk_of(good), array_header_of(good),
                         chunk_of(good)};
  for (const Requests& tail : {Requests{array_header_of(infinite), chunk_of(infinite)},
                               Requests{array_header_of(good), chunk_of(infinite)},
                               Requests{array_header_of(good), chunk_of("1")},
                               Requests{array_header_of(good), chunk_of("1"), header_of(good)},
                               Requests{array_header_of("123")}}) {
    try {
      UploadReceiver receiver(*_store, "ada", 10'000);
      for (const auto& request : head) receiver.accept(request);
      for (const auto& request : tail) receiver.accept(request);
      receiver.complete();
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.metadata().at("file"), "2") << error.what();
    }
    EXPECT_EQ(files(), 0u);
  }
}

TEST_F(UploadReceiverTest, BoundsTheFilesOfAStream) {
  const std::string content(8, '1');
  UploadReceiver receiver(*_store, "ada", 10'000);
  for (std::size_t i = 0; i < UploadReceiver::max_files; ++i) {
    receiver.accept(array_header_of(content));
    receiver.accept(chunk_of(content));
  }
  EXPECT_THROW(receiver.accept(array_header_of(content)), Error);
  EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace anticrack::rpc

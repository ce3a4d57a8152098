// SPDX-License-Identifier: GPL-3.0-or-later
//
// An upload, message by message, into a real store. A piece is a message of the stream. An odd
// first byte corrects size and hash of the headers, so that whole uploads are reached.
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "errors/errors.hpp"
#include "fuzz/input.hpp"
#include "fuzz/quiet_protobuf.hpp"
#include "rpc/upload_receiver.hpp"
#include "store/store.hpp"
#include "support/temporary_folder.hpp"

namespace {

using namespace anticrack;

constexpr std::uint64_t max_bytes = 1U << 16;
const std::string owner = "somebody";

const testing::TemporaryFolder& the_folder() {
  static const testing::TemporaryFolder folder;
  return folder;
}

/// One for all inputs: opening one makes a database.
store::Store& the_store() {
  static const auto store = store::open({the_folder().path(), 0});
  return *store;
}

std::vector<v1::CreateUploadsRequest> messages(fuzz::Pieces& pieces) {
  std::vector<v1::CreateUploadsRequest> list;
  while (!pieces.empty()) {
    if (!list.emplace_back().ParseFromString(pieces.piece())) list.pop_back();
  }
  return list;
}

void correct(std::vector<v1::CreateUploadsRequest>& list) {
  std::uint64_t size = 0;
  digest::Sha256 hash;
  for (const auto& message : list) {
    if (!message.has_chunk()) continue;
    size += message.chunk().size();
    hash.add(message.chunk());
  }
  const std::string sha256 = hash.finish();
  for (auto& message : list) {
    if (!message.has_header()) continue;
    message.mutable_header()->set_size(size);
    message.mutable_header()->set_sha256(sha256);
  }
}

/// Neither parts of uploads that are not whole stay, nor what has expired.
void require_nothing_left() {
  the_store().expire_uploads(records::Clock::now() + std::chrono::hours(1));
  const std::filesystem::directory_iterator left(the_folder() / "uploads");
  fuzz::require(left == std::filesystem::directory_iterator(), "a file is left behind");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Pieces pieces(fuzz::text_of(data, size));
  const bool corrected = pieces.selector() % 2 == 1;
  std::vector<v1::CreateUploadsRequest> list = messages(pieces);
  if (corrected) correct(list);
  try {
    rpc::UploadReceiver receiver(the_store(), owner, max_bytes);
    for (const auto& message : list) receiver.accept(message);
    const std::string sha256 = receiver.complete().front().id;
    const auto path = the_store().upload_path(sha256, owner);
    fuzz::require(path.has_value(), "an upload that was accepted is not there");
    fuzz::require(std::filesystem::file_size(*path) <= max_bytes, "an upload over the bound");
  } catch (const errors::Error& error) {
    fuzz::require(error.reason() != errors::Reason::internal, error.what());
  }
  require_nothing_left();
  return 0;
}

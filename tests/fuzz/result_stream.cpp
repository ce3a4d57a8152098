// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a server tells the client of a result: the layouts and chunks of two blocks, put together,
// and the result assembled of them. Pieces: a layout and a chunk for each block. An odd first byte
// corrects sums and sizes, so that whole blocks are reached.
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "client/block.hpp"
#include "client/error.hpp"
#include "digest/digest.hpp"
#include "fuzz/input.hpp"
#include "fuzz/quiet_protobuf.hpp"
#include "fuzz/small_result.hpp"
#include "results/assemble.hpp"

namespace {

using namespace anticrack;

client::Block receive(fuzz::Pieces& pieces, bool corrected) {
  v1::BlockLayout layout;
  v1::BlockChunk chunk;
  layout.ParseFromString(pieces.piece());
  if (corrected) {
    chunk.set_data(pieces.piece());
    const auto bytes = std::as_bytes(std::span(chunk.data()));
    chunk.set_crc32c(digest::crc32c(bytes));
    layout.set_size(chunk.data().size());
    layout.set_sha256(digest::Sha256().add(bytes).finish());
  } else {
    chunk.ParseFromString(pieces.piece());
  }
  client::BlockReceiver receiver;
  receiver.accept(layout);
  receiver.accept(chunk);
  return receiver.finish();
}

std::shared_ptr<const std::vector<std::byte>> shared(const client::Block& block) {
  return std::make_shared<const std::vector<std::byte>>(block.bytes);
}

/// What the messages say of the job the seeds are of.
results::Result answers() {
  results::Result result = fuzz::small_result();
  result.arrays.clear();
  return result;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const results::Result known = answers();
  fuzz::Pieces pieces(fuzz::text_of(data, size));
  const bool corrected = pieces.selector() % 2 == 1;
  try {
    const client::Block mesh = receive(pieces, corrected);
    const client::Block result = receive(pieces, corrected);
    const results::Result whole =
        results::assemble(known, {mesh.layout, shared(mesh)}, {result.layout, shared(result)});
    const std::string fault = results::first_fault(whole);
    fuzz::require(fault.empty(), fault.c_str());
  } catch (const client::Error&) {
  } catch (const results::Error&) {
  }
  return 0;
}

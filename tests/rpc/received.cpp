// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/received.hpp"

#include <span>
#include <utility>

#include "digest/digest.hpp"

namespace anticrack::testing {
namespace {

template <class Response, class Reader>
grpc::Status receive(Reader& reader, std::uint64_t offset, Received& to) {
  Response response;
  while (reader.Read(&response)) {
    if (response.has_layout()) {
      EXPECT_EQ(static_cast<int>(response.layout().first_array()), to.layout.arrays_size());
      EXPECT_LE(response.ByteSizeLong(), 1u << 20);
      google::protobuf::RepeatedPtrField<v1::ArrayLayout> arrays =
          std::move(*to.layout.mutable_arrays());
      to.layout = response.layout();
      to.layout.mutable_arrays()->Swap(&arrays);
      to.layout.mutable_arrays()->MergeFrom(arrays);
      EXPECT_EQ(to.chunks, 0);
      continue;
    }
    const v1::BlockChunk& chunk = response.chunk();
    EXPECT_EQ(chunk.offset(), offset + to.bytes.size());
    EXPECT_LE(chunk.data().size(), 1u << 20);
    EXPECT_EQ(digest::crc32c(std::as_bytes(std::span(chunk.data()))), chunk.crc32c());
    to.bytes += chunk.data();
    ++to.chunks;
  }
  return reader.Finish();
}

}  // namespace

grpc::Status read_result(RunningServer& server, const std::string& job, std::uint64_t offset,
                         Received& to) {
  Context context;
  auto request = named<v1::ReadResultRequest>(job);
  request.set_offset(offset);
  const auto reader = server.jobs->ReadResult(&context, request);
  return receive<v1::ReadResultResponse>(*reader, offset, to);
}

grpc::Status read_mesh(RunningServer& server, const std::string& mesh, std::uint64_t offset,
                       Received& to) {
  Context context;
  auto request = named<v1::ReadMeshRequest>(mesh);
  request.set_offset(offset);
  const auto reader = server.meshes->ReadMesh(&context, request);
  return receive<v1::ReadMeshResponse>(*reader, offset, to);
}

const v1::ArrayLayout* find_array(const Received& block, const std::string& name) {
  for (const v1::ArrayLayout& array : block.layout.arrays()) {
    if (array.name() == name) return &array;
  }
  return nullptr;
}

std::vector<double> doubles(const Received& block, const std::string& name) {
  return values_of<double>(block, name, v1::ArrayLayout::TYPE_FLOAT64);
}

}  // namespace anticrack::testing

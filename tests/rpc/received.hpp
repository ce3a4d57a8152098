// SPDX-License-Identifier: GPL-3.0-or-later
//
// Blocks as a client receives them.
#pragma once

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "rpc/running_server.hpp"

namespace anticrack::testing {

struct Received {
  v1::BlockLayout layout;
  std::string bytes;
  int chunks = 0;
};

/// From an offset to the end; chunks are checked on the way.
grpc::Status read_result(RunningServer& server, const std::string& job, std::uint64_t offset,
                         Received& to);
grpc::Status read_mesh(RunningServer& server, const std::string& mesh, std::uint64_t offset,
                       Received& to);

/// Null where there is no array of this name.
const v1::ArrayLayout* find_array(const Received& block, const std::string& name);

/// The values of an array in one piece; a gtest failure where it is missing or of another type.
template <class T>
std::vector<T> values_of(const Received& block, const std::string& name, v1::ArrayLayout::Type type,
                         std::vector<std::uint64_t>* shape = nullptr) {
  const v1::ArrayLayout* array = find_array(block, name);
  if (array == nullptr || array->type() != type) {
    ADD_FAILURE() << "no array " << name << " of type " << type;
    return {};
  }
  std::size_t count = 1;
  for (const std::uint64_t extent : array->shape()) count *= extent;
  if (array->offset() + count * sizeof(T) > block.bytes.size()) {
    ADD_FAILURE() << name << " is not all there";
    return {};
  }
  std::vector<T> values(count);
  std::memcpy(values.data(), block.bytes.data() + array->offset(), count * sizeof(T));
  if (shape != nullptr) shape->assign(array->shape().begin(), array->shape().end());
  return values;
}

std::vector<double> doubles(const Received& block, const std::string& name);

}  // namespace anticrack::testing

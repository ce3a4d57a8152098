// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/block.hpp"

namespace anticrack::results {
namespace {

constexpr const char* fetch_again =
    "the server and this client do not understand each other: compare their versions with "
    "`anticrack server`";

std::size_t size_of(ArrayView::Type type) {
  switch (type) {
    case ArrayView::Type::float64:
      return 8;
    case ArrayView::Type::int32:
      return 4;
    case ArrayView::Type::uint8:
      return 1;
  }
  return 1;
}

}  // namespace

const char* name_of(ArrayView::Type type) {
  switch (type) {
    case ArrayView::Type::float64:
      return "float64";
    case ArrayView::Type::int32:
      return "int32";
    case ArrayView::Type::uint8:
      return "uint8";
  }
  return "";
}

std::string text_of(const std::vector<std::uint64_t>& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    text += (i == 0 ? "" : ",") + std::to_string(shape[i]);
  }
  return text + ")";
}

std::uint64_t byte_count(const std::string& subject, const ArrayView& array) {
  std::uint64_t bytes = size_of(array.type);
  for (const std::uint64_t extent : array.shape) {
    if (__builtin_mul_overflow(bytes, extent, &bytes)) {
      throw Error(subject,
                  "array " + array.name + " has the impossible shape " + text_of(array.shape),
                  fetch_again);
    }
  }
  return bytes;
}

void Block::fail(const std::string& cause) const {
  throw Error(_subject, cause, fetch_again);
}

Edges edges_of(const Block& block, const std::string& interface) {
  const std::string at = "interfaces/" + interface;
  return {kinds_of(block.get<std::int32_t>(at + "/kind")),
          block.get<std::int32_t>(at + "/inclusion")};
}

void add_mesh(const Block& block, Mesh& mesh) {
  mesh.xy = block.get<double>("nodes", 2);
  mesh.triangles = block.get<std::int32_t>("triangles", 3);
  mesh.subdomain = block.get<std::int32_t>("subdomain");
  mesh.boundary = block.get<std::int32_t>("boundary", 2);
  const std::string fault = first_mesh_fault(mesh);
  if (!fault.empty()) block.fail(fault);
}

ArrayView view(std::string name, ArrayView::Type type, std::vector<std::uint64_t> shape,
               std::uint64_t offset, std::span<const std::byte> block) {
  const std::string subject = "a block of the server";
  ArrayView array{std::move(name), type, std::move(shape), {}};
  const std::uint64_t bytes = byte_count(subject, array);
  if (offset > block.size() || bytes > block.size() - offset) {
    throw Error(subject,
                "array " + array.name + " of shape " + text_of(array.shape) + " at byte " +
                    std::to_string(offset) + " lies outside the " + std::to_string(block.size()) +
                    " bytes",
                fetch_again);
  }
  array.bytes = block.subspan(offset, bytes);
  return array;
}

}  // namespace anticrack::results

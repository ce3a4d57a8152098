// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the helper process does with an uploaded .msh, in this process.
#include "errors/errors.hpp"
#include "fuzz/input.hpp"
#include "mesh/codec.hpp"
#include "mesher/grading.hpp"
#include "mesher/import.hpp"

namespace {

using namespace anticrack;

constexpr std::size_t max_triangles = 2'000;

void check_reply(const mesh::Mesh& mesh) {
  mesh::validate(mesh);
  const mesh::Bytes bytes = mesh::encode(mesh::MesherReply(mesh));
  const mesh::MesherReply back = mesh::decode_reply(bytes);
  fuzz::require(mesh::encode(back) == bytes, "the reply comes back as another");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const mesh::Mesh base =
        mesher::import_msh(fuzz::text_of(data, size), mesh::MeshOptions{}, max_triangles);
    check_reply(base);
    check_reply(mesher::graded(base, mesh::MeshOptions{}, max_triangles));
  } catch (const errors::Error& error) {
    fuzz::require(error.reason() != errors::Reason::internal, error.what());
  }
  return 0;
}

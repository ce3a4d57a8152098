// SPDX-License-Identifier: GPL-3.0-or-later
//
// What travels between server and helper, and what a stored mesh is: the first byte chooses.
#include <span>
#include <string>

#include "errors/errors.hpp"
#include "fuzz/input.hpp"
#include "mesh/codec.hpp"

namespace {

using namespace anticrack;

/// What was decoded comes back from its own bytes as it is.
template <class Decode>
void check(std::span<const std::byte> bytes, const Decode& decode) {
  const mesh::Bytes once = mesh::encode(decode(bytes));
  fuzz::require(mesh::encode(decode(once)) == once, "what was decoded comes back as another");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Pieces pieces(fuzz::text_of(data, size));
  const int which = pieces.selector() % 3;
  const std::string rest = pieces.rest();
  const auto bytes = std::as_bytes(std::span(rest));
  try {
    if (which == 0) check(bytes, [](auto b) { return mesh::decode_request(b); });
    if (which == 1) check(bytes, [](auto b) { return mesh::decode_reply(b); });
    if (which == 2) {
      check(bytes, [](auto b) {
        mesh::Mesh mesh = mesh::decode_mesh(b);
        try {
          mesh::validate(mesh);
        } catch (const errors::Error&) {
        }
        return mesh;
      });
    }
  } catch (const errors::Error&) {
  }
  return 0;
}

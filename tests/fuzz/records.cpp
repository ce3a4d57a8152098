// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the store's database holds: the first byte chooses between meshes and jobs.
#include <string>

#include "errors/errors.hpp"
#include "fuzz/input.hpp"
#include "fuzz/quiet_protobuf.hpp"
#include "records/case_record.hpp"
#include "records/job_record.hpp"
#include "records/mesh_record.hpp"
#include "store/record_codec.hpp"

namespace {

using namespace anticrack;

template <class Decode>
void check(const std::string& bytes, const Decode& decode) {
  const std::string once = store::encode(decode(bytes));
  fuzz::require(store::encode(decode(once)) == once, "the record comes back as another");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Pieces pieces(fuzz::text_of(data, size));
  const bool job = pieces.selector() % 2 == 1;
  try {
    job ? check(pieces.rest(), store::decode_job_record)
        : check(pieces.rest(), store::decode_mesh_record);
  } catch (const errors::Error&) {
  }
  return 0;
}

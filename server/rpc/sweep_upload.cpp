// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/sweep_upload.hpp"

#include "api/requests.hpp"
#include "digest/digest.hpp"
#include "errors/errors.hpp"
#include "rpc/block_feed.hpp"
#include "rpc/upload_receiver.hpp"

namespace anticrack::rpc {

static_assert(api::max_packed_bytes <= max_chunk_bytes, "it is one chunk");

bool has_packed_matrix(const v1::JobSpec& spec) {
  const v1::Sweep::Matrix* matrix = api::matrix_of(spec.sweep()).matrix;
  return matrix != nullptr && matrix->has_packed();
}

void keep_packed_matrix(const v1::JobSpec& spec, store::Store& store, const std::string& owner) {
  const auto [matrix, field] = api::matrix_of(spec.sweep());
  const std::string& packed = matrix->packed();
  v1::CreateUploadsRequest header;
  header.mutable_header()->set_size(packed.size());
  header.mutable_header()->set_sha256(digest::Sha256().add(packed).finish());
  header.mutable_header()->set_kind(v1::Upload::KIND_ARRAY);
  v1::CreateUploadsRequest values;
  values.set_chunk(packed);
  UploadReceiver receiver(store, owner, api::max_packed_bytes);
  try {
    receiver.accept(header);
    receiver.accept(values);
    receiver.complete();
  } catch (const errors::Error& error) {
    if (error.fields().empty()) throw;  // an error of the disk, not of the matrix
    throw errors::Error(error.reason(), error.what()).at(field + ".packed");
  }
}

}  // namespace anticrack::rpc

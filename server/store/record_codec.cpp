// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/record_codec.hpp"

#include <algorithm>
#include <limits>

#include "api/translations.hpp"
#include "records/job_record.hpp"
#include "records/mesh_record.hpp"
#include "store/records.pb.h"

namespace anticrack::store {

using errors::Error;
using errors::Reason;

Error damaged_record(const std::string& what) {
  return {Reason::storage, "its record in the database is damaged (" + what +
                               "): delete it and make it again, or restore the data folder from a "
                               "backup"};
}

namespace {

/// Calls read(message); its errors become those of a damaged record.
template <class Record, class Read>
auto decoded(std::string_view bytes, const Read& read) {
  Record record;
  if (bytes.size() > std::size_t{std::numeric_limits<int>::max()} ||
      !record.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
    throw damaged_record("it cannot be parsed");
  try {
    return read(record);
  } catch (const Error& error) {
    throw damaged_record(error.what());
  }
}

}  // namespace

std::string encode(const records::MeshRecord& record) {
  disk::MeshRecord out;
  api::Translation<records::MeshRecord>::write(record, *out.mutable_mesh());
  if (const auto* refinement = std::get_if<records::Refinement>(&record.definition))
    api::write_field(*refinement, out, "refinement");
  else
    api::write_definition(record.definition, *out.mutable_definition());
  api::write_field(record.for_job, out, "for_job");
  return api::serialized(out);
}

std::string encode(const records::JobRecord& record) {
  disk::JobRecord out;
  api::Translation<records::JobRecord>::write(record, *out.mutable_job());
  api::write_field(record.request_id, out, "request_id");
  api::write_field(record.crashes, out, "crashes");
  return api::serialized(out);
}

records::MeshRecord decode_mesh_record(std::string_view bytes) {
  return decoded<disk::MeshRecord>(bytes, [](const disk::MeshRecord& in) {
    records::MeshRecord record = api::Translation<records::MeshRecord>::read(in.mesh());
    if (in.has_refinement())
      record.definition = api::read_one<records::Refinement>(in, "refinement");
    else
      record.definition = api::read_definition(in.definition());
    record.for_job = in.for_job();
    return record;
  });
}

records::JobRecord decode_job_record(std::string_view bytes) {
  return decoded<disk::JobRecord>(bytes, [](const disk::JobRecord& in) {
    records::JobRecord record = api::Translation<records::JobRecord>::read(in.job());
    record.request_id = in.request_id();
    record.crashes = in.crashes();
    return record;
  });
}

}  // namespace anticrack::store

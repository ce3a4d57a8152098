// SPDX-License-Identifier: GPL-3.0-or-later
//
// Records as bytes (records.proto). Exact: every field comes back bit by bit, except what a record
// does not keep: an answer's traces, fields and closed contacts, the values of an array.
#pragma once

#include <string>
#include <string_view>

#include "store/records.hpp"

namespace anticrack::store {

/// What the database keeps.
std::string encode(const MeshRecord& record);
std::string encode(const JobRecord& record);

/// Throw errors::Error (storage) where the bytes are no record.
MeshRecord decode_mesh_record(std::string_view bytes);
JobRecord decode_job_record(std::string_view bytes);

}  // namespace anticrack::store

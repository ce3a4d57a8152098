// SPDX-License-Identifier: GPL-3.0-or-later
//
// Translations of structs whose fields differ from those of the message. All other structs are
// translated field by field (translation.hpp). Reading throws errors::Error (invalid_argument, with
// the field at fault); the domain checks the values.
#pragma once

#include <chrono>
#include <span>
#include <string>
#include <vector>

#include "anticrack/v1/error.pb.h"
#include "anticrack/v1/job.pb.h"
#include "anticrack/v1/mesh.pb.h"
#include "api/translation.hpp"
#include "records/block.hpp"
#include "records/job_record.hpp"
#include "records/mesh_record.hpp"

namespace anticrack::v1 {
class Job;
class LoadCaseAnswer;
class Stage;
}  // namespace anticrack::v1

namespace anticrack::api {

#define ANTICRACK_TRANSLATION(Type, Message)           \
  template <>                                          \
  struct Translation<Type> {                           \
    using Of = Message;                                \
    static void write(const Type& value, Message& to); \
    static Type read(const Message& from);             \
  }

// times, in nanoseconds
ANTICRACK_TRANSLATION(records::Clock::time_point, google::protobuf::Timestamp);
ANTICRACK_TRANSLATION(std::chrono::nanoseconds, google::protobuf::Duration);

/// The error without the code, at full length; see error_message.hpp.
ANTICRACK_TRANSLATION(errors::Error, v1::Status);

// mesh/
/// Like the others, but reading throws if a single point is not set.
template <>
struct Translation<mesh::Point> {
  using Of = v1::Point;
  static constexpr bool required = true;
  static void write(const mesh::Point& value, v1::Point& to);
  static mesh::Point read(const v1::Point& from);
};
ANTICRACK_TRANSLATION(std::vector<mesh::Point>, v1::Polyline);
ANTICRACK_TRANSLATION(mesh::InterfaceSpec, v1::InterfaceCurve);
ANTICRACK_TRANSLATION(mesh::LineSpec, v1::Line);
ANTICRACK_TRANSLATION(mesh::OutlineSpec, v1::Outline);
ANTICRACK_TRANSLATION(mesh::InclusionSpec, v1::Inclusion);
ANTICRACK_TRANSLATION(mesh::CrackSpec, v1::Crack);
ANTICRACK_TRANSLATION(mesh::RegionSpec, v1::Region);
ANTICRACK_TRANSLATION(mesh::MeshOptions, v1::MeshOptions);

// fem/ and contact/
ANTICRACK_TRANSLATION(fem::Force, v1::Force);
ANTICRACK_TRANSLATION(fem::PointForce, v1::PointForce);
ANTICRACK_TRANSLATION(contact::UzawaOptions, v1::Uzawa);
ANTICRACK_TRANSLATION(contact::ActiveSetOptions, v1::ActiveSet);
ANTICRACK_TRANSLATION(contact::SolverOptions, v1::Solver);

// store/
/// The record without the definition.
ANTICRACK_TRANSLATION(records::MeshRecord, v1::Mesh);
ANTICRACK_TRANSLATION(records::Refinement, v1::Refinement);
/// Its rows are in JobStatus.sweep_answer.
ANTICRACK_TRANSLATION(records::SweepSpec, v1::Sweep);
/// The record without the name, which is that of the load.
ANTICRACK_TRANSLATION(records::CaseRecord, v1::LoadCaseAnswer);
ANTICRACK_TRANSLATION(records::AccuracySpec, v1::Accuracy);
ANTICRACK_TRANSLATION(records::StageRecord, v1::Stage);
ANTICRACK_TRANSLATION(records::JobSpec, v1::JobSpec);
/// The record without the request id.
ANTICRACK_TRANSLATION(records::JobRecord, v1::Job);
#undef ANTICRACK_TRANSLATION

/// The definition of a mesh: source and options of a v1::CreateMeshRequest or v1::Mesh. A
/// refinement exists only in the latter and in records.
void write_definition(const records::MeshDefinition& value, Message& to);
records::MeshDefinition read_definition(const v1::CreateMeshRequest& from);

/// Most arrays in one message of a layout; each takes some 100 bytes.
constexpr std::size_t max_layout_arrays = 4096;
/// The layout of a block: at most `count` of its arrays, from `first` on.
v1::BlockLayout layout_of(const records::BlockSource& block, std::size_t first = 0,
                          std::size_t count = max_layout_arrays);
/// The layout of all arrays in a block of `size` bytes.
v1::BlockLayout layout_of(std::span<const records::ArrayLayout> arrays, std::uint64_t size,
                          const std::string& sha256);

}  // namespace anticrack::api

// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is not the same fields in the struct and in the message of the API, each way. All else is
// translated by its name (translation.hpp). Reading throws errors::Error (invalid_argument, with
// the field at fault) where the message is no such value; what the value means is checked below.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "anticrack/v1/error.pb.h"
#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "api/translation.hpp"
#include "store/block.hpp"
#include "store/records.hpp"

namespace anticrack::api {

#define ANTICRACK_TRANSLATION(Type, Message)           \
  template <>                                          \
  struct Translation<Type> {                           \
    using Of = Message;                                \
    static void write(const Type& value, Message& to); \
    static Type read(const Message& from);             \
  }

// times: to the nanosecond
ANTICRACK_TRANSLATION(store::Clock::time_point, google::protobuf::Timestamp);
ANTICRACK_TRANSLATION(std::chrono::nanoseconds, google::protobuf::Duration);

/// Its code is left 0, and nothing is cut; see error_message.hpp.
ANTICRACK_TRANSLATION(errors::Error, v1::Status);

// mesh/
/// write() and read() as of all others; unset where one is due, reading throws.
template <>
struct Translation<mesh::Point> {
  using Of = v1::Point;
  static constexpr bool required = true;
  static void write(const mesh::Point& value, v1::Point& to);
  static mesh::Point read(const v1::Point& from);
};
ANTICRACK_TRANSLATION(std::vector<mesh::Point>, v1::Polyline);
ANTICRACK_TRANSLATION(mesh::InterfaceSpec, v1::InterfaceCurve);
ANTICRACK_TRANSLATION(mesh::InclusionSpec, v1::Inclusion);
ANTICRACK_TRANSLATION(mesh::RegionSpec, v1::Region);
ANTICRACK_TRANSLATION(mesh::MeshOptions, v1::MeshOptions);

// fem/ and contact/
ANTICRACK_TRANSLATION(fem::Force, v1::Force);
ANTICRACK_TRANSLATION(fem::PointForce, v1::PointForce);
ANTICRACK_TRANSLATION(contact::UzawaOptions, v1::Uzawa);
ANTICRACK_TRANSLATION(contact::ActiveSetOptions, v1::ActiveSet);
ANTICRACK_TRANSLATION(contact::SolverOptions, v1::Solver);

// store/
/// But for the title, which is the mesh's.
ANTICRACK_TRANSLATION(store::MeshDefinition, v1::CreateMeshRequest);
/// But for its definition.
ANTICRACK_TRANSLATION(store::MeshRecord, v1::Mesh);
/// Its rows are in Job.sweep_answer.
ANTICRACK_TRANSLATION(store::SweepSpec, v1::Sweep);
/// But for the name, which is the load's.
ANTICRACK_TRANSLATION(store::CaseRecord, v1::LoadCaseAnswer);
/// Of Job, what the client set.
ANTICRACK_TRANSLATION(store::JobSpec, v1::Job);
/// But for its request id.
ANTICRACK_TRANSLATION(store::JobRecord, v1::Job);
#undef ANTICRACK_TRANSLATION

/// Where the arrays of a block of `size` bytes lie.
v1::BlockLayout layout_of(const std::vector<store::ArrayLayout>& arrays, std::uint64_t size,
                          const std::string& sha256);
/// The same of a block.
inline v1::BlockLayout layout_of(const store::BlockSource& block) {
  return layout_of(block.arrays(), block.size(), block.sha256());
}

}  // namespace anticrack::api

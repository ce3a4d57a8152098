// SPDX-License-Identifier: GPL-3.0-or-later
//
// Meshes on the server: make them, wait for them, read them; and the files from which meshes and
// loads are made (MeshService, UploadService; requests and answers, with units, are those of
// anticrack/v1/mesh.proto and upload.proto).
//
// Threads, retries, Error and Interrupted are as in jobs.hpp.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/upload.pb.h"
#include "block.hpp"
#include "connection.hpp"
#include "error.hpp"

namespace anticrack::client {

/// Sends a mesh file (MSH 2.0 to 2.2 or 4.1, or of FreeFEM) in chunks of 1 MiB; returns
/// "uploads/SHA256", for CreateMeshRequest.upload. Sending it again is harmless. Error:
/// invalid_argument (no .msh, or over the server's upload limit), resource_exhausted. Throws
/// std::runtime_error if the file, which is read at once, cannot be read.
std::string upload_mesh(Connection& connection, const std::filesystem::path& path,
                        const std::stop_token& stop = {});

/// Sends values unchanged (float64, little-endian); returns "uploads/SHA256", for Force.Array and
/// Sweep.Matrix. Their unit is that of the quantity for which they are used. Error:
/// invalid_argument (over the server's upload limit), resource_exhausted.
std::string upload_array(Connection& connection, std::span<const double> values,
                         const std::stop_token& stop = {});

/// Returns the values of an array. It is called on a separate thread, for one array at a time and
/// in order, and again for arrays that must be sent again after a lost connection.
using ReadArray = std::function<std::vector<double>(std::size_t index)>;

/// upload_array for `count` arrays. They are sent together, each being read while the one before is
/// sent, and the server writes them to the disk together: all of a stream (500 arrays) or none.
/// Error: as upload_array; Details::metadata "file" is the index of the array at fault. Also throws
/// what `read` throws.
std::vector<std::string> upload_arrays(Connection& connection, std::size_t count,
                                       const ReadArray& read, const std::stop_token& stop = {});

/// An upload of this client ("uploads/SHA256"). Error: not_found.
v1::Upload get_upload(Connection& connection, const std::string& name,
                      const std::stop_token& stop = {});

/// One page of this client's uploads, by name. Error: invalid_argument (page token or size).
v1::ListUploadsResponse list_uploads(Connection& connection, const v1::ListUploadsRequest& request,
                                     const std::stop_token& stop = {});

/// Deletes an upload of this client. Error: not_found, failed_precondition (a job that has not
/// ended or a mesh that is not meshed needs it).
void delete_upload(Connection& connection, const std::string& name,
                   const std::stop_token& stop = {});

/// Requests the mesh of a geometry or of an upload. Returns before the mesh is made, most often
/// PENDING; a job may name it at once, and wait_for_mesh() waits for it. Equal requests give the
/// same mesh. Error: invalid_argument (Details::fields names the fields), not_found (the upload),
/// resource_exhausted.
v1::Mesh create_mesh(Connection& connection, const v1::CreateMeshRequest& request,
                     const std::stop_token& stop = {});

/// The present state of the mesh with this name ("meshes/ID"). Error: not_found.
v1::Mesh get_mesh(Connection& connection, const std::string& name,
                  const std::stop_token& stop = {});

/// One page of the meshes this client may see, the newest first. Error: invalid_argument (page
/// token or size).
v1::ListMeshesResponse list_meshes(Connection& connection, const v1::ListMeshesRequest& request,
                                   const std::stop_token& stop = {});

/// Starts factorising a mesh, so that the next job need not wait. `pin` (administrators only) keeps
/// it in memory until it is evicted. Returns before the mesh is factorised. Error: not_found,
/// failed_precondition (meshing failed), resource_exhausted (memory budget), permission_denied.
v1::Mesh warm_mesh(Connection& connection, const std::string& name, bool pin,
                   const std::stop_token& stop = {});

/// Frees the factors of a mesh; the next job makes them again. For administrators. Error:
/// not_found, failed_precondition (a running job uses them), permission_denied.
v1::Mesh evict_mesh(Connection& connection, const std::string& name,
                    const std::stop_token& stop = {});

/// Deletes a mesh. Error: not_found, failed_precondition (a job that has not ended uses it).
void delete_mesh(Connection& connection, const std::string& name, const std::stop_token& stop = {});

/// Whether the server is done with a mesh: READY, EVICTED or FAILED.
bool settled(v1::Mesh::State state);

/// Polls, at most once a second, until the mesh is settled or `enough`; calls `seen` for every new
/// state, on this thread. A mesh that FAILED is returned and does not throw: see Mesh.error. Error:
/// not_found.
v1::Mesh wait_for_mesh(Connection& connection, const std::string& name,
                       const std::function<void(const v1::Mesh&)>& seen = {},
                       const std::stop_token& stop = {},
                       const std::function<bool(const v1::Mesh&)>& enough = {});

/// Nodes, triangles and interfaces (ReadMeshResponse in mesh.proto lists the arrays); after a lost
/// connection the read goes on where it was. Coordinates are in the unit of the geometry. Error:
/// not_found, failed_precondition (not meshed yet), data_loss (damaged several times in a row).
Block read_mesh(Connection& connection, const std::string& name, const std::stop_token& stop = {});

}  // namespace anticrack::client

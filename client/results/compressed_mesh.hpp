// SPDX-License-Identifier: GPL-3.0-or-later
//
// The arrays of a mesh as HDF5 keeps them, compressed. That takes longer than all else of writing a
// result and needs nothing of the answers: it is done while they are computed.
#pragma once

#include <map>
#include <string>

#include "results/filtered_chunks.hpp"
#include "results/result.hpp"

namespace anticrack::results {

/// By the name of the dataset; small arrays are left out.
using CompressedMesh = std::map<std::string, hdf5::FilteredChunks>;

/// Calls nothing of HDF5: may run beside it on any thread. About 30 MB/s.
CompressedMesh compress(const Mesh& mesh);

}  // namespace anticrack::results

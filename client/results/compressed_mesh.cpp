// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/compressed_mesh.hpp"

#include <functional>

#include "results/tables.hpp"

namespace anticrack::results {

CompressedMesh compress(const Mesh& mesh) {
  CompressedMesh compressed;
  arrays::for_each(
      [&](const auto& row) {
        const auto& values = std::invoke(row.member, mesh);
        hdf5::FilteredChunks chunks = hdf5::filtered_chunks(
            std::as_bytes(std::span(values)), sizeof(values[0]), arrays::columns_of(row.shape));
        if (!chunks.empty()) compressed.emplace(row.name, std::move(chunks));
      },
      tables::mesh);
  return compressed;
}

}  // namespace anticrack::results

// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a server would send of a result.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "results/tables.hpp"

namespace anticrack::testing {

/// A block, array by array, as the server lays it out.
struct BlockMaker {
  v1::BlockLayout layout;
  std::vector<std::byte> bytes;

  BlockMaker& add(const std::string& name, const results::Array& added) {
    v1::ArrayLayout& array = *layout.add_arrays();
    array.set_name(name);
    array.set_type(static_cast<v1::ArrayLayout::Type>(added.type));
    array.mutable_shape()->Add(added.shape.begin(), added.shape.end());
    array.set_offset(bytes.size());
    const auto size = results::count_of(added.shape) * results::bytes_of(added.type);
    bytes.insert(bytes.end(), added.data.get(), added.data.get() + size);
    bytes.resize((bytes.size() + 7) / 8 * 8);
    return *this;
  }
  template <class T>
  BlockMaker& add(const std::string& name, const std::vector<T>& values, std::size_t columns = 0) {
    return add(
        name, results::array_of(values, columns == 0 ? results::Shape{} : results::Shape{columns}));
  }
};

/// The two blocks of load cases.
struct ResultBlocks {
  explicit ResultBlocks(const results::Result& result) {
    for (const auto& [path, array] : result.arrays) {
      const std::size_t begin = path.find('/') + 1, end = path.find('/', begin);
      std::string name = path;
      if (path.starts_with("loads/")) {
        const auto load =
            std::ranges::find(result.loads, path.substr(begin, end - begin), &results::Load::name);
        name = arrays::load_folder(static_cast<std::size_t>(load - result.loads.begin())) +
               path.substr(end + 1, path.ends_with("/u") ? path.size() - end - 3 : path.npos);
      }
      const bool of_mesh = path.starts_with("mesh/");
      (of_mesh || path.find("/edge_") != path.npos ? mesh : answer)
          .add(of_mesh ? path.substr(begin) : name, array);
    }
  }

  BlockMaker mesh, answer;
};

}  // namespace anticrack::testing

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "anticrack/v1/mesh.pb.h"

namespace anticrack::testing {

/// A block, array by array, as the server lays it out.
struct BlockMaker {
  v1::BlockLayout layout;
  std::vector<std::byte> bytes;

  template <class T>
  BlockMaker& add(const std::string& name, const std::vector<T>& values, std::size_t columns = 0) {
    v1::ArrayLayout& array = *layout.add_arrays();
    array.set_name(name);
    array.set_type(sizeof(T) == 8   ? v1::ArrayLayout::TYPE_FLOAT64
                   : sizeof(T) == 4 ? v1::ArrayLayout::TYPE_INT32
                                    : v1::ArrayLayout::TYPE_UINT8);
    array.add_shape(columns == 0 ? values.size() : values.size() / columns);
    if (columns != 0) array.add_shape(columns);
    array.set_offset(bytes.size());
    const auto added = std::as_bytes(std::span(values));
    bytes.insert(bytes.end(), added.begin(), added.end());
    bytes.resize((bytes.size() + 7) / 8 * 8);
    return *this;
  }
};

}  // namespace anticrack::testing

// SPDX-License-Identifier: GPL-3.0-or-later
//
// Memory of factors.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>

namespace anticrack::ddm {

struct FreeValues {
  void operator()(double* values) const noexcept { std::free(values); }
};
using Values = std::unique_ptr<double, FreeValues>;

/// Uninitialised, aligned to a cache line; large blocks to huge pages, if available, as page faults
/// took a tenth of the factorisation. Throws errors::Error (limit_exceeded) without memory.
Values make_values(std::size_t count);

}  // namespace anticrack::ddm

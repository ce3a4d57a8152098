// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/values.hpp"

#include <sys/mman.h>

#include "errors/errors.hpp"

namespace anticrack::ddm {

Values make_values(std::size_t count) {
  constexpr std::size_t cache_line = 64, huge_page = std::size_t{2} << 20;
  const std::size_t bytes = sizeof(double) * count;
  const std::size_t alignment = bytes >= 4 * huge_page ? huge_page : cache_line;
  Values values(static_cast<double*>(
      std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment)));
  if (!values) {
    throw errors::Error(errors::Reason::limit_exceeded,
                        "no memory for the factor of a subdomain; take a coarser mesh");
  }
  if (alignment == huge_page) {
    // Advice: where it is not taken, small pages do as well.
    static_cast<void>(madvise(values.get(), bytes / huge_page * huge_page, MADV_HUGEPAGE));
  }
  return values;
}

}  // namespace anticrack::ddm

// SPDX-License-Identifier: GPL-3.0-or-later
//
// Returns the memory of evicted operators to the system, as glibc's heaps would keep it.
#pragma once

namespace anticrack::operators {

/// Blocks of 32 MiB and more get pages of their own, which return to the system when freed, but for
/// those of base/large.hpp. Smaller ones come from heaps, of which up to 256 MiB free at the end
/// stay for the next load; heaps shrink at their end only, so return_freed_memory() is to be called
/// after an eviction. Acts on the whole process, once; thread-safe.
void set_up_heaps() noexcept;

/// Returns the free pages of all heaps, and the blocks that base/large.hpp keeps, to the system.
/// Takes their locks one at a time; the caller should hold no lock.
void return_freed_memory() noexcept;

}  // namespace anticrack::operators

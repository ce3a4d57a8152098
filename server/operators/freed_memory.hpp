// SPDX-License-Identifier: GPL-3.0-or-later
//
// Returns the memory of evicted operators to the system, as glibc's heaps would keep it.
#pragma once

namespace anticrack::operators {

/// Blocks of 4 MiB and more get pages of their own, which return to the system when freed. By
/// default glibc raises that threshold to the largest block ever freed (up to 32 MiB), so after the
/// first eviction factors would come from heaps, which shrink at their end only. A heap keeps up to
/// 4 MiB free at its end. Acts on the whole process, once; thread-safe.
void set_up_heaps() noexcept;

/// Returns the free pages of all heaps to the system. Takes their locks one at a time; the caller
/// should hold no lock.
void return_freed_memory() noexcept;

}  // namespace anticrack::operators

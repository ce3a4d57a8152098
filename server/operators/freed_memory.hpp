// SPDX-License-Identifier: GPL-3.0-or-later
//
// Memory of evicted operators goes back to the system (glibc).
#pragma once

namespace anticrack::operators {

/// Large blocks get pages of their own from now on, which go back the moment they are freed. Left
/// alone, glibc raises the size from which it does so to that of the largest block ever freed (up
/// to 32 MiB): after the first eviction all factors would come out of heaps that only shrink from
/// their end. Process-wide, once; later calls do nothing. Thread-safe.
void map_large_blocks() noexcept;

/// Gives back the free pages within all heaps. O(heaps); waits for their locks one at a time, so
/// call it with no lock held.
void return_freed_memory() noexcept;

}  // namespace anticrack::operators

// SPDX-License-Identifier: GPL-3.0-or-later
//
// What glibc's heaps keep: memory of evicted operators goes back to the system.
#pragma once

namespace anticrack::operators {

/// Large blocks get pages of their own from now on, which go back the moment they are freed. Left
/// alone, glibc raises the size from which it does so to that of the largest block ever freed (up
/// to 32 MiB): after the first eviction all factors would come out of heaps that only shrink from
/// their end. A heap keeps up to 4 MiB at its end rather than growing and shrinking all the time.
/// Process-wide, once; later calls do nothing. Thread-safe.
void set_up_heaps() noexcept;

/// Gives back the free pages within all heaps. O(heaps); waits for their locks one at a time, so
/// call it with no lock held.
void return_freed_memory() noexcept;

}  // namespace anticrack::operators

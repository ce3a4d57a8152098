// SPDX-License-Identifier: GPL-3.0-or-later
//
// The address space (ulimit -v) that the server takes besides factorised meshes. Uses only constant
// expressions and system calls, since early_check.cpp calls it before any library is set up.
#pragma once

#include <openblas_config.h>
#include <sys/resource.h>

#include <cstdint>
#include <string_view>

namespace anticrack::app {

/// The limit ulimit -v in bytes; 0 if there is none.
inline std::uint64_t address_space_limit() noexcept {
  rlimit space{};
  const bool limited = ::getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY;
  return limited ? space.rlim_cur : 0;
}

/// The address space of a thread: its stack (ulimit -s, as the C library reads it), guard and heap.
inline std::uint64_t address_space_of_a_thread() noexcept {
  constexpr std::uint64_t other = 2 << 20, usual = 8 << 20, most = 64 << 20;
  rlimit stack{};
  const bool limited = ::getrlimit(RLIMIT_STACK, &stack) == 0 && stack.rlim_cur < most;
  return (limited ? stack.rlim_cur : usual) + other;
}

/// A buffer of OpenBLAS: 32 MiB in Debian 12, 128 MiB in Debian 13. A thread that multiplies
/// matrices needs one, and waits for it for ever if there is no room.
constexpr std::uint64_t blas_buffer =
    (std::string_view(OPENBLAS_VERSION).find(" 0.3.21 ") == std::string_view::npos ? 128ULL : 32ULL)
    << 20;

/// The address space taken until main() begins: program and libraries, and the threads that
/// OpenBLAS starts, one for each processor. Measured with two: 235 MiB in Debian 12, 370 MiB in
/// Debian 13.
inline std::uint64_t address_space_to_load(std::uint64_t processors) noexcept {
  constexpr std::uint64_t libraries = 192ULL << 20;
  return libraries + processors * (address_space_of_a_thread() + blas_buffer);
}

/// The address space of a server with `threads` solver threads that does nothing yet: libraries,
/// connections, the other threads, and buffers of OpenBLAS for threads that multiply matrices.
inline std::uint64_t address_space_to_serve(std::uint64_t processors,
                                            std::uint64_t threads) noexcept {
  constexpr std::uint64_t heaps = 256ULL << 20, others = 32;
  return address_space_to_load(processors) + heaps +
         (threads + others) * address_space_of_a_thread() + (threads + 4) * blas_buffer;
}

}  // namespace anticrack::app

// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the server takes of ulimit -v beside factorised meshes. Constant expressions and system
// calls only: early_check.cpp asks before any library is set up.
#pragma once

#include <openblas_config.h>
#include <sys/resource.h>

#include <cstdint>
#include <string_view>

namespace anticrack::app {

/// ulimit -v, bytes; 0: none.
inline std::uint64_t address_space_limit() noexcept {
  rlimit space{};
  const bool limited = ::getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY;
  return limited ? space.rlim_cur : 0;
}

/// Of a thread: what ulimit -s says, as the C library has it, and its guard and heap.
inline std::uint64_t address_space_of_a_thread() noexcept {
  constexpr std::uint64_t other = 2 << 20, usual = 8 << 20, most = 64 << 20;
  rlimit stack{};
  const bool limited = ::getrlimit(RLIMIT_STACK, &stack) == 0 && stack.rlim_cur < most;
  return (limited ? stack.rlim_cur : usual) + other;
}

/// A buffer of OpenBLAS: 32 MiB in Debian 12, 128 MiB in Debian 13. A thread that multiplies
/// matrices has one, and waits for it for ever where there is no room.
constexpr std::uint64_t blas_buffer =
    (std::string_view(OPENBLAS_VERSION).find(" 0.3.21 ") == std::string_view::npos ? 128ULL : 32ULL)
    << 20;

/// Until main() begins: programs and libraries, and the threads that OpenBLAS starts, one for each
/// processor. Measured with two: 235 MiB in Debian 12, 370 MiB in Debian 13.
inline std::uint64_t address_space_to_load(std::uint64_t processors) noexcept {
  constexpr std::uint64_t libraries = 192ULL << 20;
  return libraries + processors * (address_space_of_a_thread() + blas_buffer);
}

/// Of a server with `threads` solver threads that does nothing yet: libraries, connections, the
/// other threads, and buffers of OpenBLAS for those that multiply matrices.
inline std::uint64_t address_space_to_serve(std::uint64_t processors,
                                            std::uint64_t threads) noexcept {
  constexpr std::uint64_t heaps = 256ULL << 20, others = 32;
  return address_space_to_load(processors) + heaps +
         (threads + others) * address_space_of_a_thread() + (threads + 4) * blas_buffer;
}

}  // namespace anticrack::app

// SPDX-License-Identifier: GPL-3.0-or-later
//
// A check that runs before libraries are set up, because OpenBLAS starts threads then and hangs if
// there is no address space for them. Of the libraries only libc is set up here.
#include <sched.h>
#include <unistd.h>

#include <cstdio>

#include "app/address_space.hpp"

// Sanitizers set themselves up earlier, and reserve more than any limit.
#ifdef __has_feature  // clang
#define ANTICRACK_SANITIZED (__has_feature(address_sanitizer) || __has_feature(thread_sanitizer))
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ANTICRACK_SANITIZED 1
#else
#define ANTICRACK_SANITIZED 0
#endif

#if !ANTICRACK_SANITIZED

namespace anticrack::app {
namespace {

std::uint64_t processors() noexcept {
  cpu_set_t set;
  if (::sched_getaffinity(0, sizeof set, &set) != 0) return CPU_SETSIZE;
  const int count = CPU_COUNT(&set);
  return count > 0 ? static_cast<std::uint64_t>(count) : 1;
}

void refuse_too_little_space() {
  constexpr std::uint64_t kibibyte = 1024;
  const std::uint64_t limit = address_space_limit(), wanted = address_space_to_load(processors());
  if (limit == 0 || limit >= wanted) return;
  ::dprintf(STDERR_FILENO,
            "anticrackd: ulimit -v (address space) of %ju KiB is too small to load the program: "
            "it takes %ju KiB; raise it, or leave it away\n",
            std::uintmax_t{limit / kibibyte}, std::uintmax_t{wanted / kibibyte});
  ::_exit(2);
}

}  // namespace
}  // namespace anticrack::app

// Runs as part of the program, before the constructors of its libraries.
[[gnu::used, gnu::section(".preinit_array")]] static void (*const early_check)() =
    anticrack::app::refuse_too_little_space;

#endif

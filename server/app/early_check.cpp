// SPDX-License-Identifier: GPL-3.0-or-later
//
// A check that runs before libraries are set up, because OpenBLAS starts threads then and hangs if
// there is no address space for them. No library is set up here, so this uses only system calls.
#include <sched.h>
#include <unistd.h>

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

class Line {
 public:
  Line& operator<<(const char* text) noexcept {
    while (*text != 0 && _size < sizeof _text) _text[_size++] = *text++;
    return *this;
  }
  Line& operator<<(std::uint64_t number) noexcept {
    char digits[21];
    char* first = digits + 20;
    for (*first = 0; number > 0 || *first == 0; number /= 10) {
      *--first = static_cast<char>('0' + number % 10);
      if (number < 10) break;
    }
    return *this << first;
  }
  void write() const noexcept {
    const auto ignored = ::write(STDERR_FILENO, _text, _size);
    static_cast<void>(ignored);
  }

 private:
  char _text[300] = {};
  std::size_t _size = 0;
};

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
  Line line;
  line << "anticrackd: ulimit -v (address space) of " << limit / kibibyte
       << " KiB is too small to load the program: it takes " << wanted / kibibyte
       << " KiB; raise it, or leave it away\n";
  line.write();
  ::_exit(2);
}

}  // namespace
}  // namespace anticrack::app

// Runs as part of the program, before the constructors of its libraries.
[[gnu::used, gnu::section(".preinit_array")]] static void (*const early_check)() =
    anticrack::app::refuse_too_little_space;

#endif

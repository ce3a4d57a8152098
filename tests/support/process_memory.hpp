// SPDX-License-Identifier: GPL-3.0-or-later
//
// Memory of a process, as the kernel counts it.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

namespace anticrack::testing {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool sanitized = true;  ///< the allocator keeps what is freed
#else
inline constexpr bool sanitized = false;
#endif

/// Bytes of "VmRSS", what is resident, or "VmHWM", the most that was; 0: there is no such process
/// or key. `process`: its number, by default this one.
inline std::uint64_t memory_of(const std::string& key, const std::string& process = "self") {
  std::ifstream file("/proc/" + process + "/status");
  for (std::string word; file >> word;) {
    std::uint64_t kibibytes = 0;
    if (word == key + ":" && file >> kibibytes) return kibibytes << 10U;
  }
  return 0;
}

/// From now on this process's VmHWM is the most since now. False where the system cannot do it.
inline bool reset_peak_memory() {
  std::ofstream file("/proc/self/clear_refs");
  file << '5';
  return static_cast<bool>(file.flush());
}

}  // namespace anticrack::testing

// SPDX-License-Identifier: GPL-3.0-or-later
//
// A result file, as the client reads it.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "fuzz/input.hpp"
#include "results/file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace anticrack;
  const int file = memfd_create("result", MFD_CLOEXEC);
  fuzz::require(file >= 0 && write(file, data, size) == static_cast<ssize_t>(size), "no memory");
  try {
    const auto result = results::read("/proc/self/fd/" + std::to_string(file));
    const std::string fault = results::first_fault(result);
    fuzz::require(fault.empty(), fault.c_str());
  } catch (const results::Error&) {
  }
  close(file);
  return 0;
}

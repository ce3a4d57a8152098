// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/memory_file.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "figures/figures.hpp"

namespace anticrack::figures {
namespace {

[[noreturn]] void no_memory_file(const std::string& what) {
  throw Error("gnuplot: " + what + ": " + std::generic_category().message(errno));
}

}  // namespace

MemoryFile::MemoryFile(std::string_view content)
    : _descriptor(memfd_create("anticrack-gnuplot", MFD_CLOEXEC)) {
  if (_descriptor < 0) no_memory_file("memfd_create");
  while (!content.empty()) {
    const ssize_t written = ::write(_descriptor, content.data(), content.size());
    if (written < 0 && errno != EINTR) no_memory_file("write");
    content.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
  }
}

MemoryFile::MemoryFile(MemoryFile&& other) noexcept
    : _descriptor(std::exchange(other._descriptor, -1)) {}

MemoryFile::~MemoryFile() {
  if (_descriptor >= 0) close(_descriptor);
}

std::string MemoryFile::tail(off_t most) const {
  const off_t size = lseek(_descriptor, 0, SEEK_END);
  off_t at = most > 0 ? std::max<off_t>(size - most, 0) : 0;
  std::string text(static_cast<std::size_t>(std::max<off_t>(size - at, 0)), '\0');
  std::size_t count = 0;
  while (count < text.size()) {
    const ssize_t got = pread(_descriptor, text.data() + count, text.size() - count, at);
    if (got <= 0) break;
    count += static_cast<std::size_t>(got);
    at += got;
  }
  text.resize(count);
  return text;
}

}  // namespace anticrack::figures

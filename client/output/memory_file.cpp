// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/memory_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace anticrack::output {

MemoryFile::MemoryFile() : _descriptor(memfd_create("anticrack", MFD_CLOEXEC)) {
  if (_descriptor < 0)
    throw std::system_error(errno, std::generic_category(), "cannot make a file in memory");
}

MemoryFile::~MemoryFile() { close(_descriptor); }

std::string MemoryFile::content(std::size_t most) const {
  struct stat status {};
  fstat(_descriptor, &status);
  const auto size = static_cast<std::size_t>(status.st_size);
  std::string text(std::min(most, size), '\0');
  std::size_t done = 0;
  for (ssize_t count = 1; count > 0 && done < text.size(); done += static_cast<std::size_t>(count))
    count = std::max<ssize_t>(pread(_descriptor, text.data() + done, text.size() - done,
                                    static_cast<off_t>(size - text.size() + done)),
                              0);
  text.resize(done);
  return text;
}

}  // namespace anticrack::output

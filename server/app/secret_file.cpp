// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/secret_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "app/config.hpp"
#include "store/files.hpp"

namespace anticrack::app {
namespace {

constexpr std::size_t max_bytes = std::size_t{1} << 20;

/// Reads the whole file, or one byte more than `max_bytes`; false on an error (errno).
bool read_all(int descriptor, std::string& content) {
  std::size_t filled = 0;
  content.resize(max_bytes + 1);
  while (filled < content.size()) {
    const ssize_t count = ::read(descriptor, content.data() + filled, content.size() - filled);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    if (count == 0) break;
    filled += static_cast<std::size_t>(count);
  }
  content.resize(filled);
  return true;
}

}  // namespace

std::string read_guarded_file(const std::string& key, const std::string& path,
                              OthersMay others_may) {
  const std::string where = key + ": " + path;
  const base::Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat found {};
  std::string content;
  if (!file || ::fstat(file.get(), &found) != 0 || !read_all(file.get(), content))
    throw ConfigError(where + " cannot be read: " + std::generic_category().message(errno));
  const mode_t forbidden = others_may == OthersMay::read ? S_IWOTH : (S_IROTH | S_IWOTH);
  if ((found.st_mode & forbidden) != 0)
    throw ConfigError(where + " is accessible to every user of this machine; run chmod o-rw on it");
  if (content.size() > max_bytes)
    throw ConfigError(where + " is larger than 1 MiB, too large for such a file");
  return content;
}

}  // namespace anticrack::app

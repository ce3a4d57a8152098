// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/private_place.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <utility>

namespace anticrack::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view prefix = "anticrack-private-";
constexpr const char* lock_name = "owner";

/// The value of a variable; an empty one counts as none.
const char* variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0' ? value : nullptr;
}

/// Takes the lock that is held while the server of the folder lives. Some file systems have no
/// locks; then nobody gets one, and nothing is swept.
bool lock(const base::Descriptor& file) { return ::flock(file.get(), LOCK_EX | LOCK_NB) == 0; }

/// Whether `folder` was left behind by a server that is gone.
bool is_left(const fs::path& folder) {
  struct stat found {};
  if (::lstat(folder.c_str(), &found) != 0 || !S_ISDIR(found.st_mode) ||
      found.st_uid != ::geteuid())
    return false;
  const base::Descriptor file(
      ::open((folder / lock_name).c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (file.get() >= 0) return lock(file);
  // The server may be about to make the file.
  constexpr std::chrono::seconds time_to_make_it{60};
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return errno == ENOENT && now - found.st_mtime > time_to_make_it.count();
}

void remove_folder(const fs::path& folder) noexcept {
  constexpr int tries = 20;  // threads that still work may make new files
  std::error_code error;
  for (int i = 0; i < tries && fs::exists(folder, error); ++i) fs::remove_all(folder, error);
}

void sweep(const fs::path& parent) {
  std::error_code error;
  for (fs::directory_iterator entry(parent, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename();
    if (name.starts_with(prefix) && is_left(entry->path())) remove_folder(entry->path());
  }
}

/// Whether a socket in a folder of `parent` has a path that sockets can have, and that an address
/// can name as it is.
bool takes_sockets(const fs::path& parent) {
  const std::string longest = parent / (std::string(prefix) + "XXXXXX") / "socket";
  return longest.size() < sizeof(sockaddr_un::sun_path) &&
         longest.find_first_not_of(
             "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789/._-+@=,~") ==
             std::string::npos;
}

std::string refusal(const fs::path& parent, const std::string& why) {
  const std::string cure = "a folder you may write in";
  return variable("TMPDIR") != nullptr
             ? "TMPDIR is " + parent.string() + ": " + why + "; set it to " + cure + ", or unset it"
             : parent.string() + ": " + why + "; set TMPDIR to " + cure;
}

fs::path temporary_parent() {
  const char* named = variable("TMPDIR");
  std::error_code error;
  const fs::path parent = fs::absolute(named != nullptr ? named : "/tmp", error);
  constexpr std::size_t longest = 400;  // SQLite's is 512, with what lies below
  if (parent.native().size() > longest)
    throw ConfigError(refusal(parent, "its path is too long for a database"));
  return error ? fs::path(named) : parent;
}

fs::path socket_parent(const fs::path& data_parent) {
  const char* runtime = variable("XDG_RUNTIME_DIR");
  const fs::path own = runtime != nullptr ? runtime : "/tmp";
  if (own.is_absolute() && takes_sockets(own) && ::access(own.c_str(), W_OK | X_OK) == 0)
    return own;
  if (::access("/tmp", W_OK | X_OK) == 0) return "/tmp";
  throw ConfigError(refusal(data_parent, "no socket can have so long a path, or such a one"));
}

}  // namespace

/// A new folder that belongs to this object while it lives.
class PrivatePlace::Folder {
 public:
  explicit Folder(const fs::path& parent) : _lock(-1) {
    sweep(parent);
    constexpr int tries = 10;  // another process may sweep a folder before it is locked
    for (int i = 0; i < tries; ++i)
      if (make(parent)) return;
    throw ConfigError(refusal(parent, "a new folder is removed by others at once"));
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    remove_folder(path);
    if (_lock >= 0) ::close(_lock);
  }

  fs::path path;

 private:
  bool make(const fs::path& parent) {
    std::string name = parent / (std::string(prefix) + "XXXXXX");
    if (::mkdtemp(name.data()) == nullptr)
      throw ConfigError(refusal(parent, std::generic_category().message(errno)));
    path = name;
    _lock = ::open((path / lock_name).c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (_lock < 0) {
      const int cause = errno;
      remove_folder(path);
      if (cause == ENOENT) return false;
      throw ConfigError(refusal(parent, std::generic_category().message(cause)));
    }
    struct stat found {};
    const bool taken = ::flock(_lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (!taken && ::fstat(_lock, &found) == 0 && found.st_nlink > 0) return true;
    ::close(std::exchange(_lock, -1));
    return false;
  }

  int _lock;
};

PrivatePlace::PrivatePlace() {
  const fs::path parent = temporary_parent();
  _data = std::make_unique<Folder>(parent);
  if (!takes_sockets(parent)) _socket = std::make_unique<Folder>(socket_parent(parent));
}

PrivatePlace::~PrivatePlace() = default;

std::vector<Setting> PrivatePlace::settings() const {
  const fs::path& beside = _socket ? _socket->path : _data->path;
  const std::string where = "--private";
  return {{"listen", "unix:" + (beside / "socket").string(), where},
          {"data-dir", _data->path / "data", where},
          {"drain-time", "0s", where}};  // nobody would fetch the results
}

std::function<void()> PrivatePlace::removal() const {
  return [data = _data->path, socket = _socket ? _socket->path : fs::path()] {
    if (!socket.empty()) remove_folder(socket);
    remove_folder(data);
  };
}

void wait_for_end_of_input() {
  std::array<char, 256> ignored{};
  while (true) {
    const ssize_t count = ::read(STDIN_FILENO, ignored.data(), ignored.size());
    if (count == 0 || (count < 0 && errno != EINTR)) return;
  }
}

}  // namespace anticrack::app

// SPDX-License-Identifier: GPL-3.0-or-later
//
// A library to be preloaded (LD_PRELOAD): a disk that fails. It stands between a program and what
// writes to files, counts the calls for what lies below a folder, and lets some of them fail.
//
//   FAULTS_FOLDER   the folder, an absolute path; without it nothing is counted and nothing fails
//   FAULTS_AT       number of the call that fails, from 1
//   FAULTS_FROM     if set, all later ones as well
//   FAULTS_SWITCH   a path: every call fails while there is something
//   FAULTS_ERROR    KILL: the process ends as by kill -9, before the call; ENOSPC, EIO: the call
//                   does nothing and reports that; SHORT, TORN: a write (of more than a byte)
//                   writes half of what it was given, and says so or ends the process
//   FAULTS_COUNT    a path: the number of calls is written there when the program ends
//
// Flushes are counted, not done: what a killed process wrote stays in the system's memory, and a
// test needs no disk that survives a power cut.
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace {

std::atomic<long> calls{0};

/// The function of this name in the libraries behind this one.
template <class Function>
Function* behind(const char* name) {
  void* const found = dlsym(RTLD_NEXT, name);
  if (found == nullptr) abort();
  Function* function = nullptr;
  static_assert(sizeof found == sizeof function);
  memcpy(&function, &found, sizeof found);
  return function;
}

bool below(const char* path) {
  const char* const folder = getenv("FAULTS_FOLDER");
  if (folder == nullptr || path == nullptr) return false;
  const size_t length = strlen(folder);
  return strncmp(path, folder, length) == 0 && (path[length] == '/' || path[length] == '\0');
}

bool below(int file) {
  char link[64];
  char path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  if (length < 0) return false;
  path[length] = '\0';
  return below(path);
}

enum class Fate { done, failed, halved, torn };

bool due() {
  const long number = ++calls;
  const char* const at = getenv("FAULTS_AT");
  const char* const control = getenv("FAULTS_SWITCH");
  struct stat ignored {};
  if (control != nullptr && stat(control, &ignored) == 0) return true;
  if (at == nullptr) return false;
  const long first = atol(at);
  return number == first || (number > first && getenv("FAULTS_FROM") != nullptr);
}

/// What is to become of a call for something below the folder; sets errno where it fails.
Fate fate(size_t bytes = 0) {
  const int before = errno;
  if (!due()) {
    errno = before;
    return Fate::done;
  }
  const char* const error = getenv("FAULTS_ERROR");
  if (error == nullptr || strcmp(error, "KILL") == 0) kill(getpid(), SIGKILL);
  if (strcmp(error, "SHORT") == 0) return bytes > 1 ? Fate::halved : Fate::done;
  if (strcmp(error, "TORN") == 0) {
    if (bytes > 1) return Fate::torn;
    kill(getpid(), SIGKILL);
  }
  errno = strcmp(error, "ENOSPC") == 0 ? ENOSPC : EIO;
  return Fate::failed;
}

/// call(bytes) writes so many of them.
template <class Call>
ssize_t write_with(int file, size_t bytes, const Call& call) {
  switch (below(file) ? fate(bytes) : Fate::done) {
    case Fate::done:
      return call(bytes);
    case Fate::failed:
      return -1;
    case Fate::halved:
      return call(bytes / 2);
    case Fate::torn:
      call(bytes / 2);
      kill(getpid(), SIGKILL);
  }
  return -1;
}

template <class Name>
bool fails(Name name) {
  const int before = errno;
  const bool counts = below(name);
  errno = before;
  return counts && fate() == Fate::failed;
}

int flush(int file, const char* name) {
  if (!below(file)) return behind<int(int)>(name)(file);
  return fate() == Fate::failed ? -1 : 0;
}

/// Opening what is there takes no space.
bool takes_space(int flags, bool is_there) {
  const char* const error = getenv("FAULTS_ERROR");
  return (flags & O_CREAT) != 0 && !(is_there && error != nullptr && strcmp(error, "ENOSPC") == 0);
}

int open_with(const char* name, const char* path, int flags, mode_t mode) {
  if (takes_space(flags, access(path, F_OK) == 0) && fails(path)) return -1;
  return behind<int(const char*, int, ...)>(name)(path, flags, mode);
}

int open_at(const char* name, int folder, const char* path, int flags, mode_t mode) {
  const bool counts = path[0] == '/' ? below(path) : folder != AT_FDCWD && below(folder);
  const bool is_there = faccessat(folder, path, F_OK, 0) == 0;
  if (takes_space(flags, is_there) && counts && fate() == Fate::failed) return -1;
  return behind<int(int, const char*, int, ...)>(name)(folder, path, flags, mode);
}

struct Report {
  ~Report() {
    const char* const path = getenv("FAULTS_COUNT");
    if (path == nullptr) return;
    char text[32];
    const int length = snprintf(text, sizeof text, "%ld\n", calls.load());
    const int file = behind<int(const char*, int, ...)>("open")(
        path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (file >= 0 && write(file, text, static_cast<size_t>(length)) != length) abort();
    close(file);
  }
};
const Report report;

}  // namespace

// The declarations of the C library carry attributes and aliases of its own; these have its types.
extern "C" {

ssize_t write(int file, const void* bytes, size_t count) {
  return write_with(file, count, [&](size_t part) {
    return behind<ssize_t(int, const void*, size_t)>("write")(file, bytes, part);
  });
}

ssize_t pwrite(int file, const void* bytes, size_t count, off_t offset) {
  return write_with(file, count, [&](size_t part) {
    return behind<ssize_t(int, const void*, size_t, off_t)>("pwrite")(file, bytes, part, offset);
  });
}

ssize_t pwrite64(int file, const void* bytes, size_t count, off64_t offset) {
  return write_with(file, count, [&](size_t part) {
    return behind<ssize_t(int, const void*, size_t, off64_t)>("pwrite64")(file, bytes, part,
                                                                          offset);
  });
}

ssize_t writev(int file, const struct iovec* pieces, int count) {
  if (fails(file)) return -1;
  return behind<ssize_t(int, const struct iovec*, int)>("writev")(file, pieces, count);
}

int fsync(int file) { return flush(file, "fsync"); }

int fdatasync(int file) { return flush(file, "fdatasync"); }

int ftruncate(int file, off_t length) noexcept {
  return fails(file) ? -1 : behind<int(int, off_t)>("ftruncate")(file, length);
}

int ftruncate64(int file, off64_t length) noexcept {
  return fails(file) ? -1 : behind<int(int, off64_t)>("ftruncate64")(file, length);
}

int fallocate(int file, int mode, off_t offset, off_t length) {
  if (fails(file)) return -1;
  return behind<int(int, int, off_t, off_t)>("fallocate")(file, mode, offset, length);
}

int posix_fallocate(int file, off_t offset, off_t length) {
  if (fails(file)) return errno;
  return behind<int(int, off_t, off_t)>("posix_fallocate")(file, offset, length);
}

int rename(const char* from, const char* to) noexcept {
  return fails(from) ? -1 : behind<int(const char*, const char*)>("rename")(from, to);
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
  if (fails(from)) return -1;
  return behind<int(int, const char*, int, const char*)>("renameat")(from_folder, from, to_folder,
                                                                     to);
}

int link(const char* from, const char* to) noexcept {
  return fails(to) ? -1 : behind<int(const char*, const char*)>("link")(from, to);
}

int unlink(const char* path) noexcept {
  return fails(path) ? -1 : behind<int(const char*)>("unlink")(path);
}

int mkdir(const char* path, mode_t mode) noexcept {
  return fails(path) ? -1 : behind<int(const char*, mode_t)>("mkdir")(path, mode);
}

int mkstemp(char* path) { return fails(path) ? -1 : behind<int(char*)>("mkstemp")(path); }

int mkostemp(char* path, int flags) {
  return fails(path) ? -1 : behind<int(char*, int)>("mkostemp")(path, flags);
}

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return open_with("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return open_with("open64", path, flags, mode);
}

int openat(int folder, const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return open_at("openat", folder, path, flags, mode);
}

}  // extern "C"

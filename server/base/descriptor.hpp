// SPDX-License-Identifier: GPL-3.0-or-later
//
// Owns a file, socket or event of the system.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <utility>

namespace anticrack::base {

/// The end of the scope closes it.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) noexcept : _number(number) {}
  ~Descriptor() { reset(); }
  Descriptor(Descriptor&& other) noexcept : _number(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    if (this != &other) reset(other.release());
    return *this;
  }
  /// The number; -1 if there is none.
  int get() const noexcept { return _number; }
  explicit operator bool() const noexcept { return _number >= 0; }
  /// Returns the number, which the caller must close from then on.
  int release() noexcept { return std::exchange(_number, -1); }
  /// Closes it now and holds `number` instead. Does not change errno, which may be of a failed call
  /// that is yet to be reported.
  void reset(int number = -1) noexcept {
    const int code = errno;
    if (_number >= 0) ::close(_number);
    errno = code;
    _number = number;
  }

 private:
  int _number;
};

}  // namespace anticrack::base

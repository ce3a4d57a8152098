// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "store/files.hpp"

namespace anticrack::rpc {

/// The listening sockets of an address. gRPC's own sockets stop for good once the process runs out
/// of descriptors, and know no limit of connections.
class Listener {
 public:
  /// `listen` is HOST:PORT (port 0: any free one; 0.0.0.0 and [::] are both families), [IPV6]:PORT
  /// or unix:PATH. No second server can take the port. Throws errors::Error (invalid_argument,
  /// field "listen").
  explicit Listener(const std::string& listen);
  /// Removes the unix socket, if it is still its own.
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// HOST:PORT with the real port, or unix:PATH.
  const std::string& address() const noexcept { return _address; }
  /// The sockets, which do not block.
  const std::vector<base::Descriptor>& sockets() const noexcept { return _sockets; }

 private:
  std::vector<base::Descriptor> _sockets;
  std::string _address;
  std::string _path;  ///< of a unix socket, else empty
  ino_t _inode = 0;   ///< inode of that path
};

}  // namespace anticrack::rpc

// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/uuid.hpp"

#include <fstream>
#include <stdexcept>

namespace anticrack::client {

std::string make_uuid() {
  std::string uuid;
  if (!(std::ifstream("/proc/sys/kernel/random/uuid") >> uuid))
    throw std::runtime_error("Linux gives no random UUID: /proc is not mounted; mount it");
  return uuid;
}

}  // namespace anticrack::client

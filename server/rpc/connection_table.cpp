// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/connection_table.hpp"

#include <vector>

#include "access/share.hpp"

namespace anticrack::rpc {

Admitted ConnectionTable::judge(const std::string& address) const {
  const auto used = static_cast<int>(_connections.size());
  if (used >= _limits.all) return Admitted::full;
  const auto found = _by_address.find(address);
  const int own = found == _by_address.end() ? 0 : found->second;
  const auto count = [](int number) { return static_cast<std::uint64_t>(number); };
  const bool fair = access::may_have(count(own), 1, count(used), count(_limits.all));
  return own < _limits.an_address && fair ? Admitted::yes : Admitted::address_full;
}

Admitted ConnectionTable::add(const std::string& address, int descriptor, std::uint64_t socket,
                              Clock::time_point now) {
  forget(descriptor);  // the connection that had this number before is closed
  Admitted admitted = judge(address);
  if (admitted != Admitted::yes && now - _asked >= patience) {
    forget_closed();
    _asked = now;
    admitted = judge(address);
  }
  if (admitted != Admitted::yes) return admitted;
  _connections.emplace(descriptor, Connection{socket, address});
  ++_by_address[address];
  return Admitted::yes;
}

int ConnectionTable::open() {
  forget_closed();
  return static_cast<int>(_connections.size());
}

void ConnectionTable::forget(int descriptor) {
  const auto found = _connections.find(descriptor);
  if (found == _connections.end()) return;
  const auto owner = _by_address.find(found->second.address);
  if (--owner->second == 0) _by_address.erase(owner);
  _connections.erase(found);
}

void ConnectionTable::forget_closed() {
  std::vector<int> closed;
  for (const auto& [descriptor, connection] : _connections)
    if (!_is_open(descriptor, connection.socket)) closed.push_back(descriptor);
  for (const int descriptor : closed) forget(descriptor);
}

}  // namespace anticrack::rpc

// SPDX-License-Identifier: GPL-3.0-or-later
#include "postgres/database.hpp"

namespace anticrack::postgres {

Database::Database(std::string url) : _url(std::move(url)) {
  try {
    give(Connection(_url));
  } catch (const Lost& lost) {
    throw errors::Error(errors::Reason::storage,
                        "store: {}; check --store, and that PostgreSQL runs", lost.what());
  }
}

Connection Database::take() {
  {
    const std::lock_guard lock(_mutex);
    if (!_free.empty()) {
      Connection connection = std::move(_free.back());
      _free.pop_back();
      return connection;
    }
  }
  return Connection(_url);
}

void Database::give(Connection connection) {
  const std::lock_guard lock(_mutex);
  if (_free.size() < most_kept) _free.push_back(std::move(connection));
}

}  // namespace anticrack::postgres

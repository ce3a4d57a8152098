// SPDX-License-Identifier: GPL-3.0-or-later
#include "postgres/address.hpp"

#include <libpq-fe.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include "errors/errors.hpp"

namespace anticrack::postgres {

namespace {

using errors::Error;
using errors::Reason;

std::vector<std::string> split(std::string_view list) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    parts.emplace_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace

Address::Address(const std::string& text) {
  const std::unique_ptr<PQconninfoOption, void (*)(PQconninfoOption*)> parsed(
      PQconninfoParse(text.c_str(), nullptr), PQconninfoFree);
  if (!parsed) {
    throw Error(Reason::invalid_argument,
                "this is no address of a PostgreSQL database: give "
                "postgresql://user@host:port/database, with % codes for special characters");
  }
  Options common;
  for (const PQconninfoOption* option = parsed.get(); option->keyword != nullptr; ++option)
    if (option->val != nullptr) common[option->keyword] = option->val;
  // A list of hosts is tried by us, one at a time, as libpq would wait for a dead one until the
  // deadline of the whole attempt.
  std::map<std::string, std::vector<std::string>> lists;
  std::size_t count = 1;
  for (const char* key : {"host", "hostaddr", "port"}) {
    if (const auto given = common.find(key); given != common.end()) {
      count = std::max(count, (lists[key] = split(given->second)).size());
      common.erase(given);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    Options server = common;
    for (const auto& [key, list] : lists) {
      if (list.size() != count && list.size() != 1) {
        throw Error(Reason::invalid_argument,
                    "the address of the PostgreSQL database has {} hosts and {} of \"{}\": give "
                    "one for all or one for each",
                    count, list.size(), key);
      }
      server[key] = list.size() == 1 ? list[0] : list[i];
    }
    _servers.push_back(std::move(server));
  }
  const auto value = [](const Options& options, const char* key) {
    const auto found = options.find(key);
    return found == options.end() ? std::string() : found->second;
  };
  if (const std::string user = value(common, "user"); !user.empty()) _shown = user + "@";
  for (const Options& server : _servers) {
    if (&server != &_servers.front()) _shown += ',';
    const std::string host = value(server, "host");
    _shown += host.empty() ? value(server, "hostaddr") : host;
    if (const std::string port = value(server, "port"); !port.empty()) _shown += ":" + port;
  }
  _shown += "/" + value(common, "dbname");
}

}  // namespace anticrack::postgres

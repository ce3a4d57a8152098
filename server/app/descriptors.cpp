// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/descriptors.hpp"

#include <fmt/core.h>
#include <sys/resource.h>

#include <algorithm>

namespace anticrack::app {
namespace {

constexpr int most_descriptors = 1 << 20;
constexpr int fewest_connections = 16;

}  // namespace

std::uint64_t raise_descriptor_limit() noexcept {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return 0;
  rlimit wanted = limit;
  wanted.rlim_cur =
      std::max<rlim_t>(limit.rlim_cur, std::min<rlim_t>(limit.rlim_max, most_descriptors));
  return ::setrlimit(RLIMIT_NOFILE, &wanted) == 0 ? wanted.rlim_cur : limit.rlim_cur;
}

int other_descriptors(const Config& config) { return 256 + config.limits.transfers; }

void fit_connections(Config& config, std::uint64_t descriptors) {
  int& connections = config.limits.connections;
  const int others = other_descriptors(config);
  const int most =
      static_cast<int>(std::min<std::uint64_t>(descriptors, most_descriptors)) - others;
  const int least = connections == 0 ? fewest_connections : connections;
  if (most < least) {
    throw ConfigError(fmt::format(
        "connections: {} connections and {} other files need a limit of {} open files, and this "
        "process has {}; raise it (ulimit -n {}; LimitNOFILE= of systemd){}",
        least, others, least + others, descriptors, least + others,
        connections == 0 ? "" : " or lower connections"));
  }
  if (connections == 0) connections = std::min(most, rpc::Limits().connections);
}

}  // namespace anticrack::app

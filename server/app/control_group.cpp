// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/control_group.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>
#include <string_view>
#include <vector>

namespace anticrack::app {
namespace {

/// A hierarchy of control groups in the file system.
struct Mount {
  std::string group;  ///< the group that its folder shows
  std::string folder;
  bool second = false;                   ///< whether it is of version 2
  std::vector<std::string> controllers;  ///< of version 1
};

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

bool contains(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

/// Undoes the kernel's escapes in paths, where white space and backslashes are \040 and the like.
std::string unescaped(const std::string& text) {
  const auto digit = [&](std::size_t i) {
    return i < text.size() && text[i] >= '0' && text[i] <= '7';
  };
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\\' && digit(i + 1) && digit(i + 2) && digit(i + 3)) {
      result += static_cast<char>(std::stoi(text.substr(i + 1, 3), nullptr, 8));
      i += 3;
    } else {
      result += text[i];
    }
  }
  return result;
}

std::vector<Mount> mounts(const std::string& root) {
  std::vector<Mount> result;
  std::ifstream file(root + "/proc/self/mountinfo");
  for (std::string line; std::getline(file, line);) {
    const std::vector<std::string> words = split(line, ' ');
    const auto dash = std::find(words.begin(), words.end(), "-");
    if (words.size() < 6 || words.end() - dash < 4) continue;
    const bool second = dash[1] == "cgroup2";
    if (!second && dash[1] != "cgroup") continue;
    result.push_back({unescaped(words[3]), unescaped(words[4]), second, split(dash[3], ',')});
  }
  return result;
}

/// The process's group in the hierarchy of version 2 (controller ""), or in that of a controller;
/// empty if there is none.
std::string own_group(const std::string& root, const std::string& controller) {
  std::ifstream file(root + "/proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool it = controller.empty() ? controllers.empty() && line.starts_with("0:")
                                       : contains(split(controllers, ','), controller);
    if (it && line.substr(second + 1).starts_with('/')) return line.substr(second + 1);
  }
  return "";
}

/// The folders of the group and of those around it, innermost first. A container may see its own
/// group as the top of the hierarchy, whatever name the group has outside.
std::vector<std::string> folders(const Mount& mount, const std::string& group) {
  std::string below;
  if (mount.group == "/")
    below = group;
  else if (group.starts_with(mount.group + "/"))
    below = group.substr(mount.group.size());
  else if (group != mount.group && !mount.folder.starts_with("/sys/fs/cgroup"))
    return {};  // this part of the hierarchy has nothing to do with the process
  if (below.find("/..") != std::string::npos) below.clear();  // outside what can be seen
  std::vector<std::string> result;
  for (; !below.empty() && below != "/"; below.erase(below.rfind('/')))
    result.push_back(mount.folder + below);
  result.push_back(mount.folder);
  return result;
}

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// A whole number from 0; none for "max", -1 and anything else.
std::optional<std::uint64_t> number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole ? std::optional(value) : std::nullopt;
}

std::optional<std::uint64_t> of_groups_above(const std::string& path) {
  std::ifstream file(path);
  std::string name, value;
  while (file >> name >> value)
    if (name == "hierarchical_memory_limit") return number(value);
  return std::nullopt;
}

class Tightest {
 public:
  explicit Tightest(const std::string& root) : _root(root) {}

  void memory(const std::string& file, const std::optional<std::uint64_t>& bytes) {
    if (!bytes || (limits.memory_bytes && *limits.memory_bytes <= *bytes)) return;
    limits.memory_bytes = bytes;
    limits.memory_file = file;
  }
  void memory(const std::string& file) { memory(file, number(first_line(_root + file))); }

  void processors(const std::string& quota, const std::string& period) {
    const auto time = number(quota), of = number(period);
    if (!time || !of || *of == 0) return;
    const double share = static_cast<double>(*time) / static_cast<double>(*of);
    limits.processors = std::min(limits.processors.value_or(share), share);
  }

  void first_version(const Mount& mount) {
    if (contains(mount.controllers, "memory")) {
      for (const std::string& folder : folders(mount, own_group(_root, "memory"))) {
        memory(folder + "/memory.limit_in_bytes");
        const std::string stat = folder + "/memory.stat";
        memory(stat, of_groups_above(_root + stat));
      }
    }
    if (contains(mount.controllers, "cpu")) {
      for (const std::string& folder : folders(mount, own_group(_root, "cpu"))) {
        processors(first_line(_root + folder + "/cpu.cfs_quota_us"),
                   first_line(_root + folder + "/cpu.cfs_period_us"));
      }
    }
  }

  void second_version(const Mount& mount) {
    for (const std::string& folder : folders(mount, own_group(_root, ""))) {
      memory(folder + "/memory.max");
      memory(folder + "/memory.high");
      const std::vector<std::string> words = split(first_line(_root + folder + "/cpu.max"), ' ');
      if (words.size() == 2) processors(words[0], words[1]);
    }
  }

  GroupLimits limits;

 private:
  const std::string& _root;
};

}  // namespace

GroupLimits group_limits(const std::string& root) {
  Tightest tightest(root);
  for (const Mount& mount : mounts(root))
    mount.second ? tightest.second_version(mount) : tightest.first_version(mount);
  return tightest.limits;
}

}  // namespace anticrack::app

// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/force_arrays.hpp"

#include <fmt/core.h>

#include <set>
#include <utility>
#include <variant>

#include "errors/placed.hpp"
#include "store/array_upload.hpp"
#include "store/files.hpp"

namespace anticrack::jobs {
namespace {

using errors::Error;
using errors::Reason;

}  // namespace

void require_arrays(const std::vector<fem::Load>& loads, const store::Store& store,
                    const std::string& owner) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const auto* array = std::get_if<fem::Array>(&loads[i].force);
    if (array != nullptr && seen.insert(array->upload).second) {
      errors::at(fmt::format("load_cases[{}].force.array", i), [&] {
        return store::array_length(store::require_upload(store, array->upload, owner));
      });
    }
  }
}

ForceArrays::ForceArrays(const std::vector<fem::Load>& loads, std::string owner)
    : _owner(std::move(owner)) {
  for (const fem::Load& load : loads)
    if (const auto* array = std::get_if<fem::Array>(&load.force))
      ++_entries[array->upload].cases_left;
}

fem::Load ForceArrays::resolve(const fem::Load& load, const store::Store& store) {
  fem::Load resolved = load;
  if (auto* array = std::get_if<fem::Array>(&resolved.force))
    array->values = errors::at("force.array", [&] { return take(array->upload, store); });
  return resolved;
}

ForceArrays::Values ForceArrays::take(const std::string& sha256, const store::Store& store) {
  // The mutex is held while reading, so that another case that needs the same values waits.
  const std::lock_guard lock(_mutex);
  Entry& entry = _entries.at(sha256);
  const bool last = --entry.cases_left == 0;
  Values values = entry.in_use.lock();
  if (!values) {
    const std::string path = store::require_upload(store, sha256, _owner);
    store::require_intact_upload(path, sha256);
    values = std::make_shared<const std::vector<double>>(store::read_array(path));
    entry.in_use = values;
  }
  const std::size_t bytes = values->size() * sizeof(double);
  if (entry.kept && last) {
    entry.kept.reset();
    _kept_bytes -= bytes;
  } else if (!entry.kept && !last && _kept_bytes + bytes <= max_kept_bytes) {
    entry.kept = values;
    _kept_bytes += bytes;
  }
  return values;
}

}  // namespace anticrack::jobs

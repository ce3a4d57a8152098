// SPDX-License-Identifier: GPL-3.0-or-later
//
// The arrays from which the load cases of one job take their forces.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "fem/load.hpp"
#include "store/store.hpp"

namespace anticrack::jobs {

/// Throws errors::Error at "load_cases[i].force.array": not_found if the store has no such upload
/// of this owner, invalid_argument if it is not an array.
void require_arrays(const std::vector<fem::Load>& loads, const store::Store& store,
                    const std::string& owner);

/// Reads each upload when its first load case is solved, and shares the values among all. They are
/// freed after the last case that names them, or at once if `max_kept_bytes` are kept already (the
/// next case then reads them again). Thread-safe.
class ForceArrays {
 public:
  static constexpr std::size_t max_kept_bytes = std::size_t{512} << 20;

  /// `owner`: the owner of the uploads. Reads nothing yet.
  ForceArrays(const std::vector<fem::Load>& loads, std::string owner);

  /// The load, with values if its force is an array. To be called once for each load case. Throws
  /// errors::Error at "force.array" as require_arrays does, and if a value is not finite.
  fem::Load resolve(const fem::Load& load, const store::Store& store);

 private:
  using Values = std::shared_ptr<const std::vector<double>>;
  struct Entry {
    std::size_t cases_left = 0;
    Values kept;
    std::weak_ptr<const std::vector<double>> in_use;
  };

  Values take(const std::string& sha256, const store::Store& store);

  const std::string _owner;
  std::mutex _mutex;
  std::map<std::string, Entry> _entries;  ///< by sha256
  std::size_t _kept_bytes = 0;
};

}  // namespace anticrack::jobs

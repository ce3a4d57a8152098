// SPDX-License-Identifier: GPL-3.0-or-later
//
// Names of meshes and jobs as users type them, and suggestions for unknown ones.
#pragma once

#include <string>
#include <vector>

#include "cli/session.hpp"
#include "client/error.hpp"

namespace anticrack::cli {

struct Collection {
  std::string prefix;  ///< of its names
  std::string one;     ///< the word for one of them

  static const Collection meshes, jobs;
};
inline const Collection Collection::meshes{"meshes/", "mesh"}, Collection::jobs{"jobs/", "job"};

/// The full name, "jobs/ID" for "jobs/ID" or "ID". Throws UsageError for anything else.
std::string full_name(const Collection& collection, const std::string& given);

/// The cure for a `name` that is not among `known`: the name that begins with it, the nearest one,
/// or where to look. It is only a suggestion: names must be exact, so that nothing is deleted by
/// mistake.
std::string name_cure(const Collection& collection, const std::string& name,
                      const std::vector<std::string>& known);

/// The error with name_cure(), from the names that this user may see, newest first.
client::Error with_cure(Session& session, const Collection& collection, const std::string& name,
                        const client::Error& error);

/// Runs call(). The error for an unknown resource `name` suggests another name.
template <class Call>
auto about(Session& session, const Collection& collection, const std::string& name,
           const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const client::Error& error) {
    if (error.code() != client::Code::not_found) throw;
    throw with_cure(session, collection, name, error);
  }
}

/// Runs call(connection, name, more..., stop), a function of the client library, as `about` does,
/// for the resource that the user names.
template <class Call, class... More>
auto call_about(Session& session, const Collection& collection, const std::string& given,
                const Call& call, const More&... more) {
  const std::string name = full_name(collection, given);
  return about(session, collection, name,
               [&] { return call(session.connection(), name, more..., session.stop()); });
}

}  // namespace anticrack::cli

// SPDX-License-Identifier: GPL-3.0-or-later
//
// Names of meshes and jobs as people type them, and suggestions for unknown ones.
#pragma once

#include <string>
#include <vector>

#include "cli/session.hpp"
#include "client/error.hpp"

namespace anticrack::cli {

enum class Collection { meshes, jobs };

/// "jobs/ID" of "jobs/ID" or "ID". Throws UsageError for anything else.
std::string full_name(Collection collection, const std::string& given);

/// The cure for a `name` that is not among `known`: the one that begins with it, the nearest, or
/// where to look. A suggestion only: names must be exact, so that nothing is deleted by mistake.
std::string name_cure(Collection collection, const std::string& name,
                      const std::vector<std::string>& known);

/// The error with its cure, from the names that this user may see, newest first.
client::Error with_cure(Session& session, Collection collection, const std::string& name,
                        const client::Error& error);

/// call(). An unknown resource `name` is an error that suggests another name.
template <class Call>
auto about(Session& session, Collection collection, const std::string& name, const Call& call)
    -> decltype(call()) {
  try {
    return call();
  } catch (const client::Error& error) {
    if (error.code() != client::Code::not_found) throw;
    throw with_cure(session, collection, name, error);
  }
}

/// call(connection, name, more..., stop), a function of the client library, as in `about`.
template <class Call, class... More>
auto call_about(Session& session, Collection collection, const std::string& name, const Call& call,
                const More&... more) {
  return about(session, collection, name,
               [&] { return call(session.connection(), name, more..., session.stop()); });
}

}  // namespace anticrack::cli

// SPDX-License-Identifier: GPL-3.0-or-later
//
// Names of meshes and jobs as people type them, and what they meant where there is none such.
#pragma once

#include <string>
#include <vector>

#include "cli/session.hpp"
#include "client/error.hpp"

namespace anticrack::cli {

enum class Collection { meshes, jobs };

/// "jobs/ID" of "jobs/ID" or "ID". Throws UsageError for what is the name of no job (or mesh).
std::string full_name(Collection collection, const std::string& given);

/// What to write instead of `name`, which is none of `known`: the one that begins like it, the
/// nearest, or where to look. A suggestion only: names are exact, so that nothing is deleted that
/// was not meant.
std::string name_cure(Collection collection, const std::string& name,
                      const std::vector<std::string>& known);

/// The error with the cure, out of the names that this user may see, newest first.
client::Error with_cure(Session& session, Collection collection, const std::string& name,
                        const client::Error& error);

/// Does what needs the resource `name`; where the server knows no such, the error names the
/// nearest that there is.
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

}  // namespace anticrack::cli

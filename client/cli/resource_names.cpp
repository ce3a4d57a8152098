// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/resource_names.hpp"

#include <algorithm>

#include "cli/report.hpp"
#include "client/jobs.hpp"
#include "client/meshes.hpp"
#include "words/nearest.hpp"

namespace anticrack::cli {
namespace {

constexpr int names_looked_at = 1000;

std::string see(const Collection& collection) {
  return "; see anticrack " + collection.one + " list";
}

bool is_id(const std::string& text) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
  };
  return !text.empty() && std::all_of(text.begin(), text.end(), fits);
}

std::vector<std::string> names_of(Session& session, const Collection& collection) {
  std::vector<std::string> names;
  const auto list = [&](const auto& call, auto request) {
    request.set_page_size(names_looked_at);
    return call(session.connection(), request, session.stop());
  };
  if (collection.one == "mesh") {
    const auto response = list(client::list_meshes, v1::ListMeshesRequest());
    for (const v1::Mesh& mesh : response.meshes()) names.push_back(mesh.name());
  } else {
    const auto response = list(client::list_jobs, v1::ListJobsRequest());
    for (const v1::Job& job : response.jobs()) names.push_back(job.name());
  }
  return names;
}

}  // namespace

std::string full_name(const Collection& collection, const std::string& given) {
  for (const Collection& other : {Collection::meshes, Collection::jobs})
    if (other.one != collection.one && given.starts_with(other.prefix))
      throw UsageError(given + " is a " + other.one + "; name a " + collection.one +
                       see(collection));
  const bool whole = given.starts_with(collection.prefix);
  if (!is_id(whole ? given.substr(collection.prefix.size()) : given)) {
    throw UsageError("\"" + given + "\" is not a name of a " + collection.one + "; write " +
                     collection.prefix + "ID" + see(collection));
  }
  return whole ? given : collection.prefix + given;
}

std::string name_cure(const Collection& collection, const std::string& name,
                      const std::vector<std::string>& known) {
  std::vector<std::string> ids;  // without the common prefix
  std::vector<std::string> longer;
  const std::string id = name.substr(collection.prefix.size());
  for (const std::string& each : known) {
    ids.push_back(each.substr(collection.prefix.size()));
    if (each.starts_with(name)) longer.push_back(ids.back());
  }
  const auto meant = longer.size() == 1 ? longer.front() : words::nearest(id, ids).value_or("");
  return meant.empty() ? see(collection) : "; did you mean " + collection.prefix + meant + "?";
}

client::Error with_cure(Session& session, const Collection& collection, const std::string& name,
                        const client::Error& error) {
  std::string cure;
  try {
    cure = name_cure(collection, name, names_of(session, collection));
  } catch (const client::Error&) {
    // Then the first error is reported.
  }
  return client::Error(error.code(), error.what() + cure, error.details());
}

}  // namespace anticrack::cli

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

struct CollectionWords {
  std::string prefix;  ///< of the collection's names
  std::string one;
  std::string see;
};

CollectionWords words_of(Collection collection) {
  return collection == Collection::meshes
             ? CollectionWords{"meshes/", "mesh", "; see anticrack mesh list"}
             : CollectionWords{"jobs/", "job", "; see anticrack job list"};
}

bool is_id(const std::string& text) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
  };
  return !text.empty() && std::all_of(text.begin(), text.end(), fits);
}

std::vector<std::string> names_of(Session& session, Collection collection) {
  std::vector<std::string> names;
  const auto list = [&](const auto& call, auto request) {
    request.set_page_size(names_looked_at);
    return call(session.connection(), request, session.stop());
  };
  if (collection == Collection::meshes) {
    const auto response = list(client::list_meshes, v1::ListMeshesRequest());
    for (const v1::Mesh& mesh : response.meshes()) names.push_back(mesh.name());
  } else {
    const auto response = list(client::list_jobs, v1::ListJobsRequest());
    for (const v1::Job& job : response.jobs()) names.push_back(job.name());
  }
  return names;
}

}  // namespace

std::string full_name(Collection collection, const std::string& given) {
  const CollectionWords words = words_of(collection);
  const CollectionWords other =
      words_of(collection == Collection::meshes ? Collection::jobs : Collection::meshes);
  if (given.starts_with(other.prefix))
    throw UsageError(given + " is a " + other.one + "; name a " + words.one + words.see);
  const bool whole = given.starts_with(words.prefix);
  if (!is_id(whole ? given.substr(words.prefix.size()) : given)) {
    throw UsageError("\"" + given + "\" is not a name of a " + words.one + "; write " +
                     words.prefix + "ID" + words.see);
  }
  return whole ? given : words.prefix + given;
}

std::string name_cure(Collection collection, const std::string& name,
                      const std::vector<std::string>& known) {
  const CollectionWords words = words_of(collection);
  std::vector<std::string> ids;  // without the common prefix
  std::vector<std::string> longer;
  const std::string id = name.substr(words.prefix.size());
  for (const std::string& each : known) {
    ids.push_back(each.substr(words.prefix.size()));
    if (each.starts_with(name)) longer.push_back(ids.back());
  }
  const auto meant = longer.size() == 1 ? longer.front() : words::nearest(id, ids).value_or("");
  return meant.empty() ? words.see : "; did you mean " + words.prefix + meant + "?";
}

client::Error with_cure(Session& session, Collection collection, const std::string& name,
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

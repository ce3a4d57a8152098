// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/names.hpp"

#include <algorithm>
#include <string>

#include "digest/digest.hpp"
#include "errors/errors.hpp"
#include "words/shown.hpp"

namespace anticrack::api {
namespace {

using errors::Error;
using errors::Reason;

constexpr std::size_t max_id_bytes = 64;

std::string id_below(std::string_view collection, const std::string& name, std::string_view field) {
  const std::string prefix = std::string(collection) + "/";
  if (!name.starts_with(prefix) || !is_id(std::string_view(name).substr(prefix.size()))) {
    throw Error(Reason::invalid_argument, "\"{}\" is not a name of the form \"{}/ID\"",
                words::printable(name, 100), collection)
        .at(std::string(field));
  }
  return name.substr(prefix.size());
}

}  // namespace

std::string mesh_name(const std::string& id) { return "meshes/" + id; }
std::string job_name(const std::string& id) { return "jobs/" + id; }
std::string upload_name(const std::string& sha256) { return "uploads/" + sha256; }

std::string mesh_id(const std::string& name, std::string_view field) {
  return id_below("meshes", name, field);
}

std::string job_id(const std::string& name, std::string_view field) {
  return id_below("jobs", name, field);
}

std::string upload_sha256(const std::string& name, std::string_view field) {
  std::string sha256 = id_below("uploads", name, field);
  if (!digest::is_sha256(sha256)) {
    throw Error(Reason::invalid_argument,
                "\"{}\" does not end in a sha256 of 64 lower-case hexadecimal digits", name)
        .at(std::string(field));
  }
  return sha256;
}

bool is_id(std::string_view text) noexcept {
  return !text.empty() && text.size() <= max_id_bytes &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '-' || c == '_';
         });
}

std::string after_slash(const std::string& name, std::string_view field) {
  const std::size_t slash = name.find('/');
  if (slash == std::string::npos) {
    throw Error(Reason::invalid_argument, "\"{}\" is not a name of the form \"COLLECTION/ID\"",
                words::printable(name, 100))
        .at(std::string(field));
  }
  return name.substr(slash + 1);
}

}  // namespace anticrack::api

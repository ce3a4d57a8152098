// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/read_case.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "casefile/case.hpp"
#include "errors/errors.hpp"

namespace anticrack::casefile {
namespace {

constexpr int most_overrides = 200;
constexpr std::size_t most_places = 20'000;  // some 3 MB

/// Limits the overrides, as each of them may look through all loads.
void check_overrides(const v1::ReadCaseRequest& request) {
  if (request.overrides_size() <= most_overrides) return;
  throw errors::Error(errors::Reason::limit_exceeded,
                      "{} are above the limit of {}; write them into the case",
                      request.overrides_size(), most_overrides)
      .at("overrides");
}

template <class Field>
std::vector<std::string> words_of(const Field& field) {
  return {field.begin(), field.end()};
}

Case case_of(const v1::ReadCaseRequest& request) {
  const std::vector<std::string> overrides = words_of(request.overrides());
  switch (request.content_case()) {
    case v1::ReadCaseRequest::kMsh:
      return mesh_file_case(request.msh(), overrides);
    case v1::ReadCaseRequest::CONTENT_NOT_SET:
      throw errors::Error(errors::Reason::invalid_argument,
                          "there is no case; give toml, json or msh")
          .at("toml");
    default: {
      const bool json = request.content_case() == v1::ReadCaseRequest::kJson;
      return parse_case(json ? request.json() : request.toml(), request.source(), overrides,
                        request.loads_optional() ? Loads::optional : Loads::needed,
                        words_of(request.loads()), json ? Language::json : Language::toml);
    }
  }
}

std::size_t depth_of(const std::string& field) {
  return static_cast<std::size_t>(
      std::ranges::count_if(field, [](char c) { return c == '.' || c == '['; }));
}

/// The depth up to which places of fields are told; with many fields only those of whole entries.
std::size_t deepest_told(const std::map<std::string, Spot>& spots) {
  std::vector<std::size_t> of_depth;
  for (const auto& [field, spot] : spots) {
    const std::size_t depth = depth_of(field);
    if (of_depth.size() <= depth) of_depth.resize(depth + 1);
    ++of_depth[depth];
  }
  std::size_t depth = 0;
  for (std::size_t all = 0; depth < of_depth.size(); ++depth)
    if ((all += of_depth[depth]) > most_places) break;
  return depth;  // one more than the last that fits
}

void write_places(const std::map<std::string, Spot>& spots, const std::string& source,
                  v1::ReadCaseResponse& response) {
  const std::size_t deepest = deepest_told(spots);
  for (const auto& [field, spot] : spots) {
    if (depth_of(field) >= deepest) continue;
    v1::CasePlace& place = (*response.mutable_places())[field];
    place.set_where(spot.source.empty() ? source : where(spot));  // nodes of JSON have none
    place.set_key(spot.key);
  }
}

void check_size(const v1::ReadCaseResponse& response, const Limits& limits) {
  for (const auto& [bytes, what] : {std::pair{response.mesh().ByteSizeLong(), "geometry"},
                                    std::pair{response.spec().ByteSizeLong(), "loads"}}) {
    if (bytes <= limits.request_bytes) continue;
    throw errors::Error(errors::Reason::limit_exceeded,
                        "its {} are {} bytes as a request, and the server takes {}; write fewer "
                        "points, or a mesh in a file",
                        what, bytes, limits.request_bytes);
  }
}

}  // namespace

v1::ReadCaseResponse read_case(const v1::ReadCaseRequest& request, const Limits& limits) {
  check_overrides(request);
  Case read;
  try {
    read = case_of(request);
    if (read.spec.load_cases_size() > limits.load_cases) {
      throw Error({"load", request.source(), 0},
                  fmt::format("{} loads are above the limit of {}; make several cases of them",
                              read.spec.load_cases_size(), limits.load_cases));
    }
  } catch (const Error& error) {
    // Nodes of JSON have no source.
    Spot spot = error.spot();
    const bool named = !spot.source.empty() || request.source().empty();
    errors::Error told(errors::Reason::case_invalid,
                       (named ? "" : request.source() + ": ") + error.what());
    if (!spot.key.empty()) told.at(std::move(spot.key));
    throw told;
  }
  v1::ReadCaseResponse response;
  if (request.content_case() == v1::ReadCaseRequest::kJson || request.overrides_size() > 0 ||
      request.loads_size() > 0)
    response.set_toml(std::move(read.text));
  write_places(read.spots, request.source(), response);
  for (const std::string& note : read.notes) response.add_notes(note);
  for (ForceFile& file : read.force_files) {
    v1::CaseArray& array = *response.add_arrays();
    array.set_load_case(file.load_case);
    array.set_file(std::move(file.path));
    array.set_dataset(std::move(file.dataset));
  }
  response.set_mesh_file(read.mesh_file.value_or(""));
  *response.mutable_mesh() = std::move(read.mesh);
  *response.mutable_spec() = std::move(read.spec);
  check_size(response, limits);
  return response;
}

}  // namespace anticrack::casefile

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/curve_groups.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "errors/errors.hpp"
#include "mesh/names.hpp"
#include "mesher/msh_scanner.hpp"

namespace anticrack::mesher {
namespace {

constexpr std::string_view keywords =
    "dirichlet, neumann, glue, crack, crack:NAME, inclusion:NAME or delaminated:NAME";

/// Upper case to lower, whatever the locale.
std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// Whether a name belongs to a crack or to an inclusion, one of them only.
class NameOwners {
 public:
  void add(const CurveMeaning& meaning) {
    if (meaning.name.empty()) return;
    const bool crack = meaning.role == CurveRole::crack;
    if (_is_crack.emplace(meaning.name, crack).first->second == crack) return;
    throw errors::Error(
        errors::Reason::mesh_invalid,
        "\"" + meaning.name + "\" is the name of a crack and of an inclusion; give each its own");
  }

 private:
  std::map<std::string, bool> _is_crack;
};

std::string title_of(std::int32_t tag, bool physical, const std::string& name) {
  if (!physical) return "curve " + std::to_string(tag) + " (in no group)";
  const std::string title = "curve group " + std::to_string(tag);
  return title + (name.empty() ? " (no name)" : " \"" + printable(name) + "\"");
}

CurveGroup named_by_file(std::int32_t tag, bool physical, const std::string& name) {
  CurveGroup group{tag, title_of(tag, physical, name), std::nullopt};
  ReadMeaning read = read_meaning(name);
  if (!read.fault.empty()) {
    throw errors::Error(errors::Reason::mesh_invalid, group.title + " " + read.fault);
  }
  group.meaning = std::move(read.meaning);
  return group;
}

CurveMeaning given_meaning(std::int32_t tag, const std::string& text) {
  ReadMeaning read = read_meaning(text);
  if (read.meaning) return std::move(*read.meaning);
  throw errors::Error(
      errors::Reason::invalid_argument,
      "curve group " + std::to_string(tag) + " is said to be \"" + printable(text) + "\"" +
          (read.fault.empty() ? "; it is " + std::string(keywords) : ", which " + read.fault))
      .at("options.curve_groups[" + std::to_string(tag) + "]");
}

[[noreturn]] void refuse_missing(std::int32_t tag, const CurveGroups& known) {
  std::vector<std::int32_t> tags;
  tags.reserve(known.groups.size());
  for (const auto& [there, group] : known.groups) tags.push_back(there);
  const std::string what = known.physical ? "curve group" : "curve";
  throw errors::Error(
      errors::Reason::invalid_argument,
      "the file has no " + what + " " + std::to_string(tag) + "; " +
          (tags.empty() ? "it has no lines at all" : "its " + what + "s are " + list_of(tags)))
      .at("options.curve_groups[" + std::to_string(tag) + "]");
}

}  // namespace

ReadMeaning read_meaning(const std::string& text) {
  const std::string_view whole = trimmed(text);
  const std::size_t colon = whole.find(':');
  const std::string keyword = lower(trimmed(whole.substr(0, colon)));
  if (colon == std::string_view::npos) {
    if (keyword == "dirichlet") return {CurveMeaning{CurveRole::dirichlet, ""}, ""};
    if (keyword == "neumann") return {CurveMeaning{CurveRole::neumann, ""}, ""};
    if (keyword == "glue") return {CurveMeaning{CurveRole::glue, ""}, ""};
    if (keyword == "crack") return {CurveMeaning{CurveRole::crack, ""}, ""};
  }
  const std::pair<std::string_view, CurveRole> named[] = {{"crack", CurveRole::crack},
                                                          {"inclusion", CurveRole::inclusion},
                                                          {"delaminated", CurveRole::delaminated}};
  for (const auto& [known, role] : named) {
    if (keyword != known) continue;
    const std::string name(colon == std::string_view::npos ? "" : trimmed(whole.substr(colon + 1)));
    if (mesh::valid_name(name)) return {CurveMeaning{role, name}, ""};
    return {std::nullopt,
            "takes a name, \"" + std::string(known) + ":NAME\": " + std::string(mesh::name_rule)};
  }
  return {};
}

const CurveGroup* CurveGroups::of(const MshElement<2>& line) const {
  const auto found = groups.find(physical ? line.group : line.entity);
  return found == groups.end() ? nullptr : &found->second;
}

CurveGroups read_curve_groups(const MshFile& file,
                              const std::map<std::int32_t, std::string>& given) {
  CurveGroups result;
  // names may be left over of groups that are gone
  result.physical =
      file.lines.empty() || std::any_of(file.lines.begin(), file.lines.end(),
                                        [](const auto& line) { return line.group != 0; });
  for (const auto& [tag, name] : file.curve_names) {
    if (result.physical) result.groups.emplace(tag, named_by_file(tag, true, name));
  }
  for (const auto& line : file.lines) {
    const std::int32_t tag = result.physical ? line.group : line.entity;
    // physical tag 0 stands for none
    if ((result.physical && tag == 0) || result.groups.contains(tag)) continue;
    result.groups.emplace(tag, named_by_file(tag, result.physical, ""));
  }
  for (const auto& [tag, text] : given) {
    const auto group = result.groups.find(tag);
    if (group == result.groups.end()) refuse_missing(tag, result);
    group->second.meaning = given_meaning(tag, text);
  }
  NameOwners owners;
  for (const auto& [tag, group] : result.groups) {
    if (group.meaning) owners.add(*group.meaning);
  }
  return result;
}

std::string list_of(const std::vector<std::int32_t>& tags) {
  constexpr std::size_t most = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(tags.size(), most); ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(tags[i]);
  }
  if (tags.size() > most) text += " and " + std::to_string(tags.size() - most) + " more";
  return text;
}

}  // namespace anticrack::mesher

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/import_steps.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "mesh/names.hpp"
#include "mesher/messages.hpp"
#include "mesher/msh_scanner.hpp"

namespace anticrack::mesher {
namespace {

constexpr const char* choices =
    "dirichlet, dirichlet:NAME, neumann, neumann:NAME, glue, crack, crack:NAME, free, free:NAME, "
    "inclusion:NAME or delaminated:NAME";

struct Keyword {
  std::string_view word;
  CurveRole role;
  bool alone;  ///< whether it may stand without a name
  bool named;  ///< whether it may have a name
};
constexpr Keyword keywords[] = {{"dirichlet", CurveRole::dirichlet, true, true},
                                {"neumann", CurveRole::neumann, true, true},
                                {"glue", CurveRole::glue, true, false},
                                {"crack", CurveRole::crack, true, true},
                                {"free", CurveRole::free, true, true},
                                {"inclusion", CurveRole::inclusion, false, true},
                                {"delaminated", CurveRole::delaminated, false, true}};

/// The text in lower case, whatever the locale.
std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// A name belongs to a crack or to an inclusion, not to both.
void check_names(const std::map<std::int32_t, CurveGroup>& groups) {
  std::map<std::string, bool> is_crack;
  for (const auto& [tag, group] : groups) {
    if (!group.meaning || group.meaning->name.empty() || of_boundary(group.meaning->role)) continue;
    const bool crack = !is_rigid(group.meaning->role);
    if (is_crack.emplace(group.meaning->name, crack).first->second == crack) continue;
    refuse("\"{}\" is the name of a crack and of an inclusion; give each its own name",
           group.meaning->name);
  }
}

std::string title_of(std::int32_t tag, bool physical, const std::string& name) {
  if (!physical) return fmt::format("curve {} (in no group)", tag);
  if (name.empty()) return fmt::format("curve group {} (no name)", tag);
  return fmt::format("curve group {} \"{}\"", tag, printable(name));
}

CurveGroup named_by_file(std::int32_t tag, bool physical, const std::string& name) {
  CurveGroup group{tag, title_of(tag, physical, name), {}, {}};
  ReadMeaning read = read_meaning(name);
  if (!read.fault.empty()) refuse("{} {}", group.title, read.fault);
  group.meaning = std::move(read.meaning);
  if (group.meaning || !physical) return group;
  group.part = mesh::valid_name(name) ? name : fmt::format("group-{}", tag);
  group.renamed = !name.empty() && group.part != name;
  return group;
}

[[noreturn]] void refuse_option(std::int32_t tag, const std::string& message) {
  throw errors::Error(errors::Reason::invalid_argument, message)
      .at(fmt::format("options.curve_groups[{}]", tag));
}

CurveMeaning given_meaning(std::int32_t tag, const std::string& text) {
  ReadMeaning read = read_meaning(text);
  if (read.meaning) return std::move(*read.meaning);
  refuse_option(tag, fmt::format("curve group {} is given as \"{}\"{}{}", tag, printable(text),
                                 read.fault.empty() ? "; choose " : ", which ",
                                 read.fault.empty() ? choices : read.fault));
}

[[noreturn]] void refuse_missing(std::int32_t tag, const CurveGroups& known) {
  std::vector<std::int32_t> tags;
  tags.reserve(known.groups.size());
  for (const auto& [there, group] : known.groups) tags.push_back(there);
  const char* what = known.physical ? "curve group" : "curve";
  refuse_option(tag,
                fmt::format("the file has no {} {}; {}", what, tag,
                            tags.empty() ? "it has no lines at all"
                                         : fmt::format("its {}s are {}", what, list_of(tags))));
}

/// Refuses names without elements: gmsh leaves the groups out of MSH 2 if it saves all elements.
void refuse_lost_groups(const MshFile& file) {
  for (const auto& [tag, name] : file.curve_names) {
    const CurveGroup group = named_by_file(tag, true, name);
    if (!group.meaning) continue;
    refuse(
        "the file names {}, but none of its lines is in a group; save it as MSH 4.1, or with "
        "Mesh.SaveAll = 0, or give its curves a meaning in the groups of the mesh options",
        group.title);
  }
}

}  // namespace

ReadMeaning read_meaning(const std::string& text) {
  const std::string_view whole = trimmed(text);
  const std::size_t colon = whole.find(':');
  const std::string keyword = lower(trimmed(whole.substr(0, colon)));
  for (const auto& [word, role, alone, named] : keywords) {
    if (keyword != word) continue;
    if (colon == std::string_view::npos && alone) return {CurveMeaning{role, ""}, ""};
    if (!named) break;
    const std::string name(colon == std::string_view::npos ? "" : trimmed(whole.substr(colon + 1)));
    if (mesh::valid_name(name)) return {CurveMeaning{role, name}, ""};
    return {std::nullopt, fmt::format("takes a name, \"{}:NAME\": {}", word, mesh::name_rule)};
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
  // $PhysicalNames may name groups that no longer exist
  result.physical =
      file.lines.empty() || std::any_of(file.lines.begin(), file.lines.end(),
                                        [](const auto& line) { return line.group != 0; });
  // a user who says what the elementary curves are need not save them in groups
  if (!result.physical && given.empty()) refuse_lost_groups(file);
  for (const auto& [tag, name] : file.curve_names)
    if (result.physical) result.groups.emplace(tag, named_by_file(tag, true, name));
  for (const auto& line : file.lines) {
    const std::int32_t tag = result.physical ? line.group : line.entity;
    // physical tag 0 stands for no group
    if ((result.physical && tag == 0) || result.groups.contains(tag)) continue;
    result.groups.emplace(tag, named_by_file(tag, result.physical, ""));
  }
  for (const auto& [tag, text] : given) {
    const auto group = result.groups.find(tag);
    if (group == result.groups.end()) refuse_missing(tag, result);
    group->second.meaning = given_meaning(tag, text);
  }
  check_names(result.groups);
  return result;
}

}  // namespace anticrack::mesher

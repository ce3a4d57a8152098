// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/mesh_start.hpp"

#include <algorithm>
#include <vector>

#include "mesher/messages.hpp"

namespace anticrack::mesher {
namespace {

constexpr std::string_view blanks = " \t\r\n";

/// Takes the first word off the text; empty if the text ends before the word does.
std::string_view take_word(std::string_view& text) {
  const std::size_t end = text.find_first_of(blanks);
  if (end == std::string_view::npos) return {};
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(end);
  return word;
}

bool is_count(std::string_view word) {
  return !word.empty() && word.size() < 20 &&
         std::ranges::all_of(word, [](char c) { return c >= '0' && c <= '9'; });
}

/// Whether the first line has the counts of vertices, triangles and edges, and nothing else.
bool begins_like_freefem(std::string_view text) {
  text = text.substr(0, text.find('\n') + 1);
  std::size_t counts = 0;
  while (!text.empty()) {
    const std::string_view word = take_word(text);
    if (!word.empty() && !is_count(word)) return false;
    if (!word.empty()) ++counts;
    text.remove_prefix(std::min(text.size(), std::size_t{1}));
  }
  return counts == 3;
}

}  // namespace

FileFormat format_of(std::string_view start) {
  if (start.empty()) refuse("the mesh file is empty; save the mesh as MSH 4.1 or 2.2");
  std::string_view text = start.substr(0, start_bytes);
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  const bool freefem = begins_like_freefem(text);
  const std::string_view word = take_word(text);
  if (word == "$MeshFormat" || word == "$Comments") return FileFormat::msh;
  if (word == "MeshVersionFormatted") return FileFormat::medit;
  if (freefem) return FileFormat::freefem;
  if (word == "$NOD") {
    refuse(
        "the file is MSH 1, which is not read; convert it: gmsh old.msh -save -format msh41 -o "
        "new.msh");
  }
  refuse(
      "the file does not begin with $MeshFormat, so it is not a .msh file; save the mesh as MSH "
      "4.1 or 2.2 (gmsh case.geo -2 -o case.msh)");
}

}  // namespace anticrack::mesher

// SPDX-License-Identifier: GPL-3.0-or-later
//
// Lists the table of keys for users.
#include <algorithm>
#include <sstream>

#include "casefile/keys.hpp"
#include "errors/errors.hpp"
#include "words/nearest.hpp"
#include "words/shown.hpp"

namespace anticrack::casefile {
namespace {

using Words = std::vector<std::string>;

constexpr const char* any_entry = "N";

struct Row {
  Words path;  ///< "load", "N", "f"
  const Key* key;
  const Keys* keys;
};

void add_rows(const Keys& keys, const Words& path, std::vector<Row>& rows) {
  for (const Key* key : keys.known()) {
    Row& row = rows.emplace_back(Row{path, key, &keys});
    row.path.emplace_back(key->name);
    if (!key->below) continue;
    Words below = row.path;
    if (key->many) below.emplace_back(any_entry);
    add_rows(*key->below, below, rows);
  }
}

std::vector<Row> all_rows() {
  std::vector<Row> rows;
  add_rows(case_keys, {}, rows);
  return rows;
}

Words split(const std::string& name) {
  Words words;
  std::istringstream parts(name);
  for (std::string part; std::getline(parts, part, '.');) words.push_back(part);
  return words;
}

std::string joined(const Words& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

/// The words of a path without names of entries.
Words plain(const Words& path) {
  Words words = path;
  std::erase(words, any_entry);
  return words;
}

bool is_path(const Words& words, const Row& row) { return plain(row.path) == words; }

/// Whether the words are the path of a row, with names or indices of entries.
bool is_path_of_entry(const Words& words, const Row& row) {
  Words path = row.path;
  if (row.key->many && words.size() > path.size()) path.emplace_back(any_entry);
  return std::ranges::equal(path, words, [](const std::string& part, const std::string& word) {
    return part == any_entry || part == word;
  });
}

bool ends_in(const Words& words, const Row& row) {
  const Words all = plain(row.path);
  return words.size() <= all.size() && std::equal(words.rbegin(), words.rend(), all.rbegin());
}

/// Whether a row is directly below another.
bool directly_below(const Row& row, const Row& above) {
  const Words head = plain(above.path);
  Words own = plain(row.path);
  if (own.size() != head.size() + 1) return false;
  own.pop_back();
  return own == head;
}

std::vector<Row> rows_of(const std::string& name) {
  std::vector<Row> rows = all_rows();
  if (name.empty()) return rows;
  const Words words = split(name);
  std::vector<Row> found;
  for (const auto& meant : {is_path, is_path_of_entry, ends_in}) {
    std::ranges::copy_if(rows, std::back_inserter(found),
                         [&](const Row& row) { return meant(words, row); });
    if (!found.empty()) break;
  }
  if (words.empty() || found.empty()) {
    Words known;
    for (const Row& row : rows)
      known.push_back(words.size() < 2 ? std::string(row.key->name) : joined(plain(row.path), "."));
    const auto near = words::nearest(name, known);
    throw errors::Error(
        errors::Reason::invalid_argument, "no key of a case is called {}; {}", words::shown(name),
        near ? "did you mean " + *near + "?" : "anticrack explain lists the sections")
        .at("name");
  }
  std::vector<Row> with_below;
  std::ranges::copy_if(rows, std::back_inserter(with_below), [&](const Row& row) {
    return std::ranges::any_of(found, [&](const Row& one) {
      return one.path == row.path || (found.size() == 1 && directly_below(row, one));
    });
  });
  return with_below;
}

std::string choice_form(const Row& row) {
  const Words values = choices(*row.keys->field(row.key->path())->enum_type());
  std::string text;
  for (const std::string& value : values) {
    if (!text.empty()) text += &value == &values.back() ? " or " : ", ";
    text += "\"" + value + "\"";
  }
  return text;
}

std::string form_of(const Row& row) {
  if (!row.key->form.empty()) return std::string(row.key->form);
  switch (row.key->type) {
    case Type::text:
      return "text";
    case Type::number:
      return "number";
    case Type::positive:
      return "number > 0";
    case Type::count:
      return "whole number from 1";
    case Type::boolean:
      return "true or false";
    case Type::choice:
      return choice_form(row);
    case Type::time:
      return "seconds, or text such as \"10min\" or \"2h\"";
    case Type::expression:
      return "number, or expression in x and y";
    case Type::point:
      return "[x, y]";
    default:
      return "table";
  }
}

v1::CaseKey told(const Row& row) {
  v1::CaseKey key;
  key.add_names(joined(row.path, "."));
  key.set_form(form_of(row));
  key.set_if_absent(std::string(row.key->need.empty() ? row.key->if_absent : "needed"));
  key.set_unit(std::string(row.key->unit));
  const std::string only =
      row.key->only.empty() ? "" : "; of \"" + std::string(row.key->only) + "\"";
  key.set_meaning(std::string(row.key->meaning) + only);
  if (const auto* field = row.keys->field(row.key->path()))
    key.set_field(field->containing_type()->name() + "." + field->name());
  return key;
}

bool same(const v1::CaseKey& a, const v1::CaseKey& b) {
  const auto word = [](const v1::CaseKey& key) {
    return key.names(0).substr(key.names(0).rfind('.') + 1);
  };
  return a.meaning() == b.meaning() && a.form() == b.form() && word(a) == word(b);
}

}  // namespace

v1::ListCaseKeysResponse list_keys(const v1::ListCaseKeysRequest& request) {
  constexpr std::size_t longest = 200;
  if (request.name().size() > longest) {
    throw errors::Error(errors::Reason::limit_exceeded, "no key has {} bytes; write at most {}",
                        request.name().size(), longest)
        .at("name");
  }
  v1::ListCaseKeysResponse response;
  auto& keys = *response.mutable_keys();
  for (const Row& row : rows_of(request.name())) {
    const v1::CaseKey key = told(row);
    const auto twin =
        std::ranges::find_if(keys, [&](const v1::CaseKey& one) { return same(one, key); });
    if (twin == keys.end())
      *keys.Add() = key;
    else
      twin->add_names(key.names(0));
  }
  return response;
}

}  // namespace anticrack::casefile

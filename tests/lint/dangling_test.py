# SPDX-License-Identifier: GPL-3.0-or-later
"""What the check `dangling` finds."""
import unittest

from checks import load
from processes import FolderTest

dangling = load("dangling")

# What is to be found has BAD behind it, and nothing else.
SOURCE = """\
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

using Texts = std::vector<std::string>;

struct Mesh {
  const Texts& warnings() const;
  Texts copies() const;
  const Mesh& self() const;
  Texts member;
};

struct Meshes {
  Mesh get() const;
  const Mesh& known() const;
  Mesh* pointer();
};

Mesh get_mesh(int number);
const Mesh& known_mesh(int number);
std::optional<Mesh> some_mesh();
std::unique_ptr<Mesh> owned_mesh();
std::vector<double> make_values();
std::span<const double> see_values();
std::string make_text();

void loops(Meshes& meshes) {
  for (const std::string& warning : get_mesh(1).warnings()) {}  // BAD
  for (const std::string& warning : meshes.get().warnings()) {}  // BAD
  for (const std::string& text : meshes.get().self().member) {}  // BAD
  for (const char letter : *get_mesh(1).copies().begin()) {}  // BAD
  for (const char letter : get_mesh(1).copies()[0]) {}  // BAD
  for (const std::string& warning : some_mesh()->warnings()) {}  // BAD
  for (const std::string& text : some_mesh().value().member) {}  // BAD
  for (const std::string& text : (*some_mesh()).member) {}  // BAD
  for (const std::string& text : owned_mesh()->member) {}  // BAD
  for (const std::string& warning : Mesh{}.warnings()) {}  // BAD
  for (const std::string& text : get_mesh(1).member) {}
  for (const std::string& warning : known_mesh(1).warnings()) {}
  for (const std::string& text : known_mesh(1).copies()) {}
  for (const std::string& warning : meshes.known().warnings()) {}
  for (const std::string& warning : meshes.pointer()->warnings()) {}
  const auto lambda = [&] {
    for (const std::string& warning : meshes.get().warnings()) {}  // BAD
  };
}

template <class T>
void in_template(T meshes) {
  for (const std::string& warning : get_mesh(1).warnings()) {}  // BAD
  for (const std::string& warning : meshes.known().warnings()) {}
}

void references(const Meshes& meshes, const std::vector<double>& values) {
  const auto& bad_list = meshes.get().warnings();  // BAD
  const auto& bad_text = meshes.get().copies()[0];  // BAD
  auto&& bad_self = get_mesh(1).self();  // BAD
  const auto& bad_choice = values.empty() ? get_mesh(1).self() : known_mesh(1);  // BAD
  const auto& member = meshes.get().member;
  const auto& text = meshes.known().warnings().at(0);
  const auto copy = get_mesh(1).self();
  const double& seen = see_values()[0];
}

void views(const std::vector<double>& values) {
  const std::span<const double> bad_values = make_values();  // BAD
  const std::span<const double> bad_first(std::span<const double>(make_values()).first(1));  // BAD
  const std::string_view bad_text = make_text();  // BAD
  const std::string_view bad_letters = make_text().c_str();  // BAD
  const std::span<const double> known = values;
  const std::span<const double> part = see_values().first(1);
  const std::string_view constant = std::string_view("text").substr(1);
}
"""


class Findings(FolderTest):
    def found(self, text):
        path = self.folder / "sample.cpp"
        path.write_text(text, encoding="utf-8")
        return dangling.findings(path, ["-std=c++20"])

    def test_are_those_that_are_gone_and_no_others(self):
        bad = [number for number, line in enumerate(SOURCE.splitlines(), 1) if line.endswith("// BAD")]
        self.assertEqual([int(line.rpartition(":")[2]) for line in self.found(SOURCE)], bad)

    def test_are_looked_for_in_whatever_may_be_one(self):
        """Each by itself, for one in a file is enough for it to be read; string_views are left to clang-tidy."""
        for line in SOURCE.splitlines():
            if line.endswith("// BAD") and "string_view" not in line:
                self.assertRegex(line, dangling.CANDIDATE)

    def test_of_files_that_do_not_compile_are_none_but_an_error(self):
        with self.assertRaisesRegex(RuntimeError, "undeclared identifier 'unknown'"):
            self.found("const int& some = unknown();\n")


if __name__ == "__main__":
    unittest.main()

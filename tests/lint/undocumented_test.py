# SPDX-License-Identifier: GPL-3.0-or-later
"""Which functions the check of `deploy/test --lint` finds without a comment."""
import re
import unittest

from checks import load
from processes import FolderTest

undocumented = load("undocumented")

# What is to be found has BAD in its name, and nothing else.
HEADER = """\
#pragma once
#include <string>

namespace sample {

int bad_alone();

/// A comment.
int above();
int in_its_group();
int in_its_group_too();

int bad_behind_an_empty_line();

#define MADE(name) int name();
MADE(by_a_macro)

int behind(int value);  ///< a comment

/// A comment of
/// two lines.
template <class T>
T templated(T value) {
  return value + 1;
}
int bad_behind_a_long_body();

template <class T>
T bad_template(T value);

/// A comment of a class that names named() alone.
class Class {
 public:
  Class() = default;
  explicit Class(int value) : _value(value), _other(value) {}
  Class(int bad, int other);
  Class(const Class&) = delete;
  Class(Class&& other) noexcept : _value(other._value) { other._value = 0; }
  Class& operator=(const Class&) = delete;
  virtual ~Class();

  int value() const noexcept { return _value; }
  int bad_other() const { return _other; }
  void named();
  virtual int bad_virtual() const = 0;
  /// A comment.
  virtual int documented() const = 0;

  struct Inner {
    int bad_inner(
        int in_two_lines) const;
  };

 protected:
  int not_public();

 private:
  struct Hidden {
    int not_public_either();
  };
  int not_public_at_all();

  int _value = 0;
  int _other = 0;
};

class Derived final : public Class {
 public:
  using Class::Class;
  int documented() const override;
  int bad_virtual() const override;
  /* another kind of comment */
  int bad_of_derived();
};

inline int Class::not_public() { return 1; }

int operator+(const Class& a, const Class& b);

}  // namespace sample
"""


class Findings(FolderTest):
    def found(self, text):
        header = self.folder / "sample.hpp"
        header.write_text(text, encoding="utf-8")
        headers = {header.resolve(): undocumented.Header(header)}
        search = undocumented.Search(headers)
        search.visit(undocumented.parse(headers, ["-std=c++20"]).cursor)
        self.functions = search.functions
        return [(line, name) for path, line, name in search.findings if path == header.resolve()]

    def test_are_those_without_a_comment_and_no_others(self):
        lines = HEADER.splitlines()
        expected = [number for number, line in enumerate(lines, 1)
                    if re.search(r"\bbad", line) and "override" not in line]
        found = self.found(HEADER)
        self.assertEqual([lines[line - 1] for line, _ in found], [lines[number - 1] for number in expected])
        self.assertEqual(len(found), 9)

    def test_have_names_by_which_they_are_known(self):
        self.assertEqual(self.found("#pragma once\nint some(int, double);\n"), [(2, "some(int, double)")])
        self.assertEqual(self.functions, 1)

    def test_of_headers_that_do_not_compile_are_none_but_an_error(self):
        with self.assertRaises(SystemExit) as raised:
            self.found("#pragma once\nint some(Unknown);\n")
        self.assertIn("unknown type name 'Unknown'", str(raised.exception))

    def test_parts_of_sources_have_no_interface(self):
        part = self.folder / "part.hpp"
        part.write_text("int some();\n", encoding="utf-8")
        self.assertFalse(undocumented.Header(part).has_interface)


if __name__ == "__main__":
    unittest.main()

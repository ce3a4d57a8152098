# SPDX-License-Identifier: GPL-3.0-or-later
"""The API keeps what its last release had, and the check of that finds every way to break it."""
import pathlib
import unittest

from processes import FolderTest, run

COMPATIBLE = pathlib.Path(__file__).resolve().parents[2] / "proto" / "compatible"

API = """\
syntax = "proto3";
package some.v1;
service Service {
  rpc Ask(Request) returns (stream Answer);
}
message Request {
  enum Kind {
    KIND_UNSPECIFIED = 0;
    KIND_FIRST = 1;
  }
  string name = 1;
  optional double size = 2;
  oneof choice {
    int32 count = 3;
    Kind kind = 4;
  }
}
message Answer {
  repeated string lines = 1;
}
"""


class Compatible(FolderTest):
    def check(self, old, new):
        """(exit code, errors) once `old` was released and is `new` in some place."""
        self.assertIn(old, API)
        proto = self.folder / "some.proto"
        proto.write_text(API, encoding="utf-8")
        released = run(COMPATIBLE, "--list", self.folder)
        self.assertEqual(released.returncode, 0, released.stderr)
        (self.folder / "RELEASED").write_text(released.stdout, encoding="utf-8")
        proto.write_text(API.replace(old, new), encoding="utf-8")
        ended = run(COMPATIBLE, self.folder)
        return ended.returncode, ended.stderr

    def test_of_this_api(self):
        ended = run(COMPATIBLE)
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))

    def test_additions_are_free(self):
        for old, new in [("string name = 1;", "string name = 1; string title = 5;"),
                         ("KIND_FIRST = 1;", "KIND_FIRST = 1; KIND_SECOND = 2;"),
                         ("Kind kind = 4;", "Kind kind = 4; bool none = 6;"),
                         ("service Service {", "service Service { rpc Say(Request) returns (Answer);")]:
            self.assertEqual(self.check(old, new), (0, ""), new)

    def test_everything_else_is_refused_by_name(self):
        for old, new, named in [
                ("string name = 1;", "", "some.v1.Request 1: name, string"),
                ("string name = 1;", "reserved 1;", "some.v1.Request 1: name, string"),
                ("string name = 1;", "string name = 7;", "some.v1.Request 1: name, string"),
                ("string name = 1;", "string title = 1;", "some.v1.Request 1: name, string"),
                ("string name = 1;", "bytes name = 1;", "some.v1.Request 1: name, string"),
                ("optional double size", "double size", "some.v1.Request 2: size, optional double"),
                ("repeated string lines", "string lines", "some.v1.Answer 1: lines, repeated string"),
                ("oneof choice {\n    int32 count = 3;", "int32 count = 3;\n  oneof choice {",
                 "some.v1.Request 3: count, int32 in choice"),
                ("KIND_FIRST = 1;", "KIND_ONE = 1;", "some.v1.Request.Kind 1: KIND_FIRST"),
                ("KIND_FIRST = 1;", "KIND_FIRST = 2;", "some.v1.Request.Kind 1: KIND_FIRST"),
                ("rpc Ask(", "rpc Tell(", "some.v1.Service: Ask"),
                ("returns (stream Answer)", "returns (Answer)", "some.v1.Service: Ask")]:
            code, errors = self.check(old, new)
            self.assertEqual(code, 1, new)
            self.assertIn("the last release has " + named, errors, new)


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""The API's reference is what its comments say now, and they say something of everything."""
import pathlib
import re
import unittest

from processes import FolderTest, run

ROOT = pathlib.Path(__file__).resolve().parents[2]
REFERENCE = ROOT / "proto" / "reference"

COMMENTED = """\
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Of the file.
syntax = "proto3";

package anticrack.v1;

// Of the service.
service Service {
  // Of the method.
  // Errors: NOT_FOUND.
  rpc Ask(AskRequest) returns (stream AskResponse);
}

// Of the request.
message AskRequest {
  // Of the nested one.
  message Inner {
    int32 number = 1;             // of the nested field
  }
  // Of the enum.
  enum Kind {
    KIND_UNSPECIFIED = 0;         // of the value
  }
  // Of the oneof.
  oneof choice {
    Inner inner = 1;              // [u] >= 0, |a*b|
    Kind kind = 2;                // of the kind
  }

  // Of those below.

  map<string, double> numbers = 3;   // of the map
  optional uint32 count = 4;      // of the optional one
  repeated Inner inners = 5;      // of the list
}

// Of the answer:
//   one   two
message AskResponse {}
"""


class References(FolderTest):
    def reference(self, text):
        (self.folder / "some.proto").write_text(text, encoding="utf-8")
        return run(REFERENCE, self.folder)

    def test_is_committed_as_it_would_be_made_now(self):
        made = run(REFERENCE)
        self.assertEqual((made.returncode, made.stderr), (0, ""))
        self.assertEqual(made.stdout, (ROOT / "proto" / "REFERENCE.md").read_text(encoding="utf-8"),
                         "run proto/reference > proto/REFERENCE.md")

    def test_links_lead_somewhere_and_headings_are_told_apart(self):
        text = run(REFERENCE).stdout
        headings = [re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")
                    for heading in re.findall(r"^#+ (.*)$", text, re.MULTILINE)]
        self.assertEqual(len(headings), len(set(headings)))
        self.assertLessEqual(set(re.findall(r"\]\(#([^)]*)\)", text)), set(headings))

    def test_every_method_says_how_it_fails(self):
        text = run(REFERENCE).stdout
        methods = re.findall(r"^#### (\w+)\n(.*?)(?=^###)", text, re.MULTILINE | re.DOTALL)
        self.assertTrue(methods)
        self.assertEqual([name for name, said in methods if said.count("**Errors:**") != 1], [])

    def test_lists_the_reasons_that_the_server_gives(self):
        said = re.findall(r"^([A-Z_]+) +[A-Z_]+ +\S", run(REFERENCE).stdout, re.MULTILINE)
        given = re.findall(r'"([A-Z_]+)"', (ROOT / "server/errors/errors.cpp").read_text(encoding="utf-8"))
        self.assertEqual(sorted(said), sorted(set(given)))

    def test_shows_types_comments_and_errors(self):
        made = self.reference(COMMENTED)
        self.assertEqual((made.returncode, made.stderr), (0, ""))
        for part in ("[AskRequest](#askrequest) → stream of [AskResponse](#askresponse)",
                     "Of the method.\n\n**Errors:** NOT_FOUND.\n",
                     "Of those below.\n\n| Field |",
                     "`choice` (`inner` or `kind`): Of the oneof.",
                     r"| `inner` | [AskRequest.Inner](#askrequestinner) | [u] >= 0, \|a\*b\| |",
                     "| `numbers` | map of string to double | of the map |",
                     "| `count` | optional uint32 | of the optional one |",
                     "| `inners` | repeated [AskRequest.Inner](#askrequestinner) | of the list |",
                     "| `KIND_UNSPECIFIED` | 0 | of the value |",
                     "Of the answer:\n\n```text\none   two\n```\n"):
            self.assertIn(part, made.stdout)

    def test_names_what_has_no_comment(self):
        bare = re.sub(r"//.*", "", COMMENTED)
        made = self.reference(bare)
        self.assertEqual((made.returncode, made.stdout), (1, ""))
        lines = made.stderr.splitlines()
        self.assertEqual(lines[-1], "reference: 14 elements without a comment, above")
        self.assertEqual(sorted(line.split(": ")[1] for line in lines[:-1]), sorted([
            "Service", "Ask", "AskRequest", "AskRequest.choice", "AskRequest.inner", "AskRequest.kind",
            "AskRequest.numbers", "AskRequest.count", "AskRequest.inners", "AskRequest.Inner",
            "AskRequest.Inner.number", "AskRequest.Kind", "AskRequest.Kind.KIND_UNSPECIFIED", "AskResponse"]))
        self.assertIn("some.proto:19: AskRequest.Inner.number", lines)


if __name__ == "__main__":
    unittest.main()

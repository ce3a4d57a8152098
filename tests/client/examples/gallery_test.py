# SPDX-License-Identifier: GPL-3.0-or-later
"""What keeps the gallery whole."""
import re
import unittest

import gallery_paper_test
import gallery_shapes_test
from gallery import EXAMPLES
from opening import Opening

CASES = sorted(path.stem for path in EXAMPLES.glob("*.toml"))


class Rules(unittest.TestCase):
    """A case without commands, without a test or missing in the index fails."""

    def test_every_case_opens_with_what_it_shows_its_commands_and_what_to_expect(self):
        for name in CASES:
            with self.subTest(name):
                opening = Opening(EXAMPLES / f"{name}.toml")
                self.assertRegex(opening.words, r"\w[\s\S]*\n Expect\b")
                self.assertRegex(opening.words[opening.words.index("Expect"):], r"\d")
                self.assertTrue(any(f"client/examples/{name}.toml" in command.text for command in opening.commands))

    def test_every_case_has_a_test(self):
        names = dir(gallery_paper_test.Paper) + dir(gallery_shapes_test.Shapes)
        tests = {name[5:].replace("_", "-") for name in names if name.startswith("test_")}
        self.assertEqual(tests, set(CASES))

    def test_every_other_file_is_used(self):
        texts = {path: path.read_text(encoding="utf-8") for path in EXAMPLES.glob("*.toml")}
        for path in EXAMPLES.iterdir():
            if path.suffix in (".csv", ".msh", ".geo"):
                self.assertTrue(any(path.name in text for text in texts.values()), path.name)

    def test_the_index_has_every_example_with_its_command_and_numbers(self):
        index = (EXAMPLES / "README.md").read_text(encoding="utf-8")
        for path in EXAMPLES.iterdir():
            if path.suffix in (".toml", ".py"):
                self.assertIn(f"[{path.name}]({path.name})", index)
        for name in CASES:
            opening = Opening(EXAMPLES / f"{name}.toml")
            command = next(command.text for command in opening.commands if f"{name}.toml" in command.text)
            self.assertIn(" ".join(command.split()), " ".join(index.replace("\\\n", " ").split()))
            row = next(line for line in index.splitlines() if line.startswith(f"| [{name}.toml]"))
            for number in re.findall(r"\d+\.\d{3,}", row):
                self.assertIn(number, opening.words, row)
        for name in re.findall(r"\]\(([^)#:]+)\)", index):
            self.assertTrue((EXAMPLES / name).exists(), name)

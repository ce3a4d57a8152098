# SPDX-License-Identifier: GPL-3.0-or-later
"""Wrong command lines and wrong cases: what the real command says of each, in full, and its exit
code. The tables are in wrong_commands.py and wrong_cases.py."""
import hashlib
import json
import os
import pathlib
import re
import shlex
import tempfile
import unittest

import h5py
import numpy

import anticrack
import wrong_cases
import wrong_commands
from processes import ANTICRACK, Daemon, run

TWO_LOADS = wrong_cases.GOOD.replace('method = "uzawa"\ntheta = 1.5\n', "") + '\n[[load]]\nname = "skew"\nf = "x"\n'
MSH = """\
$MeshFormat
2.2 0 8
$EndMeshFormat
"""


def make_files(folder):
    """What the tables name, beside case.toml and what is made with the server."""
    texts = {"case.toml": wrong_cases.GOOD, "two.toml": TWO_LOADS, "empty.toml": "", "plate.msh": MSH,
             "token": "secret\n", "empty.csv": "", "good.csv": "opening,skew\n1,2\n3,4\n",
             "short.csv": "opening,skew\n1,2\n3\n", "letters.csv": "1,2\n3,four\n", "nan.csv": "1,nan\n",
             "mixed.csv": "opening;skew\n1,5;2\n3;2.5\n",
             "unknown.csv": "opening,skwe\n1,2\n", "twice.csv": "skew,skew\n1,2\n", "partial.csv": "skew\n1\n"}
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "binary.toml").write_bytes(b"\x00\x01\x02\xfe\xff")
    (folder / "latin.toml").write_bytes('title = "Böschung"\n'.encode("latin-1"))
    (folder / "large.toml").write_text("# " + 5_000_000 * "a" + "\n" + wrong_cases.GOOD, encoding="utf-8")
    (folder / "folder").mkdir()
    with h5py.File(folder / "plain.h5", "w") as file:
        file["vector"] = numpy.ones(3)
        file["matrix"] = numpy.ones((2, 2))
        file["wide"] = numpy.ones((2, 5))
        file["named"] = numpy.ones((2, 2))
        file["named"].attrs["loads"] = ["opening", "skwe"]


def make_results(folder):
    """A result file, and ones that went wrong."""
    result = (folder / "result.h5").read_bytes()
    (folder / "no-fields.h5").write_bytes(result)
    (folder / "truncated.h5").write_bytes(result[:len(result) // 2])
    (folder / "other.h5").write_bytes(result)
    with h5py.File(folder / "other.h5", "a") as file:
        file.attrs["format"] = "anticrack-result/9"


class BadUsage(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        folder = cls.enterClassContext(tempfile.TemporaryDirectory(prefix="anticrack-test-"))
        cls.folder = pathlib.Path(folder)
        make_files(cls.folder)
        for name in ("open", "guarded"):
            (cls.folder / name).mkdir()
        digest = hashlib.sha256(b"another").hexdigest()
        (cls.folder / "tokens").write_text(f"ann user {digest}\n", encoding="utf-8")
        cls.server = cls.address(cls.folder / "open")
        cls.guarded = cls.address(cls.folder / "guarded", "--tokens", cls.folder / "tokens")
        ended = cls.anticrack("run", "case.toml", "-o", "result.h5", "--json")
        document = json.loads(ended.stdout)
        cls.job, cls.mesh = document["job"], document["mesh"]["name"]
        make_results(cls.folder)

    @classmethod
    def address(cls, folder, *flags):
        """Of a server that runs as long as the tests do."""
        return f"127.0.0.1:{cls.enterClassContext(Daemon(folder, *flags)).port}"

    @classmethod
    def anticrack(cls, *words):
        environment = {name: value for name, value in os.environ.items() if not name.startswith("ANTICRACK_")}
        environment["ANTICRACK_SERVER"] = cls.server
        return run(ANTICRACK, *words, cwd=cls.folder, env=environment)

    @classmethod
    def masked(cls, text):
        text = text.replace(cls.server, "SERVER").replace(cls.guarded, "SERVER")
        text = re.sub(r"\(-?\d\.\d{7,}, -?\d\.\d{7,}\)", "(X, Y)", text)  # a node of the mesh
        text = re.sub(r"range \[(\d+) - (\d+)\]", r"range \1 to \2", text)  # as CLI11 of Debian 12 has it
        return re.sub(r"(jobs|meshes)/[0-9a-f]{10,16}\b", r"\1/ID", text)

    @classmethod
    def words_of(cls, command):
        """{guarded}, {job:N}, {mesh:N}: an address, and the first N letters of an ID."""
        def cut(match):
            text = {"job": cls.job, "mesh": cls.mesh}[match[1]]
            return text[:text.index("/") + 1] + text.split("/")[1][:int(match[2])]
        return shlex.split(re.sub(r"\{(job|mesh):(-?\d+)\}", cut, command).replace("{guarded}", cls.guarded))

    @classmethod
    def said(cls, *words):
        """The exit code, and what is said on standard error."""
        ended = cls.anticrack(*words)
        return ended.returncode, cls.masked(ended.stderr)

    @classmethod
    def said_of_command(cls, command):
        return cls.said(*cls.words_of(command))

    @classmethod
    def said_of_case(cls, text):
        (cls.folder / "wrong.toml").write_text(text, encoding="utf-8")
        return cls.said("run", "wrong.toml")

    def test_wrong_commands(self):
        for command, code, message in wrong_commands.COMMANDS:
            with self.subTest(command):
                self.assertEqual(self.said_of_command(command), (code, f"anticrack: {message}\n"))

    def test_python_says_the_same_of_wrong_cases(self):
        with anticrack.connect(self.server) as client:
            for text, code, message in wrong_cases.texts():
                if code != 2 or any(word in message for word in (".h5", ".msh: ", "not TOML")):  # of other libraries
                    continue
                case = anticrack.Case.parse(text, "wrong.toml")
                with self.subTest(message), self.assertRaises(anticrack.Error) as caught:
                    client.submit(case)
                self.assertEqual(self.masked(str(caught.exception)), message)

    def test_wrong_cases(self):
        for text, code, message in wrong_cases.texts():
            with self.subTest(message):
                self.assertEqual(self.said_of_case(text), (code, f"anticrack: {message}\n"))

    def test_an_output_that_cannot_be_written_is_seen_before_anything_is_submitted(self):
        before = self.anticrack("job", "list").stdout
        code, said = self.said("run", "case.toml", "-o", "no-folder/out.h5")
        self.assertEqual(code, 2)
        self.assertIn("no-folder", said)
        self.assertEqual(self.anticrack("job", "list").stdout, before)

    def test_a_stage_beyond_the_memory_says_why(self):
        (self.folder / "small").mkdir()
        server = self.address(self.folder / "small", "--memory-budget", "6MiB")
        text = TWO_LOADS.replace("[solver]", "[accuracy]\nenergy = 1e-5").replace("size = 0.5", "size = 0.2")
        (self.folder / "fine.toml").write_text(text, encoding="utf-8")
        code, said = self.said("--server", server, "run", "fine.toml")
        self.assertEqual(code, 3)
        self.assertEqual(said, "")
        self.assertIn("than the memory-budget", self.anticrack("show", "fine.h5").stdout)

    def test_with_json_the_same_is_said_in_a_document(self):
        for command, code, message in wrong_commands.COMMANDS[::3]:
            with self.subTest(command):
                ended = self.anticrack("--json", *self.words_of(command))
                self.assertEqual(ended.returncode, code)
                error = json.loads(ended.stdout)["error"]
                self.assertEqual(set(error), {"code", "reason", "message", "fields"})
                # What is not UTF-8 is U+FFFD here, on a terminal "?".
                self.assertEqual(self.masked(error["message"]).replace("\ufffd", "?"), message)

    @unittest.skipIf(os.geteuid() == 0, "root may read and write everything")
    def test_what_permissions_forbid(self):
        (self.folder / "secret.toml").write_text(wrong_cases.GOOD, encoding="utf-8")
        (self.folder / "secret.toml").chmod(0)
        (self.folder / "locked").mkdir(mode=0o500)
        for command, message in wrong_commands.FORBIDDEN:
            with self.subTest(command):
                self.assertEqual(self.said_of_command(command), (2, f"anticrack: {message}\n"))

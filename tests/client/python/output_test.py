# SPDX-License-Identifier: GPL-3.0-or-later
"""Where Python writes: links, pipes, devices, a full disk; which proxy it would use."""
import os
import pathlib
import resource
import stat
import subprocess
import sys
import threading
import unittest
import unittest.mock

import h5py

import anticrack
from anticrack import output
from anticrack.proxies import proxy_for
from cases import read
from processes import ANTICRACK, FolderTest, run

EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])
SAME = pathlib.Path(os.environ["SAME"])


class Output(FolderTest):
    def setUp(self):
        super().setUp()
        self.scratch = self.folder / "scratch"
        self.scratch.mkdir()
        (self.scratch / "old").write_text("old", encoding="utf-8")

    def files(self):
        return sorted(path.name for path in self.scratch.iterdir())

    def test_links_are_written_through(self):
        links = {"absolute": self.scratch / "old", "relative": "scratch/old", "through": "absolute",
                 "new": "scratch/new", "up": "scratch/../scratch/old"}
        for name, to in links.items():
            link = self.folder / name
            link.symlink_to(to)
            output.write(link, name.encode())
            self.assertTrue(link.is_symlink())
            self.assertEqual((self.scratch / ("new" if name == "new" else "old")).read_text(encoding="utf-8"), name)
        output.write(self.folder / "relative", b"kept", keep=True)
        self.assertEqual((self.scratch / "old~").read_text(encoding="utf-8"), "up")
        self.assertEqual(self.files(), ["new", "old", "old~"])

    def test_permissions_stay(self):
        (self.scratch / "old").chmod(0o640)
        output.write(self.scratch / "old", b"new")
        output.write(self.scratch / "other", b"new")
        (self.scratch / "plain").write_text("", encoding="utf-8")
        modes = [stat.S_IMODE((self.scratch / name).stat().st_mode) for name in ("old", "other", "plain")]
        self.assertEqual(modes[0], 0o640)
        self.assertEqual(modes[1], modes[2])

    def test_pipes_and_devices_are_streams(self):
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        read = []
        reader = threading.Thread(target=lambda: read.append(pipe.read_bytes()))
        reader.start()
        output.write(pipe, b"x" * 200_000)
        reader.join()
        self.assertEqual(read, [b"x" * 200_000])
        output.write("/dev/null", b"x", keep=True)
        self.assertTrue(pathlib.Path("/dev/null").is_char_device())
        with self.assertRaisesRegex(anticrack.Error, "^/dev/full cannot be written: No space left on device; free"):
            output.write("/dev/full", b"x")
        (self.folder / "link").symlink_to("/proc/self/fd/1")
        program = ("import sys; from anticrack import output; print('before')\n"
                   "for path in ('/dev/stdout', '/dev/fd/1', sys.argv[1]): output.write(path, b'x')\nprint('after')")
        with open(self.folder / "out", "wb") as out:
            subprocess.run([sys.executable, "-c", program, str(self.folder / "link")], stdout=out, check=True)
        self.assertEqual((self.folder / "out").read_text(encoding="utf-8"), "before\nxxxafter\n")

    def test_what_cannot_be_is_named(self):
        (self.folder / "round").symlink_to("round")
        for path, said in ((self.folder / "round", "round cannot be written: Too many levels of symbolic links"),
                           (self.scratch, "is a folder; name a file"),
                           (self.scratch / "old" / "file", "cannot be written: Not a directory"),
                           (self.folder / "none" / "file", "there is no folder .*none; make it")):
            with self.assertRaisesRegex(anticrack.Error, said):
                output.write(path, b"x")


class Save(FolderTest):
    def result(self):
        path = self.folder / "made.h5"
        ended = run(ANTICRACK, "--local", "--quiet", "run", EXAMPLES / "slit.toml", "-o", path)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        return anticrack.read(path)

    def test_on_a_full_disk_is_an_error_and_python_goes_on(self):
        result, saved = self.result(), self.folder / "saved.h5"
        result.save(saved)
        before = saved.read_bytes()
        for most in (0, 1, 100, 2_000, 10_000, len(before) - 1):
            limits = resource.getrlimit(resource.RLIMIT_FSIZE)
            resource.setrlimit(resource.RLIMIT_FSIZE, (most, limits[1]))
            try:
                for path in (saved, self.folder / "other.h5"):
                    with self.assertRaisesRegex(anticrack.Error, f"{path.name} cannot be written: File too large"):
                        result.save(path)
            finally:
                resource.setrlimit(resource.RLIMIT_FSIZE, limits)
            self.assertEqual(saved.read_bytes(), before)
            self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["made.h5", "saved.h5"])
        result.save(saved)
        self.assertEqual(anticrack.read(saved).job, result.job)

    def test_goes_through_a_link_and_into_a_stream(self):
        result, link = self.result(), self.folder / "link.h5"
        link.symlink_to("target.h5")
        result.save(link)
        result.save(link)
        self.assertTrue(link.is_symlink())
        self.assertEqual(anticrack.read(self.folder / "target.h5").job, result.job)
        result.save("/dev/null")
        os.mkfifo(self.folder / "pipe")
        with open(self.folder / "read.h5", "wb") as read, subprocess.Popen(["cat", self.folder / "pipe"], stdout=read):
            result.save(self.folder / "pipe")
        self.assertEqual(anticrack.read(self.folder / "read.h5").job, result.job)

    def test_a_load_from_what_is_no_dataset_is_named(self):
        with h5py.File(self.folder / "f.h5", "w") as file:
            file.create_group("group").create_group("inner")
            file.create_group("empty")
            file["type"] = h5py.string_dtype()
        case = (EXAMPLES / "slit.toml").read_text(encoding="utf-8")
        for name, said in (("group", "group is a group, not a dataset; it has inner$"),
                           ("empty", "empty is a group, not a dataset$"), ("type", "type is a named type, not a")):
            (self.folder / "case.toml").write_text(
                case[:case.index("[[load]]")] + f'[[load]]\nname = "a"\nf = {{ file = "f.h5", dataset = "{name}", '
                'per = "node" }\n', encoding="utf-8")
            with self.assertRaisesRegex(anticrack.CaseError, said):
                read(self.folder / "case.toml").arrays()


class Proxies(unittest.TestCase):
    def test_are_those_of_the_command(self):
        rows = [line.split() for line in (SAME / "proxies.txt").read_text(encoding="utf-8").splitlines()
                if not line.startswith("#")]
        self.assertGreater(len(rows), 40)
        for address, variables, *expected in rows:
            pairs = (entry.partition("=") for entry in variables.split(",") if "=" in entry)
            environment = {name: value.replace(";", ",") for name, _, value in pairs}
            with unittest.mock.patch.dict(os.environ, environment, clear=True):
                self.assertEqual(proxy_for(address), None if expected == ["-"] else tuple(expected),
                                 (address, variables))


if __name__ == "__main__":
    unittest.main()

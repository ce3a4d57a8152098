# SPDX-License-Identifier: GPL-3.0-or-later
"""What the real command writes to: links, pipes, devices, a full disk, an output that is closed."""
import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import tempfile
import threading
import unittest

import h5py

from processes import ANTICRACK, Daemon, run

CASE = """
[geometry]
boundary = [[-1,-1], [1,-1], [1,1], [-1,1]]
interface = [[-1,0], [1,0]]
[[geometry.inclusion]]
name = "fibre"
from = [-0.5,0]
to = [0.5,0]
[[load]]
name = "opening"
f = "y > 0 ? 1 : -1"
[mesh]
size = 0.2
[output]
fields = true
"""
FULL = "anticrack: standard output cannot be written: No space left on device\n"
HAS_DOCUMENT = [  # with --json; those that need no server, so that they are many and quick
    "show r.h5", "export r.h5 -o {new}", "plot r.h5 -o {new} --only traces --format svg", "completion bash",
    "completion zsh", "completion fish", "manual {new}", "show missing.h5"]
WITH_SERVER = ["--local server", "--local mesh show case.toml", "--local mesh show case.toml -o {new} --format svg",
               "--local mesh create case.toml", "--local mesh list", "--local job list", "--local job submit case.toml",
               "--local run case.toml -o full.h5", "--local sweep case.toml --coefficients c.csv -o full.h5"]


def no_longer_than(count):
    """As a full disk: writes of files stop there. A signal comes with it, which the command must not die of."""
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
        resource.setrlimit(resource.RLIMIT_FSIZE, (count, count))
    return limit


class Outputs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.made = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="anticrack-test-")))
        (cls.made / "case.toml").write_text(CASE, encoding="utf-8")
        (cls.made / "c.csv").write_text("1\n2\n", encoding="utf-8")
        ended = run(ANTICRACK, "--local", "run", "case.toml", "-o", "r.h5", cwd=cls.made)
        assert ended.returncode == 0, ended.stderr

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="anticrack-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.count = 0
        for name in ("case.toml", "c.csv", "r.h5"):
            shutil.copy(self.made / name, self.folder)

    def run_in_folder(self, words, **options):
        self.count += 1
        words = words.format(new=f"new-{self.count}").split()
        options.setdefault("stdout", subprocess.PIPE)
        return subprocess.run([ANTICRACK, *words], cwd=self.folder, text=True, stderr=subprocess.PIPE, check=False,
                              stdin=subprocess.DEVNULL, **options)

    def shell(self, command):
        return subprocess.run(["bash", "-c", command], cwd=self.folder, text=True, capture_output=True, check=False,
                              env={**os.environ, "A": ANTICRACK})

    def partial(self):
        return [path for path in self.folder.rglob("*") if "partial" in path.name or path.name == "-"]

    def test_a_link_is_written_through(self):
        scratch = self.folder / "scratch"
        scratch.mkdir()
        for name in ("l.h5", "t.csv", "s.csv"):
            (self.folder / name).symlink_to(scratch / name)
        for words in ("--local run case.toml -o l.h5", "show r.h5 --csv t.csv",
                      "--local sweep case.toml --coefficients c.csv -o w.h5 --csv s.csv"):
            self.assertEqual(self.run_in_folder(words).returncode, 0)
        for name in ("l.h5", "t.csv", "s.csv"):
            self.assertTrue((self.folder / name).is_symlink(), name)
            self.assertGreater((scratch / name).stat().st_size, 0)
        (self.folder / "same.csv").symlink_to("r.h5")
        self.assertRegex(self.run_in_folder("show r.h5 --csv same.csv").stderr, "this is also the result file")
        self.assertEqual(self.partial(), [])

    def test_figures_and_exports_go_through_links(self):
        (self.folder / "figures").mkdir()
        for name, words in (("figures/opening-traces.svg", "plot r.h5 -o figures --only traces --format svg"),
                            ("figures/opening.vtu", "export r.h5 -o figures"),
                            ("figures/anticrack.1", "manual figures")):
            (self.folder / name).symlink_to(self.folder / "target")
            self.assertEqual(self.run_in_folder(words).returncode, 0)
            self.assertTrue((self.folder / name).is_symlink())
            self.assertGreater((self.folder / "target").stat().st_size, 100)

    def test_standard_output_by_each_of_its_names(self):
        (self.folder / "link").symlink_to("/proc/self/fd/1")
        (self.folder / "device").symlink_to("/dev/stdout")
        for name in ("-", "/dev/stdout", "/dev/fd/1", "link", "device", "out.txt"):
            for quiet in ("", "--quiet "):
                with open(self.folder / "out.txt", "w", encoding="utf-8") as out:
                    ended = self.run_in_folder(f"{quiet}show r.h5 --inclusions --csv {name}", stdout=out)
                self.assertEqual(ended.returncode, 0, ended.stderr)
                rows = (self.folder / "out.txt").read_text(encoding="utf-8").splitlines()
                self.assertTrue(rows[0].startswith("load,"), rows)
                self.assertTrue(all(row.count(",") == rows[0].count(",") for row in rows), "nothing but the table")
                self.assertEqual("triangles" in ended.stderr, not quiet)
        self.assertTrue((self.folder / "link").is_symlink())
        self.assertEqual(self.partial(), [])
        for words in ("--json show r.h5 --csv -", "--local --json run case.toml -o -",
                      "--local sweep case.toml --coefficients c.csv -o - --csv /dev/stdout"):
            ended = self.run_in_folder(words)
            self.assertEqual(ended.returncode, 2)
            self.assertRegex(ended.stderr, "standard output is already that of .*; name a file")

    def test_a_folder_cannot_be_standard_output(self):
        for words in ("plot r.h5 -o -", "export r.h5 -o -", "manual -", "--local mesh show case.toml -o -"):
            ended = self.run_in_folder(words)
            self.assertEqual(ended.returncode, 2, words)
            self.assertRegex(ended.stderr, "-: is standard output, and several files .*; name a folder")
        self.assertEqual(self.partial(), [])

    def test_a_result_is_a_stream_where_it_is_asked_for(self):
        with open(self.folder / "out.h5", "wb") as out:
            ended = self.run_in_folder("--local run case.toml -o -", stdout=out)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        with h5py.File(self.folder / "out.h5") as file:
            self.assertIn("loads", file)
        self.assertRegex(ended.stderr, "Results: - ")
        self.assertEqual(self.run_in_folder("--local run case.toml -o /dev/null").returncode, 0)
        self.assertTrue(pathlib.Path("/dev/null").is_char_device())

    def test_a_pipe_is_fed(self):
        os.mkfifo(self.folder / "pipe")
        read = []
        reader = threading.Thread(target=lambda: read.append((self.folder / "pipe").read_text(encoding="utf-8")))
        reader.start()
        self.assertEqual(self.run_in_folder("show r.h5 --csv pipe").returncode, 0)
        reader.join()
        self.assertTrue(read[0].startswith("load,"))
        self.assertTrue((self.folder / "pipe").is_fifo())
        self.assertIn("opening", self.shell("$A --quiet show r.h5 --csv >(cat >&2) > /dev/null; wait").stderr)

    def test_a_full_output_is_one_line(self):
        with open("/dev/full", "wb") as full:
            for words in [*HAS_DOCUMENT, *WITH_SERVER]:
                for json_flag in ("", "--json "):
                    ended = self.run_in_folder(json_flag + words, stdout=full)
                    said = ended.stderr.splitlines(keepends=True)
                    if "missing" not in words:
                        self.assertEqual(ended.returncode, 2, (words, ended.stderr))
                    if "missing" not in words or json_flag:
                        self.assertEqual(said[-1:], [FULL], words)
                        self.assertEqual(said.count(FULL), 1, words)
            for words in ("--help", "--version", "run --help", "--complete -- anticrack ru"):
                ended = self.run_in_folder(words, stdout=full)
                self.assertEqual((ended.returncode, ended.stderr), (2, FULL), words)
        self.assertTrue((self.folder / "full.h5").exists(), "the result is saved all the same")

    def test_a_closed_output_is_one_line(self):
        for words in ("show r.h5", "--json show r.h5", "--version", "--local --json server", "completion bash"):
            ended = self.shell(f"$A {words} >&-")
            self.assertEqual((ended.returncode, ended.stderr),
                             (2, "anticrack: standard output cannot be written: Bad file descriptor\n"), words)
        self.assertEqual(self.shell("$A --local --quiet run case.toml -o q.h5 >&- <&-").returncode, 0)
        self.assertEqual(self.shell("$A show r.h5 2>&-").returncode, 0)
        self.assertEqual(self.shell("$A show missing.h5 >&- 2>&- <&-").returncode, 2)

    def test_a_reader_that_has_enough_is_no_error(self):
        for words in ("--local run case.toml -o head.h5", "--local --json run case.toml -o head.h5", "show r.h5",
                      "--local server", "completion bash", "--help", "--local mesh show case.toml",
                      "--local sweep case.toml --coefficients c.csv -o head.h5 --csv -"):
            ended = self.shell(f"$A {words} | true; echo ${{PIPESTATUS[0]}}")
            self.assertIn(ended.stdout, ("0\n", "141\n"), words)
            self.assertNotIn("cannot be written", ended.stderr, words)
            if "head.h5" in words:
                with h5py.File(self.folder / "head.h5") as file:
                    self.assertIn("mesh", file)
                (self.folder / "head.h5").unlink()

    def test_a_watch_ends_with_its_reader(self):
        (self.folder / "long.toml").write_text(
            CASE + '[solver]\nmethod = "uzawa"\ntheta = 1e-9\nepsilon = 1e-30\nmax_iterations = 1000000\n',
            encoding="utf-8")
        with Daemon(self.folder) as daemon:
            server = f"--server 127.0.0.1:{daemon.port}"
            job = self.run_in_folder(f"{server} --quiet job submit long.toml").stdout.strip()
            ended = self.shell(f"$A {server} job watch {job} | head -1; echo ${{PIPESTATUS[0]}}")
            self.assertRegex(ended.stdout, f"^{job}: .*\n141\n$")
            state = json.loads(self.run_in_folder(f"{server} --json job cancel {job}").stdout)["status"]["state"]
            self.assertNotIn(state, ("STATE_SUCCEEDED", "STATE_NOT_CONVERGED", "STATE_FAILED"), "it had ended before")

    def test_a_full_disk_is_one_line_and_leaves_nothing_cut_off(self):
        before = sorted(path.name for path in self.folder.iterdir())
        for words in ("export r.h5 -o {new}", "plot r.h5 -o {new} --only membrane --format svg",
                      "show r.h5 --csv t.csv", "manual {new}", "plot r.h5 -o {new} --only membrane --format png"):
            ended = self.run_in_folder(words, preexec_fn=no_longer_than(100))
            self.assertEqual(ended.returncode, 2, (words, ended.stderr))
            self.assertRegex(ended.stderr, "^anticrack: .*\n$")
            files = [path for folder in self.folder.glob("new-*") for path in folder.iterdir()]
            self.assertEqual([path for path in files if path.stat().st_size == 100], [], words)
        after = sorted(path.name for path in self.folder.iterdir() if not path.name.startswith("new-"))
        self.assertEqual(after, before)
        self.assertEqual(self.partial(), [])


if __name__ == "__main__":
    unittest.main()

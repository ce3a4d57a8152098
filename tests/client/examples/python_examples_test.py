# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python programs among the examples, against the real server and a file of the real command."""
import json
import os
import pathlib
import re
import sys

from processes import ANTICRACK, Daemon, FolderTest, run

EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])


class ReadResults(FolderTest):
    def setUp(self):
        super().setUp()
        self.result = self.folder / "paper.h5"
        solved = run(ANTICRACK, "--local", "--json", "run", EXAMPLES / "paper.toml", "-o", self.result)
        self.assertEqual(solved.returncode, 0, solved.stderr)
        self.answers = json.loads(run(ANTICRACK, "--json", "show", self.result).stdout)

    def read(self, *arguments):
        ended = run(sys.executable, EXAMPLES / "read_results.py", *arguments)
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        return ended.stdout

    def test_prints_what_the_command_shows(self):
        printed = re.findall(r"^(\S+): converged, energy (\S+), A of gamma_c = (\S+)$", self.read(self.result), re.M)
        shown = [(load["name"], f"{load['energy']:.6g}", f"{load['inclusions'][0]['A']:.6g}")
                 for load in self.answers["answers"]]
        self.assertEqual(printed, shown)
        self.assertEqual(len(printed), 4)

    def test_draws_a_load_case(self):
        picture = self.folder / "example-2.png"
        self.read(self.result, picture, "example-2")
        self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertGreater(picture.stat().st_size, 20_000)


class Sheet(FolderTest):
    def test_is_the_case_of_the_command_to_the_bit(self):
        solved = run(ANTICRACK, "--local", "run", EXAMPLES / "sheet.toml", "-o", self.folder / "theirs.h5")
        self.assertEqual(solved.returncode, 0, solved.stderr)
        path = f"{pathlib.Path(ANTICRACK).parent}:{os.environ['PATH']}"
        ended = run(sys.executable, EXAMPLES / "sheet.py", cwd=self.folder, env=dict(os.environ, PATH=path))
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertLess(len((EXAMPLES / "sheet.py").read_text(encoding="utf-8").splitlines()), 30)
        ours, theirs = (json.loads(run(ANTICRACK, "--json", "show", self.folder / name).stdout)
                        for name in ("sheet.h5", "theirs.h5"))
        self.assertEqual(ours["mesh"]["triangle_count"], theirs["mesh"]["triangle_count"])
        for mine, other in zip(ours["answers"], theirs["answers"], strict=True):
            self.assertEqual((mine["energy"], mine["inclusions"]), (other["energy"], other["inclusions"]))
        self.assertGreater((self.folder / "pressure.png").stat().st_size, 10_000)
        self.assertIn(b">N/mm<", (self.folder / "paraview/up-interfaces.vtu").read_bytes())


class SubmitJob(FolderTest):
    def test_watches_to_the_end_and_prints_the_answers(self):
        with Daemon(self.folder) as daemon:
            ended = run(sys.executable, EXAMPLES / "submit_job.py", f"127.0.0.1:{daemon.port}")
            self.assertEqual(ended.returncode, 0, ended.stderr)
            job = re.match(r"(jobs/\S+) on meshes/", ended.stdout).group(1)
            self.assertRegex(ended.stderr, rf"(?m)^{job}: opening: converged after \d+ steps?$")
            stored = json.loads(run(ANTICRACK, "--json", "--server", f"127.0.0.1:{daemon.port}", "job", "show", job).stdout)
        for answer in stored["status"]["answers"]:
            moved = answer["inclusions"][0]["displacement"]
            self.assertIn(f"{answer['name']}: converged, energy {answer['energy']:.6g}, A of fibre = {moved:.6g}\n",
                          ended.stdout)
        self.assertEqual(len(stored["status"]["answers"]), 2)

# SPDX-License-Identifier: GPL-3.0-or-later
"""The build installed under a prefix of one's own, and programs made and run with nothing but what is there."""
import json
import os
import pathlib
import re
import sys
import tempfile

import processes
from processes import Daemon, FolderTest, run

CMAKE = os.environ["CMAKE"]
CLEAN = {"PATH": "/usr/bin:/bin", "LC_ALL": "C.UTF-8"}


def succeed(*command, **options):
    ended = run(*command, env=CLEAN, **options)
    if ended.returncode != 0:
        raise AssertionError(f"{command} ended with {ended.returncode}:\n{ended.stdout[-4000:]}{ended.stderr[-4000:]}")
    return ended.stdout


def install(prefix, *flags):
    return succeed(CMAKE, "--install", os.environ["BUILD"], "--prefix", prefix, *flags)


class Installed(FolderTest):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="anticrack-test-")
        cls.addClassCleanup(folder.cleanup)
        cls.prefix = pathlib.Path(folder.name) / "prefix"
        install(cls.prefix)
        cls.examples = cls.prefix / "share/anticrack/examples"
        processes.ANTICRACKD = cls.prefix / "bin/anticrackd"  # which finds its helper by itself

    def test_library_is_found_and_solves(self):
        build = self.folder / "build"
        succeed(CMAKE, "-S", self.examples / "library", "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}",
                "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
        succeed(CMAKE, "--build", build)
        with Daemon(self.folder) as daemon:
            said = succeed(build / "solve", f"127.0.0.1:{daemon.port}")
            answer = float(re.search(r"^upward: A = (\S+)$", said, re.M).group(1))
            client = (self.prefix / "bin/anticrack", "--json", "--server", f"127.0.0.1:{daemon.port}", "job")
            listed = json.loads(succeed(*client, "list"))
            stored = json.loads(succeed(*client, "show", listed["jobs"][0]["name"]))["status"]["answers"][0]
        self.assertIn("meshing\n", said)
        self.assertAlmostEqual(answer, stored["inclusions"][0]["displacement"], places=5)
        ended = run(build / "solve", f"unix:{self.folder}/nobody", env=CLEAN)
        self.assertEqual(ended.returncode, 1)
        self.assertIn("nobody", ended.stderr)

    def test_library_is_of_this_version_only(self):
        (self.folder / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(other LANGUAGES CXX)\nfind_package(anticrack 0.2 REQUIRED)\n",
            encoding="utf-8")
        ended = run(CMAKE, "-S", self.folder, "-B", self.folder / "build", f"-DCMAKE_PREFIX_PATH={self.prefix}", env=CLEAN)
        self.assertNotEqual(ended.returncode, 0)
        self.assertIn('compatible with requested version "0.2"', ended.stderr)

    def test_command_solves_with_a_server_of_its_own(self):
        result = self.folder / "paper.h5"
        succeed(self.prefix / "bin/anticrack", "--local", "run", self.examples / "paper-3.toml", "-o", result)
        self.assertGreater(result.stat().st_size, 10_000)

    def test_python_example_finds_the_package(self):
        (packages,) = self.prefix.glob("lib/python3.*/dist-packages")
        with Daemon(self.folder) as daemon:
            said = succeed("env", f"PYTHONPATH={packages}", sys.executable, self.examples / "submit_job.py",
                           f"127.0.0.1:{daemon.port}")
        self.assertIn("opening: converged", said)

    def test_manual_of_the_server_names_every_key(self):
        check_config = succeed(processes.ANTICRACKD, "--data-dir", self.folder, "--check-config")
        keys = [line.split(" = ")[0] for line in check_config.splitlines()]
        self.assertGreater(len(keys), 30)
        for page, written in [("man8/anticrackd.8.gz", "--{} "), ("man5/anticrackd.toml.5.gz", "{} = ")]:
            ended = run("man", "--warnings", "-l", self.prefix / "share/man" / page,
                        env=dict(CLEAN, MANWIDTH="200", MANROFFOPT="-c"))
            self.assertEqual((ended.returncode, ended.stderr), (0, ""))
            for key in keys:
                self.assertIn(written.format(key), re.sub(r"\n", " \n", ended.stdout), page)

    def test_unit_names_the_places_of_the_prefix(self):
        unit = (self.prefix / "lib/systemd/system/anticrackd.service").read_text(encoding="utf-8")
        command = re.search(r"^ExecStart=(.*)", unit, re.M).group(1)
        self.assertTrue(command.startswith(f"{self.prefix}/bin/anticrackd --config {self.prefix}/etc/anticrack/anticrackd.toml "),
                        command)
        command = command.replace("${STATE_DIRECTORY}", str(self.folder)).split()
        succeed(*command, "--check-config")

    def test_configuration_is_kept_when_installed_again(self):
        mine = self.folder / "etc/anticrack/anticrackd.toml"
        install(self.folder, "--component", "server")
        mine.write_text("threads = 1\n", encoding="utf-8")
        self.assertIn(f"Kept as it is: {mine}", install(self.folder, "--component", "server"))
        self.assertEqual(mine.read_text(encoding="utf-8"), "threads = 1\n")

# SPDX-License-Identifier: GPL-3.0-or-later
"""Backups of a server at work, their restoration, and the recipe for upgrade and rollback in deploy/README.md."""
import json
import os
import re
import sqlite3
import subprocess
import threading

from places import DEPLOY, EXAMPLES
from processes import ANTICRACK, ANTICRACKD, Daemon, FolderTest, run

COARSE = ["--set", "mesh.preset=uniform", "--set", "mesh.size=0.05"]  # results above what the database keeps itself


class BackupTest(FolderTest):
    def client(self, daemon, *words):
        ended = run(ANTICRACK, "--server", f"127.0.0.1:{daemon.port}", *words)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        return ended.stdout

    def solve(self, daemon, output, *overrides):
        self.client(daemon, "run", EXAMPLES / "slit.toml", *COARSE, *overrides, "-o", output)

    def jobs(self, daemon):
        return {job["name"]: job for job in json.loads(self.client(daemon, "--json", "job", "list"))["jobs"]}

    def back_up(self, to, data=None):
        return run(ANTICRACKD, "--data-dir", data or self.folder / "data", "--backup", to)

    def assert_sound(self, data):
        ended = run(ANTICRACKD, "--data-dir", data, "--check-store")
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        return ended.stdout


class Backup(BackupTest):
    def test_is_whole_while_results_come_and_go(self):
        restored = self.folder / "restored"
        restored.mkdir()
        with Daemon(self.folder, "--kept-jobs", "3") as daemon:
            self.solve(daemon, self.folder / "first.h5")
            stop, failures = threading.Event(), []

            def load(number):
                turn = 0
                while not stop.is_set():
                    turn += 1
                    try:
                        self.solve(daemon, self.folder / f"load-{number}.h5", "--set", f"load.half.f={number}+{turn}/100")
                    except AssertionError as error:
                        failures.append(error)
                        return

            threads = [threading.Thread(target=load, args=[number]) for number in (1, 2)]
            for thread in threads:
                thread.start()
            try:
                for number in range(6):
                    ended = self.back_up(self.folder / f"backup-{number}")
                    self.assertEqual(ended.returncode, 0, ended.stderr)
                before = set(self.jobs(daemon))
                self.assertEqual(self.back_up(restored / "data").returncode, 0)
            finally:
                stop.set()
                for thread in threads:
                    thread.join()
            self.assertEqual(failures, [])
            self.assertGreater(len(before), 1)
        for number in range(6):
            self.assertNotIn(" 0 files", self.assert_sound(self.folder / f"backup-{number}"))
        self.assert_sound(restored / "data")
        with Daemon(restored) as daemon:  # keeps all: a job that ends does not take the place of one that is listed
            jobs = self.jobs(daemon)
            self.assertTrue(jobs)
            for name in jobs:
                self.client(daemon, "job", "watch", name)  # what had not ended runs again
                self.client(daemon, "job", "fetch", name, "-o", self.folder / "fetched.h5")
            self.solve(daemon, self.folder / "more.h5")
        self.assert_sound(restored / "data")
        self.assert_sound(self.folder / "data")

    def test_refuses_what_it_cannot_do_and_leaves_nothing(self):
        with Daemon(self.folder) as daemon:
            self.solve(daemon, self.folder / "first.h5")
        ended = self.back_up(self.folder / "data")
        self.assertEqual(ended.returncode, 1)
        self.assertIn("exists already", ended.stderr)
        ended = self.back_up(self.folder / "made", data=self.folder / "none")
        self.assertEqual(ended.returncode, 1)
        self.assertIn("has no database", ended.stderr)
        self.assertFalse((self.folder / "none").exists())
        for result in (self.folder / "data/results").iterdir():
            result.unlink()
        ended = self.back_up(self.folder / "made")
        self.assertEqual(ended.returncode, 1)
        self.assertRegex(ended.stderr, r"results/[0-9a-f]{64} is missing")
        self.assertEqual([path.name for path in self.folder.glob("made*")], [])

    def test_on_another_file_system_is_a_copy(self):
        other = "/dev/shm"
        if not os.path.isdir(other) or os.stat(other).st_dev == os.stat(self.folder).st_dev:
            self.skipTest("there is no other file system here")
        with Daemon(self.folder) as daemon:
            self.solve(daemon, self.folder / "first.h5")
            to = f"{other}/{self.folder.name}"
            self.addCleanup(subprocess.run, ["rm", "-rf", to], check=True)
            ended = self.back_up(to)
            self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assert_sound(to)


class Recipe(BackupTest):
    """The commands of deploy/README.md, run as they stand there but for the places; systemctl and apt are of the test."""

    def commands(self, name):
        text = (DEPLOY / "README.md").read_text(encoding="utf-8")
        recipes = re.findall(r"(?:^    .*\n)+", text[text.index("## Upgrade and rollback"):], re.M)
        places = {"/var/lib/private/anticrack": self.folder / "data", "/var/backups": self.folder / "backups",
                  "/etc/anticrack/anticrackd.toml": DEPLOY / "anticrackd.toml"}
        commands = recipes[["upgrade", "rollback"].index(name)]
        for place, here in places.items():
            self.assertTrue(name == "rollback" or place in commands)
            commands = commands.replace(place, str(here))
        return [line.strip().removeprefix("sudo ") for line in commands.splitlines()]

    def run_recipe(self, name):
        for command in self.commands(name):
            words = command.split()
            if words[0] == "systemctl":
                if self.daemon:
                    self.daemon.__exit__()
                    self.daemon = None
                if words[1] != "stop":
                    self.daemon = Daemon(self.folder)
            elif words[0] == "apt":
                self.assertEqual(words[1], "install")
            else:
                words = [ANTICRACKD if word == "anticrackd" else word for word in words]
                ended = run(*words)
                self.assertEqual(ended.returncode, 0, command + "\n" + ended.stderr)

    def test_brings_back_what_was_there_before_the_upgrade(self):
        (self.folder / "backups").mkdir()
        self.daemon = Daemon(self.folder)
        self.addCleanup(lambda: self.daemon and self.daemon.__exit__())
        self.solve(self.daemon, self.folder / "before.h5")
        before = self.jobs(self.daemon)
        self.run_recipe("upgrade")
        self.assertEqual(self.jobs(self.daemon), before)
        self.solve(self.daemon, self.folder / "after.h5")
        self.daemon.__exit__()
        self.daemon = None
        with sqlite3.connect(self.folder / "data/anticrack.db") as database:  # what a newer version may do
            version = database.execute("PRAGMA user_version").fetchone()[0]
            database.execute(f"PRAGMA user_version = {version + 1}")
        with self.assertRaisesRegex(RuntimeError, "start the newer anticrack"):
            Daemon(self.folder)
        self.run_recipe("rollback")
        self.assertEqual(self.jobs(self.daemon), before)
        name = next(iter(before))
        self.client(self.daemon, "job", "fetch", name, "-o", self.folder / "fetched.h5")
        self.assertTrue((self.folder / "data-after/anticrack.db").exists())

# SPDX-License-Identifier: GPL-3.0-or-later
"""Servers on one PostgreSQL without haproxy: names and clocks that are wrong, and a database that is backed up."""
import glob
import os
import re
import shutil
import unittest.mock

import anticrack

from group import PROGRAMS, Database, Member, eventually
from places import DEPLOY, EXAMPLES
from processes import ANTICRACK, ANTICRACKD, Daemon, FolderTest, run

FAKETIME = next(iter(glob.glob("/usr/lib/*/faketime/libfaketimeMT.so.1")), "")
LEASE = 6  # seconds, server/group/leases.hpp


class MembersTest(FolderTest):
    attempts = 1

    def setUp(self):
        super().setUp()
        self.database = Database(self.folder)
        self.addCleanup(self.database.stop)
        self.url = self.database.fresh("crack")

    def add(self, name, environment=None):
        with unittest.mock.patch.dict(os.environ, environment or {}):
            member = Member(self.folder / name, self.url, "--threads", "1", "--drain-time", "0")
        self.addCleanup(member.__exit__)
        return member

    def client(self, member, *words):
        for _ in range(self.attempts):
            ended = run(ANTICRACK, "--server", f"127.0.0.1:{member.port}", *words)
            if ended.returncode == 0:
                return ended.stdout
        self.fail(ended.stdout + ended.stderr)

    def submit(self, member, iterations):
        settings = ("method=uzawa", "theta=1e-4", "epsilon=1e-300", f"max_iterations={iterations}")
        words = [word for setting in settings for word in ("--set", f"solver.{setting}")]
        return re.search(r"jobs/\w+", self.client(member, "job", "submit", EXAMPLES / "paper-3.toml", *words)).group(0)

    def job(self, member, name):
        for left in reversed(range(self.attempts)):
            try:
                with anticrack.connect(f"127.0.0.1:{member.port}") as client:
                    return client.job(name)
            except anticrack.ServerError:
                if left == 0:
                    raise

    def runs(self, member, name, attempt=1):
        job = self.job(member, name)
        return job.state == "running" and job.message.status.attempt == attempt

    def ended(self, member, name):
        return eventually(lambda: (job := self.job(member, name)).ended and job)

    def sql(self, text):
        return self.database.sql(text, "crack")


class Members(MembersTest):
    def test_of_one_name_by_a_copied_folder_do_no_harm(self):
        first = self.add("a")
        name = self.submit(first, 1_000_000)
        eventually(lambda: self.runs(first, name))
        (self.folder / "b/data").mkdir(parents=True)
        shutil.copy(self.folder / "a/data/server", self.folder / "b/data/server")
        second = self.add("b")  # as if the first had died and this were its next start
        job = self.ended(second, name)
        self.assertEqual(job.state, "not_converged")
        self.assertEqual(job.message.status.attempt, 2, "the first lost it once")
        self.assertEqual(job.message.status.answers[0].iterations, 1_000_000)
        for member in (first, second):  # both are in the group, and stay there
            eventually(lambda one=member: one.metric("anticrack_group_servers") == 2)
            self.ended(member, self.submit(member, 10))
        self.assertEqual(self.sql("SELECT count(DISTINCT name), max(epoch) FROM anticrack.servers"), "1|3")
        self.assertEqual([one.metric("anticrack_group_leases_lost_total") for one in (first, second)], [1, 0])
        eventually(lambda: "warning lease lost" in first.log())
        self.assertNotIn("lease lost", second.log())

    def test_tell_how_the_group_is(self):
        members = [self.add(name) for name in "ab"]
        name = self.submit(members[0], 500_000)
        eventually(lambda: self.runs(members[0], name))
        for member in members:
            ended = run("promtool", "check", "metrics", input=member.page()[1])
            self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
            self.assertIn('anticrack_group_jobs{state="running"} 1\n', member.page()[1])
            self.assertIn('anticrack_group_servers{state="living"} 2\n', member.page()[1])
            self.assertEqual(member.page("/ready"), (200, "ready\n"))
        self.database.stop()
        for member in members:
            eventually(lambda one=member: one.page("/ready")[0] == 503)
            self.assertGreater(member.metric("anticrack_store_unreachable_seconds"), 5)
        self.database.start()
        for member in members:
            eventually(lambda one=member: one.page("/ready")[0] == 200)
        self.ended(members[1], name)

    def test_whose_clocks_differ_by_a_minute_keep_their_leases(self):
        self.assertTrue(FAKETIME)
        self.attempts = 3  # a gRPC server under libfaketime refuses a connection now and then
        clocks = {"a": 0, "b": 60, "c": -60}
        fake = {name: {"LD_PRELOAD": FAKETIME, "FAKETIME": f"{offset:+d}s", "DONT_FAKE_MONOTONIC": "1"}
                for name, offset in clocks.items() if offset}
        members = {name: self.add(name, fake.get(name)) for name in clocks}
        for name, member in members.items():
            self.assertAlmostEqual(member.metric("anticrack_store_clock_offset_seconds"), -clocks[name], delta=5)
        begun = int(self.sql("SELECT min(beats) FROM anticrack.servers"))
        jobs = [self.submit(member, 5_000) for member in members.values()]
        for member, name in zip(members.values(), jobs):
            self.assertEqual(self.ended(member, name).message.status.attempt, 1)
        eventually(lambda: int(self.sql("SELECT min(beats) FROM anticrack.servers")) > begun + LEASE + 3)
        self.assertEqual(self.sql("SELECT count(*) FILTER (WHERE NOT dead), max(epoch) FROM anticrack.servers"), "3|3")
        name = self.submit(members["a"], 400_000)
        runner = eventually(lambda: self.sql("SELECT name FROM anticrack.servers JOIN anticrack.queue ON epoch = runner"
                                             f" WHERE job = '{name.removeprefix('jobs/')}'"))
        victim = next(one for one in members if (self.folder / one / "data/server").read_text("utf-8") == runner)
        eventually(lambda: self.runs(members[victim], name))
        members.pop(victim).kill()
        job = self.ended(next(iter(members.values())), name)
        self.assertEqual((job.message.status.attempt, job.message.status.answers[0].iterations), (2, 400_000))


class Backup(MembersTest):
    """The commands of deploy/README.md."""

    def recipe(self):
        text = (DEPLOY / "README.md").read_text(encoding="utf-8")
        section = text[text.index("## A group's backup"):]
        commands = re.search(r"(?:^    .*\n)+", section, re.M).group(0).splitlines()
        return [line.strip().split("  #")[0] for line in commands]

    def test_of_a_group_at_work_is_restored_with_every_job(self):
        one = self.add("a")
        self.client(one, "run", EXAMPLES / "slit.toml", "-o", self.folder / "before.h5")
        waiting = self.submit(one, 10_000)
        environment = {**os.environ, "PATH": f"{os.path.dirname(ANTICRACKD)}:{PROGRAMS}:{os.environ['PATH']}"}
        for command in self.recipe():
            for place, here in {"postgresql://anticrack@db/anticrack": self.url, "postgresql://anticrack@db/restored":
                                self.database.url("restored"), "-h db": f"-h {self.database.folder} -U test",
                                "/var/backups": self.folder}.items():
                command = command.replace(place, str(here))
            ended = run("bash", "-c", command.replace(self.url, f"'{self.url}'").replace(
                self.database.url("restored"), f"'{self.database.url('restored')}'"), env=environment)
            self.assertEqual(ended.returncode, 0, command + ended.stdout + ended.stderr)
        self.assertIn(" 0 flaws", ended.stdout)
        self.url = self.database.url("restored")
        other = self.add("b")
        self.assertEqual(self.ended(other, waiting).message.status.answers[0].iterations, 10_000)
        with anticrack.connect(f"127.0.0.1:{other.port}") as client:
            self.assertEqual(len(client.jobs()), 2)
            client.jobs()[1].result()


class CopyStore(MembersTest):
    def test_goes_on_with_the_jobs_of_the_folder(self):
        with Daemon(self.folder, "--drain-time", "0") as alone:
            self.client(alone, "run", EXAMPLES / "slit.toml", "-o", self.folder / "before.h5")
            running = self.submit(alone, 500_000)
            eventually(lambda: self.runs(alone, running))
            ended = self.copy()
            self.assertEqual(ended.returncode, 2)
            self.assertIn("another anticrackd uses it", ended.stderr)
        ended = self.copy("--dry-run")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertIn("would be copied", ended.stdout)
        self.assertEqual(self.copy().returncode, 0)
        ended = self.copy()
        self.assertEqual(ended.returncode, 1)
        self.assertIn("give an empty one", ended.stderr)
        member = self.add("a")
        self.assertEqual(self.ended(member, running).message.status.answers[0].iterations, 500_000)
        self.client(member, "job", "list")
        ended = run(ANTICRACKD, "--data-dir", self.folder / "data", "--store", self.url)
        self.assertEqual(ended.returncode, 1)
        self.assertIn("is a store of its own", ended.stderr)

    def copy(self, *words):
        return run(ANTICRACKD, "--data-dir", self.folder / "data", "--store", self.url, "--copy-store", *words)

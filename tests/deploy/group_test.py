# SPDX-License-Identifier: GPL-3.0-or-later
"""Three servers on one PostgreSQL behind haproxy with deploy/haproxy.cfg, all of them real; clients are behind it."""
import os
import re
import subprocess

import anticrack

from group import Balancer, Database, Member, eventually
from places import DEPLOY, EXAMPLES
from processes import ANTICRACK, FolderTest, run

CALL = re.compile(r"^\S+ (?P<server>\S+) \d+ .*/anticrack\.v1\.\w+/(?P<method>\w+) mesh=(?P<mesh>\S+)$", re.M)


class GroupTest(FolderTest):
    """Servers a, b, c of one owner, whose token all clients have."""

    def setUp(self):
        super().setUp()
        self.database = Database(self.folder)
        self.addCleanup(self.database.stop)
        self.url = self.database.fresh("crack")
        made = self.folder / "certificates"
        self.assertEqual(run(DEPLOY / "make-certificates", made).returncode, 0)
        token = run(DEPLOY / "make-certificates", "token", "ann", "user").stdout
        (self.folder / "token").write_text(re.search(r": (\w{64})\n", token).group(1), encoding="utf-8")
        os.chmod(self.folder / "token", 0o600)
        (self.folder / "tokens").write_text(re.search(r"file: (.*)", token).group(1) + "\n", encoding="utf-8")
        self.pem = self.folder / "anticrack.pem"
        self.pem.write_text((made / "server.crt").read_text() + (made / "server.key").read_text(), encoding="utf-8")
        self.made, self.members = made, {}
        self.addCleanup(self.stop)

    def stop(self):
        for member in self.members.values():
            member.terminate()
            member.terminate()  # at once
        for member in self.members.values():
            member.__exit__()

    def add(self, name, **ports):
        """Starts a server, stopped at the end of the test."""
        member = Member(self.folder / name, self.url, "--tls-certificate", self.made / "server.crt", "--tls-key",
                        self.made / "server.key", "--tokens", self.folder / "tokens", "--threads", "1",
                        "--drain-delay", "3s", "--drain-time", "1m", "--memory-budget", "256MiB", **ports)
        self.members[name] = member
        return member

    def balance(self, names="abc"):
        """haproxy before these servers, which are started; it has found all ready."""
        members = [self.add(name) for name in names]
        ports = [(one.port, int(re.search(r":(\d+)/", one.metrics_url()).group(1))) for one in members]
        places = {"/etc/haproxy/anticrack.pem": self.pem, "/etc/haproxy/anticrack-ca.crt": self.made / "ca.crt"}
        self.balancer = Balancer(self.folder, (DEPLOY / "haproxy.cfg").read_text(encoding="utf-8"), places, ports)
        self.addCleanup(self.balancer.stop)
        self.server = dict(zip(names, self.balancer.names))  # haproxy's names of them
        return members

    def words(self, *words):
        return [str(word) for word in [ANTICRACK, "--server", f"localhost:{self.balancer.port}", "--ca",
                                       self.made / "ca.crt", "--token-file", self.folder / "token", *words]]

    def client(self, *words):
        ended = run(*self.words(*words))
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        return ended.stdout

    def connect(self):
        return anticrack.connect(f"localhost:{self.balancer.port}", ca=self.made / "ca.crt",
                                 token_file=self.folder / "token")

    def calls(self, begin=0):
        return [match.groupdict() for match in CALL.finditer(self.balancer.log()[begin:])]

    def up(self, name):
        """Whether haproxy sends this server calls: it says each change."""
        said = re.findall(rf"Server servers/{self.server[name]} is (UP|DOWN)", self.balancer.log())
        return not said or said[-1] == "UP"


class Mesh(GroupTest):
    """x-mesh-id, as haproxy sees it."""

    NO_MESH = {"ReadCase", "CreateMesh", "CreateUploads", "GetServerInfo"}

    def check(self, used, work):
        """Returns the mesh. haproxy writes a call's line after its end, so those of one before may come late."""
        said = len(self.balancer.log())
        work()
        eventually(lambda: used <= {call["method"] for call in self.calls(said)})
        calls = self.calls(said)
        meshes = {call["mesh"] for call in calls if call["method"] not in self.NO_MESH}
        self.assertEqual(len(meshes), 1, calls)
        mesh = meshes.pop()
        self.assertRegex(mesh, r"^[0-9a-f]{16}$")
        self.assertLessEqual({call["mesh"] for call in calls if call["method"] in self.NO_MESH}, {"-"})
        self.assertEqual(len({call["server"] for call in calls if call["mesh"] != "-"}), 1, "one mesh, one server")
        return mesh

    def test_is_on_every_call_that_concerns_one(self):
        self.balance()
        whole_run = {"CreateJob", "WatchJob", "ReadResult", "GetMesh", "ReadMesh"}
        mesh = self.check(whole_run, lambda: self.client("run", EXAMPLES / "slit.toml", "-o", self.folder / "a.h5"))
        self.check({"GetMesh"}, lambda: self.client("mesh", "show", f"meshes/{mesh}"))
        with self.connect() as client:
            self.check(whole_run | {"GetJob"}, lambda: client.run(EXAMPLES / "slit.toml", progress=False))

            def with_job():
                again = client.submit(EXAMPLES / "slit.toml")
                again.refresh().wait(progress=False)
                again.result()
                again.cancel()
                again.delete()
            self.check({"CreateJob", "GetJob", "WatchJob", "CancelJob", "DeleteJob", "ReadResult"}, with_job)

    def test_is_no_way_to_end_a_client(self):
        self.balance("abc")
        for name in ("meshes/\u00fc", "meshes/a\nb", "meshes/" + "a" * 99, "meshes/", "meshes/a/b"):
            ended = run(*self.words("mesh", "show", name))
            self.assertGreater(ended.returncode, 0)
            self.assertNotIn(ended.returncode, range(128, 160), ended.stderr)
            with self.connect() as client, self.assertRaises(anticrack.ServerError) as raised:
                client.mesh_arrays(name)
            self.assertEqual(raised.exception.code, "INVALID_ARGUMENT")
        self.assertEqual({call["mesh"] for call in self.calls()}, {"-"})


class Failover(GroupTest):
    """A long run at a client that knows haproxy only."""

    ITERATIONS = 200_000

    def start_run(self, name):
        """Returns the client, the job once it iterates, and the server that its watch is at."""
        said = len(self.balancer.log())
        settings = [f"solver.{setting}" for setting in ("method=uzawa", "theta=1e-4", "epsilon=1e-300",
                                                        f"max_iterations={self.ITERATIONS}")]
        words = self.words("run", EXAMPLES / "paper-3.toml", "-o", self.folder / f"{name}.h5",
                           *(word for setting in settings for word in ("--set", setting)))
        with open(self.folder / name, "w", encoding="utf-8") as out:
            client = subprocess.Popen(words, stdout=out, stderr=out)
        self.addCleanup(client.kill)
        eventually(lambda: client.poll() is not None or "iteration" in self.told(name))
        self.assertIsNone(client.poll(), self.told(name))
        created = next(call for call in self.calls(said) if call["method"] == "CreateJob")
        return client, next(own for own, its in self.server.items() if its == created["server"])

    def told(self, name):
        return (self.folder / name).read_text(encoding="utf-8")

    def assert_ran(self, client, name):
        self.assertEqual(client.wait(180), 3, self.told(name))  # did not converge, as it was told to go on
        with self.connect() as one:
            job = one.jobs(1)[0].refresh()
            self.assertEqual(job.message.status.answers[0].iterations, self.ITERATIONS)
            return job

    def test_nothing_is_lost_when_servers_die_stop_and_come(self):
        self.balance()
        client, victim = self.start_run("killed")
        ports = dict(port=self.members[victim].port, metrics_port=self.balancer.names[self.server[victim]][1])
        self.members[victim].kill()
        self.members[victim].__exit__()
        eventually(lambda: not self.up(victim))
        eventually(lambda: "trying again" in self.told("killed"))
        self.assert_ran(client, "killed")

        said = len(self.balancer.log())
        self.add(victim, **ports)
        eventually(lambda: self.up(victim))
        client, stopped = self.start_run("drained")
        self.members[stopped].terminate()
        eventually(lambda: not self.up(stopped))
        said = len(self.balancer.log())
        self.client("job", "list")
        with self.connect() as one:
            for _ in range(6):
                one.info()
        eventually(lambda: len(self.calls(said)) == 7)
        self.assertNotIn(self.server[stopped], {call["server"] for call in self.calls(said)})
        job = self.assert_ran(client, "drained")
        self.assertNotIn("trying again", self.told("drained"), "the watch ended at the server that stops")
        self.assertEqual(job.message.status.attempt, 1)
        self.assertEqual(self.members[stopped].wait(), 0)
        self.assertEqual(self.database.sql("SELECT count(*) FROM anticrack.queue", "crack"), "0")

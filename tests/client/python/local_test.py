# SPDX-License-Identifier: GPL-3.0-or-later
"""anticrack.local(): its server lives as long as somebody has the client, and not longer, however the program ends."""
import asyncio
import gc
import io
import multiprocessing
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time
import unittest
import unittest.mock

import anticrack
from anticrack import Case, Geometry, Inclusion, Interface, Load, Mesh, Uzawa, aio
from processes import ANTICRACKD, FolderTest

GEOMETRY = Geometry([(-1, -1), (1, -1), (1, 1), (-1, 1)], [Interface([(-1, 0), (1, 0)])],
                    [Inclusion("fibre", (-0.5, 0), (0.5, 0))])
CASE = Case(GEOMETRY, [Load("opening", "y > 0 ? 1 : -1")], Mesh(size=0.2))
LONG = Case(GEOMETRY, [Load("opening", "y > 0 ? 1 : -1")],
            solver=Uzawa(theta=1e-9, epsilon=1e-30, max_iterations=1_000_000))
PROGRAM = f"""
import os, signal, sys, threading, time
import anticrack
sys.path.insert(0, {os.path.dirname(__file__)!r})
from local_test import ANTICRACKD, CASE, LONG, server_of
client = anticrack.local(program=ANTICRACKD)
print(server_of(client), flush=True)
"""


def server_of(client):
    return client._session.transport.server_process._process.pid  # pylint: disable=protected-access


def alive(process):
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def eventually(condition, what):
    limit = time.monotonic() + 120
    while not condition():
        if time.monotonic() > limit:
            raise AssertionError(what)
        time.sleep(0.02)


def solve_alone(_):
    with anticrack.local(program=ANTICRACKD) as client:
        return client.run(CASE, progress=False)["opening"].energy


class Local(FolderTest):
    def setUp(self):
        super().setUp()
        self.temporary = self.folder / "temporary"
        self.temporary.mkdir()
        patch = unittest.mock.patch.dict(os.environ, TMPDIR=str(self.temporary))
        patch.start()
        self.addCleanup(patch.stop)

    def left(self):
        return [path.name for path in self.temporary.iterdir()]

    def start(self, rest):
        """A program that has a client, and its server."""
        program = subprocess.Popen([sys.executable, "-Wignore", "-c", PROGRAM + rest], text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(program.communicate)
        self.addCleanup(program.kill)
        line = program.stdout.readline()
        if not line:
            self.fail(program.stderr.read())
        return program, int(line)

    def test_without_a_context(self):
        client = anticrack.local(program=ANTICRACKD)
        server = server_of(client)
        self.assertTrue(client.run(CASE, progress=False).converged)
        self.assertEqual(len(self.left()), 1)
        client.close()
        client.close()
        self.assertFalse(alive(server))
        self.assertEqual(self.left(), [])
        with self.assertRaisesRegex(anticrack.Error, "this client is closed"):
            client.info()

    def test_that_nobody_has_any_more(self):
        client = anticrack.local(program=ANTICRACKD)
        server = server_of(client)
        job = client.submit(CASE)
        del client
        gc.collect()
        self.assertTrue(job.wait(progress=False).result().converged)
        del job
        gc.collect()
        self.assertFalse(alive(server))
        self.assertEqual(anticrack.local(program=ANTICRACKD).submit(CASE).result().job.partition("/")[0], "jobs")
        gc.collect()
        self.assertEqual(self.left(), [])

    def test_of_a_thread_that_has_ended(self):
        made = []
        thread = threading.Thread(target=lambda: made.append(anticrack.local(program=ANTICRACKD)))
        thread.start()
        thread.join()
        time.sleep(0.1)
        with made[0] as client:
            self.assertTrue(client.run(CASE, progress=False).converged)

    def test_that_dies_is_an_error_at_once(self):
        for number, said in ((signal.SIGKILL, r"died of signal 9 \(Killed\), perhaps because memory"),
                             (signal.SIGABRT, r"died of signal 6"), (signal.SIGTERM, "ended with exit code 0")):
            with anticrack.local(program=ANTICRACKD) as client:
                job = client.submit(LONG)
                with self.assertRaisesRegex(anticrack.LocalServerError, "^the private server " + said):
                    for i, _ in enumerate(message for message in job.events() if message.HasField("samples")):
                        if i == 0:
                            os.kill(server_of(client), number)
                with self.assertRaises(anticrack.LocalServerError):
                    client.info()
            self.assertEqual(self.left(), [])

    def test_with_asyncio(self):
        async def main():
            client = aio.local(program=ANTICRACKD)
            server = server_of(client)
            self.assertTrue((await client.run(CASE)).converged)
            await client.close()
            self.assertFalse(alive(server))
            async with aio.local(program=ANTICRACKD) as other:
                os.kill(server_of(other), signal.SIGKILL)
                with self.assertRaises(anticrack.LocalServerError):
                    await other.info()
        asyncio.run(main())
        self.assertEqual(self.left(), [])

    def test_ends_with_a_program(self):
        for rest in ("", "sys.exit(3)", "raise RuntimeError", "os._exit(0)", "del client",
                     "job = client.submit(LONG)", "import atexit; atexit.register(client.close)",
                     "threading.Thread(target=lambda: client.run(CASE, progress=False)).start()"):
            program, server = self.start(rest)
            program.communicate()
            eventually(lambda server=server: not alive(server), rest)
            eventually(lambda: self.left() == [], rest)

    def test_ends_with_a_program_that_is_killed(self):
        for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGKILL, signal.SIGINT, signal.SIGSEGV):
            program, server = self.start("for _ in client.submit(LONG).events(): print('event', flush=True)")
            program.stdout.readline()
            self.assertTrue(alive(server))
            program.send_signal(number)
            program.communicate()
            eventually(lambda server=server: not alive(server), number)
            eventually(lambda: self.left() == [], number)

    def test_a_forked_child_neither_ends_nor_uses_it(self):
        with anticrack.local(program=ANTICRACKD) as client:
            client.info()
            for end in (sys.exit, os._exit):  # pylint: disable=protected-access
                program, server = self.start("\n".join([
                    "client.info()", "child = os.fork()", "if child == 0:", "    try: client.info()",
                    "    except anticrack.Error as error: print(error, flush=True)",
                    f"    client.close(); {end.__module__.replace('posix', 'os')}.{end.__name__}(0)",
                    "os.waitpid(child, 0)", "print(client.run(CASE, progress=False).converged, flush=True)"]))
                output, error = program.communicate()
                self.assertEqual(error, "")
                self.assertRegex(output, "^this client belongs to the process that this one was forked from; .*\n"
                                         "True\n$")
                self.assertFalse(alive(server))

    def test_does_not_live_on_with_a_forked_child(self):
        program, server = self.start("child = os.fork()\nif child == 0: time.sleep(600)\n"
                                     "print(child, flush=True)\ntime.sleep(600)")
        child = int(program.stdout.readline())
        self.addCleanup(os.kill, child, signal.SIGKILL)
        program.kill()
        eventually(lambda: not alive(server), "the server goes on")
        self.assertTrue(alive(child))

    def test_each_process_of_a_pool_has_its_own(self):
        with anticrack.local(program=ANTICRACKD) as client:
            energy = client.run(CASE, progress=False)["opening"].energy
            with multiprocessing.get_context("spawn").Pool(2) as pool:
                self.assertEqual(pool.map(solve_alone, range(3)), [energy] * 3)
            self.assertEqual(client.run(CASE, progress=False)["opening"].energy, energy)

    def test_near_servers_use_no_proxy(self):
        names = ("grpc_proxy", "https_proxy", "http_proxy")
        with unittest.mock.patch.dict(os.environ, {name: "http://127.0.0.1:9" for name in names}):
            with anticrack.local("--listen", "127.0.0.1:0", program=ANTICRACKD) as client:
                self.assertRegex(repr(client), "127.0.0.1:[1-9]")
                client.info()
            with self.assertRaisesRegex(anticrack.ServerError, "grpc_proxy sends what goes there through the proxy "
                                                               "127.0.0.1:9: .*no_proxy"):
                anticrack.connect("far.example:7433", first_contact=0).info()

    def test_progress_that_nobody_reads_costs_no_job(self):
        with anticrack.local(program=ANTICRACKD) as client:
            with open("/dev/full", "wb", buffering=0) as raw:
                full = io.TextIOWrapper(raw, write_through=True)
                self.assertTrue(client.submit(CASE).wait(out=full).result().converged)
            self.assertTrue(client.submit(CASE).wait(out=full).result().converged, "closed")
            with unittest.mock.patch.object(sys, "stderr", None):
                self.assertTrue(client.run(CASE).converged)


if __name__ == "__main__":
    unittest.main()

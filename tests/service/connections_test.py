# SPDX-License-Identifier: GPL-3.0-or-later
"""A server that many connections are thrown at lets new clients in again.

By hand with more of them: CONNECTIONS=100000 in the environment.
"""
import contextlib
import os
import pathlib
import re
import resource
import selectors
import socket
import struct
import subprocess
import time
import unittest
import urllib.request

from processes import ANTICRACK, ANTICRACKD, FolderTest, run

CONNECTIONS = int(os.environ.get("CONNECTIONS", "4000"))
PREFACE = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"


def limited(soft, hard):
    """Of open files, in the child."""
    return lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


class Server:
    """anticrackd with these limits of open files."""

    def __init__(self, folder, *flags, listen="127.0.0.1:0", soft=1024, hard=1024):
        self._error = open(folder / "daemon.log", "w+", encoding="utf-8")
        command = [ANTICRACKD, "--listen", listen, "--data-dir", folder / "data", "--metrics-listen", "127.0.0.1:0",
                   *flags]
        self._process = subprocess.Popen([str(word) for word in command], text=True, stdout=subprocess.PIPE,
                                         stderr=self._error, preexec_fn=limited(soft, hard))
        self.address = self._process.stdout.readline().rsplit(" ", 1)[1].strip()

    def log(self):
        return pathlib.Path(self._error.name).read_text(encoding="utf-8")

    def metric(self, name):
        while not (url := re.search(r"url=(http://\S+)", self.log())):
            time.sleep(0.01)
        with urllib.request.urlopen(url.group(1), timeout=60) as answer:
            page = answer.read().decode()
        return float(re.search(rf"^{name} (\S+)$", page, re.MULTILINE).group(1))

    def connect(self):
        if self.address.startswith("unix:"):
            made = socket.socket(socket.AF_UNIX)  # which waits for room in the queue
            made.connect(self.address[len("unix:"):])
            return made
        host, port = self.address.rsplit(":", 1)
        return socket.create_connection((host.strip("[]").replace("0.0.0.0", "127.0.0.1"), int(port)), timeout=60)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.terminate()
        self.ended = self._process.wait()
        self._process.stdout.close()
        self._error.close()


def closed_by_peer(connections, seconds):
    """How many of them the server closes within that time."""
    waiting = selectors.DefaultSelector()
    for connection in connections:
        waiting.register(connection, selectors.EVENT_READ)
    closed = 0
    end = time.monotonic() + seconds
    while waiting.get_map() and time.monotonic() < end:
        for key, _ in waiting.select(end - time.monotonic()):
            with contextlib.suppress(OSError):
                if key.fileobj.recv(4096):
                    continue
            waiting.unregister(key.fileobj)
            closed += 1
    waiting.close()
    return closed


class Connections(FolderTest):
    def client(self, server, *flags):
        """A client that is new: its own process."""
        return run(ANTICRACK, "--server", server.address, *flags, "server")

    def assert_lets_in(self, server, *flags):
        """At the latest when the server has noticed that others are gone."""
        limit = time.monotonic() + 120
        while (ended := self.client(server, *flags)).returncode != 0:
            self.assertLess(time.monotonic(), limit, ended.stderr + server.log())

    def flood(self, server, at_once):
        """CONNECTIONS of them that say nothing, so many at a time."""
        for _ in range(max(1, CONNECTIONS // at_once)):
            with contextlib.ExitStack() as stack:
                for _ in range(at_once):
                    stack.enter_context(contextlib.closing(server.connect()))

    def fill(self, server, at_once):
        """So many that stay until all are taken or refused."""
        with contextlib.ExitStack() as stack:
            for _ in range(at_once):
                stack.enter_context(contextlib.closing(server.connect()))
            limit = time.monotonic() + 120
            while server.metric("anticrack_connections_refused_total") == 0:
                self.assertLess(time.monotonic(), limit, server.log())
                time.sleep(0.05)

    def survives(self, server, *flags):
        self.assert_lets_in(server, *flags)
        before = server.metric("anticrack_connections_accepted_total")
        self.flood(server, 1200)
        self.fill(server, 3000)
        self.assert_lets_in(server, *flags)
        self.assertGreater(server.metric("anticrack_connections_accepted_total"), before)
        self.assertIn("connections refused", server.log())

    def setUp(self):
        super().setUp()
        _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
        resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))

    def test_in_plain_text(self):
        with Server(self.folder) as server:
            self.survives(server)
        self.assertEqual(server.ended, 0)

    def test_over_ipv6(self):
        with Server(self.folder, listen="[::1]:0") as server:
            self.survives(server)

    def test_on_both_families(self):
        with Server(self.folder, "--allow-insecure-remote", listen="0.0.0.0:0") as server:
            self.survives(server)
            server.address = "[::1]:" + server.address.rsplit(":", 1)[1]
            self.survives(server)

    def test_on_a_unix_socket(self):
        path = self.folder / "socket"
        with Server(self.folder, listen=f"unix:{path}") as server:
            self.survives(server)
        self.assertFalse(path.exists())

    def test_connections_that_are_reset_do_not_fill_the_log(self):
        with Server(self.folder) as server:
            for _ in range(1000):
                with contextlib.closing(server.connect()) as connection:
                    connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            self.assert_lets_in(server)
            self.assertLess(server.log().count("\n"), 20)

    def test_with_tls(self):
        made = run(pathlib.Path(os.environ["DEPLOY"]) / "make-certificates", self.folder / "tls")
        self.assertEqual(made.returncode, 0, made.stderr)
        tls = self.folder / "tls"
        with Server(self.folder, "--tls-certificate", tls / "server.crt", "--tls-key", tls / "server.key") as server:
            self.survives(server, "--ca", tls / "ca.crt")

    def test_the_soft_limit_is_raised(self):
        with Server(self.folder, soft=300, hard=4096) as server:
            self.assertEqual(server.metric("process_max_fds"), 4096)
            self.survives(server)
            self.assertLessEqual(server.metric("anticrack_connections"), server.metric("anticrack_connections_limit"))

    def test_one_address_leaves_room_for_others(self):
        with Server(self.folder, "--connections", "40", "--allow-insecure-remote", listen="0.0.0.0:0") as server:
            port = int(server.address.rsplit(":", 1)[1])
            with contextlib.ExitStack() as stack:
                for _ in range(100):
                    stack.enter_context(socket.create_connection(("127.0.0.1", port), source_address=("127.0.0.2", 0)))
                self.assert_lets_in(server)
                self.assertLessEqual(server.metric("anticrack_connections"), 21)

    def test_too_few_descriptors_are_named_at_the_start(self):
        ended = run(ANTICRACKD, "--listen", "127.0.0.1:0", "--data-dir", self.folder / "data",
                    preexec_fn=limited(200, 200))
        self.assertEqual((ended.returncode, ended.stdout), (2, ""))
        self.assertIn("this process has 200; raise it (ulimit -n", ended.stderr)

    def test_connections_that_do_not_speak_are_closed(self):
        silent = b""
        half = PREFACE[:10]
        no_settings = PREFACE
        with Server(self.folder) as server, contextlib.ExitStack() as stack:
            connections = []
            for said in (silent, half, no_settings, b"GET / HTTP/1.1\r\n"):
                connections.append(stack.enter_context(server.connect()))
                connections[-1].sendall(said)
            self.assertEqual(closed_by_peer(connections, 120), len(connections))
            limit = time.monotonic() + 120
            while server.metric("anticrack_connections") > 0:
                self.assertLess(time.monotonic(), limit)


if __name__ == "__main__":
    unittest.main()

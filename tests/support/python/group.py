# SPDX-License-Identifier: GPL-3.0-or-later
"""PostgreSQL, haproxy and several anticrackd on it, as processes on loopback and Unix sockets."""
import os
import pathlib
import pwd
import re
import shutil
import signal
import socket
import subprocess
import time
import urllib.error
import urllib.request

from processes import Daemon, run

PROGRAMS = max(pathlib.Path("/usr/lib/postgresql").glob("*/bin"), default=pathlib.Path("/usr/bin"))
HAPROXY = shutil.which("haproxy", path=os.environ.get("PATH", "") + ":/usr/sbin")


def eventually(holds, seconds=180):
    """The first true value of holds(); fails when it takes too long."""
    limit = time.monotonic() + seconds
    while not (value := holds()):
        if time.monotonic() > limit:
            raise AssertionError("this did not happen in time")
        time.sleep(0.02)
    return value


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Database:
    """A PostgreSQL server in a folder, as the user postgres where the caller is root; flushes nothing to the disk."""

    def __init__(self, folder):
        self.folder, self._process = folder / "postgresql", None
        self.folder.mkdir()
        if os.geteuid() == 0:
            user = pwd.getpwnam("postgres")
            os.chmod(folder, 0o755)
            os.chown(self.folder, user.pw_uid, user.pw_gid)
        self._done(PROGRAMS / "initdb", "--auth=trust", "--username=test", "--encoding=UTF8", "--locale=C", "--no-sync",
                   "--no-instructions", self.folder / "cluster")
        self.start()

    def _words(self, *command):
        guard = ["setpriv", "--reuid=postgres", "--regid=postgres", "--clear-groups"] if os.geteuid() == 0 else []
        return [str(word) for word in [*guard, *command]]

    def _done(self, *command):
        ended = run(*self._words(*command), cwd="/")
        assert ended.returncode == 0, ended.stdout + ended.stderr
        return ended.stdout

    def start(self):
        with open(self.folder.parent / "postgresql.log", "a", encoding="utf-8") as log:
            self._process = subprocess.Popen(
                self._words(PROGRAMS / "postgres", "-D", self.folder / "cluster", "-k", self.folder, "-c",
                            "listen_addresses=", "-c", "fsync=off", "-c", "max_connections=100", "-c",
                            "shared_buffers=32MB"), stderr=log, cwd="/")
        eventually(lambda: run(PROGRAMS / "pg_isready", "-q", "-h", self.folder).returncode == 0)

    def stop(self):
        """At once, as a crash does."""
        self._process.send_signal(signal.SIGQUIT)
        self._process.wait()

    def url(self, name="postgres"):
        return f"postgresql://test@/{name}?host={self.folder}"

    def sql(self, text, name="postgres"):
        return self._done(PROGRAMS / "psql", "-XqAt", "-v", "ON_ERROR_STOP=1", "-d", self.url(name), "-c", text).strip()

    def fresh(self, name):
        """Makes a database; returns its address."""
        self.sql(f"CREATE DATABASE {name}")
        return self.url(name)


class Member(Daemon):
    """One server of a group, with a folder of its own."""

    def __init__(self, folder, url, *flags, port=0, metrics_port=0):
        folder.mkdir(exist_ok=True)
        super().__init__(folder, "--store", url, "--metrics-listen", f"127.0.0.1:{metrics_port}", *flags, port=port)

    @property
    def pid(self):
        return self._process.pid

    def page(self, path="/metrics"):
        """Status and text of a page of the metrics port; 0 where nobody answers."""
        try:
            with urllib.request.urlopen(self.metrics_url().replace("/metrics", path), timeout=10) as answer:
                return answer.status, answer.read().decode()
        except urllib.error.HTTPError as error:
            return error.code, ""
        except OSError:
            return 0, ""

    def metric(self, name):
        """The sum of a metric over its labels."""
        return sum(float(value) for value in re.findall(rf"^{name}(?:{{.*}})? (\S+)$", self.page()[1], re.M))


class Balancer:
    """haproxy with the configuration of deploy/, but for addresses, ports and places of files."""

    def __init__(self, folder, configuration, places, servers):
        """places: what stands in place of what; servers: ports of calls and metrics, in the order of the lines."""
        self.port = free_port()
        text = configuration
        for place, here in {"bind :7433": f"bind 127.0.0.1:{self.port}", **places}.items():
            assert place in text, place
            text = text.replace(place, str(here))
        lines = re.findall(r"^ *server (\S+) \S+ check port \d+.*$", text, re.M)
        assert len(lines) == len(servers)
        for name, (port, metrics_port) in zip(lines, servers):
            here = f"127.0.0.1:{port} check port {metrics_port}"
            text = re.sub(rf"(server {name}) \S+ check port \d+", rf"\1 {here}", text)
        self.names = dict(zip(lines, servers))
        self.path = folder / "haproxy.cfg"
        self.path.write_text(text, encoding="utf-8")
        self._log = folder / "haproxy.log"
        with open(self._log, "w", encoding="utf-8") as log:
            self._process = subprocess.Popen([HAPROXY, "-db", "-f", self.path], stdout=log, stderr=log)
        eventually(self._listens)

    def _listens(self):
        if self._process.poll() is not None:
            raise RuntimeError("haproxy does not start: " + self.log())
        with socket.socket() as one:
            return one.connect_ex(("127.0.0.1", self.port)) == 0

    def log(self):
        return self._log.read_text(encoding="utf-8")

    def stop(self):
        self._process.terminate()
        self._process.wait()

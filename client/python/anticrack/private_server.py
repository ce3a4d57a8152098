# SPDX-License-Identifier: GPL-3.0-or-later
"""A private server. Its standard input closes when this process ends, however that happens; the server then ends too
and removes its folders; see anticrackd --private."""
from __future__ import annotations

import os
import pathlib
import shutil
import signal
import subprocess
import threading
import weakref

from .credentials import Path
from .errors import LocalServerError

DYING = 1.0  # how long a process may take to end after its connections have closed [s]
PATIENCE = 20.0  # how long stop() waits for the server to end [s]


class Server:
    """Runs anticrackd (`program`, or the one on PATH) on a socket that only this user can reach, with a data folder
    that is removed with it; `flags` are added to its command line. Raises LocalServerError. Belongs to the process that
    made it: in a forked process stop() does nothing."""

    def __init__(self, *flags: str, program: Path | None = None) -> None:
        found = shutil.which("anticrackd" if program is None else program)
        if found is None:
            raise LocalServerError("there is no anticrackd on PATH; install anticrack-server, or name the program: "
                                   "anticrack.local(program=...)")
        self._owner, self._stopping = os.getpid(), threading.Lock()
        self._log = os.memfd_create("anticrackd-log")
        try:
            self._process = subprocess.Popen(
                [found, "--private", "--log-level", "warn", *flags], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                stderr=self._log, start_new_session=True)
        except OSError as error:
            os.close(self._log)
            raise LocalServerError(f"{found} cannot be started: {error.strerror}") from None
        _alive.add(self)
        self.address = ""
        try:
            self._wait_until_ready()
        except BaseException:
            self.stop()
            raise

    def _wait_until_ready(self) -> None:
        assert self._process.stdout is not None
        line = self._process.stdout.readline().decode()  # comes once it listens; empty if it ends before that
        self.address = line.partition("listening on ")[2].strip()
        if not self.address:
            self._process.wait()
            raise LocalServerError(f"anticrackd {self._ending(' before it was ready')}{self._last_words()}")

    def require_alive(self) -> None:
        """Call it after a lost connection: raises LocalServerError, which says how, if the server has ended."""
        try:
            self._process.wait(DYING)
        except subprocess.TimeoutExpired:
            return
        raise LocalServerError(f"the private server {self._ending()}{self._last_words()}")

    def stop(self) -> None:
        """Stops the server and waits until it has ended; a second call does nothing."""
        if os.getpid() != self._owner:
            return
        with self._stopping:
            if self._log < 0:
                return
            assert self._process.stdin is not None and self._process.stdout is not None
            self._process.stdin.close()  # this asks the server to end
            try:
                self._process.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
            if self._process.returncode != 0:
                self._remove_left()
            self._process.stdout.close()
            os.close(self._log)
            self._log = -1

    def leave(self) -> None:
        """Lets go of the server in a forked child, which would otherwise keep it alive beyond its owner."""
        if self._process.stdin is not None and not self._process.stdin.closed:
            self._process.stdin.close()
        self._process.returncode = 0  # the server is not this process's child

    def _ending(self, when: str = "") -> str:
        code = self._process.returncode
        if code >= 0:
            return f"ended with exit code {code}{when}"
        known: dict[int, str] = {
            signal.SIGKILL: ", perhaps because memory ran out: a coarser mesh takes less",
            signal.SIGXCPU: ", the limit of processor time: raise it with ulimit -t"}
        return f"died of signal {-code} ({signal.strsignal(-code)}){when}{known.get(-code, '')}"

    def _last_words(self) -> str:
        size = os.fstat(self._log).st_size
        text = os.pread(self._log, 4000, max(size - 4000, 0)).decode("utf-8", "replace").strip()
        return "".join([":"] + ["\n  " + line for line in text.splitlines()[-5:]]) if text else ""

    def _remove_left(self) -> None:
        """Removes the folder that the server had no chance to remove."""
        folder = pathlib.Path(self.address.removeprefix("unix:")).parent
        if folder.name.startswith("anticrack-private-"):
            shutil.rmtree(folder, ignore_errors=True)


_alive: weakref.WeakSet[Server] = weakref.WeakSet()


def _in_child() -> None:
    for server in list(_alive):
        server.leave()


if hasattr(os, "register_at_fork"):  # Windows has neither this nor fork
    os.register_at_fork(after_in_child=_in_child)

# SPDX-License-Identifier: GPL-3.0-or-later
"""A server of one's own, for as long as it is needed."""
from __future__ import annotations

import contextlib
import pathlib
import shutil
import signal
import subprocess
import tempfile
import threading
from collections.abc import Iterator

from .credentials import Path
from .errors import LocalServerError


@contextlib.contextmanager
def server(*flags: str, program: Path | None = None) -> Iterator[str]:
    """The address of an anticrackd (that on PATH unless named) on a socket that only this user can reach, with a data
    folder that goes with it; `flags` are further ones of its command line. Raises LocalServerError."""
    found = shutil.which("anticrackd" if program is None else program)
    if found is None:
        raise LocalServerError("there is no anticrackd on PATH; install anticrack-server, or name the program: "
                               "anticrack.local(program=...)")
    with tempfile.TemporaryDirectory(prefix="anticrack-") as folder:
        address = f"unix:{folder}/socket"
        log = pathlib.Path(folder, "log")
        with open(log, "wb") as errors:
            process = subprocess.Popen(
                [*_ends_with_us(), found, "--listen", address, "--data-dir", folder + "/data", "--log-level", "warn",
                 *flags],
                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=errors, text=True, start_new_session=True)
        assert process.stdout is not None
        try:
            line = process.stdout.readline()  # once it listens; empty if it ends before
            if not line:
                process.wait()
                raise LocalServerError("anticrackd ended before it was ready:\n"
                                       + log.read_text(encoding="utf-8", errors="replace")[-2000:])
            yield address
        finally:
            process.send_signal(signal.SIGTERM)
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
            process.stdout.close()


def _ends_with_us() -> list[str]:
    """So that a killed program leaves no server behind. It would be stopped at the end of this thread, hence only of
    the main one."""
    setpriv = shutil.which("setpriv")
    main = threading.current_thread() is threading.main_thread()
    return [setpriv, "--pdeathsig", "TERM"] if setpriv and main else []

# SPDX-License-Identifier: GPL-3.0-or-later
"""What the programs of this package share: the parser, the options that name a server, and how errors are told."""
from __future__ import annotations

import argparse
import contextlib
import dataclasses
import math
import os
import sys
from typing import Any

from .credentials import Credentials, token_of
from .errors import Error, LocalServerError, ServerError
from .text import harmless

FAILED, USAGE, NOT_CONVERGED, SERVER, INTERRUPTED, CLOSED = 1, 2, 3, 4, 130, 141  # exit codes, as those of `anticrack`


class Usage(Error):
    """The command line is wrong."""


class Parser(argparse.ArgumentParser):
    def error(self, message: str) -> Any:
        raise Usage(f"{message.replace('argument ', '')}; see {self.prog} --help")


def number(low: float, high: float, kind: Any) -> Any:
    """Makes a parser of numbers in a range."""
    def read(text: str) -> Any:
        with contextlib.suppress(ValueError):
            if low <= kind(text) <= high:
                return kind(text)
        raise argparse.ArgumentTypeError(f"{text} is no number from {low:g} to {high:g}")
    return read


def add_server(parser: argparse.ArgumentParser) -> None:
    """Adds the options of `anticrack` that name a server and prove who asks."""
    parser.add_argument("--local", action="store_true", help="start a private anticrackd, and stop it after")
    parser.add_argument("--server", metavar="ADDRESS", help="HOST:PORT or unix:PATH of anticrackd "
                        "(default: ANTICRACK_SERVER, or 127.0.0.1:7433)")
    parser.add_argument("--tls", action="store_true", help="encrypt, and know the server by the roots of this system")
    for name in ("ca", "cert", "key", "token-file"):
        parser.add_argument(f"--{name}", metavar="FILE", help=f"as of anticrack --{name}",
                            default=os.environ.get(f"ANTICRACK_{name.upper().replace('-', '_')}"))


def credentials(given: argparse.Namespace) -> Credentials:
    return Credentials(given.tls, given.ca, given.cert, given.key, token_of(None, given.token_file))


def client_of(module: Any, given: argparse.Namespace) -> Any:
    """Makes the client that the options name; module: client, or aio."""
    return module.local() if given.local else module.connect(given.server, **dataclasses.asdict(credentials(given)))


def complain(error: Exception) -> None:
    """Tells of an error on standard error."""
    for line in str(error).splitlines():
        print("anticrack:", harmless(line), file=sys.stderr)


def code_of(error: Error) -> int:
    return SERVER if isinstance(error, (ServerError, LocalServerError)) else USAGE


def finite(value: Any) -> Any:
    """What JSON can hold: numbers that are not finite are None."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: finite(entry) for key, entry in value.items()}
    return [finite(entry) for entry in value] if isinstance(value, (list, tuple)) else value


def document_of(error: Error, code: str) -> dict[str, Any]:
    """The document of an error for --json."""
    return {"error": {"code": code, "reason": "", "message": str(error), "fields": []}}

# SPDX-License-Identifier: GPL-3.0-or-later
"""Credentials: how the client proves who it is and checks who the server is."""
from __future__ import annotations

import os
import pathlib
import re
from dataclasses import dataclass
from typing import Any

import grpc

from .errors import CaseError

Path = str | os.PathLike[str]
DEFAULT_ADDRESS = "127.0.0.1:7433"
# The server sends heartbeats every 10 s, so a stream that is silent for longer may hang on a dead connection.
CHANNEL = [("grpc.keepalive_time_ms", 30_000), ("grpc.keepalive_timeout_ms", 10_000),
           ("grpc.initial_reconnect_backoff_ms", 100), ("grpc.min_reconnect_backoff_ms", 1_000),
           ("grpc.max_reconnect_backoff_ms", 1_000), ("grpc.max_receive_message_length", -1)]


def host_and_port(address: str) -> tuple[str, str]:
    """Splits HOST, HOST:PORT, [IPV6]:PORT or IPV6 into host and port, in lower case, without the resolver's name."""
    text = re.sub(r"^(dns:///|dns:|ipv4:|ipv6:)", "", address.lower())
    found = re.fullmatch(r"\[(.*)\]:?(.*)|([^:]*):?([^:]*)", text)
    return (found[1] or found[3] or "", found[2] or found[4] or "") if found else (text, "")


def is_loopback(address: str) -> bool:
    """Whether data sent to the address stay on this machine."""
    host, _ = host_and_port(address)
    return (address.startswith(("unix:", "unix-abstract:")) or host in ("localhost", "localhost.", "::1")
            or re.fullmatch(r"127\.[0-9.]*", host) is not None)


def _read(path: Path | None, option: str, needed: str) -> bytes | None:
    if path is None:
        return None
    try:
        content = pathlib.Path(path).read_bytes()
    except OSError as error:
        raise CaseError(f"{option}: {os.fspath(path)} cannot be read: {error.strerror}") from None
    if needed.encode() not in content:
        raise CaseError(f"{option}: {os.fspath(path)} should contain {needed}")
    return content


@dataclass(frozen=True)
class Credentials:
    """What anticrack.connect takes to encrypt and to identify the client; files are PEM."""
    tls: bool = False
    ca: Path | None = None
    cert: Path | None = None
    key: Path | None = None
    token: str | None = None

    def of_channel(self, address: str) -> Any:
        """The channel's credentials, or None if it is unencrypted. Raises CaseError for unusable files, and for a token
        that would go over a network unencrypted."""
        if (self.cert is None) != (self.key is None):
            raise CaseError("cert needs key, and key needs cert")
        tls = self.tls or self.ca is not None or self.cert is not None
        if self.token is not None:
            if not re.fullmatch(r"[!-~]{1,4096}", self.token):
                raise CaseError("token: one line of at most 4096 printable characters without blanks is one")
            if not tls and not is_loopback(address):
                raise CaseError(f"the token would go to {address} unencrypted, for anybody on the way to read; give "
                                "ca, or tls=True where the server's certificate is of a public authority")
        begin = "-----BEGIN "
        files = (_read(self.ca, "ca", begin + "CERTIFICATE-----"), _read(self.key, "key", begin),
                 _read(self.cert, "cert", begin + "CERTIFICATE-----"))
        return grpc.ssl_channel_credentials(*files) if tls else None

    def metadata(self) -> tuple[tuple[str, str], ...]:
        """The metadata of every call."""
        return (("authorization", f"Bearer {self.token}"),) if self.token is not None else ()


def address_of(address: str | None) -> str:
    return address or os.environ.get("ANTICRACK_SERVER") or DEFAULT_ADDRESS


def token_of(token: str | None, token_file: Path | None) -> str | None:
    if token_file is not None:
        content = _read(token_file, "token_file", "")
        assert content is not None
        return content.decode("utf-8", "replace").rstrip("\r\n")
    return token if token is not None else os.environ.get("ANTICRACK_TOKEN") or None

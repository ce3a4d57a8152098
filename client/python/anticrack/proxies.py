# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the HTTP proxy that gRPC takes from the environment."""
from __future__ import annotations

import ipaddress
import os

from .credentials import host_and_port, is_loopback


def proxy_for(address: str) -> tuple[str, str] | None:
    """Returns the variable that names the proxy, and the proxy's HOST:PORT. None for an address on this machine, and
    for one that the first set variable of no_grpc_proxy, no_proxy and NO_PROXY exempts: a list of ends of names,
    addresses and networks (10.0.0.0/8), each also with a port, or *."""
    name = _first_set("grpc_proxy", "https_proxy", "http_proxy")
    if name is None or not os.environ[name] or is_loopback(address):
        return None
    server = host_and_port(address)
    exempt = _first_set("no_grpc_proxy", "no_proxy", "NO_PROXY")
    if exempt is not None and any(_exempts(entry.strip(), *server) for entry in os.environ[exempt].split(",")):
        return None
    return name, os.environ[name].rpartition("://")[2].partition("/")[0].rpartition("@")[2]  # without a password


def remark(proxy: tuple[str, str]) -> str:
    return (f"{proxy[0]} sends what goes there through the proxy {proxy[1]}: for a server that is reached without it "
            "add its host to no_proxy")


def _first_set(*names: str) -> str | None:
    return next((name for name in names if name in os.environ), None)


def _ip(host: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address | None:
    try:
        ip = ipaddress.ip_address(host)
    except ValueError:
        return None
    return getattr(ip, "ipv4_mapped", None) or ip


def _exempts(entry: str, host: str, port: str) -> bool:
    if entry == "*":
        return True
    ip = _ip(host)
    if "/" in entry:
        try:
            return ip is not None and ip in ipaddress.ip_network(entry, strict=False)
        except ValueError:
            return False
    wanted, wanted_port = host_and_port(entry[1:] if entry.startswith("*.") else entry)
    if not wanted or wanted_port not in ("", port):
        return False
    other = _ip(wanted)
    return ip == other if other is not None else host.endswith(wanted) or "." + host == wanted

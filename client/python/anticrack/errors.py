# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors in a case, on the way to the server, or on the server."""
from __future__ import annotations

import importlib
from typing import Any

import grpc

from .text import harmless
from .v1 import error_pb2


class Error(Exception):
    """The base of all errors of this package."""


class CaseError(Error, ValueError):
    """A case is wrong; the message names the file, the key and the cure."""


class UnknownName(Error, KeyError):
    """Nothing has this name; the message lists the known names."""

    def __str__(self) -> str:
        return Exception.__str__(self)  # KeyError would put the message in quotes


class UnknownIndex(Error, IndexError):
    """An index is out of range; the message says how many entries there are."""


class MissingPackage(Error, ImportError):
    """The call needs a package that is not installed."""


def package(module: str) -> Any:
    """Imports a module of an optional package; raises MissingPackage if it is not installed."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        name = module.partition(".")[0]
        if error.name is not None and error.name.partition(".")[0] != name:
            raise
        raise MissingPackage(f"this takes {name}, which is not installed; install it with 'apt install python3-{name}' "
                             f"or 'pip install {name}'", name=name) from None


class LocalServerError(Error):
    """A private server did not start."""


class ServerError(Error):
    """The server refused a call, a mesh or a job, or one of these failed, or the server cannot be reached.

    code: gRPC's name, as "NOT_FOUND". message: the server's text. reason: see ErrorInfo in error.proto. fields: pairs
    (path in the request, what is wrong with it). metadata: values named in the message. retry_delay [s]: wait at least
    this long; 0 if the server gave none.
    """

    def __init__(self, code: str, message: str, reason: str = "", fields: tuple[tuple[str, str], ...] = (),
                 metadata: dict[str, str] | None = None, retry_delay: float = 0) -> None:
        lines = [f"{path}: {what}" for path, what in fields]
        super().__init__(harmless("\n".join(lines) or message, "\n"))
        self.code, self.message, self.reason, self.fields = code, harmless(message, "\n"), reason, fields
        self.metadata, self.retry_delay = metadata or {}, retry_delay

    @property
    def lost(self) -> bool:
        """Whether the connection was lost, not the call refused."""
        return (self.code == "UNAVAILABLE" or (self.code == "UNKNOWN" and "Stream removed" in str(self))
                or (self.code == "CANCELLED" and not self.reason)  # a stopping server cancelled it, not a caller
                or (self.code == "INTERNAL" and "RST_STREAM" in str(self)))

    @property
    def may_retry(self) -> bool:
        return self.lost or (self.code == "RESOURCE_EXHAUSTED" and self.retry_delay > 0)


def of_status(status: error_pb2.Status) -> ServerError:
    """Makes the error of a mesh, a job or a load case."""
    names = {code.value[0]: code.name for code in grpc.StatusCode}
    info, request, retry = error_pb2.ErrorInfo(), error_pb2.BadRequest(), error_pb2.RetryInfo()
    kinds: dict[str, Any] = {"google.rpc.ErrorInfo": info, "google.rpc.BadRequest": request,
                             "google.rpc.RetryInfo": retry}
    for detail in status.details:
        message = kinds.get(detail.type_url.rpartition("/")[2])
        if message is not None:
            message.ParseFromString(detail.value)
    fields = tuple((violation.field, violation.description) for violation in request.field_violations)
    return ServerError(names.get(status.code, "UNKNOWN"), status.message, info.reason, fields, dict(info.metadata),
                       retry.retry_delay.seconds + retry.retry_delay.nanos * 1e-9)


def of_call(call: Any) -> ServerError:
    """Makes the error of a failed call, which is a grpc.RpcError."""
    for key, value in call.trailing_metadata() or ():
        if key == "grpc-status-details-bin":
            try:
                return of_status(error_pb2.Status.FromString(value))
            except Exception:  # details that are not ours: gRPC's message has to do
                break
    return ServerError(call.code().name, call.details() or "")

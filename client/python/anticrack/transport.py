# SPDX-License-Identifier: GPL-3.0-or-later
"""Calls to the server, one try each, that raise ServerError. The session is written once, as coroutines: with the
blocking calls of this transport they never wait for an event loop, so that `finished` runs them like functions."""
from __future__ import annotations

import time
from collections.abc import AsyncIterator, Callable, Coroutine, Iterable, Iterator
from typing import Any, TypeVar

import grpc

from .credentials import CHANNEL, Credentials
from .errors import Error, of_call
from .v1 import mesh_pb2_grpc, server_pb2_grpc, solve_pb2_grpc, upload_pb2_grpc

T = TypeVar("T")
DEADLINE = 30.0  # of a try of a unary call [s]


class _Closed:
    """In place of the methods of a server."""

    def __getattr__(self, method: str) -> Any:
        raise Error("this client is closed, as at the end of its 'with'; use it before, or connect another")


class Transport:
    """Blocking."""

    def __init__(self, address: str, credentials: Credentials) -> None:
        secrets = credentials.of_channel(address)
        self.metadata = credentials.metadata()
        self.channel = self._open(address, secrets)
        self.meshes: Any = mesh_pb2_grpc.MeshServiceStub(self.channel)  # type: ignore[no-untyped-call]
        self.jobs: Any = solve_pb2_grpc.SolveServiceStub(self.channel)  # type: ignore[no-untyped-call]
        self.server: Any = server_pb2_grpc.ServerServiceStub(self.channel)  # type: ignore[no-untyped-call]
        self.uploads: Any = upload_pb2_grpc.UploadServiceStub(self.channel)  # type: ignore[no-untyped-call]

    def _open(self, address: str, secrets: Any) -> Any:
        if secrets is None:
            return grpc.insecure_channel(address, CHANNEL)
        return grpc.secure_channel(address, secrets, CHANNEL)

    async def unary(self, method: Callable[..., Any], request: Any) -> Any:
        try:
            return method(request, timeout=DEADLINE, metadata=self.metadata)
        except grpc.RpcError as error:
            raise of_call(error) from None

    async def upload(self, parts: Callable[[], Iterable[Any]]) -> Any:
        try:
            return self.uploads.CreateUploads(iter(parts()), metadata=self.metadata)
        except grpc.RpcError as error:
            raise of_call(error) from None

    async def stream(self, method: Callable[..., Any], request: Any) -> AsyncIterator[Any]:
        call = method(request, metadata=self.metadata)
        try:
            for message in call:
                yield message
        except grpc.RpcError as error:
            raise of_call(error) from None
        finally:
            call.cancel()

    async def sleep(self, seconds: float) -> None:
        time.sleep(seconds)

    def _end(self) -> None:
        self.meshes = self.jobs = self.server = self.uploads = _Closed()

    async def close(self) -> None:
        self._end()
        self.channel.close()


def finished(work: Coroutine[Any, Any, T]) -> T:
    """What a coroutine returns that waits for nothing."""
    try:
        work.send(None)
    except StopIteration as end:
        return end.value  # type: ignore[no-any-return]
    raise RuntimeError("a blocking call waited for an event loop")


def each(messages: AsyncIterator[T]) -> Iterator[T]:
    """The same of an iterator."""
    async def following() -> T:
        return await messages.__anext__()

    async def close() -> None:
        await messages.aclose()  # type: ignore[attr-defined]
    try:
        while True:
            try:
                message = finished(following())
            except StopAsyncIteration:
                return
            yield message
    finally:
        finished(close())

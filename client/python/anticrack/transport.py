# SPDX-License-Identifier: GPL-3.0-or-later
"""Calls to the server, one try each, that raise ServerError. The session is written once, as coroutines: with the
blocking calls of this transport, coroutines never wait for an event loop, so `finished` runs them like functions."""
from __future__ import annotations

import os
import re
import time
import weakref
from collections.abc import AsyncIterator, Callable, Coroutine, Iterable, Iterator
from typing import Any, TypeVar

import grpc

from .credentials import CHANNEL, Credentials
from .errors import Error, of_call
from .private_server import Server
from .proxies import proxy_for
from .v1 import case_pb2_grpc, mesh_pb2_grpc, server_pb2_grpc, solve_pb2, solve_pb2_grpc, upload_pb2_grpc

# Debian 13 builds gRPC without NDEBUG, which turns on an experiment of debug builds: os.fork() then waits for ever in
# a process that has called a server. This has to precede the first channel; experiments set by the user are kept.
if grpc.__version__.startswith("1.51."):
    os.environ.setdefault("GRPC_EXPERIMENTS", "-posix_event_engine_enable_polling")

T = TypeVar("T")
DEADLINE = 30.0  # for each try of a unary call [s]
MESH = re.compile(r"meshes/([A-Za-z0-9_-]{1,64})")
MOST_JOBS_KNOWN = 10_000


class _Closed:
    """Stands in for the methods of a server once the client is closed."""

    def __getattr__(self, method: str) -> Any:
        raise Error("this client is closed, as at the end of its 'with'; use it before, or connect another")


class Transport:
    """Calls that block until the answer is there."""
    calls: Any = grpc

    def __init__(self, address: str, credentials: Credentials, server: Server | None = None) -> None:
        """server: a private server, which ends together with the transport."""
        self.server_process, self._owner = server, os.getpid()
        self.stop_server: Any = weakref.finalize(self, server.stop) if server else lambda: None
        secrets = credentials.of_channel(address)
        self.proxy = proxy_for(address)
        self.options = [*CHANNEL, ("grpc.enable_http_proxy", int(self.proxy is not None))]
        self.metadata = credentials.metadata()
        self._meshes: dict[str, str] = {}  # of jobs, by their names
        self.channel = (self.calls.insecure_channel(address, self.options) if secrets is None else
                        self.calls.secure_channel(address, secrets, self.options))
        self.cases: Any = case_pb2_grpc.CaseServiceStub(self.channel)  # type: ignore[no-untyped-call]
        self.meshes: Any = mesh_pb2_grpc.MeshServiceStub(self.channel)  # type: ignore[no-untyped-call]
        self.jobs: Any = solve_pb2_grpc.SolveServiceStub(self.channel)  # type: ignore[no-untyped-call]
        self.server: Any = server_pb2_grpc.ServerServiceStub(self.channel)  # type: ignore[no-untyped-call]
        self.uploads: Any = upload_pb2_grpc.UploadServiceStub(self.channel)  # type: ignore[no-untyped-call]

    def require_owner(self) -> None:
        """Raises in a forked child, whose calls would wait for ever, as gRPC's connections do not survive a fork."""
        if os.getpid() != self._owner:
            raise Error("this client belongs to the process that this one was forked from; make one here, with "
                        "anticrack.local() or anticrack.connect()")

    def require_alive(self) -> None:
        """Call it after a lost connection: raises LocalServerError if the private server has ended."""
        if self.server_process is not None:
            self.server_process.require_alive()

    async def answer(self, call: Any) -> Any:
        return call

    async def messages(self, call: Any) -> AsyncIterator[Any]:
        for message in call:
            yield message

    async def sleep(self, seconds: float) -> None:
        time.sleep(seconds)

    def _metadata(self, request: Any) -> Any:
        """The token, and the id of the mesh that a request is about, if one is known: by it balancers send calls for
        one mesh to one server."""
        name = (request.spec.mesh if isinstance(request, solve_pb2.CreateJobRequest) else
                request.mesh if isinstance(request, solve_pb2.ListJobsRequest) else getattr(request, "name", ""))
        found = MESH.fullmatch(self._meshes.get(name, name))
        return self.metadata if found is None else [*self.metadata, ("x-mesh-id", found.group(1))]

    def _learn(self, answer: Any) -> None:
        if isinstance(answer, solve_pb2.Job):
            if len(self._meshes) >= MOST_JOBS_KNOWN:
                self._meshes.clear()
            self._meshes[answer.name] = answer.spec.mesh

    async def unary(self, method: Callable[..., Any], request: Any, deadline: float | None = DEADLINE) -> Any:
        self.require_owner()
        try:
            answer = await self.answer(method(request, timeout=deadline, metadata=self._metadata(request)))
            self._learn(answer)
            return answer
        except grpc.RpcError as error:
            raise of_call(error) from None

    async def upload(self, parts: Callable[[], Iterable[Any]]) -> Any:
        return await self.unary(self.uploads.CreateUploads, iter(parts()), None)

    async def stream(self, method: Callable[..., Any], request: Any) -> AsyncIterator[Any]:
        self.require_owner()
        call = method(request, metadata=self._metadata(request))
        try:
            async for message in self.messages(call):
                yield message
        except grpc.RpcError as error:
            raise of_call(error) from None
        finally:
            call.cancel()

    async def close(self) -> None:
        self.cases = self.meshes = self.jobs = self.server = self.uploads = _Closed()
        await self.answer(self.channel.close())
        self.stop_server()


def finished(work: Coroutine[Any, Any, T]) -> T:
    """Runs a coroutine that never waits, and returns its value."""
    try:
        work.send(None)
    except StopIteration as end:
        return end.value  # type: ignore[no-any-return]
    raise RuntimeError("a blocking call waited for an event loop")


def each(messages: AsyncIterator[T]) -> Iterator[T]:
    """Yields the items of an asynchronous iterator that never waits."""
    async def following() -> T:
        return await messages.__anext__()
    try:
        while True:
            yield finished(following())
    except StopAsyncIteration:
        return
    finally:
        finished(messages.aclose())  # type: ignore[attr-defined]

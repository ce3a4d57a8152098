# SPDX-License-Identifier: GPL-3.0-or-later
"""The client for asyncio: connect and local as in the package anticrack, but their calls are awaited."""
from __future__ import annotations

import asyncio
import os
from collections.abc import AsyncIterator, Sequence
from typing import TYPE_CHECKING, Any, TextIO

import grpc

from .arrays import Array
from .case import Case
from .client import JobState, noted
from .credentials import Credentials, Path, token_of
from .progress import Progress
from .result import Result
from .retry import Backoff
from .session import Session, session_of_own, session_to
from .transport import Transport
from .v1 import mesh_pb2, server_pb2, solve_pb2

if TYPE_CHECKING:
    from .study import Study


class AsyncTransport(Transport):
    """The calls of Transport on grpc.aio."""
    calls = grpc.aio

    async def answer(self, call: Any) -> Any:
        return await call

    def messages(self, call: Any) -> Any:
        return call

    async def sleep(self, seconds: float) -> None:
        await asyncio.sleep(seconds)


class AsyncJob(JobState):
    """A job as anticrack.Job, whose calls are awaited."""

    async def refresh(self) -> AsyncJob:
        self.message = await self._session.job(self.name)
        return self

    async def events(self, after: int = 0) -> AsyncIterator[solve_pb2.WatchJobResponse]:
        async for message in self._session.events(self.name, after):
            if message.HasField("ended"):
                self.message = message.ended
            yield message

    async def wait(self, progress: bool = False, out: TextIO | None = None) -> AsyncJob:
        shown = Progress(self.message, out, progress)
        async for message in self.events():
            shown.take(message)
        return self

    async def cancel(self) -> AsyncJob:
        self.message = await self._session.cancel(self.name)
        return self

    async def delete(self) -> None:
        await self._session.delete(self.name)

    async def result(self) -> Result:
        await self.refresh()
        if not self.ended:
            await self.wait()
        return await self._result()


class AsyncClient:
    """A client as anticrack.Client, whose calls are awaited."""

    def __init__(self, session: Session) -> None:
        self._session = session

    async def submit(self, case: Case | str | os.PathLike[str], coefficients: Any = None, nodal_forces: Any = None,
                     traces: Sequence[int] = (), bounds: bool = False, tips: bool = False) -> AsyncJob:
        message, read = await self._session.submit(case, coefficients, nodal_forces, traces, bounds, tips)
        return AsyncJob(self._session, message, read, coefficients)

    async def run(self, case: Case | str | os.PathLike[str], coefficients: Any = None, nodal_forces: Any = None,
                  traces: Sequence[int] = (), progress: bool = False, bounds: bool = False,
                  tips: bool = False) -> Result:
        job = await self.submit(case, coefficients, nodal_forces, traces, bounds, tips)
        return noted(await (await job.wait(progress)).result())

    async def study(self, case: Case | str | os.PathLike[str], vary: Any, path: Path | None = None, *, jobs: int = 4,
                    progress: bool = False, most_meshes: int = 1000, retry: bool = False) -> Study:
        from .study.rows import rows_of
        from .study.run import Told, run
        return await run(self._session, case, rows_of(vary), path, jobs, most_meshes, retry, Told(progress))

    async def mesh(self, case: Case | str | os.PathLike[str]) -> mesh_pb2.Mesh:
        return await self._session.mesh_of(case)

    async def mesh_arrays(self, mesh: mesh_pb2.Mesh | str) -> dict[str, Array]:
        return await self._session.mesh_arrays(mesh if isinstance(mesh, str) else mesh.name)

    async def job(self, name: str) -> AsyncJob:
        return AsyncJob(self._session, await self._session.job(name))

    async def jobs(self, limit: int = 50) -> list[AsyncJob]:
        return [AsyncJob(self._session, message) for message in await self._session.jobs(limit)]

    async def info(self) -> server_pb2.ServerInfo:
        return await self._session.info()

    async def close(self) -> None:
        await self._session.transport.close()

    async def __aenter__(self) -> AsyncClient:
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.close()


def connect(address: str | None = None, *, tls: bool = False, ca: Path | None = None, cert: Path | None = None,
            key: Path | None = None, token: str | None = None, token_file: Path | None = None,
            patience: float = 300.0, first_contact: float = 3.0) -> AsyncClient:
    """Makes a client as anticrack.connect does; an event loop must be running."""
    return AsyncClient(session_to(AsyncTransport, address, Credentials(tls, ca, cert, key, token_of(token, token_file)),
                                  Backoff(patience, first_contact)))


def local(*flags: str, program: Path | None = None) -> AsyncClient:
    """Makes a client of a private server as anticrack.local does; an event loop must be running."""
    return AsyncClient(session_of_own(AsyncTransport, *flags, program=program))

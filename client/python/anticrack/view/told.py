# SPDX-License-Identifier: GPL-3.0-or-later
"""A session that tells the page when the server is lost and found again, and server-sent events to the page."""
from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator, Callable
from typing import Any

from aiohttp import web

from ..errors import Error, ServerError
from ..retry import Backoff
from ..session import Session
from ..text import harmless
from ..v1 import job_pb2, solve_pb2
from .gate import text_of

Event = tuple[str, Any, int | None]  # its name, its data, and the sequence number to go on after
_PATIENCE = 3.0  # for another page once the last one has gone [s]
_PAUSE = 1.0  # between signs of life to a page, whose loss is noticed by them [s]


class Told(Session):
    lost = ""
    pages: set[asyncio.Queue[Event]]  # of the pages that listen

    def tell(self, lost: str) -> None:
        if lost != self.lost:
            self.lost = lost
            for page in self.pages:
                page.put_nowait(self.connection())

    def connection(self) -> Event:
        return "connection", {"server": self.address, "lost": self.lost, "met": self.backoff.met}, None

    async def _wait(self, backoff: Backoff, error: ServerError) -> None:
        if error.lost:
            self.tell(harmless(error))
        await super()._wait(backoff, error)

    def _succeeded(self, backoff: Backoff) -> None:
        self.tell("")
        super()._succeeded(backoff)

    async def call(self, method: Any, request: Any) -> Any:
        if isinstance(request, solve_pb2.CreateJobRequest):
            ask_for_fields(request.spec)
        return await super().call(method, request)


def ask_for_fields(spec: job_pb2.JobSpec) -> None:
    """The page shows the membrane, so a job that may keep u on every node does."""
    if spec.WhichOneof("task") in (None, "accuracy"):
        wanted = [job_pb2.OUTPUT_FIELDS, *([] if spec.without_bounds else [job_pb2.OUTPUT_INDICATORS])]
        spec.outputs.extend(kind for kind in wanted if kind not in spec.outputs)


class Pages:
    """The pages that listen now. until_closed: the server ends when the last one has gone and none comes for a
    while."""

    def __init__(self, session: Told, until_closed: bool) -> None:
        self.session, self._until_closed = session, until_closed
        session.pages = set()

    def _leave(self) -> None:
        if self._until_closed and not self.session.pages:
            raise web.GracefulExit

    async def stream(self, request: web.Request, events: Callable[[], AsyncIterator[Event]]) -> web.StreamResponse:
        """Sends events, and what becomes of the connection to the server, until the page goes."""
        response = web.StreamResponse(headers={"Content-Type": "text/event-stream"})
        await response.prepare(request)
        queue: asyncio.Queue[Event] = asyncio.Queue()
        queue.put_nowait(self.session.connection())
        self.session.pages.add(queue)

        async def fill() -> None:
            try:
                async for event in events():
                    queue.put_nowait(event)
            except Error as error:
                queue.put_nowait(("failed", {"error": harmless(error, "\n")}, None))
        filling = asyncio.create_task(fill())
        try:
            while True:
                try:
                    name, data, number = await asyncio.wait_for(queue.get(), _PAUSE)
                except asyncio.TimeoutError:
                    await response.write(b": alive\n\n")
                    continue
                mark = "" if number is None else f"id: {number}\n"
                await response.write(f"event: {name}\n{mark}data: {text_of(data)}\n\n".encode())
        except ConnectionError:
            return response
        finally:
            filling.cancel()
            self.session.pages.discard(queue)
            if not self.session.pages:
                asyncio.get_running_loop().call_later(_PATIENCE, self._leave)
            with contextlib.suppress(asyncio.CancelledError):
                await filling

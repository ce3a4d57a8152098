# SPDX-License-Identifier: GPL-3.0-or-later
"""Jobs of the server: a list that is kept up to date, the events of one, and what may be done with it."""
from __future__ import annotations

import asyncio
import uuid
from collections.abc import AsyncIterator, Callable
from typing import Any

from aiohttp import web

from .. import entries
from ..errors import Error, ServerError, of_status
from ..v1 import solve_pb2
from .opened import Opened
from .gate import reply
from .told import Event, Pages, Told

_MOST = 200  # jobs that are listed, the newest
_PAUSE = 0.5  # between looks at the list [s]


def told(job: solve_pb2.Job) -> dict[str, Any]:
    """A job in a line of the list."""
    status, task = job.status, job.spec.WhichOneof("task")
    rows = status.sweep_answer
    done, total = status.load_cases_ended, status.load_case_count
    if task == "sweep":
        done, total = rows.converged + rows.not_converged + rows.failed, rows.rows
    return {"name": job.name, "title": job.spec.title, "owner": job.owner, "state": _word(status.state), "done": done,
            "total": total, "task": task or "", "created": status.create_time.ToMilliseconds(),
            "result": status.result_state == solve_pb2.JobStatus.RESULT_STATE_AVAILABLE,
            "error": str(of_status(status.error)) if status.HasField("error") else ""}


def _word(state: int) -> str:
    return entries.status_name(state, solve_pb2.JobStatus.State.DESCRIPTOR)


def _whole(job: solve_pb2.Job) -> dict[str, Any]:
    """A job with its loads and its timeline."""
    return told(job) | {
        "loads": [load.name for load in job.spec.load_cases], "not_reached": job.status.not_reached,
        "timeline": [{"time": step.time.ToMilliseconds(), "state": _word(step.state), "detail": step.detail,
                      "attempt": step.attempt} for step in job.status.timeline],
        "stages": list(map(_stage, job.status.stages)),
        "answers": [_answer(i, answer) for i, answer in enumerate(job.status.answers)]}


def _stage(stage: solve_pb2.Stage) -> dict[str, Any]:
    return {**entries.values_of(stage), "answers": [entries.values_of(answer) for answer in stage.answers]}


def _answer(index: int, answer: solve_pb2.LoadCaseAnswer) -> dict[str, Any]:
    return {"load": index, **entries.values_of(answer),
            "inclusions": [entries.values_of(part) for part in answer.inclusions]}


def event_of(message: solve_pb2.WatchJobResponse) -> list[Event]:
    """What a message of a watch tells the page, in order: load cases that ended come behind their samples."""
    kind, number = message.WhichOneof("event") or "heartbeat", message.sequence
    of = getattr(message, kind)
    told_of: dict[str, Callable[[], dict[str, Any]]] = {
        "samples": lambda: {field.name: list(getattr(of, field.name)) for field in of.DESCRIPTOR.fields},
        "phase": lambda: {"state": _word(of.state), "detail": of.detail},
        "stage_ended": lambda: _stage(of), "sweep_rows": lambda: {"count": len(of.status)},
        "growth_step": lambda: {"load": of.load_case, **entries.values_of(of.row)},
        "snapshot": lambda: _whole(of.job), "ended": lambda: _whole(of)}
    own: list[Event] = [(kind, told_of[kind](), None if kind == "snapshot" else number)] if kind in told_of else []
    answers: list[Event] = [("answer", _answer(ended.load_case, ended.answer), number)
                            for ended in message.load_cases_ended]
    return own + answers if kind == "samples" else answers + own


async def _listed(session: Told) -> AsyncIterator[Event]:
    """The list whenever it has changed. It goes on for ever, also while the server is away."""
    last: Any = None
    while True:
        try:
            jobs = [told(job) for job in await session.jobs(_MOST)]
            if jobs != last:
                yield "jobs", jobs, None
            last = jobs
        except ServerError as error:
            if not error.lost:
                raise
            session.tell(str(error))
            last = None
        await asyncio.sleep(_PAUSE)


async def _again(session: Told, name: str) -> str:
    """Submits the same job once more."""
    job = await session.job(name)
    spec = job.spec
    for matrix in (spec.sweep.coefficients, spec.sweep.nodal_forces) if spec.HasField("sweep") else ():
        if matrix.sha256:
            matrix.upload = f"uploads/{matrix.sha256}"  # the server keeps what was packed under this name
            matrix.sha256 = ""
    request = solve_pb2.CreateJobRequest(spec=spec, request_id=str(uuid.uuid4()))
    return str((await session.call(session.transport.jobs.CreateJob, request)).name)


def add_routes(app: web.Application, session: Told, pages: Pages, opened: Opened) -> None:
    async def listed(request: web.Request) -> web.StreamResponse:
        return await pages.stream(request, lambda: _listed(session))

    async def watch(request: web.Request) -> web.StreamResponse:
        after = int(request.headers.get("Last-Event-ID", 0))
        return await pages.stream(request, lambda: (
            event async for message in session.events(request.query["of"], after) for event in event_of(message)))

    async def act(request: web.Request) -> web.Response:
        asked = await request.json()
        name = str(asked["name"])
        if asked["action"] == "cancel":
            await session.cancel(name)
        elif asked["action"] == "delete":
            await session.delete(name)
            opened.forget(name)
        elif asked["action"] == "again":
            again = await _again(session, name)
            opened.again(name, again)
            name = again
        else:
            raise Error("a job can be cancelled, deleted, or submitted again")
        return reply({"name": name})
    app.add_routes([web.get("/api/jobs", listed), web.get("/api/watch", watch), web.post("/api/job", act)])

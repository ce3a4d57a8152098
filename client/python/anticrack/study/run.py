# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves the rows of a study, several jobs at once, written once for blocking and asynchronous clients. A row that is
in the file is not solved again, and a job that a crash left on the server is found by its request id, which is made of
what the job asks for."""
from __future__ import annotations

import hashlib
import itertools
import os
import time
from typing import TextIO

from ..case import Case, as_case
from ..errors import CaseError, ServerError, package
from ..progress import PAUSE, Place
from ..reading import ReadCase
from ..result import Units
from ..session import ENDED as JOB_ENDED
from ..session import Session
from ..text import counted, harmless, listed
from ..v1 import solve_pb2
from .record import ENDED, SOLVED, Row, Study, is_study
from .rows import Values, overrides_of

AT_ONCE, MOST_MESHES = 4, 1000
_REFUSALS = ("INVALID_ARGUMENT", "FAILED_PRECONDITION", "OUT_OF_RANGE", "UNIMPLEMENTED")  # these are a row's own
_FIRST, _LONGEST = 0.02, 0.25  # between two looks at the jobs [s]
_WRITING = 20  # the file is written again after so many times as long as writing it takes
_MOST_AT_ONCE = 1000


class Plan:
    """What is to be done: a study whose rows know their identity, with the answers of an earlier run. meshes: how many
    are made for what is left; notes: the server's, on the case; cases: the first and the last row's as TOML; strangers:
    rows with answers in the file that are none of this study."""

    def __init__(self, study: Study) -> None:
        self.study, self.meshes, self.strangers = study, 0, 0
        self.notes, self.cases = list[str](), ["", ""]

    @property
    def left(self) -> list[int]:
        return [index for index, row in enumerate(self.study.rows) if row.status not in ENDED]


class Told:
    """Tells how far a study is."""

    def __init__(self, shown: bool, out: TextIO | None = None) -> None:
        self._place = Place(out, shown)
        self._pause = PAUSE if self._place.replaces else 2.0
        self.begin()

    def begin(self) -> None:
        self._began = time.monotonic()
        self._next = self._began + self._pause

    def show(self, what: str, done: int, of: int, new: int, more: str = "", last: bool = False) -> None:
        """new: how many of those that are done were done in this run, by which the rest of the time is estimated."""
        now = time.monotonic()
        if now < self._next and not last:
            return
        self._next = now + self._pause
        left = f", about {_duration((now - self._began) / new * (of - done))} left" if 0 < new and done < of else ""
        self._place.show(f"{what} {done}/{of}{more}{left}", last)


def _duration(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.0f} min" if seconds < 6000 else (
        f"{seconds / 3600:.1f} h")


def _digest(*parts: bytes) -> str:
    digest = hashlib.sha256()
    for part in parts:
        digest.update(len(part).to_bytes(8, "little") + part)
    return digest.hexdigest()[:48]


async def plan_of(session: Session, case: Case | str | os.PathLike[str], rows: list[Values],
                  path: str | os.PathLike[str] | None = None, retry: bool = False, told: Told | None = None) -> Plan:
    """Has the server read every row, and takes the answers that the file at `path` has of them. A row that is refused
    is told as such. retry: rows that failed are left. Raises CaseError if all rows are refused."""
    case, files = as_case(case), dict[str, bytes]()
    plan = Plan(Study([Row(values) for values in rows], case=case.text))
    meshes, notes, earlier = dict[str, str](), dict[str, None](), dict[str, Row]()
    if path is not None and is_study(path):
        earlier = {row.identity: row for row in Study.read(path).rows if row.status in (SOLVED if retry else ENDED)
                   and row.identity}
    refusals = list[CaseError]()
    for index, row in enumerate(plan.study.rows):
        try:
            read = await session.read(case, overrides=overrides_of(row.values))
            meshes[row.identity] = _identify(read, row, files)
        except CaseError as error:
            row.status, row.error = "refused", str(error)
            refusals.append(error)
            continue
        units = read.spec.units
        plan.study.title, plan.study.units = read.spec.title, Units(units.length, units.force)
        plan.cases = [plan.cases[0] or read.text, read.text]
        notes.update(dict.fromkeys(read.notes))
        if row.identity in earlier:
            found = earlier[row.identity]
            row.status, row.error, row.job, row.answers = found.status, found.error, found.job, found.answers
        if told is not None:
            told.show("reading row", index + 1, len(rows), index + 1)
    if len(refusals) == len(rows):
        raise refusals[0]
    mine = {row.identity for row in plan.study.rows}
    plan.strangers = sum(identity not in mine for identity in earlier)
    plan.meshes = len({meshes[plan.study.rows[index].identity] for index in plan.left})
    plan.notes = list(notes)
    return plan


def _identify(read: ReadCase, row: Row, files: dict[str, bytes]) -> str:
    """Makes the identity of a row of all that its job will be made of; returns that of its mesh."""
    if read.mesh_file not in files:
        files[read.mesh_file] = hashlib.sha256(read.msh() or b"").digest()
    mesh = _digest(read.mesh.SerializeToString(deterministic=True), files[read.mesh_file])
    arrays = [hashlib.sha256(values.tobytes()).digest() for _, values in read.arrays()]
    row.identity = _digest(mesh.encode(), read.spec.SerializeToString(deterministic=True), *arrays)
    return mesh


class _File:
    """The study's file, written again often enough to lose little and seldom enough to cost little."""

    def __init__(self, plan: Plan, path: str | os.PathLike[str] | None) -> None:
        self._study, self._path, self._due, self.changed = plan.study, path, 0.0, True
        if path is not None:
            former = os.path.isfile(path) and (not is_study(path) or plan.strangers > 0)
            self._write(former)
            if former:
                plan.notes.append(f"kept {os.fspath(path)}~, what {os.path.basename(path)} was before")

    def _write(self, keep: bool = False) -> None:
        began = time.monotonic()
        if self._path is not None:
            self._study.save(self._path, keep)
        self.changed, self._due = False, time.monotonic() + _WRITING * (time.monotonic() - began)

    def look(self, now: bool = False) -> None:
        if self.changed and (now or time.monotonic() >= self._due):
            self._write()


async def solve(session: Session, case: Case | str | os.PathLike[str], plan: Plan,
                path: str | os.PathLike[str] | None = None, at_once: int = AT_ONCE, retry: bool = False,
                told: Told | None = None) -> Study:
    """Solves what is left of a plan, `at_once` rows at a time. An interrupt, or a server that is lost, leaves the file
    with what is done; jobs that run go on, and the next run finds them."""
    case, study, told = as_case(case), plan.study, told or Told(False)
    if not 1 <= at_once <= _MOST_AT_ONCE:
        raise CaseError(f"{at_once} jobs at once are not possible; write 1 to {_MOST_AT_ONCE}")
    file, left = _File(plan, path), plan.left
    waiting, running, ended, pause = list(reversed(left)), dict[int, solve_pb2.Job](), 0, _FIRST
    told.begin()
    try:
        while waiting or running:
            while waiting and len(running) < at_once:
                index = waiting.pop()
                row = study.rows[index]
                try:
                    read = await session.read(case, overrides=overrides_of(row.values))
                    running[index] = await _job_of(session, read, retry)
                except (CaseError, ServerError) as error:
                    if isinstance(error, ServerError) and error.code not in _REFUSALS:
                        raise
                    row.status, row.error = "refused", str(error)
                    ended += 1
                    file.changed = True
            before = ended
            for index in list(running):
                job = running[index]
                if job.status.state not in JOB_ENDED:
                    job = running[index] = await session.call(session.transport.jobs.GetJob, solve_pb2.GetJobRequest(
                        name=job.name))
                if job.status.state in JOB_ENDED:
                    study.rows[index].take(job)
                    del running[index]
                    ended += 1
                    file.changed = True
            file.look()
            done = len(study.rows) - len(left) + ended
            wrong = sum(row.status not in ("", "succeeded") for row in study.rows)
            told.show("row", done, len(study.rows), ended, f", {wrong} without all answers" * (wrong > 0),
                      last=not (waiting or running))
            pause = min(1.5 * pause, _LONGEST) if ended == before else _FIRST
            if running and ended == before:
                await session.transport.sleep(pause)
    finally:
        file.look(now=True)
    return study


async def _job_of(session: Session, read: ReadCase, retry: bool) -> solve_pb2.Job:
    """Creates the job of a row, or finds the one that an earlier run created. One that was cancelled is left alone, and
    with `retry` one that failed."""
    useless = [solve_pb2.JobStatus.STATE_CANCELLED] + [solve_pb2.JobStatus.STATE_FAILED] * retry
    for attempt in itertools.count():
        job = await session.create(read, lambda spec: (
            f"study-{_digest(spec.SerializeToString(deterministic=True))}-{attempt}"))
        if job.status.state not in useless:
            break
    return job


def check_size(plan: Plan, most_meshes: int, cure: str) -> None:
    """Raises CaseError if more meshes would be made than wanted."""
    if plan.meshes > most_meshes:
        raise CaseError(f"{plan.meshes} meshes would be made, more than {most_meshes}; {cure}")


async def run(session: Session, case: Case | str | os.PathLike[str], rows: list[Values],
              path: str | os.PathLike[str] | None, at_once: int, most_meshes: int, retry: bool, told: Told) -> Study:
    if path is not None:
        package("h5py")
    plan = await plan_of(session, case, rows, path, retry, told)
    check_size(plan, most_meshes, f"give most_meshes={plan.meshes} if that is meant")
    return await solve(session, case, plan, path, at_once, retry, told)


def dry_text(plan: Plan) -> str:
    """What a study would do: rows, meshes, what is wrong, the first and the last case."""
    rows = plan.study.rows
    told = [f"{counted(len(rows), 'row')}, {len(rows) - len(plan.left)} of them in the file or refused; "
            f"{counted(plan.meshes, 'mesh').replace('meshs', 'meshes')} for the rest", *map(harmless, plan.notes)]
    told += [f"row {index} is refused: {row.error}" for index, row in enumerate(rows) if row.status == "refused"][:10]
    for which, text, row in zip(("first", "last"), plan.cases, (rows[0], rows[-1])):
        told += [f"# the {which} case: {listed(overrides_of(row.values))}", text.rstrip()]
    return "\n".join(told)

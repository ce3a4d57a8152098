# SPDX-License-Identifier: GPL-3.0-or-later
"""The client that waits for each answer. anticrack.aio has the same with await."""
from __future__ import annotations

import os
import warnings
from collections.abc import Iterator, Sequence
from typing import Any, TextIO

from .arrays import Array
from .case import Case
from .credentials import Credentials, Path, token_of
from .errors import ServerError, of_status
from .notes import notes_on
from .progress import Progress
from .reading import ReadCase, in_terms_of, places_of
from .result import Result
from .retry import Backoff
from .session import ENDED, Session, session_of_own, session_to
from .sweeps import coefficients_of
from .text import harmless
from .transport import Transport, each, finished
from .v1 import mesh_pb2, server_pb2, solve_pb2


class JobState:
    """A job as it was last heard of: `message`, see Job in solve.proto."""

    def __init__(self, session: Session, message: solve_pb2.Job, case: ReadCase | None = None,
                 coefficients: Any = None) -> None:
        self.message = message
        self._session, self._case = session, case
        # As they are now: the array may be used for something else before the answers are there.
        self._coefficients = None if coefficients is None else coefficients_of(
            coefficients, [load.name for load in message.spec.load_cases])

    @property
    def name(self) -> str:
        """"jobs/ID"; client.job(name) finds it again, from any machine."""
        return str(self.message.name)

    @property
    def state(self) -> str:
        """"queued", "waiting_for_mesh", "running", "succeeded", "not_converged", "failed" or "cancelled"."""
        return str(solve_pb2.JobStatus.State.Name(self.message.status.state)).removeprefix("STATE_").lower()

    @property
    def ended(self) -> bool:
        return self.message.status.state in ENDED

    @property
    def error(self) -> ServerError | None:
        """Of one that failed."""
        if not self.message.status.HasField("error"):
            return None
        return in_terms_of(self._case.places if self._case else places_of(self.message.spec),
                           of_status(self.message.status.error))

    async def _result(self) -> Result:
        if self.message.status.result_state != solve_pb2.JobStatus.RESULT_STATE_AVAILABLE:
            raise self.error or ServerError("FAILED_PRECONDITION", f"{self.name} is {self.state} and has no answers")
        result = await self._session.result(self.name, self._case.text if self._case else "")
        if result.sweep is not None and self._coefficients is not None:
            result.sweep.coefficients = self._coefficients
        return result

    def __repr__(self) -> str:
        return f"<{harmless(self.name)}: {self.state}>"


def noted(result: Result) -> Result:
    """Warns of what is to be known, at the line that called run()."""
    for note in notes_on(result):
        warnings.warn(harmless(note), stacklevel=3)
    return result


class Job(JobState):
    """Outlives this program: only cancel() ends it."""

    def refresh(self) -> Job:
        self.message = finished(self._session.job(self.name))
        return self

    def events(self, after: int = 0) -> Iterator[solve_pb2.WatchJobResponse]:
        """Every event after a sequence number, in order, up to the one that ends the job; see WatchJobResponse."""
        for message in each(self._session.events(self.name, after)):
            if message.HasField("ended"):
                self.message = message.ended
            yield message

    def wait(self, progress: bool = True, out: TextIO | None = None) -> Job:
        """Until it has ended; an interrupt leaves it running. progress: shown on `out`, standard error by default."""
        shown = Progress(self.message, out, progress)
        for message in self.events():
            shown.take(message)
        return self

    def cancel(self) -> Job:
        """It ends within an iteration and keeps what is finished."""
        self.message = finished(self._session.cancel(self.name))
        return self

    def delete(self) -> None:
        """One that has ended, and its results."""
        finished(self._session.delete(self.name))

    def result(self, progress: bool = False) -> Result:
        """Once it has ended. Raises ServerError where there are no answers; one that did not converge is not an
        error: see Result.converged."""
        self.refresh()
        if not self.ended:
            self.wait(progress)
        return finished(self._result())


class Client:
    """Of one server; may be used as a context. Raises ServerError where a call is refused."""

    def __init__(self, session: Session) -> None:
        self._session = session

    def __repr__(self) -> str:
        return f"<client of {self._session.address}>"

    def submit(self, case: Case | str | os.PathLike[str], coefficients: Any = None, nodal_forces: Any = None,
               traces: Sequence[int] = (), bounds: bool = False) -> Job:
        """A job of a case, or of a file with one; returns at once.

        A sweep solves a load case for every row of coefficients (rows, loads), a DataFrame or an array in the order of
        the loads, or of nodal_forces (rows, nodes): f on the mesh's nodes. traces: rows whose traces are kept.
        bounds: of the energy and of every A in each row, which then takes as long as a load case."""
        message, read = finished(self._session.submit(case, coefficients, nodal_forces, traces, bounds))
        return Job(self._session, message, read, coefficients)

    def run(self, case: Case | str | os.PathLike[str], coefficients: Any = None, nodal_forces: Any = None,
            traces: Sequence[int] = (), progress: bool = True, bounds: bool = False) -> Result:
        """Submits, waits and fetches the answers; warns where u is not small against the sheet."""
        return noted(self.submit(case, coefficients, nodal_forces, traces, bounds).wait(progress).result())

    def mesh(self, case: Case | str | os.PathLike[str]) -> mesh_pb2.Mesh:
        """The mesh of a case, once it is meshed: its counts, subdomains and interfaces (Mesh in mesh.proto)."""
        return finished(self._session.mesh_of(case))

    def mesh_arrays(self, mesh: mesh_pb2.Mesh | str) -> dict[str, Array]:
        """nodes (n, 2), triangles (m, 3), subdomain (m), boundary (b, 2), interfaces/I/...: see ReadMeshResponse."""
        return finished(self._session.mesh_arrays(mesh if isinstance(mesh, str) else mesh.name))

    def job(self, name: str) -> Job:
        return Job(self._session, finished(self._session.job(name)))

    def jobs(self, limit: int = 50) -> list[Job]:
        """The newest first, without load cases and answers."""
        return [Job(self._session, message) for message in finished(self._session.jobs(limit))]

    def info(self) -> server_pb2.ServerInfo:
        """Version, limits and counters."""
        return finished(self._session.info())

    def close(self) -> None:
        finished(self._session.transport.close())

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def connect(address: str | None = None, *, tls: bool = False, ca: Path | None = None, cert: Path | None = None,
            key: Path | None = None, token: str | None = None, token_file: Path | None = None,
            patience: float = 300.0, first_contact: float = 3.0) -> Client:
    """A client of the server at "HOST:PORT" or "unix:PATH" (ANTICRACK_SERVER, or 127.0.0.1:7433). The first call
    connects.

    tls: with the system's authorities; ca: with this one. cert, key: of this client. token, or its file (or
    ANTICRACK_TOKEN): never sent over a network unencrypted. A lost connection is restored for up to `patience`
    seconds, before the first answer for `first_contact`."""
    return Client(session_to(Transport, address, Credentials(tls, ca, cert, key, token_of(token, token_file)),
                             Backoff(patience, first_contact)))


def local(*flags: str, program: Path | None = None) -> Client:
    """A client of a private server, which ends at the end of `with`, by close(), or when nobody has the client or a job
    of it any more. flags: of anticrackd, as "--threads", "2"; program: that on PATH unless named."""
    return Client(session_of_own(Transport, *flags, program=program))

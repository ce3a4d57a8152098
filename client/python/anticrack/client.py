# SPDX-License-Identifier: GPL-3.0-or-later
"""The client that blocks until each answer is there. anticrack.aio has the same client with await."""
from __future__ import annotations

import os
import warnings
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, TextIO

from .arrays import Array
from .case import Case
from .credentials import Credentials, Path, token_of
from .errors import ServerError, of_status
from .notebook import job_html
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

if TYPE_CHECKING:
    from .study import Study


class JobState:
    """The state of a job when the server last told it: `message`, see Job in solve.proto."""

    def __init__(self, session: Session, message: solve_pb2.Job, case: ReadCase | None = None,
                 coefficients: Any = None) -> None:
        self.message = message
        self._session, self._case = session, case
        # A copy, as the caller may change the array before the answers are there.
        self._coefficients = None if coefficients is None else coefficients_of(
            coefficients, [load.name for load in message.spec.load_cases])

    @property
    def name(self) -> str:
        """"jobs/ID"; client.job(name) finds the job again, from any machine."""
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
        """The error of a failed job, else None."""
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

    def _repr_html_(self) -> str:
        """The HTML that a notebook shows."""
        return job_html(self.message, f"{self.name}: {self.state.replace('_', ' ')}", str(self.error or ""))


def noted(result: Result) -> Result:
    """Issues the notes on a result as warnings, at the line that called run()."""
    for note in notes_on(result):
        warnings.warn(harmless(note), stacklevel=3)
    return result


class Job(JobState):
    """A job on the server. It outlives this program: only cancel() ends it early."""

    def refresh(self) -> Job:
        self.message = finished(self._session.job(self.name))
        return self

    def events(self, after: int = 0) -> Iterator[solve_pb2.WatchJobResponse]:
        """Yields every event after a sequence number in order, up to the job's last event; see WatchJobResponse."""
        for message in each(self._session.events(self.name, after)):
            if message.HasField("ended"):
                self.message = message.ended
            yield message

    def wait(self, progress: bool = True, out: TextIO | None = None) -> Job:
        """Waits until the job has ended; an interrupt leaves it running. progress: show it on `out`, by default
        standard error."""
        shown = Progress(self.message, out, progress)
        for message in self.events():
            shown.take(message)
        return self

    def cancel(self) -> Job:
        """Cancels the job, which ends within an iteration and keeps the load cases that are finished."""
        self.message = finished(self._session.cancel(self.name))
        return self

    def delete(self) -> None:
        """Deletes a job that has ended, with its results."""
        finished(self._session.delete(self.name))

    def result(self, progress: bool = False) -> Result:
        """Waits until the job has ended and returns its answers. Raises ServerError if there are none; an answer that
        did not converge is no error: see Result.converged."""
        self.refresh()
        if not self.ended:
            self.wait(progress)
        return finished(self._result())


class Client:
    """A client of one server; `with` closes it. Raises ServerError if the server refuses a call."""

    def __init__(self, session: Session) -> None:
        self._session = session

    def __repr__(self) -> str:
        return f"<client of {self._session.address}>"

    def submit(self, case: Case | str | os.PathLike[str], coefficients: Any = None, nodal_forces: Any = None,
               traces: Sequence[int] = (), bounds: bool = False, tips: bool = False) -> Job:
        """Submits a case, or the case in a file, as a job and returns at once.

        A sweep solves a load case for every row of coefficients (rows, loads), a DataFrame or an array in the order of
        the loads, or of nodal_forces (rows, nodes): f on the mesh's nodes. traces: rows whose traces are kept. bounds:
        bound the energy and every A in each row, as of a load case. tips: intensity and G of every tip in each row."""
        message, read = finished(self._session.submit(case, coefficients, nodal_forces, traces, bounds, tips))
        return Job(self._session, message, read, coefficients)

    def run(self, case: Case | str | os.PathLike[str], coefficients: Any = None, nodal_forces: Any = None,
            traces: Sequence[int] = (), progress: bool = True, bounds: bool = False, tips: bool = False) -> Result:
        """Submits a case, waits and fetches the answers; warns if u is not small against the sheet."""
        return noted(self.submit(case, coefficients, nodal_forces, traces, bounds, tips).wait(progress).result())

    def study(self, case: Case | str | os.PathLike[str], vary: Any, path: Path | None = None, *, jobs: int = 4,
              progress: bool = True, most_meshes: int = 1000, retry: bool = False) -> Study:
        """Solves a case for all combinations of values of its keys, as {"mesh.size": [0.1, 0.05]}, or for rows: a
        DataFrame with keys as columns, or a list of mappings. Keys are those of --set. jobs: so many at once.

        path: the file of the study, from which a run that was interrupted goes on; retry: also with rows that failed.
        A row that is refused or fails raises nothing, see Row.error. Raises CaseError if all rows are refused, or if
        more than most_meshes meshes would be made."""
        from .study.rows import rows_of
        from .study.run import Told, run
        return finished(run(self._session, case, rows_of(vary), path, jobs, most_meshes, retry, Told(progress)))

    def mesh(self, case: Case | str | os.PathLike[str]) -> mesh_pb2.Mesh:
        """Meshes a case and returns the mesh's counts, subdomains and interfaces (Mesh in mesh.proto)."""
        return finished(self._session.mesh_of(case))

    def mesh_arrays(self, mesh: mesh_pb2.Mesh | str) -> dict[str, Array]:
        """Reads nodes (n, 2), triangles (m, 3), subdomain (m), boundary (b, 2), interfaces/I/..., see ReadMeshResponse,
        by name."""
        return finished(self._session.mesh_arrays(mesh if isinstance(mesh, str) else mesh.name))

    def job(self, name: str) -> Job:
        return Job(self._session, finished(self._session.job(name)))

    def jobs(self, limit: int = 50) -> list[Job]:
        """Lists the server's jobs, newest first, without load cases and answers."""
        return [Job(self._session, message) for message in finished(self._session.jobs(limit))]

    def info(self) -> server_pb2.ServerInfo:
        """The server's version, limits and counters."""
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
    """Makes a client of the server at "HOST:PORT" or "unix:PATH" (default: ANTICRACK_SERVER, or 127.0.0.1:7433). The
    first call connects.

    tls: encrypt and trust the system's authorities; ca: trust this authority. cert, key: those of this client. token,
    or its file (or ANTICRACK_TOKEN): never sent over a network unencrypted. The client tries for up to `patience`
    seconds to restore a lost connection, and for `first_contact` seconds before the first answer."""
    return Client(session_to(Transport, address, Credentials(tls, ca, cert, key, token_of(token, token_file)),
                             Backoff(patience, first_contact)))


def local(*flags: str, program: Path | None = None) -> Client:
    """Starts a private server and makes its client. The server ends at the end of `with`, by close(), or when no
    reference to the client or its jobs is left. flags: of anticrackd, as "--threads", "2"; program: the path of
    anticrackd, by default the one on PATH."""
    return Client(session_of_own(Transport, *flags, program=program))

# SPDX-License-Identifier: GPL-3.0-or-later
"""The work with a server, written once for blocking and asynchronous clients. Calls that lose the connection are
tried again."""
from __future__ import annotations

import contextlib
import functools
import hashlib
import logging
import os
import uuid
from collections.abc import AsyncIterator, Callable, Iterator, Sequence
from typing import Any

from .arrays import Array
from .blocks import BlockReceiver
from .case import Case, as_case
from .credentials import Credentials, Path, address_of
from .errors import CaseError, ServerError, of_status
from .private_server import Server
from .proxies import remark
from .reading import Question, ReadCase, in_terms_of
from .result import Result
from .retry import Backoff
from .sweeps import sweep_of
from .transport import Transport
from .v1 import job_pb2, mesh_pb2, server_pb2, solve_pb2, upload_pb2

LOG = logging.getLogger("anticrack")
CHUNK = 1 << 20
FILES_A_STREAM = 500  # the server takes 1000
TRIES_OF_DAMAGED_DATA = 3
ENDED = (solve_pb2.JobStatus.STATE_SUCCEEDED, solve_pb2.JobStatus.STATE_NOT_CONVERGED,
         solve_pb2.JobStatus.STATE_FAILED, solve_pb2.JobStatus.STATE_CANCELLED)


class Session:
    def __init__(self, transport: Transport, address: str, backoff: Backoff) -> None:
        self.transport, self.address, self.backoff = transport, address, backoff

    async def _wait(self, backoff: Backoff, error: ServerError) -> None:
        """Waits until the next try. Raises `error` to give up; if the connection was lost, its message has the cure."""
        if error.lost:
            self.transport.require_alive()
        try:
            first = not backoff.failing
            delay = backoff.next(error)
            if first and self.backoff.met:
                LOG.warning("server %s: %s; trying again for up to %g s", self.address, error, backoff.patience)
        except ServerError:
            if not error.lost or error.reason:
                raise
            cure = ("is it anticrackd, and does it want TLS (ca, cert, key)? anticrack.local() starts a private one"
                    if self.transport.proxy is None else remark(self.transport.proxy))
            raise ServerError(error.code, f"cannot reach the server at {self.address} ({error}); {cure}") from None
        await self.transport.sleep(delay)

    def _succeeded(self, backoff: Backoff) -> None:
        backoff.succeeded()
        self.backoff.met = True

    async def _tried(self, call: Callable[..., Any], *arguments: Any, deletes: bool = False) -> Any:
        """Calls until there is an answer. deletes: NOT_FOUND after a lost answer means success and returns None."""
        backoff, lost = self.backoff.fresh(), False
        while True:
            try:
                response = await call(*arguments)
            except ServerError as error:
                if deletes and lost and error.code == "NOT_FOUND":
                    return None
                lost = lost or error.lost
                await self._wait(backoff, error)
            else:
                self._succeeded(backoff)
                return response

    async def call(self, method: Any, request: Any) -> Any:
        return await self._tried(self.transport.unary, method, request)

    async def events(self, name: str, after: int = 0) -> AsyncIterator[solve_pb2.WatchJobResponse]:
        """Yields every event of a job after a sequence number, in order and once each, up to the job's last one. When a
        connection was lost, goes on after the last event, or from the earliest if the server has dropped that one."""
        backoff = self.backoff.fresh()
        while True:
            lost = ServerError("UNAVAILABLE", "the server closed the stream early")
            stream = self.transport.stream(self.transport.jobs.WatchJob,
                                           solve_pb2.WatchJobRequest(name=name, after_sequence=after))
            try:
                async for message in stream:
                    self._succeeded(backoff)
                    numbered = message.WhichOneof("event") not in ("snapshot", "heartbeat")
                    if numbered and message.sequence <= after:
                        continue
                    after = message.sequence if numbered else after
                    yield message
                    if message.HasField("ended"):
                        return
            except ServerError as error:
                if error.code == "OUT_OF_RANGE" and after:
                    LOG.warning("events of %s after number %d are gone; starting again from the earliest", name,
                                after)
                    after = 0
                    continue
                lost = error
            finally:
                await stream.aclose()  # type: ignore[attr-defined]
            await self._wait(backoff, lost)

    async def block(self, method: Any, request_type: Callable[..., Any], name: str) -> dict[str, Array]:
        """Reads the arrays that a method streams; goes on where it was after a lost connection."""
        backoff, receiver, damaged = self.backoff.fresh(), BlockReceiver(), 0
        while True:
            lost = ServerError("UNAVAILABLE", "the server closed the stream early")
            try:
                async for message in self.transport.stream(method, request_type(name=name, offset=receiver.offset)):
                    self._succeeded(backoff)
                    receiver.accept(message)
                if receiver.complete:
                    return receiver.finish()
            except ServerError as error:
                lost = error
                if error.code == "DATA_LOSS":
                    damaged += 1
                    if damaged == TRIES_OF_DAMAGED_DATA:
                        raise
                    receiver = BlockReceiver()
                    continue
            await self._wait(backoff, lost)

    async def upload(self, contents: Sequence[bytes], kind: upload_pb2.Upload.Kind) -> list[str]:
        """Uploads contents and returns their names."""
        names: list[str] = []
        for begin in range(0, len(contents), FILES_A_STREAM):
            parts = functools.partial(_parts, contents[begin:begin + FILES_A_STREAM], kind)
            names += [made.name for made in (await self._tried(self.transport.upload, parts)).uploads]
        return names

    async def read(self, case: Case | str | os.PathLike[str], loads_optional: bool = False,
                   overrides: Sequence[str] = ()) -> ReadCase:
        """Has the server read a case, with overrides as of --set. Raises CaseError if the case is wrong."""
        question = Question(as_case(case), loads_optional, overrides)
        size = question.request.ByteSize()
        if size >= CHUNK and size > (most := (await self.info()).limits.message_bytes):
            raise CaseError(f"{question.case.source or 'the case'}: its {size / 1e6:.3g} MB are more than the server "
                            f"takes, {most / 1e6:.3g} MB; write fewer points, or the mesh in a .msh file")
        try:
            return ReadCase(question, await self.call(self.transport.cases.ReadCase, question.request))
        except ServerError as error:
            if error.reason != "CASE_INVALID":
                raise
            raise CaseError(error.message) from None

    async def _create_mesh(self, case: ReadCase) -> mesh_pb2.Mesh:
        msh = case.msh()
        if msh is not None:
            case.mesh.upload = (await self.upload([msh], upload_pb2.Upload.KIND_MSH))[0]
        return await self.call(self.transport.meshes.CreateMesh, case.mesh)  # type: ignore[no-any-return]

    async def mesh_of(self, case: Case | str | os.PathLike[str]) -> mesh_pb2.Mesh:
        """Returns the mesh of a case once it is meshed. Raises ServerError if it cannot be meshed."""
        read = await self.read(case, loads_optional=True)
        with _in_terms_of(read):
            mesh = await self._create_mesh(read)
            read.warn()
            mesh = await self.mesh(mesh.name)
            if mesh.HasField("error"):
                raise of_status(mesh.error)
        return mesh

    async def submit(self, case: Case | str | os.PathLike[str], coefficients: Any = None, nodal_forces: Any = None,
                     traces: Sequence[int] = (), bounds: bool = False,
                     tips: bool = False) -> tuple[solve_pb2.Job, ReadCase]:
        read = await self.read(case, nodal_forces is not None)
        if coefficients is not None or nodal_forces is not None:
            read.leave_out_accuracy()
        with _in_terms_of(read):
            matrix = sweep_of(read.spec, coefficients, nodal_forces, traces, bounds, tips)
            if matrix is not None:
                sweep = read.spec.sweep
                target = sweep.coefficients if coefficients is not None else sweep.nodal_forces
                target.upload = (await self.upload([matrix], upload_pb2.Upload.KIND_ARRAY))[0]
        created = await self.create(read, lambda spec: str(uuid.uuid4()))
        read.warn()
        return created, read

    async def create(self, read: ReadCase, identify: Callable[[job_pb2.JobSpec], str]) -> solve_pb2.Job:
        """Uploads the files of a case, asks for its mesh, and creates its job or finds the one that has its id.
        identify: the request id of a job that asks for this."""
        arrays = read.arrays()
        with _in_terms_of(read):
            names = await self.upload([values.tobytes() for _, values in arrays], upload_pb2.Upload.KIND_ARRAY)
            for (index, _), name in zip(arrays, names):
                read.spec.load_cases[index].force.array.upload = name
            read.mesh.for_job = True
            read.spec.mesh = (await self._create_mesh(read)).name
            request = solve_pb2.CreateJobRequest(spec=read.spec, request_id=identify(read.spec))
            return await self.call(self.transport.jobs.CreateJob, request)  # type: ignore[no-any-return]

    async def mesh(self, name: str) -> mesh_pb2.Mesh:
        """Returns a mesh once it is meshed or has failed."""
        pause = 0.02
        while True:
            mesh = await self.call(self.transport.meshes.GetMesh, mesh_pb2.GetMeshRequest(name=name))
            if mesh.state == mesh_pb2.Mesh.STATE_FAILED or mesh.sha256:
                return mesh  # type: ignore[no-any-return]
            await self.transport.sleep(pause)
            pause = min(1.5 * pause, 0.5)

    async def mesh_arrays(self, name: str) -> dict[str, Array]:
        return await self.block(self.transport.meshes.ReadMesh, mesh_pb2.ReadMeshRequest, name)

    async def job(self, name: str) -> solve_pb2.Job:
        return await self.call(self.transport.jobs.GetJob, solve_pb2.GetJobRequest(name=name))  # type: ignore

    async def jobs(self, limit: int) -> list[solve_pb2.Job]:
        """The newest jobs, without load cases and answers."""
        found: list[solve_pb2.Job] = []
        request = solve_pb2.ListJobsRequest()
        while len(found) < limit:
            request.page_size = min(limit - len(found), 1000)
            page = await self.call(self.transport.jobs.ListJobs, request)
            found.extend(page.jobs)
            request.page_token = page.next_page_token
            if not page.next_page_token:
                break
        return found

    async def cancel(self, name: str) -> solve_pb2.Job:
        return await self.call(self.transport.jobs.CancelJob, solve_pb2.CancelJobRequest(name=name))  # type: ignore

    async def delete(self, name: str) -> None:
        await self._tried(self.transport.unary, self.transport.jobs.DeleteJob, solve_pb2.DeleteJobRequest(name=name),
                          deletes=True)

    async def info(self) -> server_pb2.ServerInfo:
        return await self.call(self.transport.server.GetServerInfo, server_pb2.GetServerInfoRequest())  # type: ignore

    async def result(self, name: str, case_text: str = "") -> Result:
        """Reads the result of a job that has ended."""
        job = await self.job(name)
        stages = [stage.mesh for stage in job.status.stages if stage.answers]
        mesh = await self.mesh(stages[-1] if stages else job.spec.mesh)
        arrays = await self.block(self.transport.jobs.ReadResult, solve_pb2.ReadResultRequest, name)
        mesh_arrays, info = await self.mesh_arrays(mesh.name), await self.info()
        return Result.of_job(job, mesh, mesh_arrays, arrays, case_text, info.version)


@contextlib.contextmanager
def _in_terms_of(case: ReadCase) -> Iterator[None]:
    """Inside the context, errors of the server are raised with the case's keys."""
    try:
        yield
    except ServerError as error:
        raise in_terms_of(case.places, error) from None


def _parts(contents: Sequence[bytes], kind: upload_pb2.Upload.Kind) -> Iterator[upload_pb2.CreateUploadsRequest]:
    for content in contents:
        yield upload_pb2.CreateUploadsRequest(header=upload_pb2.CreateUploadsRequest.Header(
            size=len(content), sha256=hashlib.sha256(content).hexdigest(), kind=kind))
        for begin in range(0, len(content), CHUNK):
            yield upload_pb2.CreateUploadsRequest(chunk=content[begin:begin + CHUNK])


def session_to(transport: type[Transport], address: str | None, credentials: Credentials, backoff: Backoff) -> Session:
    address = address_of(address)
    return Session(transport(address, credentials), address, backoff)


def session_of_own(transport: type[Transport], *flags: str, program: Path | None) -> Session:
    """Makes a session with a private server."""
    server = Server(*flags, program=program)
    return Session(transport(server.address, Credentials(), server), server.address, Backoff(300.0, 3.0))

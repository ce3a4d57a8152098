# SPDX-License-Identifier: GPL-3.0-or-later
"""What the client makes of a server that loses connections, trims its events and damages data: one that is played."""
import hashlib
import unittest
import unittest.mock

import numpy

from anticrack.errors import ServerError
from anticrack.retry import Backoff
from anticrack.session import Session
from anticrack.transport import each, finished
from anticrack.v1 import case_pb2, job_pb2, mesh_pb2, solve_pb2

LOST = ServerError("UNAVAILABLE", "Socket closed")
BUSY = ServerError("RESOURCE_EXHAUSTED", "busy", retry_delay=0.5)
VALUES = numpy.arange(6.0)
BLOCK = VALUES.tobytes()


class Played:
    """A transport whose answers are a script: an error to raise, or what to return or stream; requests are noted."""

    def __init__(self, *script):
        self.script, self.requests, self.slept = list(script), [], []
        self.cases = self.jobs = self.meshes = unittest.mock.MagicMock()
        self.proxy = None

    def require_alive(self):
        """It is no private server."""

    def next(self, request):
        self.requests.append(request)
        return self.script.pop(0)

    async def unary(self, _, request):
        answer = self.next(request)
        if isinstance(answer, ServerError):
            raise answer
        return answer

    async def upload(self, parts):
        return await self.unary(None, list(parts()))

    async def stream(self, _, request):
        for message in self.next(request):
            if isinstance(message, ServerError):
                raise message
            yield message

    async def sleep(self, seconds):
        self.slept.append(seconds)


def session(*script, patience=300.0):
    played = Played(*script)
    return Session(played, "host:1", Backoff(patience, 3.0)), played


def phase(sequence):
    return solve_pb2.WatchJobResponse(sequence=sequence, phase={"detail": str(sequence)})


def snapshot(sequence):
    return solve_pb2.WatchJobResponse(sequence=sequence, snapshot={})


def ended(sequence):
    return solve_pb2.WatchJobResponse(sequence=sequence, ended={"name": "jobs/1"})


def layout(sha256=hashlib.sha256(BLOCK).hexdigest(), **options):
    array = {"name": "values", "type": mesh_pb2.ArrayLayout.TYPE_FLOAT64, "shape": [2, 3], "offset": 0}
    return mesh_pb2.ReadMeshResponse(layout={"size": len(BLOCK), "sha256": sha256, "arrays": [array],
                                             "array_count": 1, **options})


def chunk(begin, end, data=BLOCK):
    return mesh_pb2.ReadMeshResponse(chunk={"offset": begin, "data": data[begin:end]})


class Calls(unittest.TestCase):
    def test_lost_and_busy_ones_are_tried_again(self):
        ours, played = session(LOST, LOST, BUSY, solve_pb2.Job(name="jobs/1"))
        self.assertEqual(finished(ours.job("jobs/1")).name, "jobs/1")
        self.assertEqual(len(played.requests), 4)
        self.assertEqual(played.requests[0], played.requests[3])
        self.assertGreaterEqual(played.slept[2], 0.5)
        self.assertTrue(all(0 < seconds <= 1 for seconds in played.slept))

    def test_others_stand(self):
        ours, played = session(ServerError("NOT_FOUND", "no such job"))
        with self.assertRaisesRegex(ServerError, "^no such job$"):
            finished(ours.job("jobs/1"))
        self.assertEqual(played.slept, [])

    def test_patience_ends(self):
        ours, _ = session(LOST, patience=0)
        ours.backoff.met = True
        with self.assertRaisesRegex(ServerError, r"cannot reach the server at host:1 \(Socket closed\)"):
            finished(ours.job("jobs/1"))

    def test_a_job_keeps_its_request_id(self):
        from anticrack import Case, Geometry, Load
        ours, played = session(case_pb2.ReadCaseResponse(), mesh_pb2.Mesh(name="meshes/1"), LOST, solve_pb2.Job())
        finished(ours.submit(Case(Geometry([(0, 0), (1, 0), (0, 1)]), [Load("a", 1)])))
        self.assertEqual(played.requests[2], played.requests[3])
        self.assertTrue(played.requests[2].request_id)
        self.assertEqual(played.requests[2].spec.mesh, "meshes/1")

    def test_keys_of_a_newer_server_pass_through(self):
        from anticrack import Case
        newer = b"\xb8\xa6\x02\x01"  # field 4711 is 1
        read = case_pb2.ReadCaseResponse(mesh=mesh_pb2.CreateMeshRequest.FromString(newer),
                                         spec=job_pb2.JobSpec.FromString(newer))
        ours, played = session(read, mesh_pb2.Mesh(name="meshes/1"), solve_pb2.Job())
        finished(ours.submit(Case.parse("key-of-tomorrow = 1")))
        self.assertEqual(played.requests[0].toml, b"key-of-tomorrow = 1")
        self.assertIn(newer, played.requests[1].SerializeToString())
        self.assertIn(newer, played.requests[2].spec.SerializeToString())

    def test_what_is_gone_is_deleted(self):
        gone = ServerError("NOT_FOUND", "no such job")
        ours, _ = session(LOST, gone)
        finished(ours.delete("jobs/1"))  # the answer to the first try was lost
        ours, _ = session(gone)
        with self.assertRaises(ServerError):
            finished(ours.delete("jobs/1"))


class Watches(unittest.TestCase):
    def watch(self, *script):
        ours, played = session(*script)
        seen = [(message.sequence, message.WhichOneof("event")) for message in each(ours.events("jobs/1"))]
        return seen, [request.after_sequence for request in played.requests]

    def test_go_on_behind_the_last_event(self):
        seen, asked = self.watch([snapshot(0), phase(1), phase(2), LOST], [snapshot(2), phase(2), phase(3)],
                                 [snapshot(3), ended(4)])
        self.assertEqual(seen, [(0, "snapshot"), (1, "phase"), (2, "phase"), (2, "snapshot"), (3, "phase"),
                                (3, "snapshot"), (4, "ended")])
        self.assertEqual(asked, [0, 2, 3])

    def test_start_again_where_events_were_trimmed(self):
        trimmed = ServerError("OUT_OF_RANGE", "trimmed", "SEQUENCE_TRIMMED")
        with self.assertLogs("anticrack", "WARNING") as said:
            seen, asked = self.watch([phase(5), LOST], [trimmed], [snapshot(9), phase(7), ended(9)])
        self.assertIn("events of jobs/1 after number 5 are gone", said.output[-1])
        self.assertEqual([number for number, _ in seen], [5, 9, 7, 9])
        self.assertEqual(asked, [0, 5, 0])

    def test_end_with_what_the_server_refuses(self):
        with self.assertRaisesRegex(ServerError, "no such job"):
            self.watch([phase(1), ServerError("NOT_FOUND", "no such job")])


class Blocks(unittest.TestCase):
    def read(self, *script):
        ours, played = session(*script)
        return finished(ours.mesh_arrays("meshes/1")), [request.offset for request in played.requests]

    def test_go_on_where_they_were(self):
        arrays, asked = self.read([layout(), chunk(0, 16), LOST], [layout(), chunk(16, 48)])
        self.assertEqual(arrays["values"].tolist(), VALUES.reshape(2, 3).tolist())
        self.assertEqual(asked, [0, 16])

    def test_damaged_ones_are_read_again_three_times(self):
        damaged = [layout(), chunk(0, 48, bytes(48))]
        arrays, asked = self.read(damaged, [layout(), chunk(0, 16), chunk(20, 48)], [layout(), chunk(0, 48)])
        self.assertEqual(arrays["values"][1, 2], 5)
        self.assertEqual(asked, [0, 0, 0])
        with self.assertRaisesRegex(ServerError, "sha256 is wrong"):
            self.read(damaged, damaged, damaged)


class Uploads(unittest.TestCase):
    def test_are_sent_in_pieces_and_again_when_lost(self):
        from anticrack.v1 import upload_pb2
        answer = upload_pb2.CreateUploadsResponse(uploads=[{"name": "uploads/1"}])
        ours, played = session(LOST, answer)
        content = bytes(5 * 2**18)
        self.assertEqual(finished(ours.upload([content], upload_pb2.Upload.KIND_ARRAY)), ["uploads/1"])
        header, first, second = played.requests[1]
        self.assertEqual((header.header.size, len(first.chunk), len(second.chunk)), (5 * 2**18, 2**20, 2**18))
        self.assertEqual(played.requests[0], played.requests[1])

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes a mesh, submits a job, watches it and prints its answers, with nothing but the API's proto files.

    python3 submit_job.py [HOST:PORT]        default: $ANTICRACK_SERVER, or localhost:7433

Takes grpcio and, to make the API's Python modules from proto/ when it starts, protoc with its plugin for Python
(Debian: python3-grpcio, protobuf-compiler, protobuf-compiler-grpc). A grpcio-tools of 2020 or later does as well:
`python3 -m grpc_tools.protoc` in the place of `protoc`; Debian's python3-grpc-tools is older and cannot read
`optional` fields.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import uuid

import grpc

# In the project's folder, or in /usr/share/anticrack.
PROTO = next(folder / "proto" for folder in pathlib.Path(__file__).resolve().parents if (folder / "proto").is_dir())


def api():
    """The modules of the API: messages and services of meshes, and of jobs."""
    plugin = shutil.which("grpc_python_plugin")
    with tempfile.TemporaryDirectory(prefix="anticrack-python-") as made:
        subprocess.run(["protoc", f"--plugin=protoc-gen-grpc_python={plugin}", f"-I{PROTO}", f"--python_out={made}",
                        f"--grpc_python_out={made}", *PROTO.glob("anticrack/v1/*.proto")], check=True)
        sys.path.insert(0, made)
        from anticrack.v1 import mesh_pb2, mesh_pb2_grpc, solve_pb2, solve_pb2_grpc
        return mesh_pb2, mesh_pb2_grpc, solve_pb2, solve_pb2_grpc


def membrane(messages):
    """The paper's: a square, cut at y = 0, with a delaminated rigid inclusion from -0.5 to 0.5."""
    def points(*coordinates):
        return [messages.Point(x=x, y=y) for x, y in coordinates]

    geometry = messages.Geometry(boundary=points((-1, -1), (1, -1), (1, 1), (-1, 1)))
    interface = geometry.interfaces.add(name="sigma")
    interface.polyline.points.extend(points((-1, 0), (1, 0)))
    fibre = geometry.inclusions.add(name="fibre", delaminated=True)
    begin, end = points((-0.5, 0), (0.5, 0))
    fibre.part.CopyFrom(messages.InterfacePart(**{"from": begin, "to": end}))  # from is a word of Python's
    return geometry


def main(address=os.environ.get("ANTICRACK_SERVER", "localhost:7433")):
    mesh_pb2, mesh_pb2_grpc, solve_pb2, solve_pb2_grpc = api()
    with grpc.insecure_channel(address) as channel:
        meshes, jobs = mesh_pb2_grpc.MeshServiceStub(channel), solve_pb2_grpc.SolveServiceStub(channel)
        mesh = meshes.CreateMesh(mesh_pb2.CreateMeshRequest(geometry=membrane(mesh_pb2)))
        job = solve_pb2.Job(title="from Python", mesh=mesh.name)
        for name, force in [("opening", "y > 0 ? 1 : -1"), ("skew", "x * y > 0 ? 1 : -1")]:
            job.load_cases.add(name=name).force.expression = force
        # The same request again, after a lost answer say, gives the same job: nothing is computed twice.
        job = jobs.CreateJob(solve_pb2.CreateJobRequest(job=job, request_id=str(uuid.uuid4())))
        print(f"{job.name} on {mesh.name}")
        for message in jobs.WatchJob(solve_pb2.WatchJobRequest(name=job.name)):
            event = message.WhichOneof("event")
            if event == "phase":
                print(message.phase.detail or solve_pb2.Job.State.Name(message.phase.state))
            elif event == "samples":
                samples = message.samples
                print(f"iteration {samples.iteration[-1]}: criterion {samples.criterion[-1]:.3g}, "
                      f"{samples.contact_count[-1]} crack nodes in contact")
            elif event == "ended":
                job = message.ended
        for answer in job.answers:
            moved = ", ".join(f"A of {inclusion.name} = {inclusion.displacement:.6g}" for inclusion in answer.inclusions)
            print(f"{answer.name}: {solve_pb2.LoadCaseAnswer.Status.Name(answer.status)}, energy {answer.energy:.6g}, {moved}")
            if answer.reason:
                print(f"  {answer.reason}")
        if job.HasField("error"):
            print(f"{job.name}: {job.error.message}", file=sys.stderr)
        # As anticrack: 3 if the answers are there and some did not converge.
        exit_codes = {solve_pb2.Job.STATE_SUCCEEDED: 0, solve_pb2.Job.STATE_NOT_CONVERGED: 3}
        return exit_codes.get(job.state, 1)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

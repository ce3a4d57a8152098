# SPDX-License-Identifier: GPL-3.0-or-later
"""What is measured, a function a group: each takes a Session and returns figures."""
import json
import os

from harness import numbers
from harness.programs import freefem

# Orderings of MUMPS that won somewhere (ICNTL(7)): AMF, Scotch, METIS, its own choice.
ORDERINGS = (2, 3, 5, 7)
HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


class Session:
    """One run: its sizes, its programs, and what several groups need."""

    def __init__(self, programs, folder, sizes, repetitions, clock):
        self.programs = programs
        self.folder = folder
        self.sizes = sizes
        self.repetitions = repetitions
        self.clock = clock
        self._meshes = {}
        self._ours = {}

    def mesh(self, name):
        """Path of a mesh, made when first asked for."""
        if name not in self._meshes:
            preset, _, triangles = name.partition("-")
            what = ["--" + preset] + ([triangles] if triangles else [])
            made = self.programs.figures("bench_meshes", [
                "--helper", self.programs.path("anticrack-mesher", "build the whole project"),
                "--folder", self.folder] + what)
            self._meshes[name] = made["meshes"][0]
        return os.path.join(self.folder, name + ".mesh")

    def mesh_figures(self, name):
        self.mesh(name)
        return self._meshes[name]

    def often(self, name):
        """Repetitions on a mesh: what takes milliseconds is at the mercy of a single interruption."""
        return self.repetitions * self.sizes.often.get(name, 1)

    def ours(self, name, threads=1):
        """bench_ours on a mesh; once a run, so that all ratios have the same figures."""
        key = (name, threads)
        # A row of a large mesh takes milliseconds: as many as on the first would take minutes.
        rows = self.sizes.rows if name == self.sizes.meshes[0] else min(self.sizes.rows, 300)
        if key not in self._ours:
            self._ours[key] = self.programs.figures("bench_ours", [
                "--mesh", self.mesh(name), "--threads", threads, "--repetitions", self.often(name),
                "--loads", self.often(name), "--rows", rows])
        return self._ours[key]


def meshes(session):
    return {name: session.mesh_figures(name) for name in session.sizes.meshes}


def orderings(session):
    return {name: session.programs.figures("bench_orderings", [
        "--mesh", session.mesh(name), "--repetitions", session.repetitions])
            for name in session.sizes.meshes}


def kernels(session):
    program = session.programs.path("bench_kernels", "install Debian's libbenchmark-dev")
    text = session.programs.run([
        program, "--mesh=" + session.mesh(session.sizes.meshes[0]), "--benchmark_format=json",
        f"--benchmark_repetitions={session.repetitions}",
        f"--benchmark_min_time={session.sizes.kernel_seconds}"])
    result = {}
    field = {"wall": "real_time", "cpu": "cpu_time"}[session.clock]
    for run in json.loads(text)["benchmarks"]:
        if run.get("aggregate_name") == "median":
            nanoseconds = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}[run["time_unit"]]
            items = run.get("items_per_second")
            result[run["run_name"]] = {"seconds": run[field] * nanoseconds * 1e-9,
                                       "items_per_second": items}
    return result


def ours(session):
    return {name: {str(threads): session.ours(name, threads) for threads in session.sizes.threads}
            for name in session.sizes.meshes}


def peer_freefem(session):
    """Algorithm 2 with the same theta, loads and stop as ours: the same iterates. On the first mesh
    only: FreeFEM++ cannot read a mesh graded down to 1e-13."""
    program = freefem()
    name = session.sizes.meshes[0]
    star = session.programs.figures("bench_ours", [
        "--mesh", session.mesh(name), "--repetitions", 1, "--loads", 1, "--block", 0,
        "--uzawa-loads", 1])["uzawa"]["theta_star"]
    theta = round(0.97 * star, 3)
    own = session.programs.figures("bench_ours", [
        "--mesh", session.mesh(name), "--repetitions", 1, "--loads", 1, "--block", 0,
        "--uzawa-loads", session.repetitions, "--theta", theta])["uzawa"]
    folder = os.path.join(session.folder, "freefem")
    session.programs.run([
        session.programs.path("bench_freefem_input", "build the whole project"), "--mesh",
        session.mesh(name), "--folder", folder, "--theta", str(theta), "--loads",
        str(session.repetitions)])
    session.programs.run([program, "-nw", "-v", "0", os.path.join(HERE, "peers", "algorithm2.edp"),
                          folder])
    with open(os.path.join(folder, "answers.txt"), encoding="ascii") as file:
        preparing, *lines = file.read().splitlines()
    answers = {"displacement": [float(line.split()[0]) for line in lines],
               "energy": [float(line.split()[1]) for line in lines],
               "iterations": [int(line.split()[2]) for line in lines]}
    seconds = [float(line.split()[3]) for line in lines]
    iterations = [t / n for t, n in zip(seconds, answers["iterations"])]
    return dict(answers, mesh=name, theta=theta, ours=own,
                preparing=float(preparing),
                per_load={"wall": seconds, "cpu": seconds},  # it has a clock of CPU time only
                per_iteration={"wall": iterations, "cpu": iterations},
                difference=numbers.require_agreement("FreeFEM++", own, answers))


def peer_petsc(session):
    result = {}
    for name in session.sizes.meshes:
        own = session.ours(name)
        result[name] = {}
        ways = [("schur", ordering) for ordering in ORDERINGS]
        ways += [(method, 0) for method in ("snesvi", "tron") if name in session.sizes.slow_peers]
        for method, ordering in ways:
            figures = session.programs.figures("bench_petsc", [
                "--mesh", session.mesh(name), "--method", method, "--ordering", ordering,
                "--repetitions", session.often(name), "--loads", session.often(name)],
                cure="install Debian's petsc-dev and configure again")
            label = f"{method}-{ordering}" if method == "schur" else method
            figures["difference"] = numbers.require_agreement(f"PETSc {label} on {name}", own, figures)
            result[name][label] = figures
    return result


def limits(session):
    return session.programs.figures("bench_limits", [
        "--mesh", session.mesh(session.sizes.meshes[-1]), "--repetitions", 3 * session.repetitions,
        "--threads", max(session.sizes.threads)] + session.sizes.limits)


def growth(session):
    """A process a mesh, so that its largest memory is its own."""
    result = []
    for triangles in session.sizes.growth:
        name = f"graded-{triangles}"
        figures = session.programs.figures("bench_ours", [
            "--mesh", session.mesh(name), "--threads", max(session.sizes.threads), "--repetitions",
            session.repetitions, "--loads", session.repetitions, "--uzawa-loads", 1, "--most",
            session.sizes.most_iterations])
        result.append(dict(figures, name=name, made=session.mesh_figures(name)))
    return {"runs": result, "exponents": exponents(result, session.clock)}


def exponents(runs, clock):
    """Of what grows, over the unknowns."""
    series = {
        "meshing, s": lambda r: numbers.median(r["made"]["meshing"], "wall"),  # by the helper
        "cut, s": lambda r: numbers.median(r["cut"], clock),
        "factorise, s": lambda r: numbers.median(r["factorise"], clock),
        "first answer, s": lambda r: numbers.median(r["first"], clock),
        "further load, s": lambda r: numbers.median(r["further"], clock),
        "further load in a block, s": lambda r: numbers.median(r["block"]["per_load"], clock),
        "largest memory, bytes": lambda r: r["memory_peak"],
        "largest memory of the mesher, bytes": lambda r: r["made"]["helper_memory"],
        "operators, bytes": lambda r: r["operator_bytes"],
        "steps of the active set": lambda r: sorted(r["iterations"])[len(r["iterations"]) // 2],
        "iterations of Algorithm 2": lambda r: r["uzawa"]["iterations"][0],
    }
    unknowns = [r["unknowns"] for r in runs]
    result = {}
    for what, value in series.items():
        values = [value(r) for r in runs]
        result[what] = {"values": values, "exponent": numbers.exponent(unknowns, values)}
    return result


def service(session):
    figures = session.programs.figures("bench_service", session.sizes.service + [
        "--repetitions", session.repetitions],
        cure="configure with ANTICRACK_SERVICE=ON")
    # The same mesh and the same kind of load.
    ours = session.ours(session.sizes.meshes[0])
    return dict(figures, in_process=ours["further"], in_process_block=ours["block"]["per_load"])


GROUPS = {"meshes": meshes, "orderings": orderings, "kernels": kernels, "ours": ours, "freefem": peer_freefem,
          "petsc": peer_petsc, "limits": limits, "service": service, "growth": growth}

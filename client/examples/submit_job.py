#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Submits a job made of Python objects, watches it and prints its answers.

    python3 submit_job.py [HOST:PORT]        default: $ANTICRACK_SERVER, or 127.0.0.1:7433

Takes the Python package anticrack (python3-anticrack).
"""
import sys

import anticrack
from anticrack import Case, Geometry, Inclusion, Interface, Load

# The paper's membrane: a square, cut at y = 0, with a delaminated rigid inclusion from -0.5 to 0.5.
geometry = Geometry(boundary=[(-1, -1), (1, -1), (1, 1), (-1, 1)],
                    interfaces=[Interface([(-1, 0), (1, 0)], name="sigma")],
                    inclusions=[Inclusion("fibre", (-0.5, 0), (0.5, 0), delaminated=True)])
case = Case(geometry, [Load("opening", "y > 0 ? 1 : -1"), Load("skew", "x * y > 0 ? 1 : -1")], title="from Python")


def main(address: str | None = None) -> int:
    with anticrack.connect(address) as client:
        job = client.submit(case)
        print(f"{job.name} on {job.message.spec.mesh}")
        result = job.wait().result()  # an interrupt leaves the job running: client.job(name) finds it again
    for load in result.loads.values():
        moved = ", ".join(f"A of {name} = {a:.6g}" for name, a in load.displacements().items())
        print(f"{load.name}: {load.status}, energy {load.energy:.6g}, {moved}")
        if load.reason:
            print(f"  {load.reason}")
    return 0 if result.converged else 3  # as anticrack


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

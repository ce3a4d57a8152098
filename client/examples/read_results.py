#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a result file: prints the answers of its load cases and draws the displacements of one.

    python3 read_results.py opening.h5                       the answers
    python3 read_results.py opening.h5 opening.png           and the first load case, drawn
    python3 read_results.py opening.h5 opening.png example-3 a certain one

Takes the Python package anticrack (python3-anticrack) and, to draw, matplotlib (python3-matplotlib).
"""
import sys

import anticrack


def main(path: str, picture: str | None = None, name: str | None = None) -> None:
    result = anticrack.read(path)
    for load in result.loads.values():
        moved = "".join(f", A of {inclusion} = {a:.6g}" for inclusion, a in load.displacements().items())
        print(f"{load.name}: {load.status}, energy {load.energy:.6g}{moved}")
        if load.stages:
            count, width = load.stages["triangles"], load.stages["energy_upper"] - load.stages["energy_lower"]
            print(f"  {len(count)} stages, {count[0]} to {count[-1]} triangles: bounds of the energy {width[0]:.2g} "
                  f"to {width[-1]:.2g} apart")
    if picture is not None:
        import matplotlib
        matplotlib.use("Agg")  # no screen is needed
        anticrack.draw.traces(result, name).figure.savefig(picture, dpi=150)


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])

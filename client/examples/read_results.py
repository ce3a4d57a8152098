#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a result file: prints the answers of its load cases and draws the displacements of one.

    python3 read_results.py opening.h5                       the answers
    python3 read_results.py opening.h5 opening.png           and the first load case, drawn
    python3 read_results.py opening.h5 opening.png example-3 a certain one

Takes h5py and, to draw, matplotlib (Debian: python3-h5py, python3-matplotlib).
"""
import sys

import h5py


def answers(file):
    """One line for each load case: what was asked, whether it was solved, A and the energy."""
    for name, load in file["loads"].items():
        inclusions = zip(load["inclusions/name"].asstr(), load["inclusions/A"])
        moved = ", ".join(f"A of {inclusion} = {a:.6g}" for inclusion, a in inclusions)
        print(f"{name}: {load.attrs['status']}, energy {load.attrs['energy']:.6g}{', ' if moved else ''}{moved}")
        if "stages" in load:
            stages = load["stages"]
            count, width = stages["triangles"][:], stages["energy_upper"][:] - stages["energy_lower"][:]
            print(f"  {len(count)} stages, {count[0]} to {count[-1]} triangles: bounds of the energy {width[0]:.2g} "
                  f"to {width[-1]:.2g} apart")


def draw(file, name, path):
    """u-, u+ and the jump along every interface; contact is shaded, inclusions are bars with their names."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    traces = file[f"loads/{name}/traces"]
    inclusions = file["mesh/inclusions"].asstr()[:]
    figure, panels = pyplot.subplots(len(traces), squeeze=False, figsize=(7, 3.5 * len(traces)), layout="constrained")
    for (interface, trace), (panel,) in zip(traces.items(), panels):
        s = file[f"interfaces/{interface}/s"][:]
        panel.plot(s, trace["u_minus"][:], label="$u^-$")
        panel.plot(s, trace["u_plus"][:], "--", label="$u^+$")
        panel.plot(s, trace["jump"][:], ":", color="black", label="$[u] = u^+ - u^-$")
        low, high = panel.get_ylim()
        bar = 0.03 * (high - low)
        low -= 4 * bar
        panel.fill_between(s, low, high, where=trace["contact"][:] != 0, color="0.85", label="contact")
        lies = file[f"interfaces/{interface}/edge_inclusion"][:]
        for index in set(lies) - {-1}:
            panel.stairs(low + bar * (lies == index), s, baseline=low, fill=True, color="0.3")
            starts = s[:-1][lies == index]
            panel.text(starts[len(starts) // 2], low + 1.5 * bar, inclusions[index], ha="center")
        panel.set(ylim=(low, high), xlabel=f"arc length of interface {interface}", ylabel="displacement",
                  title=f"{file.attrs['title']}: {name}")
        panel.legend()
    figure.savefig(path, dpi=150)


def main(path, picture=None, load=None):
    with h5py.File(path) as file:
        answers(file)
        if picture is not None:
            draw(file, load or next(iter(file["loads"])), picture)


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])

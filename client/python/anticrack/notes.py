# SPDX-License-Identifier: GPL-3.0-or-later
"""Notes that a reader should know before believing the answers; the command prints them below its table."""
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .arrays import Array
from .result import Result

_LARGEST_PART = 0.1


def notes_on(result: Result) -> list[str]:
    """Notes that one of the units is missing and, if the case gives a unit of length, that u exceeds a tenth of the
    sheet's smaller side, as the equation holds for small slopes."""
    units, notes = result.units, []
    if bool(units.length) != bool(units.force):
        notes.append(f"[units] gives no {'force' if units.length else 'length'}, so energies and tensions have no unit "
                     "here; write both length and force")
    if not units.length:
        return notes  # u may have another unit than x and y
    most, load = max(((float(np.abs(values).max()), name) for name, values in _known(result) if len(values)),
                     default=(0.0, ""))
    side = float(np.ptp(result.mesh.nodes, axis=0).min())
    if most > _LARGEST_PART * side:
        where = f' in load "{load}"' if load else ""
        notes.append(f"u reaches {most:.3g} {units.length}{where}, and the smaller side of the sheet is {side:.3g} "
                     f"{units.length}: the equation is that of small slopes, u up to about a tenth of the side. u is "
                     "proportional to the load and to 1/tension: look for a factor in them")
    return notes


def _known(result: Result) -> Iterator[tuple[str, Array]]:
    """Yields the known u of each load case with the name of the load case."""
    for name, load in result.loads.items():
        yield name, np.array([inclusion.A for inclusion in load.inclusions.values() if np.isfinite(inclusion.A)])
        for trace in load.traces:
            yield from ((name, trace.u_minus), (name, trace.u_plus))
        for part in load.fields:
            yield name, part.u
    if result.sweep is not None:
        yield "", result.sweep.displacement[result.sweep.converged].ravel()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Over iterations, stages and the rows of a sweep."""
from __future__ import annotations

from numbers import Integral
from typing import Any

import numpy as np

from ..arrays import Array, array_of
from ..errors import Error
from ..names import place
from ..result import Load, Result, Sweep
from ..text import harmless
from .panel import axes, load_of

_CURVES = 6  # of a sweep, at most


def convergence(result: Result, load: str | Load | None = None, ax: Any = None) -> Any:
    """Over the iterations: the relative change, and the residuals of the optimality conditions."""
    ax, load = axes(ax), load_of(result, load)
    if not load.history:
        raise Error(f"{harmless(load.name)} has no history of iterations")
    iterations = load.history["iteration"]
    ax.plot(iterations, load.history["criterion"], ".-", label=f"{harmless(load.name)}: relative change per iteration")
    residuals = [load.history[name] for name in ("kkt_equilibrium", "kkt_gap", "kkt_sign", "kkt_complementarity")]
    ax.plot(iterations, np.max(residuals, axis=0), ".--", label=f"{harmless(load.name)}: largest KKT residual")
    ax.set(xlabel="iteration", ylabel="relative change, KKT residual")
    _log_with_zero(ax)
    ax.xaxis.get_major_locator().set_params(integer=True, min_n_ticks=1)
    ax.legend()
    return ax


def _log_with_zero(ax: Any) -> None:
    """What is exactly 0 has a place at the foot."""
    values = np.concatenate([np.asarray(line.get_ydata(), dtype=float) for line in ax.lines])
    above = values[values > 0]
    if len(above) and (values == 0).any():
        ax.set_yscale("symlog", linthresh=10.0 ** np.floor(np.log10(above.min())))
        ax.set_ylim(bottom=0)
    elif len(above):
        ax.set_yscale("log")


def error_band(result: Result, load: str | Load | None = None, ax: Any = None) -> Any:
    """The energy of each stage and the band in which the membrane's own lies; takes a case with an accuracy."""
    ax, load = axes(ax), load_of(result, load)
    if not load.stages:
        raise Error(f"{harmless(load.name)} has no stages; solve with Case(accuracy=Accuracy(energy=1e-3)), in TOML "
                    "[accuracy]")
    stages = load.stages
    ax.fill_between(stages["triangles"], stages["energy_lower"], stages["energy_upper"], alpha=0.3,
                    label=f"{harmless(load.name)}: bounds of the membrane's energy")
    ax.plot(stages["triangles"], stages["energy"], ".-", label=f"{harmless(load.name)}: energy of the stage")
    ax.set(xscale="log", xlabel="triangles", ylabel="energy" + result.units.label("F L"))
    from matplotlib.ticker import LogLocator, NullFormatter
    ax.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))  # of few decades, of which 1 alone is too few
    ax.xaxis.set_major_formatter("{x:.0f}")
    ax.xaxis.set_minor_formatter(NullFormatter())
    ax.legend()
    return ax


def _sweep_axis(columns: Sweep) -> tuple[str, Array, str]:
    """As the command: label, values and line: over the coefficient that varies, the angle of two that lie on a circle
    around 0, or else the rows, whose points are not joined."""
    rows = np.arange(len(columns.status))
    given = columns.coefficients if columns.coefficients is not None else np.empty((len(rows), 0))
    varying = np.flatnonzero((given != given[:1]).any(axis=0))
    if len(varying) == 1:
        return f"coefficient of {columns.loads[varying[0]]}", given[:, varying[0]], ".-"
    if len(varying) == 2:
        x, y = given[:, varying].T
        radius = np.hypot(x, y)
        if np.allclose(radius, radius[0], rtol=1e-6, atol=0):
            plain = np.arctan2(y, x)
            angle = np.unwrap(plain)
            first, second = (columns.loads[i] for i in varying)
            one_turn = np.ptp(angle) <= 2 * np.pi * (1 + 1e-6)
            return f"angle from {first} to {second} [\u00b0]", np.degrees(angle if one_turn else plain), ".-"
    return "row", rows, "."


def sweep(result: Result, x: str | int | Array | None = None, inclusion: str | int | None = None,
          ax: Any = None) -> Any:
    """A of the first six inclusions, or of one by name or index (where there is none: the contact length), over the
    coefficient that varies, of a load by name or index, or over values (rows) of one's own, with bands where rows have
    bounds. Rows that did not converge are left out."""
    ax = axes(ax)
    columns = result.sweep
    if columns is None:
        raise Error("this is not the result of a sweep")
    line = ".-"
    if x is None:
        label, values, line = _sweep_axis(columns)
    elif isinstance(x, (str, Integral)):
        if columns.coefficients is None:
            raise Error("the coefficients are not known; give x, a value for every row")
        index = place("load", x, columns.loads) if isinstance(x, str) else int(x)
        label, values = f"coefficient of {columns.loads[index]}", columns.coefficients[:, index]
    else:
        label, values = "", array_of(x, (len(columns.status),), lambda problem: Error(f"x: {problem}"))
    rows = np.flatnonzero(columns.converged)
    rows = rows[np.argsort(values[rows], kind="stable")]
    chosen = list(range(len(columns.inclusions)))
    if inclusion is not None and chosen:
        chosen = [place("inclusion", inclusion, columns.inclusions) if isinstance(inclusion, str) else inclusion]
    for i in chosen[:_CURVES]:
        (curve,) = ax.plot(values[rows], columns.displacement[rows, i], line,
                           label=f"A of {harmless(columns.inclusions[i])}")
        if line == ".-" and columns.displacement_lower is not None and columns.displacement_upper is not None:
            ax.fill_between(values[rows], columns.displacement_lower[rows, i], columns.displacement_upper[rows, i],
                            color=curve.get_color(), alpha=0.3, linewidth=0)
    if not chosen:
        ax.plot(values[rows], columns.contact_length[rows], line, label="contact length")
    one = len(chosen) == 1
    name = f"A of {harmless(columns.inclusions[chosen[0]])}" if one else "A" if chosen else "contact length"
    ax.set(xlabel=label, ylabel=name + result.units.label("L"))
    if label == "row":
        ax.xaxis.get_major_locator().set_params(integer=True)
    if len(ax.get_lines()) > 1:
        more = len(chosen) - _CURVES
        ax.legend(loc="best", fontsize="small", title=f"and {more} more" if more > 0 else None)
    return ax

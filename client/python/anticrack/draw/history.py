# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels over iterations and stages."""
from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.ticker import FuncFormatter, SymmetricalLogLocator

from ..arrays import Array
from ..errors import Error
from ..result import Load, Result
from ..text import counted, harmless
from .panel import CONTACT, CURVES, axes, fit_axis, load_of, log_axis, named, number_text, rounded, unit_of

_FEW = 60  # up to so many iterations are marked by points, too


# Names of the active set's residuals; it has no criterion but ends when the conditions hold.
_CONDITIONS = [("kkt_gap", "gap: faces overlap"), ("kkt_sign", "sign: closed faces pull"),
               ("kkt_complementarity", "complementarity: pressure where open")]


def convergence(result: Result, load: str | Load | None = None, ax: Any = None) -> Any:
    """Draws the relative change per iteration and epsilon for Algorithm 2, and a curve for each KKT residual over the
    steps for the active set. Values that are exactly 0 have a place at the foot."""
    ax, load = axes(ax), load_of(result, load)
    if not load.history:
        raise Error(f"{harmless(load.name)} has no history of iterations")
    steps = load.method != "uzawa"
    name = f"{named(load.name)}: " if ax.lines else ""
    iterations = load.history["iteration"]
    few = {"marker": "o", "markersize": 2.5} if len(iterations) <= _FEW else {}
    first = len(ax.lines)
    series = _CONDITIONS if steps else [("criterion", "of u in the energy norm, squared")]
    for (column, label), (color, dash) in zip(series, (2 * CURVES)[first % len(CURVES):]):
        values = np.asarray(load.history[column], dtype=float)
        ax.plot(iterations, np.where(values >= 0, values, np.nan), color=color, linestyle=dash, label=name + label,
                **few)
    epsilon = load.solver.uzawa.epsilon
    if epsilon > 0:
        ax.axhline(epsilon, color=CURVES[1][0], linestyle=CURVES[1][1], linewidth=1,
                   label=f"\u03b5 = {number_text(epsilon)}")
    ax.set(xlabel="step of the active set" if steps else "iteration",
           ylabel="KKT residual" if steps else "relative change per iteration")
    _log_with_zero(ax)
    ax.xaxis.set_major_locator(rounded(6, integer=True, min_n_ticks=1))
    told = [f"{load.status.replace('_', ' ')} after {counted(load.iterations, 'step' if steps else 'iteration')}"]
    told += [f"{sign} = {number_text(value)}" for sign, value in (("\u03b8", load.theta), ("\u03b8*", load.theta_star))
             if np.isfinite(value)]
    ax.set_title(f"{named(load.name)}: {', '.join(told)}" if not first else "")
    ax.legend(fontsize="small")
    return ax


def _log_with_zero(ax: Any) -> None:
    values = np.concatenate([np.asarray(line.get_ydata(), dtype=float) for line in ax.lines])
    above = values[values > 0]
    if not len(above):
        return
    low = 10.0 ** np.floor(np.log10(above.min()))
    if not (values == 0).any():
        ax.set_yscale("log")
        log_axis(ax.yaxis)
        return
    ax.set_yscale("symlog", linthresh=low)
    ax.set_ylim(-0.05 * low, 2 * above.max())
    every = max(1, int(np.ceil(np.log10(above.max() / low) / 6)))
    ax.set_yticks([0, *10.0 ** np.arange(np.log10(low), np.ceil(np.log10(above.max())) + 1, every).round()])
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: number_text(value, 3)))
    ax.yaxis.set_minor_locator(SymmetricalLogLocator(base=10, linthresh=low, subs=(1,)))


def bounded(load: Load) -> dict[str, Array]:
    """Triangles and relative error and displacement_error of the stages whose bounds a log axis can show; an error of A
    that is 0 becomes NaN."""
    stages = load.stages
    if not stages:
        return {"triangles": np.empty(0)}
    with np.errstate(divide="ignore", invalid="ignore"):
        error = (stages["energy_upper"] - stages["energy_lower"]) / np.abs(stages["energy"])
    kept = (stages["triangles"] > 0) & (error > 0) & np.isfinite(error)
    moved = stages.get("displacement_error", np.full(len(error), np.nan))
    return {"triangles": stages["triangles"][kept].astype(float), "error": error[kept],
            "displacement_error": np.where(moved > 0, moved, np.nan)[kept]}


def _begin(result: Result, load: str | Load | None, ax: Any) -> tuple[Any, Load]:
    ax, load = axes(ax), load_of(result, load)
    if not load.stages:
        raise Error(f"{harmless(load.name)} has no stages; solve with Case(accuracy=Accuracy(energy=1e-3)), in TOML "
                    "[accuracy]")
    ax.set(xscale="log", xlabel="triangles")
    ax.margins(x=0.04)
    return ax, load


def errors(result: Result, load: str | Load | None = None, ax: Any = None) -> Any:
    """Draws the width of the bounds of the energy and of A over the triangles of the stages; needs a case with an
    accuracy."""
    ax, load = _begin(result, load, ax)
    at = bounded(load)
    if not len(at["triangles"]):
        raise Error(f"no stage of {harmless(load.name)} has bounds")
    ax.plot(at["triangles"], at["error"][-1] * at["triangles"][-1] / at["triangles"], color="#888888", linewidth=0.7,
            label="as 1 / triangles")
    points = {"marker": "o", "markersize": 2.5}
    ax.plot(at["triangles"], at["error"], color=CURVES[0][0], label="energy, width of its bounds", **points)
    last = at["displacement_error"][-1]
    if np.isfinite(at["displacement_error"]).any():
        ax.plot(at["triangles"], at["displacement_error"], color=CURVES[1][0], linestyle=CURVES[1][1],
                label="A, half the width of its bounds", **points)
    ax.set(yscale="log", ylabel="relative error bound")
    log_axis(ax.xaxis)
    log_axis(ax.yaxis)
    of_a = f", A {number_text(100 * last, 2)} %" if np.isfinite(last) else ""
    ax.set_title(f"energy {number_text(100 * at['error'][-1], 2)} %{of_a} on {at['triangles'][-1]:.0f} triangles, "
                 + counted(len(at["triangles"]), "stage"))
    ax.legend(fontsize="small")
    return ax


def error_band(result: Result, load: str | Load | None = None, ax: Any = None) -> Any:
    """Draws the energy of each stage and the band in which the exact one lies; needs a case with an accuracy."""
    ax, load = _begin(result, load, ax)
    stages, first = load.stages, not ax.lines
    color = CURVES[len(ax.lines) % len(CURVES)][0]
    name = "" if first else f"{named(load.name)}: "
    ax.fill_between(stages["triangles"], stages["energy_lower"], stages["energy_upper"], linewidth=0,
                    color=CONTACT if first else color, alpha=1 if first else 0.3,
                    label=name + "bounds of the membrane\u2019s energy")
    ax.plot(stages["triangles"], stages["energy"], color=color, marker="o", markersize=2.5,
            label=name + "energy, in the middle of them")
    log_axis(ax.xaxis)
    ax.yaxis.set_major_locator(rounded(5))
    fit_axis(ax.yaxis, "energy", unit_of(result, "F L"))
    ax.set_title(named(load.name) if first else "")
    ax.legend(fontsize="small")
    return ax

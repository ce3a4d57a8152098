# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures with matplotlib. Each function draws one panel, on `ax` or on a new figure, and returns its Axes: several
load cases lie over each other when they are drawn on the same one. `load` is a name or an answer."""
from __future__ import annotations

from typing import Any

import numpy as np

from .arrays import Array
from .errors import Error
from .result import BONDED, CRACK, DELAMINATED, FREE, Load, Result, runs

_TIPS = 0.02  # of the length of a crack at each end: there the pressure grows without bound


def _axes(ax: Any) -> Any:
    from matplotlib import pyplot
    return pyplot.subplots(layout="constrained")[1] if ax is None else ax


def _load(result: Result, load: str | Load | None) -> Load:
    if isinstance(load, Load):
        return load
    name = next(iter(result.loads), "") if load is None else load
    if name not in result.loads:
        raise Error(f"there is no load '{name}'; known are {', '.join(result.loads)}")
    return result.loads[name]


def _interface(result: Result, load: Load, interface: int | str | None) -> int:
    """The one named, or the most eventful: whose jump is largest."""
    if isinstance(interface, int):
        return interface
    names = [entry.name for entry in result.interfaces]
    if interface is not None:
        if interface not in names:
            raise Error(f"there is no interface '{interface}'; known are {', '.join(names)}")
        return names.index(interface)
    if not load.traces:
        raise Error(f"{load.name} has no traces")
    return int(np.argmax([np.abs(trace.jump).max(initial=0) for trace in load.traces]))


def interfaces(result: Result, ax: Any = None, labels: bool = True) -> Any:
    """Inclusions (black, solid where bonded, dashed where delaminated), with their names, and cracks (red)."""
    ax = _axes(ax)
    named: set[int] = set()
    for interface in result.interfaces:
        for first, last in runs(interface.edge_kind * 100_000 + interface.edge_inclusion):
            kind, inclusion = int(interface.edge_kind[first]), int(interface.edge_inclusion[first])
            x, y = interface.x[first:last + 1], interface.y[first:last + 1]
            if kind in (BONDED, DELAMINATED):
                ax.plot(x, y, "--" if kind == DELAMINATED else "-", color="black", linewidth=2)
                if labels and inclusion not in named:
                    named.add(inclusion)
                    middle = len(x) // 2
                    ax.annotate(result.mesh.inclusions[inclusion], (x[middle], y[middle]), xytext=(0, 4),
                                textcoords="offset points", ha="center")
            elif kind in (CRACK, FREE):
                ax.plot(x, y, "-" if kind == CRACK else ":", color="tab:red", linewidth=2)
    ax.set(aspect="equal", xlabel="x", ylabel="y")
    return ax


def membrane(result: Result, load: str | Load | None = None, ax: Any = None, levels: int = 12, lines: bool = True,
             cmap: str = "viridis") -> Any:
    """u from above, in colours and contour lines, with cracks and inclusions; takes a case with fields."""
    from matplotlib.tri import Triangulation
    ax, load = _axes(ax), _load(result, load)
    if not load.fields:
        raise Error(f"{load.name} has no fields; solve with Case(fields=True), in TOML [output] fields = true")
    low, high = min(f.u.min() for f in load.fields), max(f.u.max() for f in load.fields)
    steps = np.linspace(low, high if high > low else low + 1, levels + 1)
    for part in load.fields:
        x, y = result.mesh.nodes[part.nodes].T
        triangulation = Triangulation(x, y, part.triangles)
        shades = ax.tricontourf(triangulation, part.u, steps, cmap=cmap)
        if lines:
            ax.tricontour(triangulation, part.u, steps, colors="black", linewidths=0.3, linestyles="solid")
    ax.figure.colorbar(shades, ax=ax, label="u")
    interfaces(result, ax)
    ax.set_title(load.name)
    return ax


def traces(result: Result, load: str | Load | None = None, interface: int | str | None = None, ax: Any = None) -> Any:
    """u on both sides of an interface and the jump; contact is shaded, inclusions are bars with their names. Unless
    it is named, the interface with the largest jump."""
    ax, load = _axes(ax), _load(result, load)
    index = _interface(result, load, interface)
    line, trace = result.interfaces[index], load.traces[index]
    ax.plot(line.s, trace.u_minus, label="$u^-$")
    ax.plot(line.s, trace.u_plus, "--", label="$u^+$")
    ax.plot(line.s, trace.jump, ":", color="black", label="$[u] = u^+ - u^-$")
    label: str | None = "contact"
    for first, last in runs(trace.contact):
        if trace.contact[first]:
            ax.axvspan(line.s[first], line.s[last - 1], color="0.85", zorder=0, label=label)
            label = None
    for inclusion in sorted(set(line.edge_inclusion.tolist()) - {-1}):
        lies = line.edge_inclusion == inclusion
        begin, end = line.s[:-1][lies].min(), line.s[1:][lies].max()
        ax.axvspan(begin, end, 0, 0.02, color="0.3")
        ax.annotate(result.mesh.inclusions[inclusion], ((begin + end) / 2, 0.03), ha="center",
                    xycoords=ax.get_xaxis_transform())
    ax.set(xlabel=f"arc length of {line.name or 'the interface'}", ylabel="displacement", title=load.name)
    ax.legend()
    return ax


def pressure(result: Result, load: str | Load | None = None, interface: int | str | None = None, ax: Any = None,
             tips: float = _TIPS) -> Any:
    """The contact pressure on the cracks of an interface. It grows without bound at tips: `tips` of the length of each
    crack are left out at its ends, and the axis says so."""
    ax, load = _axes(ax), _load(result, load)
    index = _interface(result, load, interface)
    line, trace = result.interfaces[index], load.traces[index]
    cracked = np.isin(line.edge_kind, (CRACK, DELAMINATED))
    for first, last in runs(cracked):
        if cracked[first]:
            s = line.s[first:last + 1]
            cut = tips * (s[-1] - s[0])
            inner = (s >= s[0] + cut) & (s <= s[-1] - cut)
            ax.plot(s[inner], trace.pressure[first:last + 1][inner], label=load.name)
    said = f" ({100 * tips:g} % at each tip left out)" if tips else ""
    ax.set(xlabel=f"arc length of {line.name or 'the interface'}{said}", ylabel="contact pressure", title=load.name)
    return ax


def convergence(result: Result, load: str | Load | None = None, ax: Any = None) -> Any:
    """Over the iterations: the relative change, and the residuals of the optimality conditions."""
    ax, load = _axes(ax), _load(result, load)
    iterations = load.history["iteration"]
    ax.plot(iterations, load.history["criterion"], ".-", label=f"{load.name}: relative change per iteration")
    residuals = [load.history[name] for name in ("kkt_equilibrium", "kkt_gap", "kkt_sign", "kkt_complementarity")]
    ax.plot(iterations, np.max(residuals, axis=0), ".--", label=f"{load.name}: largest KKT residual")
    ax.set(yscale="log", xlabel="iteration")
    ax.legend()
    return ax


def error_band(result: Result, load: str | Load | None = None, ax: Any = None) -> Any:
    """The energy of each stage and the band in which the membrane's own lies; takes a case with an accuracy."""
    ax, load = _axes(ax), _load(result, load)
    if not load.stages:
        raise Error(f"{load.name} has no stages; solve with Case(accuracy=Accuracy(energy=1e-3)), in TOML [accuracy]")
    stages = load.stages
    ax.fill_between(stages["triangles"], stages["energy_lower"], stages["energy_upper"], alpha=0.3,
                    label=f"{load.name}: bounds of the membrane's energy")
    ax.plot(stages["triangles"], stages["energy"], ".-", label=f"{load.name}: energy of the stage")
    ax.set(xscale="log", xlabel="triangles", ylabel="energy")
    ax.legend()
    return ax


def sweep(result: Result, x: str | int | Array = 0, inclusion: str | int = 0, ax: Any = None) -> Any:
    """A of an inclusion (where there is none: the contact length) over a coefficient by the name or index of its load,
    or over values (rows) of one's own; rows that did not converge are left out."""
    ax = _axes(ax)
    columns = result.sweep
    if columns is None:
        raise Error("this is not the result of a sweep")
    if isinstance(x, (str, int)):
        if columns.coefficients is None:
            raise Error("the coefficients are not known; give x, a value for every row")
        index = columns.loads.index(x) if isinstance(x, str) else x
        label, values = f"coefficient of {columns.loads[index]}", columns.coefficients[:, index]
    else:
        label, values = "", np.asarray(x)
    rows = columns.converged
    if columns.inclusions:
        chosen = columns.inclusions.index(inclusion) if isinstance(inclusion, str) else inclusion
        name, heights = f"A of {columns.inclusions[chosen]}", columns.displacement[:, chosen]
    else:
        name, heights = "contact length", columns.contact_length
    order = np.argsort(values[rows], kind="stable")
    ax.plot(values[rows][order], heights[rows][order], ".-", label=name)
    ax.set(xlabel=label, ylabel=name)
    return ax

# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures with matplotlib. Each function draws one panel, on `ax` or on a new figure, and returns its Axes: several
load cases lie over each other when they are drawn on the same one. `load` is a name or an answer."""
from __future__ import annotations

from typing import Any

import numpy as np

from .arrays import Array
from .errors import Error, package
from .names import place
from .result import BONDED, CRACK, DELAMINATED, FREE, Interface, Load, Mesh, Result, Sweep, Trace, runs


# Of kinds of edges: name and colour, as in the command's figures.
_LINES = {BONDED: ("bonded inclusion", "#000000"), DELAMINATED: ("delaminated inclusion", "#E69F00"),
          CRACK: ("crack, [u] \u2265 0", "#B04A8A"), FREE: ("free crack", "#8CD17D")}
_CURVES = 6  # of a sweep, at most


def _axes(ax: Any) -> Any:
    if ax is not None:
        return ax
    return package("matplotlib.pyplot").subplots(layout="constrained")[1]


def _load(result: Result, load: str | Load | None) -> Load:
    if isinstance(load, Load):
        return load
    return result.loads[next(iter(result.loads), "") if load is None else load]


def _interface(result: Result, load: Load, interface: int | str | None, pressed: bool = False) -> int:
    """The one named, or the most eventful: whose jump is largest or, if nothing is open, whose contact is longest.
    pressed: whose contact is longest, but the same one where its contact is at least half as long; as the command."""
    if isinstance(interface, int):
        return interface
    if interface is not None:
        return result.interfaces.place(interface)
    if not load.traces:
        raise Error(f"{load.name} has no traces")
    jumps = [np.abs(trace.jump).max(initial=0) for trace in load.traces]
    largest = max(np.abs(trace.u_plus).max(initial=0) for trace in load.traces)
    contact = [_lengths(line) @ (trace.contact != 0) for line, trace in zip(result.interfaces, load.traces)]
    longest, opened = int(np.argmax(contact)), int(np.argmax(jumps))
    if jumps[opened] <= 1e-9 * largest or (pressed and 2 * contact[opened] < contact[longest]):
        return longest
    return opened


def _lengths(line: Interface) -> Array:
    """Half of the edges at each node."""
    edges = np.diff(line.s, prepend=line.s[:1], append=line.s[-1:])
    return np.asarray((edges[:-1] + edges[1:]) / 2)


def _cut(values: Array, weights: Array, part: float, room: float) -> tuple[float, float]:
    """The end of an axis for values that are singular at tips, and the highest of them: `room` times what `part` of the
    weight stays below, or the highest if that is little more."""
    order = np.argsort(values)
    below = np.cumsum(weights[order])
    highest = float(values[order[-1]])
    shown = room * float(values[order[np.searchsorted(below, part * below[-1])]])
    return (highest if highest <= 1.25 * shown else shown), highest


def _arc_length(result: Result, line: Interface) -> str:
    """For an axis."""
    return f"arc length of {line.name} from ({line.x[0]:.4g}, {line.y[0]:.4g}){result.units.label('L')}"


def _shade_contact(line: Interface, trace: Trace, ax: Any, load: Load, curve: Any) -> None:
    """In the colour of its curve, so that those of several loads are told apart. To the middles of the edges at its
    ends: the bands add up to the contact length."""
    middles = np.concatenate((line.s[:1], (line.s[:-1] + line.s[1:]) / 2, line.s[-1:]))
    label: str | None = f"{load.name}: contact"
    for first, last in runs(trace.contact):
        if trace.contact[first]:
            ax.axvspan(middles[first], middles[last], color=curve.get_color(), alpha=0.2, linewidth=0, zorder=0,
                       label=label)
            label = None


def _fields(load: Load) -> list[Any]:
    if not load.fields:
        raise Error(f"{load.name} has no fields; solve with Case(fields=True), in TOML [output] fields = true")
    return load.fields


def _levels(load: Load, levels: int) -> Array:
    low, high = min(f.u.min() for f in load.fields), max(f.u.max() for f in load.fields)
    return np.asarray(np.linspace(low, high if high > low else low + 1, levels + 1))


def _boundary(mesh: Mesh) -> dict[str, Array]:
    """Edges (n, 2) of the boundary, by what is given on them."""
    def keys(edges: Array) -> Array:
        return np.asarray(edges.min(axis=1).astype(np.int64) * len(mesh.nodes) + edges.max(axis=1))
    edges = np.concatenate([mesh.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    _, first, count = np.unique(keys(edges), return_index=True, return_counts=True)
    outer = edges[first[count == 1]]
    held = np.isin(keys(outer), keys(mesh.boundary))
    return {"u given": outer[held], "free or traction": outer[~held]}


def interfaces(result: Result, ax: Any = None, labels: bool = True) -> Any:
    """The boundary, the inclusions, with dots on the side that came off, and the cracks; labels: names of inclusions,
    and a legend of the lines."""
    ax = _axes(ax)
    from matplotlib.collections import LineCollection
    drawn: dict[str, Any] = {}
    for (what, edges), color, width in zip(_boundary(result.mesh).items(), ("#444444", "#009E73"), (2.5, 1.2)):
        if len(edges):
            segments = LineCollection(list(result.mesh.nodes[edges]), linewidth=width, color=color, capstyle="round")
            drawn[what] = ax.add_collection(segments)
    named: set[int] = set()
    away = 0.012 * np.ptp(result.mesh.nodes, axis=0).max()
    for interface in result.interfaces:
        for first, last in runs(interface.edge_kind * 100_000 + interface.edge_inclusion):
            kind, inclusion = int(interface.edge_kind[first]), int(interface.edge_inclusion[first])
            if kind not in _LINES:
                continue
            x, y = interface.x[first:last + 1], interface.y[first:last + 1]
            what, color = _LINES[kind]
            (drawn[what],) = ax.plot(x, y, color=color, linewidth=2)
            across = np.stack((-np.gradient(y), np.gradient(x))) / np.hypot(np.gradient(x), np.gradient(y))
            if kind == DELAMINATED:
                (drawn["the side that came off"],) = ax.plot(x - away * across[0], y - away * across[1], ":",
                                                             color="#D00000")
            if labels and inclusion >= 0 and inclusion not in named:
                named.add(inclusion)
                middle = len(x) // 2
                up, right = across[1, middle], across[0, middle]
                ax.annotate(result.mesh.inclusions[inclusion], (x[middle], y[middle]), xytext=(6 * right, 6 * up),
                            textcoords="offset points", va="bottom" if up > 0.5 else "top" if up < -0.5 else "center",
                            ha="center" if abs(up) > 0.9 else "left" if right > 0 else "right",
                            bbox={"boxstyle": "round,pad=0.1", "facecolor": "white", "alpha": 0.6, "linewidth": 0})
    if labels and drawn:
        ax.legend(list(drawn.values()), list(drawn), loc="upper center", bbox_to_anchor=(0.5, -0.14), ncol=2,
                  fontsize="small", frameon=False)
    length, low, high = result.units.label("L"), result.mesh.nodes.min(axis=0), result.mesh.nodes.max(axis=0)
    margin = 0.03 * (high - low).max()
    ax.set(aspect="equal", xlabel="x" + length, ylabel="y" + length, xlim=(low[0] - margin, high[0] + margin),
           ylim=(low[1] - margin, high[1] + margin))
    ax.locator_params(nbins=6)
    return ax


def membrane(result: Result, load: str | Load | None = None, ax: Any = None, levels: int = 12, lines: bool = True,
             cmap: str = "viridis") -> Any:
    """u from above, in colours and contour lines, with cracks and inclusions; takes a case with fields."""
    ax, load = _axes(ax), _load(result, load)
    from matplotlib.tri import Triangulation
    for part in _fields(load):
        triangulation = Triangulation(*result.mesh.nodes[part.nodes].T, part.triangles)
        shades = ax.tricontourf(triangulation, part.u, _levels(load, levels), cmap=cmap)
        if lines:
            ax.tricontour(triangulation, part.u, _levels(load, levels), colors="black", linewidths=0.3,
                          linestyles="solid")
    ax.figure.colorbar(shades, ax=ax, label="u" + result.units.label("L"))
    interfaces(result, ax)
    ax.set_title(load.name)
    return ax


def flux(result: Result, load: str | Load | None = None) -> list[Array]:
    """|T grad u| in the triangles of each subdomain, as its field lists them; takes a case with fields. Where some T is
    a law, of which a result has the mean alone, |grad u|."""
    sizes = []
    tensions = np.ones(len(result.mesh.tension)) if result.mesh.tension_law else result.mesh.tension
    for tension, part in zip(tensions, _fields(_load(result, load))):
        a, b, c = np.moveaxis(result.mesh.nodes[part.nodes][part.triangles], 1, 0)
        u = part.u[part.triangles]
        (bx, by), (cx, cy) = (b - a).T, (c - a).T
        ub, uc = u[:, 1] - u[:, 0], u[:, 2] - u[:, 0]
        sizes.append(tension * np.hypot(ub * cy - uc * by, uc * bx - ub * cx) / (bx * cy - cx * by))
    return sizes


def plan(result: Result, load: str | Load | None = None, ax: Any = None, levels: int = 10, cmap: str = "Blues") -> Any:
    """From above: labelled lines of u over the flux (see `flux`) in colours, with cracks and inclusions; takes a case
    with fields. The flux grows without bound at tips: its peaks are cut off, and the colour bar says so."""
    ax, load = _axes(ax), _load(result, load)
    from matplotlib.ticker import MaxNLocator
    from matplotlib.tri import Triangulation
    sizes = flux(result, load)
    parts = [Triangulation(*result.mesh.nodes[part.nodes].T, part.triangles) for part in load.fields]
    corners = [np.stack((part.x, part.y), -1)[part.triangles] for part in parts]
    areas = [np.abs(np.linalg.det(np.diff(each, axis=1))) for each in corners]
    shown, highest = _cut(np.concatenate(sizes), np.concatenate(areas), 0.98, 1.5)
    steps = MaxNLocator(levels).tick_values(*_levels(load, 1))  # round
    for part, field, size in zip(parts, load.fields, sizes):
        shades = ax.tripcolor(part, size, vmin=0, vmax=shown if shown > 0 else 1, cmap=cmap, rasterized=True)
        inner = steps[(steps > field.u.min()) & (steps < field.u.max())]
        if inner.size:
            lines = ax.tricontour(part, field.u, inner, colors="black", linewidths=0.6, linestyles="solid")
            ax.clabel(lines, inner[::2], fmt="%.3g", fontsize="x-small")
    said = f", peaks cut off, up to {highest:.2g}" if shown < highest else ""
    name = r"$|\nabla u|$" if result.mesh.tension_law else r"$|T \nabla u|$" + result.units.label("F/L")
    ax.figure.colorbar(shades, ax=ax, label=name + said,
                       extend="max" if said else "neither")
    interfaces(result, ax)
    ax.set_title(f"{load.name}: lines of u{result.units.label('L')}")
    return ax


def traces(result: Result, load: str | Load | None = None, interface: int | str | None = None, ax: Any = None) -> Any:
    """u on both sides of an interface and the jump [u] = u+ - u-; contact is shaded, inclusions are bars with
    their names. Unless it is named, the interface with the largest jump."""
    ax, load = _axes(ax), _load(result, load)
    index = _interface(result, load, interface)
    line, trace = result.interfaces[index], load.traces[index]
    first = not ax.lines
    (curve,) = ax.plot(line.s, trace.u_minus, label=f"{load.name}: $u^-$")
    ax.plot(line.s, trace.u_plus, "--", label=f"{load.name}: $u^+$")
    ax.plot(line.s, trace.jump, ":", label=f"{load.name}: $[u]$")
    _shade_contact(line, trace, ax, load, curve)
    for inclusion in sorted(set(line.edge_inclusion.tolist()) - {-1}) if first else ():
        lies = line.edge_inclusion == inclusion
        begin, end = line.s[:-1][lies].min(), line.s[1:][lies].max()
        ax.axvspan(begin, end, 0, 0.02, color="0.3")
        ax.annotate(result.mesh.inclusions[inclusion], ((begin + end) / 2, 0.03), ha="center",
                    xycoords=ax.get_xaxis_transform())
    ax.set(xlabel=_arc_length(result, line), ylabel="displacement" + result.units.label("L"),
           title=load.name if first else "")
    # Several loads leave no room between their curves.
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncol=2, fontsize="small", frameon=False)
    return ax


def pressure(result: Result, load: str | Load | None = None, interface: int | str | None = None, ax: Any = None) -> Any:
    """The contact pressure on the cracks of an interface; contact is shaded. Unless it is named, the interface of
    `traces` or, where its contact is less than half as long as another's, the one with the longest contact. The
    pressure grows without bound at tips: its spikes are cut off, and the label of the axis says so."""
    ax, load = _axes(ax), _load(result, load)
    index = _interface(result, load, interface, pressed=True)
    line, trace = result.interfaces[index], load.traces[index]
    cracked = np.isin(line.kind, (CRACK, DELAMINATED))  # on glue it is a flux
    first = not ax.lines
    closed = trace.contact != 0
    name = load.name if closed.any() else f"{load.name}: no contact"
    (curve,) = ax.plot(line.s, np.where(cracked, trace.pressure, np.nan), label=name)
    unit = result.units.label("F/L")
    label = ax.get_ylabel() or "contact pressure" + unit
    if closed.any():
        _shade_contact(line, trace, ax, load, curve)
        shown, highest = _cut(trace.pressure[closed], _lengths(line)[closed], 0.9, 1.5)
        ax.set_ylim(0, max(1.05 * shown, 0 if first else ax.get_ylim()[1]))
        if shown < highest:
            label = f"contact pressure{unit}, cut off at the tips, up to {highest:.2g}"
    ax.set(xlabel=_arc_length(result, line), ylabel=label, title=name if first else "")
    if not first:
        ax.legend(loc="best", fontsize="small")
    return ax


def convergence(result: Result, load: str | Load | None = None, ax: Any = None) -> Any:
    """Over the iterations: the relative change, and the residuals of the optimality conditions."""
    ax, load = _axes(ax), _load(result, load)
    iterations = load.history["iteration"]
    ax.plot(iterations, load.history["criterion"], ".-", label=f"{load.name}: relative change per iteration")
    residuals = [load.history[name] for name in ("kkt_equilibrium", "kkt_gap", "kkt_sign", "kkt_complementarity")]
    ax.plot(iterations, np.max(residuals, axis=0), ".--", label=f"{load.name}: largest KKT residual")
    ax.set(yscale="log", xlabel="iteration", ylabel="relative change, KKT residual")
    ax.xaxis.get_major_locator().set_params(integer=True, min_n_ticks=1)
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
    ax.set(xscale="log", xlabel="triangles", ylabel="energy" + result.units.label("F L"))
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
    ax = _axes(ax)
    columns = result.sweep
    if columns is None:
        raise Error("this is not the result of a sweep")
    line = ".-"
    if x is None:
        label, values, line = _sweep_axis(columns)
    elif isinstance(x, (str, int)):
        if columns.coefficients is None:
            raise Error("the coefficients are not known; give x, a value for every row")
        index = place("load", x, columns.loads) if isinstance(x, str) else x
        label, values = f"coefficient of {columns.loads[index]}", columns.coefficients[:, index]
    else:
        label, values = "", np.asarray(x)
    rows = np.flatnonzero(columns.converged)
    rows = rows[np.argsort(values[rows], kind="stable")]
    chosen = list(range(len(columns.inclusions)))
    if inclusion is not None and chosen:
        chosen = [place("inclusion", inclusion, columns.inclusions) if isinstance(inclusion, str) else inclusion]
    for i in chosen[:_CURVES]:
        (curve,) = ax.plot(values[rows], columns.displacement[rows, i], line, label=f"A of {columns.inclusions[i]}")
        if line == ".-" and columns.displacement_lower is not None and columns.displacement_upper is not None:
            ax.fill_between(values[rows], columns.displacement_lower[rows, i], columns.displacement_upper[rows, i],
                            color=curve.get_color(), alpha=0.3, linewidth=0)
    if not chosen:
        ax.plot(values[rows], columns.contact_length[rows], line, label="contact length")
    name = f"A of {columns.inclusions[chosen[0]]}" if len(chosen) == 1 else "A" if chosen else "contact length"
    ax.set(xlabel=label, ylabel=name + result.units.label("L"))
    if len(ax.get_lines()) > 1:
        more = len(chosen) - _CURVES
        ax.legend(loc="best", fontsize="small", title=f"and {more} more" if more > 0 else None)
    return ax

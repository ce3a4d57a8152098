# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels along an interface: u on both sides, the jump and the contact pressure."""
from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from matplotlib.ticker import FuncFormatter

from ..arrays import Array
from ..errors import Error
from ..result import CRACK, DELAMINATED, Interface, Load, Result, Trace, runs
from ..text import harmless, with_bounds
from .panel import (BOX, CONTACT, CURVES, LINES, MARKED, Scale, axes, cut, fit_axis, legend_below, load_of, named,
                    named_without, offset_of, point_text, rounded, signed, unit_of)


def can_open(line: Interface) -> bool:
    """Whether the interface has a crack or a delaminated part."""
    return bool(np.isin(line.edge_kind, MARKED[:1] + MARKED[2:]).any())


def eventful(result: Result, loads: list[Load]) -> tuple[int, int]:
    """Indices of two interfaces: that with the largest jump (if nothing is open, with the longest contact), and that
    with the longest contact, but the first one again if its contact is at least half as long."""
    def most(of: Callable[[Interface, Trace], float]) -> list[float]:
        return [max(of(line, load.traces[i]) for load in loads) for i, line in enumerate(result.interfaces)]
    jumps = most(lambda _, trace: _largest(trace.jump))
    contact = most(lambda line, trace: float(np.diff(middles(line.s)) @ (trace.contact != 0)))
    largest = max(most(lambda _, trace: _largest(trace.u_plus)))
    longest, opened = int(np.argmax(contact)), int(np.argmax(jumps))
    if jumps[opened] <= 1e-9 * largest:
        opened = longest
    return opened, opened if 2 * contact[opened] >= contact[longest] else longest


def _begin(result: Result, load: str | Load | None, interface: int | str | None, ax: Any,
           pressed: bool = False) -> tuple[Any, Load, int, Profile, Trace, int]:
    """Chooses the interface that is named, or the most eventful. Returns the axes, the load, the interface's index,
    profile and trace, and the number of curves that the axes have already."""
    ax, load = axes(ax), load_of(result, load)
    if not result.interfaces:
        raise Error("the sheet has no interface, so there is nothing to draw along one")
    if not load.traces:
        raise Error(f"{harmless(load.name)} has no traces: it is {load.status.replace('_', ' ')}")
    if isinstance(interface, str):
        interface = result.interfaces.place(interface)
    index = eventful(result, [load])[pressed] if interface is None else operator.index(interface)
    count = sum(not line.get_label().startswith("_") for line in ax.lines)
    return ax, load, index, Profile(result, result.interfaces[index]), load.traces[index], count


def _largest(*values: Array) -> float:
    return float(np.nanmax(np.abs(np.concatenate(values)), initial=0))


def middles(values: Array) -> Array:
    """Middles between neighbours, and the two ends (k+1): they enclose half of each edge at a node."""
    return np.concatenate((values[:1], (values[:-1] + values[1:]) / 2, values[-1:]))


class Profile:
    """Places an interface on a horizontal axis: by x or y if it runs along that, as in the paper, else by the arc
    length from its first node, which the label names. at (k): places of the nodes."""

    def __init__(self, result: Result, line: Interface) -> None:
        self.line, small = line, 1e-9 * line.s[-1]
        name = "arc length s"
        self.at = line.s
        for axis, values, other in (("x", line.x, line.y), ("y", line.y, line.x)):
            steps = np.diff(values)
            if np.ptp(other) <= small and ((steps >= 0).all() or (steps <= 0).all()):
                name, self.at = axis, values
                break
        else:
            name += f" from {point_text(line.x[0], line.y[0], line.s[-1])}"
        self.ends = float(self.at.min()), float(self.at.max())
        self.scale = Scale(*self.ends)
        self.label = self.scale.label(name, unit_of(result))

    def place(self, s: Array) -> Array:
        """The places of arc lengths."""
        return np.interp(s, self.line.s, self.at)

    def axis(self, ax: Any) -> None:
        ax.xaxis.set_major_formatter(FuncFormatter(self.scale.text))
        ax.xaxis.set_major_locator(rounded(6))
        ax.set_xlabel(self.label)
        if self.ends[0] < self.ends[1]:
            ax.set_xlim(*self.ends)

    def bars(self, result: Result, ax: Any) -> None:
        """Draws bars for cracks and inclusions at the foot of the panel, with inclusions' names unless they overlap."""
        low, high = ax.get_ylim()
        inclusions = sorted({int(inclusion) for inclusion in self.line.edge_inclusion} - {-1})
        ax.set_ylim(low - (0.16 if inclusions else 0.06) * (high - low), high)
        labels = {kind: name for kind, (name, *_) in LINES.items()}
        for first, last in runs(self.line.edge_kind):
            kind = int(self.line.edge_kind[first])
            if kind in MARKED:
                ax.axvspan(*sorted((self.at[first], self.at[last])), 0, 0.035, color=LINES[kind][1], linewidth=0,
                           zorder=3, label=labels.pop(kind, "_again"))
        free, size, found = 0.0, (self.ends[1] - self.ends[0]) or 1.0, []
        for inclusion in inclusions:
            edges = np.flatnonzero(self.line.edge_inclusion == inclusion)
            middle = (self.at[edges].min() + self.at[edges + 1].max()) / 2
            found.append(((middle - self.ends[0]) / size, named(result.mesh.inclusions[inclusion], 24)))
        for middle, name in sorted(found):
            half = min(0.011 * len(name), 0.5)
            middle = float(np.clip(middle, half, 1 - half))
            if middle - half >= free:
                free = middle + half + 0.02
                ax.text(middle, 0.05, name, ha="center", va="bottom", fontsize="small", transform=ax.transAxes)


def edge_pressure(line: Interface, trace: Trace) -> tuple[Array, Array, Array, Array]:
    """Middles of the edges, the mean pressure over them, their lengths (0 off cracks), and which are in contact. Each
    node has half of an edge, but a tip's half goes to no node. The force is that of the nodes, without the teeth of the
    nodal pressures, which vary with the number of triangles at a node."""
    opens = np.isin(line.kind, (CRACK, DELAMINATED))
    begins, ends, edges = opens[:-1], opens[1:], np.diff(line.s)
    count = begins.astype(int) + ends
    closed = trace.contact != 0
    middles = line.s[:-1] + np.where(begins & ends, 0.5, np.where(begins, 0.25, 0.75)) * edges
    means = (trace.pressure[:-1] + trace.pressure[1:]) / np.maximum(count, 1)
    return middles, means, edges * count / 2, (means > 0) & (closed[:-1] | closed[1:])


def pressed(line: Interface, trace: Trace) -> bool:
    """Whether there is a pressure to draw."""
    return bool(edge_pressure(line, trace)[3].any())


def finish(ax: Any, profile: Profile, loads: list[Load], index: int, name: str, unit: str) -> None:
    """Finishes the vertical axis. Draws a line at 0 unless all values are far from it; shows as 0 a u that is rounding
    against the membrane's u (estimated from its energy), or a jump that is rounding against u. loads: empty if the
    heights are no displacements."""
    low, high = ax.get_ylim()
    if low - 0.5 * (high - low) <= 0 <= high + 0.5 * (high - low):
        ax.axhline(0, color="#888888", linewidth=0.6, zorder=0)
    if loads:
        u = _largest(*(each for load in loads for each in (load.traces[index].u_minus, load.traces[index].u_plus)))
        opened = _largest(*(load.traces[index].jump for load in loads))
        typical = max(abs(load.energy) if np.isfinite(load.energy) else 0 for load in loads) ** 0.5
        if max(u, opened) < 1e-9 * typical:
            u, opened = 10.0 ** np.floor(np.log10(typical)), 0.0
        elif name != "[u]":
            opened = u
        if opened <= 1e-9 * u > 0:
            ax.set_ylim(-u, u)
    profile.axis(ax)
    ax.yaxis.set_major_locator(rounded(6))
    fit_axis(ax.yaxis, name, unit)


def shade(profile: Profile, trace: Trace, ax: Any, color: str = CONTACT, alpha: float = 1,
          label: str = "contact") -> None:
    """Shades contact up to the middles of the edges at its ends, between which the contact
    length has its own ends."""
    ends, closed = middles(profile.at), trace.contact != 0
    for first, last in runs(closed):
        if closed[first]:
            ax.axvspan(*sorted(ends[[first, last]]), color=color, alpha=alpha, linewidth=0, zorder=-1, label=label)
            label = "_again"


def heading(result: Result, load: Load, line: Interface) -> str:
    """The title: the interface and A of its inclusions, with as many digits as there is room for."""
    unit, where = result.units.behind("L"), named(line.name, 20) if len(result.interfaces) > 1 else ""
    here = [result.mesh.inclusions[i] for i in sorted({int(i) for i in line.edge_inclusion} - {-1})]
    for bounds in (True, False):
        parts = [where] if where else []
        for part in (load.inclusions[name] for name in here if name in load.inclusions):
            known = bounds and np.isfinite(part.A_lower)
            text = with_bounds(part, "A").partition(" (")[0] if known else f"{part.A:.4g}"
            slopes = f", B = ({part.Bx:.4g}, {part.By:.4g})" if part.Bx or part.By else ""
            behind = f" ({named(part.name, 12)})" if len(load.inclusions) > 1 and part.name != line.name else ""
            parts.append(signed(f"A = {text.replace('+-', chr(177))}{unit}{slopes}{behind}"))
        if len(", ".join(parts)) <= 56:
            break
    return ", ".join(parts)


def traces(result: Result, load: str | Load | None = None, interface: int | str | None = None, ax: Any = None) -> Any:
    """Draws u on both sides of an interface and the jump [u] = u+ - u-; contact is shaded, cracks and inclusions are
    bars. The default is the interface with the largest jump."""
    ax, load, index, profile, trace, count = _begin(result, load, interface, ax)
    name = named(load.name)
    color = CURVES[sum(str(curve.get_label()).endswith(": [u]") for curve in ax.lines) % len(CURVES)][0]
    draw_traces(result, load, index, ax, (color,) * 3, f"{name}: ")
    ax.plot(profile.at, trace.jump, color=color, linestyle=CURVES[2][1], label=f"{name}: [u]")
    shade(profile, trace, ax, color, 0.2, f"{name}: contact")
    ax.relim()
    ax.autoscale(axis="y")
    finish(ax, profile, [load], index, "displacement", unit_of(result))
    if not count:
        profile.bars(result, ax)
    ax.set_title("" if count else f"{name}: {heading(result, load, profile.line)}")
    legend_below(ax)
    return ax


def common(shown: list[Trace]) -> float:
    """The part that u has in common on both sides, as on a lifted sheet, which the panel leaves out."""
    values = np.concatenate([side for trace in shown for side in (trace.u_minus, trace.u_plus)])
    values = values[np.isfinite(values)]
    return offset_of(values.min(), values.max(), max(np.ptp(trace.jump) for trace in shown)) if len(values) else 0.0


def draw_traces(result: Result, load: Load, index: int, ax: Any, colors: Sequence[str], prefix: str = "") -> None:
    """Draws u- and u+ without their common part."""
    trace, profile = load.traces[index], Profile(result, result.interfaces[index])
    offset = common([trace])
    for each, color, curve, name in zip((trace.u_minus, trace.u_plus), colors, CURVES, ("u\u207b", "u\u207a")):
        ax.plot(profile.at, each - offset, color=color, linestyle=curve[1],
                label=prefix + named_without(name, offset))


def jump(result: Result, load: str | Load | None = None, interface: int | str | None = None, ax: Any = None) -> Any:
    """Draws the jump [u] = u+ - u- along an interface, which may be too small to be seen beside u; contact is shaded.
    The default is the interface with the largest jump."""
    ax, load, index, profile, trace, count = _begin(result, load, interface, ax)
    color, dash = CURVES[count % len(CURVES)]
    ax.plot(profile.at, trace.jump, color=color, linestyle=dash, label=named(load.name))
    if not count:
        shade(profile, trace, ax)
    finish(ax, profile, [load], index, "[u]", unit_of(result))
    ax.set_title(named(load.name) if not count else "")
    return ax


def pressure(result: Result, load: str | Load | None = None, interface: int | str | None = None, ax: Any = None,
             whole: bool = False) -> Any:
    """Draws the contact pressure where an interface is in contact, which is shaded, as the mean over each edge. The
    default is the interface of `traces` or, if its contact is less than half as long as another's, the interface with
    the longest contact. The pressure grows without bound at tips: the axis ends below the peaks, and the panel says so.
    whole: show all of the interface."""
    ax, load, _, profile, trace, count = _begin(result, load, interface, ax, pressed=True)
    s, values, lengths, closed = edge_pressure(profile.line, trace)
    before = ax.get_ylim()[1] if count else 0.0
    color, dash = CURVES[count % len(CURVES)] if count else ("#009E73", "-")
    name = named(load.name) + ("" if closed.any() else ": no contact")
    ax.plot(profile.place(s), np.where(closed, values, np.nan), color=color, linestyle=dash, label=name)
    profile.axis(ax)
    if closed.any():
        if not count:
            shade(profile, trace, ax)
        shown, highest = cut(values[closed], lengths[closed], 0.9, 1.5)
        ax.set_ylim(0, max(1.06 * min(shown, highest), before))
        if shown < highest and not ax.texts:
            left = profile.place(np.mean(s[closed])) > np.mean(profile.ends) and whole
            ax.text(0.01 if left else 0.99, 0.97, "peaks at the tips are cut off", ha="left" if left else "right",
                    va="top", fontsize="small", transform=ax.transAxes, bbox={**BOX, "boxstyle": "square,pad=0.1"})
        if not whole and not count:  # show no empty axes
            here = s[closed]
            margin = 0.15 * np.ptp(here) + 0.02 * np.ptp(profile.line.s)
            ax.set_xlim(*sorted(profile.place(np.clip((here.min() - margin, here.max() + margin), 0,
                                                      profile.line.s[-1]))))
    elif not count:
        ax.set_ylim(0, 1)
    ax.yaxis.set_major_locator(rounded(4))
    fit_axis(ax.yaxis, "pressure", unit_of(result, "F/L"))
    on = f" on {named(profile.line.name, 30)}" if len(result.interfaces) > 1 else ""
    ax.set_title("" if count else f"{name}: contact pressure{on}" if closed.any() else name)
    if count:
        ax.legend(loc="best", fontsize="small")
    return ax

# SPDX-License-Identifier: GPL-3.0-or-later
"""Over the arc length of an interface."""
from __future__ import annotations

import operator
from typing import Any

import numpy as np

from ..arrays import Array
from ..result import CRACK, DELAMINATED, Interface, Load, Result, Trace, runs
from ..text import harmless
from .panel import (LINES, axes, cut, legend_below, load_of, named_without, number_text, offset_of, point_text,
                    traces_of)


def _interface(result: Result, load: Load, interface: int | str | None, pressed: bool = False) -> int:
    """The one named, or the most eventful: whose jump is largest or, if nothing is open, whose contact is longest.
    pressed: whose contact is longest, but the same one where its contact is at least half as long; as the command."""
    traces_of(result, load)
    if isinstance(interface, str):
        return result.interfaces.place(interface)
    if interface is not None:
        return operator.index(interface)
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


def _arc_length(result: Result, line: Interface) -> str:
    """For an axis."""
    start = point_text(line.x[0], line.y[0], line.s[-1])
    return f"arc length of {harmless(line.name)} from {start}{result.units.label('L')}"


def _show_zero(load: Load, trace: Trace, ax: Any) -> None:
    """Where u is rounding against that of the membrane, estimated from its energy, zero looks like zero; as the
    command's."""
    typical = float(np.sqrt(abs(load.energy))) if np.isfinite(load.energy) else 0.0
    largest = max(np.abs(values).max(initial=0) for values in (trace.u_plus, trace.u_minus, trace.jump))
    if 0 < largest < 1e-9 * typical:
        power = 10.0 ** np.floor(np.log10(typical))
        ax.update_datalim([(0, -power), (0, power)], updatex=False)
        ax.autoscale_view()


def _shade_contact(line: Interface, trace: Trace, ax: Any, load: Load, curve: Any) -> None:
    """In the colour of its curve, so that those of several loads are told apart. To the middles of the edges at its
    ends: the bands add up to the contact length."""
    middles = np.concatenate((line.s[:1], (line.s[:-1] + line.s[1:]) / 2, line.s[-1:]))
    label: str | None = f"{harmless(load.name)}: contact"
    for first, last in runs(trace.contact):
        if trace.contact[first]:
            ax.axvspan(middles[first], middles[last], color=curve.get_color(), alpha=0.2, linewidth=0, zorder=0,
                       label=label)
            label = None


def _bars(result: Result, line: Interface, ax: Any) -> None:
    """At the foot: cracks and inclusions in the colours of `interfaces`, with the names of inclusions."""
    ax.margins(y=0.12)
    labels = {kind: name for kind, (name, _) in LINES.items()}
    for begin, end in runs(line.edge_kind):
        kind = int(line.edge_kind[begin])
        if kind in LINES:
            ax.axvspan(line.s[begin], line.s[end], 0, 0.03, color=LINES[kind][1], linewidth=0,
                       label=labels.pop(kind, "_again"))
    for inclusion in sorted({int(inclusion) for inclusion in line.edge_inclusion} - {-1}):
        lies = line.edge_inclusion == inclusion
        middle = (line.s[:-1][lies].min() + line.s[1:][lies].max()) / 2
        ax.annotate(harmless(result.mesh.inclusions[inclusion]), (middle, 0.04), ha="center",
                    xycoords=ax.get_xaxis_transform())


def edge_pressure(line: Interface, trace: Trace) -> tuple[Array, Array, Array, Array]:
    """Middles of the edges, the mean pressure over them, their lengths, and which are in contact; NaN between cracks.
    Half of an edge belongs to either node, at a tip its own half to none: the force is that of the nodes, without the
    teeth of their pressures, which go up and down with the number of triangles there. As the command."""
    opens = np.isin(line.kind, (CRACK, DELAMINATED))  # on glue it is a flux
    begins, ends, edges = opens[:-1], opens[1:], np.diff(line.s)
    count, cracked = begins.astype(int) + ends, begins | ends
    pressures = np.where(opens, trace.pressure, 0)
    closed = trace.contact != 0
    middles = line.s[:-1] + np.where(begins & ends, 0.5, np.where(begins, 0.25, 0.75)) * edges
    means = (pressures[:-1] + pressures[1:]) / np.maximum(count, 1)
    found = [column[cracked] for column in (middles, means, edges * count / 2,
                                            (means > 0) & (closed[:-1] | closed[1:]))]
    gaps = [i for i in np.flatnonzero(~begins[cracked]) if i > 0]
    s, values, lengths, closed = (np.insert(column, gaps, nothing)
                                  for column, nothing in zip(found, (np.nan, np.nan, 0, False)))
    return s, values, lengths, closed


def traces(result: Result, load: str | Load | None = None, interface: int | str | None = None, ax: Any = None) -> Any:
    """u on both sides of an interface and the jump [u] = u+ - u-; contact is shaded, cracks and
    inclusions are bars. Unless it is named, the interface with the largest jump."""
    ax, load = axes(ax), load_of(result, load)
    index = _interface(result, load, interface)
    line, trace = result.interfaces[index], load.traces[index]
    first = not ax.lines
    values = np.concatenate((trace.u_minus, trace.u_plus))
    offset = offset_of(values.min(), values.max(), np.ptp(trace.jump))  # else [u] would be 0 against a lifted sheet
    name = harmless(load.name)
    (curve,) = ax.plot(line.s, trace.u_minus - offset, label=f"{name}: {named_without('$u^-$', offset)}")
    ax.plot(line.s, trace.u_plus - offset, "--", label=f"{name}: {named_without('$u^+$', offset)}")
    ax.plot(line.s, trace.jump, ":", label=f"{name}: $[u]$")
    _show_zero(load, trace, ax)
    _shade_contact(line, trace, ax, load, curve)
    if first:
        _bars(result, line, ax)
    ax.set(xlabel=_arc_length(result, line), ylabel="displacement" + result.units.label("L"),
           title=harmless(load.name) if first else "")
    legend_below(ax)  # several loads leave no room between their curves
    return ax


def pressure(result: Result, load: str | Load | None = None, interface: int | str | None = None, ax: Any = None) -> Any:
    """The contact pressure on the cracks of an interface, the mean over each edge in its middle; contact is shaded.
    Unless it is named, the interface of `traces` or, where its contact is less than half as long as another's, the one
    with the longest contact. The pressure grows without bound at tips: its spikes are cut off, and the label of the
    axis says so."""
    ax, load = axes(ax), load_of(result, load)
    index = _interface(result, load, interface, pressed=True)
    line, trace = result.interfaces[index], load.traces[index]
    s, values, lengths, closed = edge_pressure(line, trace)
    first = not ax.lines
    name = harmless(load.name) if closed.any() else f"{harmless(load.name)}: no contact"
    (curve,) = ax.plot(s, values, label=name)
    unit = result.units.label("F/L")
    label = ax.get_ylabel() or "contact pressure" + unit
    if closed.any():
        _shade_contact(line, trace, ax, load, curve)
        shown, highest = cut(values[closed], lengths[closed], 0.9, 1.5)
        ax.set_ylim(0, max(1.05 * shown, 0 if first else ax.get_ylim()[1]))
        if shown < highest:
            label = f"contact pressure{unit}, cut off at the tips, up to {number_text(highest, 2)}"
    ax.set(xlabel=_arc_length(result, line), ylabel=label, title=name if first else "")
    if not first:
        ax.legend(loc="best", fontsize="small")
    return ax

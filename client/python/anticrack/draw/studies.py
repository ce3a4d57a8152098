# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels over the rows of a study: curves over the key that varies, contours over two, and the pictures and files made
of them."""
from __future__ import annotations

from typing import Any

import numpy as np

from .. import output
from ..errors import Error
from ..output import Made
from ..study import Study
from .panel import CURVES, axes, colour_bar, fit_axis, named, rounded
from .sheet import ABOVE, BELOW, INCH, LEFT, RIGHT, Look, Sheet

_NAMES = {"energy": "energy", "contact_length": "contact length", "G": "largest G"}
_MOST = 8  # inclusions in a panel of curves, and panels of contours
_LEVELS = 12


def _places(study: Study, x: str | None) -> tuple[str, Any]:
    """The key of the horizontal axis and its values: the only one that varies, or the rows."""
    keys = [x] if x is not None else study.varying()
    return (keys[0], study[keys[0]]) if len(keys) == 1 else ("row", np.arange(len(study.rows), dtype=float))


def _columns(study: Study, name: str) -> list[str]:
    """The numbers that a name means: "A" is that of each inclusion."""
    found = [column for column in study.columns if column == name or name == "A" and column.startswith("A of ")]
    if not found:
        raise Error(f"no row of the study has {named(name)}")
    return found[:_MOST]


def _label(column: str) -> str:
    return _NAMES.get(column, named(column, 30))


def _unit(study: Study, column: str) -> str:
    return study.units.of_column(column).replace("-", "")


def curves(study: Study, name: str = "A", load: str | None = None, x: str | None = None, ax: Any = None) -> Any:
    """Draws a number of each row over the key that varies: "A" of all inclusions, "A of NAME", "energy",
    "contact_length" or "G", with bounds as bands. x: another key with numbers. load: by default the first. Where
    several keys vary, points over the rows."""
    ax = axes(ax)
    key, at = _places(study, x)
    order = np.argsort(at, kind="stable")
    columns = _columns(study, name)
    for column, (color, dash) in zip(columns, CURVES):
        values = study.column(column, load)[order]
        ax.plot(at[order], values, color=color, linestyle=dash if key != "row" else "none", marker="o",
                markersize=2.2 if len(order) <= 60 else 1.2, label=named(column.removeprefix("A of "), 18))
        kind, of, inclusion = column.partition(" of ")
        bounds = [f"{kind}_{end}{of}{inclusion}" for end in ("lower", "upper")]
        if key != "row" and set(bounds) <= set(study.columns):
            ax.fill_between(at[order], *(study.column(bound, load)[order] for bound in bounds), color=color, alpha=0.25,
                            linewidth=0)
    ax.xaxis.set_major_locator(rounded(6, integer=key == "row"))
    fit_axis(ax.xaxis, named(key, 50), "")
    ax.yaxis.set_major_locator(rounded(6))
    fit_axis(ax.yaxis, name if name == "A" and len(columns) > 1 else _label(columns[0]), _unit(study, columns[0]))
    if len(columns) > 1:
        ax.legend(loc="best", fontsize="small")
    return ax


def contours(study: Study, name: str, load: str | None = None, x: str | None = None, y: str | None = None,
             ax: Any = None, colorbar: Any = True) -> Any:
    """Draws a number of each row in colours over the two keys that vary, the rows as dots. Raises Error if other than
    two vary, or if their rows lie on a line."""
    from matplotlib.tri import Triangulation
    keys = [key for key in (x, y) if key is not None] or study.varying()
    if len(keys) != 2:
        raise Error(f"contours are over two keys, and {len(keys)} vary; name them with x= and y=")
    ax, (column,) = axes(ax), _columns(study, name)[:1]
    places, values = np.array([study[key] for key in keys]), study.column(column, load)
    known = np.isfinite(values)
    size = np.ptp(places, axis=1)
    if known.sum() < 3 or np.linalg.matrix_rank((places[:, known] - places[:, known][:, :1]) / np.where(
            size > 0, size, 1)[:, None], 1e-9) < 2:
        raise Error(f"the rows with {_label(column)} lie on a line over these keys: no contours")
    scaled = places[:, known] / np.where(size > 0, size, 1)[:, None]  # so that the triangles suit the picture
    triangles = Triangulation(*scaled).triangles
    shades = ax.tricontourf(*places[:, known], triangles, values[known], levels=_LEVELS, cmap="viridis")
    ax.tricontour(*places[:, known], triangles, values[known], levels=shades.levels, colors="white", linewidths=0.4)
    ax.plot(*places[:, known], "o", color="#222222", markersize=1.2)
    for axis, key in zip((ax.xaxis, ax.yaxis), keys):
        axis.set_major_locator(rounded(6))
        fit_axis(axis, named(key, 50), "")
    colour_bar(ax, shades, _label(column), _unit(study, column), colorbar)
    return ax


def _curves_picture(look: Look, study: Study, load: str, title: str) -> dict[str, bytes]:
    names = [name for name in ("A", "energy", "contact_length", "G") if any(
        np.isfinite(study.column(column, load)).any() for column in study.columns
        if column == name or name == "A" and column.startswith("A of "))]
    sheet = Sheet(look, title)
    panels, bottom = sheet.stack(0, [0.44 * look.width] * len(names))
    for name, ax in zip(names, panels):
        curves(study, name, load, ax=ax)
        ax.legend_ = None
    for ax in panels[:-1]:
        ax.tick_params(labelbottom=False)
        ax.set_xlabel("")
    width = panels[0].get_position().width * panels[0].figure.get_size_inches()[0]
    for ax in panels:  # aligns the axes' names, however wide the numbers are
        ax.yaxis.set_label_coords(-(LEFT - 5) / INCH / width, 0.5)
    if len(study.varying()) == 1:
        panels[0].set_title("shaded: bounds")
    handles = panels[0].get_legend_handles_labels()[0] if len(study.inclusions) > 1 else []
    return sheet.files(bottom + sheet.legend(panels[-1], 3, handles))


def _contours_picture(look: Look, study: Study, load: str, title: str, column: str) -> dict[str, bytes]:
    sheet, high = Sheet(look, title), 0.7 * look.width
    wide = look.width - LEFT - RIGHT - 15
    ax = sheet.panel(LEFT, ABOVE, wide, high)
    contours(study, column, load, ax=ax, colorbar=sheet.panel(LEFT + wide + 2.5, ABOVE, 1.8, high))
    ax.set_title(_label(column))
    return sheet.files(ABOVE + high + BELOW)


def picture(study: Study, look: Look, load: str = "", column: str = "") -> bytes:
    """The picture that draw_study makes of a load, "": the first: contours of a column, or "": curves. Raises Error if
    there is none."""
    load = load or (study.loads or [""])[0]
    title = _titled(study, load)
    with look.applied():
        made = _contours_picture(look, study, load, title, column) if column else _curves_picture(
            look, study, load, title)
    return made[look.formats[0]]


def _titled(study: Study, load: str) -> str:
    return " \u2014 ".join(text for text in (study.title, load) if text)


def draw_study(study: Study, folder: str, look: Look) -> Made:
    """Draws for every load LOAD-study, curves over the key that varies or points over the rows, and where two vary
    LOAD-NUMBER, contours. Makes the folder. Raises Error if it cannot be written or no row has an answer."""
    if not study.loads:
        raise Error("no row of the study has an answer: nothing to draw")
    drawn, maps = Made(folder), list[str]()
    output.make_folder(folder)
    if len(study.varying()) == 2:
        maps = [*(f"A of {name}" for name in study.inclusions[:_MOST]), "energy", "contact_length",
                *["G"] * ("G" in study.columns)]
    left_out = sum(not row.answers for row in study.rows)
    if left_out:
        drawn.notes.append(f"{left_out} of {len(study.rows)} rows have no answer and are left out")
    with look.applied():
        for load, stem in zip(study.loads, output.stems(study.loads, ["-study"])):
            title = _titled(study, load)
            for column in maps:
                try:
                    made = _contours_picture(look, study, load, title, column)
                    drawn.add(output.stems([f"{stem}-{column.replace(' of ', '-')}"], [])[0], made)
                except Error as error:
                    drawn.notes.append(f'load "{named(load)}": {error}')
            if not maps:
                drawn.add(f"{stem}-study", _curves_picture(look, study, load, title))
    return drawn

# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers and tables for people to read."""
from __future__ import annotations

import difflib
import html
import math
import re
import unicodedata
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

# Characters that Unicode ignores though their category does not say so.
_IGNORABLE = re.compile("[\u034f\u115f\u1160\u17b4\u17b5\u180b-\u180f\u2065\u3164\ufe00-\ufe0f\uffa0"
                        "\ufff0-\ufff8\U000e0000-\U000e0fff]")
_HIDDEN = {"Cc", "Cf", "Cs", "Zl", "Zp"}


def harmless(text: object, keep: str = "") -> str:
    """Makes text of others safe to show on a terminal or a page, as the command does: invisible characters, as line
    breaks and marks of the writing direction, become "?", except those in `keep`."""
    return "".join(c if c in keep or not (unicodedata.category(c) in _HIDDEN or _IGNORABLE.match(c)) else "?"
                   for c in str(text))


def interval(value: float, lower: float, upper: float, mesh: float, unit: str = "", error: str = "",
             probable: str = "") -> str:
    """Writes a value with the distance of its bounds, as the command's tables do, its relative error if given, and the
    value on the mesh: "0.4483 +- 0.0038 mm (0.85 %; 0.4462 on the mesh)". The printed interval contains the bounds.
    After it what the value probably is, by an estimate: ", probably 0.4472 +- 0.0001 mm". Without bounds it is the
    value alone."""
    error = error and f"{error}; "
    if not math.isfinite(lower) or not math.isfinite(upper):
        return f"{value:.6g}{unit}"
    half = (upper - lower) / 2
    size = max(abs(value), half)
    if not size > 0:
        return f"0 +- 0{unit} ({error}{mesh:.6g} on the mesh)"

    def decade(number: float) -> int:
        return math.floor(math.log10(number))
    most = 6  # digits after the first digit of the larger number
    exponent = decade(size) if decade(size) < -4 or decade(size) > 5 else 0
    behind = min(most - decade(size), 1 - decade(half) if half > 0 else most)
    step = 10.0 ** -behind
    shown = math.copysign(math.floor(abs(value) / step + 0.5), value) * step
    beside = math.ceil(max(upper - shown, shown - lower) / step - 1e-6) * step
    texts = [f"{_unsigned(number / 10.0 ** exponent, max(0, behind + exponent)):.{max(0, behind + exponent)}f}"
             for number in (shown, beside, mesh)]
    probable = probable and f", probably {probable}"
    if not exponent:
        return f"{texts[0]} +- {texts[1]}{unit} ({error}{texts[2]} on the mesh){probable}"
    return f"({texts[0]} +- {texts[1]})e{exponent}{unit} ({error}{texts[2]}e{exponent} on the mesh){probable}"


def between(value: float, lower: float, upper: float, unit: str = "") -> str:
    """Writes the interval alone: "0.4483 +- 0.0038 mm"."""
    return interval(value, lower, upper, value, unit).partition(" (")[0]


def with_bounds(of: Any, name: str, unit: str = "") -> str:
    """Writes the interval of a value of an answer, "A", "energy" and so on, and of A its relative error, as the command
    does: "0.85 %" of itself unless it may be 0, and where it is nearer to 0 "40 %; 0.3 % of 0.05 mm", of its scale.
    Then what curves in place of their chords may change, by estimate: ", chords +- 1e-05 mm"."""
    value, lower, upper, mesh = (getattr(of, name + part) for part in ("", "_lower", "_upper", "_mesh"))
    relative, errors = getattr(of, f"{name}_error_relative", math.nan), []
    if math.isfinite(relative):
        half = (upper - lower) / 2
        if not lower <= 0 <= upper:
            errors.append(per_cent(half / abs(value)))
        if half > 0 and (not value or relative < half / abs(value)):
            errors.append(f"{per_cent(relative)} of {of.A_scale:.3g}{unit}")
    gap = getattr(of, f"{name}_geometry_error", math.nan)
    chords = f", chords +- {gap:.2g}{unit}" if math.isfinite(gap) else ""
    probable = _probable(of, unit) if name == "A" else ""
    return interval(value, lower, upper, mesh, unit, "; ".join(errors), probable) + chords


def _probable(of: Any, unit: str) -> str:
    """The interval of the estimate of A, where it is closer than the bounds."""
    error = getattr(of, "A_error_probable", math.nan)
    middle = of.A_mesh + getattr(of, "A_estimated_error", math.nan)
    if not error < (of.A_upper - of.A_lower) / 2:
        return ""
    return between(middle, middle - error, middle + error, unit)


def per_cent(error: float) -> str:
    return f"{100 * error:.{2 if error < 1 else 3}g} %"


def _unsigned(number: float, decimals: int) -> float:
    """Returns 0.0 for a number that prints as zeros only, so that no "-0.00" appears."""
    return 0.0 if abs(number) < 0.5 * 10.0 ** -decimals else number


def short_length(length: float) -> str:
    """Writes a contact length with three digits: it has no bounds and is known to about one edge of the mesh."""
    return f"{float(f'{length:.3g}'):.6g}"


def without_numpy(value: Any) -> Any:
    """Replaces numpy's numbers by Python's, as numpy 2 shows np.float64(0.5) for 0.5."""
    if isinstance(value, np.generic):
        return value.item()
    return type(value)(map(without_numpy, value)) if type(value) in (list, tuple) else value


def short(text: str, most: int = 60) -> str:
    """Puts a text on one line and cuts it."""
    text = harmless(" ".join(text.split()))
    return text if len(text) <= most else text[:most] + "..."


def shown(value: Any) -> str:
    """Shows a value of a case in an error."""
    if isinstance(value, bool):
        return str(value).lower()
    if callable(value):
        return f"the Python function {getattr(value, '__name__', value)}"
    return short(f"'{value}'" if isinstance(value, str) else str(without_numpy(value)))


def counted(count: int, one: str) -> str:
    return f"{count} {one}{'' if count == 1 else 's'}"


def listed(names: Iterable[object], most: int = 20) -> str:
    """Joins names with commas; of many it shows the first."""
    texts = [harmless(name) for name in names]
    return ", ".join(texts[:most]) + (f" and {len(texts) - most} more" if len(texts) > most else "")


def suggestion(word: str, known: Iterable[str]) -> str:
    """Suggests the nearest known word, or lists the known ones, as the command does."""
    known = list(known)
    near = difflib.get_close_matches(word, known, 1)
    if near:
        return f"did you mean {harmless(near[0])}?"
    return f"known are {listed(known)}" if known else "there are none"


def lines(items: Sequence[object], most: int = 10) -> str:
    """Writes one item a line; of many it shows the first."""
    more = [f"and {len(items) - most} more"] if len(items) > most else []
    return "\n".join([repr(item) for item in items[:most]] + more)


def html_table(title: str, head: Sequence[str], rows: Sequence[Sequence[str]], most: int = 50) -> str:
    """Makes a table in HTML; of many rows it shows the first."""
    def row(cells: Sequence[str], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(harmless(cell))}</{tag}>" for cell in cells) + "</tr>"
    more = f"<p>and {len(rows) - most} more</p>" if len(rows) > most else ""
    return (f"<p>{html.escape(harmless(title))}</p><table>{row(head, 'th')}"
            f"{''.join(row(cells, 'td') for cells in rows[:most])}</table>{more}")

# SPDX-License-Identifier: GPL-3.0-or-later
"""What is made of measured numbers. Pure."""
import math
import statistics


class Disagreement(Exception):
    """Two programs gave different answers to one discrete problem."""


def median(times, clock):
    """Of {"wall": [...], "cpu": [...]} as the programs print times, seconds."""
    return statistics.median(times[clock])


def exponent(sizes, values):
    """Slope of log(value) over log(size) by least squares; None where there are not two sizes."""
    points = [(math.log(s), math.log(v)) for s, v in zip(sizes, values) if s > 0 and v > 0]
    if len({x for x, _ in points}) < 2:
        return None
    mean_x = statistics.fmean(x for x, _ in points)
    mean_y = statistics.fmean(y for _, y in points)
    above = sum((x - mean_x) * (y - mean_y) for x, y in points)
    return above / sum((x - mean_x) ** 2 for x, _ in points)


def difference(ours, theirs):
    """Largest difference of A and energy over the load cases both have, relative to the largest."""
    worst = 0.0
    for name in ("displacement", "energy"):
        pairs = list(zip(ours[name], theirs[name]))
        if not pairs:
            raise Disagreement(f"no {name} to compare")
        if not all(math.isfinite(value) for pair in pairs for value in pair):
            raise Disagreement(f"some {name} is not finite")
        scale = max(abs(value) for pair in pairs for value in pair)
        if scale > 0:
            worst = max(worst, max(abs(a - b) for a, b in pairs) / scale)
    return worst


def require_agreement(who, ours, theirs, tolerance=1e-9):
    found = difference(ours, theirs)
    if not found <= tolerance:
        raise Disagreement(f"{who}: A or energy differ by {found:.1e}, more than {tolerance:.0e}")
    return found

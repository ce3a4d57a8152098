# SPDX-License-Identifier: GPL-3.0-or-later
"""What has to be reached, and what was: computed from the figures of one run."""
from harness.numbers import median


class Row:
    """`reached` is None where a figure is missing."""

    def __init__(self, measure, bound, reached, unit, at_least):
        self.measure = measure
        self.bound = bound
        self.reached = reached
        self.unit = unit
        self.at_least = at_least

    @property
    def verdict(self):
        if self.reached is None:
            return "not measured"
        met = self.reached >= self.bound if self.at_least else self.reached <= self.bound
        return "pass" if met else "fail"

    def as_dict(self):
        return {"measure": self.measure, "bound": self.bound, "at_least": self.at_least,
                "reached": self.reached, "unit": self.unit, "verdict": self.verdict}


def _value(compute):
    """None where what it needs was not measured."""
    try:
        return compute()
    except (KeyError, IndexError, TypeError):
        return None


def best_of(methods, what, clock):
    """The fastest of PETSc's orderings at one thing: a peer may choose for each."""
    return min(median(figures[what], clock) for label, figures in methods.items()
               if label.startswith("schur"))


def rows(figures, clock):
    def at_least(measure, bound, compute, unit="x"):
        return Row(measure, bound, _value(compute), unit, True)

    def at_most(measure, bound, compute, unit):
        return Row(measure, bound, _value(compute), unit, False)

    freefem, service = figures.get("freefem", {}), figures.get("service", {})
    ours, petsc = figures.get("ours", {}), figures.get("petsc", {})
    result = [
        at_least("Uzawa iteration, paper's mesh, against FreeFEM++", 40,
                 lambda: median(freefem["per_iteration"], clock)
                 / median(freefem["ours"]["per_iteration"], clock)),
        at_least("load case through gRPC, paper's mesh, against FreeFEM++", 250,
                 lambda: median(freefem["per_load"], clock) / median(service["load_case"], "wall")),
    ]
    for mesh in ours:
        def first(threads, mesh=mesh):
            return (best_of(petsc[mesh], "first", clock)
                    / median(ours[mesh][str(threads)]["first"], clock))

        def further(time, mesh=mesh):
            return best_of(petsc[mesh], "further", clock) / time(ours[mesh]["1"])

        def bounded(what, mesh=mesh):
            own = ours[mesh]["2"]
            return (best_of(petsc[mesh], what, clock)
                    / sum(median(own[part], clock) for part in (what, "fields", "estimate")))

        result += [
            at_least(f"first answer, two threads, against PETSc + MUMPS, {mesh}", 2,
                     lambda first=first: first(2)),
            at_least(f"first answer, one thread, against PETSc + MUMPS, {mesh}", 1,
                     lambda first=first: first(1)),
            at_least(f"first answer with bounds, two threads, against PETSc + MUMPS without, {mesh}", 2.5,
                     lambda bounded=bounded: bounded("first")),
            at_least(f"further load with bounds, two threads, against PETSc + MUMPS without, {mesh}", 3,
                     lambda bounded=bounded: bounded("further")),
            at_least(f"further load alone, against PETSc + MUMPS, {mesh}", 4,
                     lambda further=further: further(lambda f: median(f["further"], clock))),
            at_least(f"further load in blocks of 32, against PETSc + MUMPS, {mesh}", 8,
                     lambda further=further: further(
                         lambda f: median(f["block"]["per_load"], clock))),
        ]
    solves = figures.get("limits", {}).get("solves", {})

    def over_bandwidth():
        """A solve reads the factor twice: forward and backward."""
        solve = median(solves["forward"], clock) + median(solves["backward"], clock)
        return solve / (2 * median(solves["reading"], clock))

    largest = (figures.get("growth", {}).get("runs") or [{}])[-1]
    result += [
        at_least("combinations a second through gRPC, end to end", 10_000,
                 lambda: 1 / median(service["combination"], "wall"), "1/s"),
        at_least("nodal loads a second through gRPC, end to end", 1_000,
                 lambda: 1 / median(service["nodal_load"], "wall"), "1/s"),
        at_most("single solve over the time to read the factor, forward and backward", 2, over_bandwidth, "x"),
        at_least("blocked solve, a column of 32, against single, forward and backward", 3,
                 lambda: (median(solves["forward"], clock) + median(solves["backward"], clock))
                 / (median(solves["forward_per_column"], clock)
                    + median(solves["backward_per_column"], clock))),
        at_most("largest mesh, from geometry to first answer", 15,
                lambda: median(largest["made"]["meshing"], "wall") + median(largest["first"], "wall"), "s"),
        at_most("largest mesh, memory an unknown", 1_200,
                lambda: max(largest["memory_peak"], largest["made"]["helper_memory"])
                / largest["unknowns"], "B"),
        at_most("largest mesh, from a cached operator to the next answer", 0.25,
                lambda: median(largest["further"], clock), "s"),
        at_least("iteration samples a second to one watcher", 2_000_000,
                 lambda: 1 / median(service["sample"], "wall"), "1/s"),
        at_most("service over solving in process, a load case of a job with many, paper's mesh", 1e-3,
                lambda: median(service["load_case"], "wall") - median(service["in_process_block"], "wall"),
                "s"),
        at_most("service over solving in process, a job of one load case, paper's mesh", 1e-3,
                lambda: median(service["single_case"], "wall") - median(service["in_process"], "wall"),
                "s"),
    ]
    return result

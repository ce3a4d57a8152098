# SPDX-License-Identifier: GPL-3.0-or-later
"""The figures of a run as Markdown."""
from harness.numbers import median


def number(value):
    if value is None:
        return "-"
    if value != 0 and (abs(value) >= 1e5 or abs(value) < 1e-2):
        return f"{value:.2e}"
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:,.0f}"


def _grid(head, lines):
    out = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return out + ["| " + " | ".join(line) + " |" for line in lines] + [""]


def _targets(rows):
    return _grid(["measure", "wanted", "reached", ""], [
        [row.measure, ("at least " if row.at_least else "at most ") + f"{number(row.bound)} {row.unit}",
         f"{number(row.reached)} {row.unit}" if row.reached is not None else "-", row.verdict]
        for row in rows])


def _peers(figures, clock):
    lines = []
    petsc = figures.get("petsc", {})
    for mesh, by_threads in figures.get("ours", {}).items():
        for threads, run in by_threads.items():
            lines.append([mesh, f"ours, {threads} thread(s)", number(median(run["first"], clock)),
                          number(median(run["further"], clock)), "", ""])
            if threads == "1":
                lines.append([mesh, "ours, in blocks of 32", "",
                              number(median(run["block"]["per_load"], clock)), "", ""])
        own = by_threads["1"]
        for label, peer in petsc.get(mesh, {}).items():
            lines.append([mesh, f"PETSc {label}", number(median(peer["first"], clock)),
                          number(median(peer["further"], clock)), f"{peer['difference']:.1e}",
                          f"{median(peer['first'], clock) / median(own['first'], clock):.2f} / "
                          f"{median(peer['further'], clock) / median(own['further'], clock):.2f}"])
    freefem = figures.get("freefem")
    if freefem:
        own = freefem["ours"]
        lines.append([freefem["mesh"], "ours, Algorithm 2", "", number(median(own["per_load"], clock)), "", ""])
        lines.append([freefem["mesh"], "FreeFEM++, Algorithm 2", number(freefem["preparing"]),
                      number(median(freefem["per_load"], clock)), f"{freefem['difference']:.1e}",
                      f"- / {median(freefem['per_load'], clock) / median(own['per_load'], clock):.2f}"])
    return _grid(["mesh", "who", "first answer, s", "further load, s", "difference of A and energy",
                  "times slower than ours on one thread"], lines) if lines else []


def _sweeps(figures, clock):
    """Rows against the operations they need at least: the load's combination on the contacts, a
    product with the matrix a step, a Cholesky factor of the open nodes in the first step. What
    follows from the row before is not taken off."""
    lines = []
    for mesh, by_threads in figures.get("ours", {}).items():
        run, sweep = by_threads["1"], by_threads["1"].get("sweep")
        if not sweep:
            continue
        seconds = median(sweep["per_row"], clock)
        flops = (2 * run["contacts"] * sweep["basis"] + 2 * sweep["steps_per_row"] * run["contacts"] ** 2
                 + sweep["open_per_row"] ** 3 / 3)
        part = "-"
        if "limits" in figures:
            part = f"{flops * median(figures['limits']['dgemm'][0]['per_flop'], clock) / seconds:.0%}"
        lines.append([mesh, number(run["contacts"]), number(1 / seconds), number(sweep["steps_per_row"]),
                      number(flops / seconds / 1e9), part])
    return _grid(["mesh", "contacts", "rows a second, one thread", "steps a row", "Gflop/s needed",
                  "of dgemm's rate"], lines) if lines else []


def _growth(growth):
    names = list(growth["exponents"])
    head = ["triangles", "unknowns"] + names
    lines = []
    for i, run in enumerate(growth["runs"]):
        lines.append([number(run["triangles"]), number(run["unknowns"])]
                     + [number(growth["exponents"][name]["values"][i]) for name in names])
    lines.append(["exponent", ""] + [number(growth["exponents"][name]["exponent"]) for name in names])
    return ["Exponents are over the unknowns; h goes like their power -1/2.", ""] + _grid(head, lines)


def _limits(limits, clock):
    lines = []
    for entry in limits["bandwidth"]:
        lines.append([f"memory read, {entry['threads']} thread(s)",
                      f"{1e-9 / median(entry['read_per_byte'], clock):.1f} GB/s"])
        lines.append([f"STREAM triad, {entry['threads']} thread(s)",
                      f"{1e-9 / median(entry['triad_per_byte'], clock):.1f} GB/s"])
    for entry in limits["dgemm"]:
        lines.append([f"dgemm, {entry['threads']} thread(s)",
                      f"{1e-9 / median(entry['per_flop'], clock):.1f} Gflop/s"])
        lines.append([f"dgemm, {entry['columns']} columns, {entry['threads']} thread(s)",
                      f"{1e-9 / median(entry['per_flop_narrow'], clock):.1f} Gflop/s"])
    solves = limits["solves"]
    rate = 2 * solves["factor_bytes"] / 8 / median(solves["forward_per_column"], clock)
    lines += [["unknowns of the solves", number(solves["unknowns"])],
              ["factor", f"{solves['factor_bytes'] / 1e6:.1f} MB"],
              ["reading it", number(median(solves["reading"], clock)) + " s"],
              ["forward solve", number(median(solves["forward"], clock)) + " s"],
              ["backward solve", number(median(solves["backward"], clock)) + " s"],
              [f"forward solve, a column of {solves['columns']:.0f}",
               number(median(solves["forward_per_column"], clock)) + " s"],
              [f"backward solve, a column of {solves['columns']:.0f}",
               number(median(solves["backward_per_column"], clock)) + " s"],
              ["forward solves of a block as a part of dgemm's rate",
               f"{rate * median(limits['dgemm'][0]['per_flop'], clock):.0%}"]]
    return _grid(["limit", ""], lines)


def _orderings(orderings, clock):
    return _grid(["mesh", "order of elimination", "ordering, s", "entries of the factor", "operations"], [
        [mesh, name.replace("_", " "), number(median(run["ordering"], clock)), number(run["entries"]),
         number(run["operations"])]
        for mesh, by_name in orderings.items() for name, run in by_name.items()])


def _kernels(kernels):
    return _grid(["kernel", "s", "items a second"], [
        [name, number(value["seconds"]), number(value["items_per_second"])]
        for name, value in kernels.items()])


def _service(service):
    return _grid(["through gRPC on loopback", "s"], [
        [name, number(median(value, "wall"))] for name, value in service.items()
        if isinstance(value, dict) and "wall" in value])


def markdown(results, rows):
    machine, figures, clock = results["machine"], results["figures"], results["clock"]
    text = ["# Benchmarks", "",
            f"{machine['processor']}, {machine['cores']} cores, {machine['memory_bytes'] / 2**30:.0f} GiB; "
            f"{machine['system']}; {machine['compiler']}, {machine['build_type']}; "
            f"{figures.get('limits', {}).get('blas', 'BLAS not asked')}; load average before: "
            f"{machine['load_before']:.2f}.",
            "Tiny meshes: shows that it works, the targets mean nothing." if results["tiny"] else "",
            f"Medians of {results['repetitions']} and more, {clock} time; ratios are of this run.", "",
            "## Targets", ""] + _targets(rows)
    sections = [("Peers", _peers(figures, clock)),
                ("Sweeps in process", _sweeps(figures, clock)),
                ("Limits", _limits(figures["limits"], clock) if "limits" in figures else []),
                ("Orderings", _orderings(figures["orderings"], clock) if "orderings" in figures else []),
                ("Kernels", _kernels(figures["kernels"]) if "kernels" in figures else []),
                ("Service", _service(figures["service"]) if "service" in figures else []),
                ("Growth", _growth(figures["growth"]) if "growth" in figures else [])]
    for title, lines in sections:
        if lines:
            text += [f"## {title}", ""] + lines
    if results["skipped"]:
        text += ["## Left out", ""] + [f"- {group}: {why}" for group, why in results["skipped"].items()] + [""]
    return "\n".join(text)

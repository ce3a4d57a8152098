# SPDX-License-Identifier: GPL-3.0-or-later
"""What `run` makes of numbers: medians, exponents, agreement, verdicts, the table."""
import unittest

from harness import numbers, table, targets


def times(*seconds):
    return {"wall": list(seconds), "cpu": [2 * s for s in seconds]}


def run(first, further, block):
    return {"first": times(first), "further": times(further), "block": {"per_load": times(block)}}


def peer(first, further):
    return {"first": times(first), "further": times(further), "difference": 1e-12}


FIGURES = {
    "ours": {"paper": {"1": run(1.0, 0.1, 0.05), "2": run(0.6, 0.1, 0.05)}},
    "petsc": {"paper": {"schur-3": peer(1.5, 0.9), "schur-5": peer(2.0, 0.45), "tron": peer(0.1, 0.01)}},
    "limits": {
        "blas": "a BLAS",
        "bandwidth": [{"threads": 1, "read_per_byte": times(2e-10), "triad_per_byte": times(1e-10)}],
        "dgemm": [{"threads": 1, "columns": 32, "per_flop": times(1e-10), "per_flop_narrow": times(2e-10)}],
        "solves": {"unknowns": 10, "factor_bytes": 1e9, "columns": 32, "reading": times(0.1),
                   "forward": times(0.2), "backward": times(0.3), "forward_per_column": times(0.05),
                   "backward_per_column": times(0.06)}},
    "service": {"load_case": times(2e-4), "in_process_block": times(1e-4), "combination": times(5e-5),
                "nodal_load": times(2e-3), "sample": times(1e-7)},
}


def verdicts(figures):
    return {row.measure: row.verdict for row in targets.rows(figures, "wall")}


class Numbers(unittest.TestCase):
    def test_median_is_of_the_clock_asked_for(self):
        self.assertEqual(numbers.median(times(3, 1, 2), "wall"), 2)
        self.assertEqual(numbers.median(times(3, 1, 2), "cpu"), 4)

    def test_exponent_of_a_power(self):
        sizes = [1e4, 1e5, 1e6]
        self.assertAlmostEqual(numbers.exponent(sizes, [3 * s**1.5 for s in sizes]), 1.5)
        self.assertIsNone(numbers.exponent([1e4, 1e4], [1, 2]))
        self.assertIsNone(numbers.exponent([1e4], [1]))

    def test_difference_is_relative_to_the_largest(self):
        ours = {"displacement": [100.0, 1.0], "energy": [-4.0, -2.0]}
        theirs = {"displacement": [100.0, 1.0 + 1e-6], "energy": [-4.0, -2.0]}
        self.assertAlmostEqual(numbers.difference(ours, theirs), 1e-8, delta=1e-12)

    def test_disagreement_is_said_with_who(self):
        ours = {"displacement": [1.0], "energy": [-1.0]}
        numbers.require_agreement("a peer", ours, ours)
        with self.assertRaisesRegex(numbers.Disagreement, "a peer"):
            numbers.require_agreement("a peer", ours, {"displacement": [1.0], "energy": [-1.0 - 1e-8]})
        with self.assertRaises(numbers.Disagreement):
            numbers.require_agreement("a peer", ours, {"displacement": [float("nan")], "energy": [-1.0]})
        with self.assertRaises(numbers.Disagreement):
            numbers.require_agreement("a peer", ours, {"displacement": [], "energy": []})


class Targets(unittest.TestCase):
    def test_a_peer_is_judged_by_its_best_ordering_for_each_thing(self):
        rows = {row.measure: row.reached for row in targets.rows(FIGURES, "wall")}
        self.assertAlmostEqual(rows["first answer, one thread, against PETSc + MUMPS, paper"], 1.5)
        self.assertAlmostEqual(rows["first answer, two threads, against PETSc + MUMPS, paper"], 2.5)
        self.assertAlmostEqual(rows["further load alone, against PETSc + MUMPS, paper"], 4.5)

    def test_bounds_work_both_ways(self):
        found = verdicts(FIGURES)
        self.assertEqual(found["further load in blocks of 32, against PETSc + MUMPS, paper"], "pass")
        self.assertEqual(found["combinations a second through gRPC, end to end"], "pass")
        self.assertEqual(found["nodal loads a second through gRPC, end to end"], "fail")
        # 0.2 s + 0.3 s against twice 0.1 s
        self.assertEqual(found["single solve over the time to read the factor, forward and backward"], "fail")
        self.assertEqual(found["blocked solve, a column of 32, against single, forward and backward"], "pass")
        of_many = "service over solving in process, a load case of a job with many, paper's mesh"
        self.assertEqual(found[of_many], "pass")

    def test_what_was_not_measured_does_not_pass(self):
        self.assertEqual(set(verdicts({}).values()), {"not measured"})


class Table(unittest.TestCase):
    def test_names_the_machine_and_every_target(self):
        rows = targets.rows(FIGURES, "wall")
        text = table.markdown({
            "machine": {"processor": "a processor", "cores": 2, "memory_bytes": 2**30, "system": "a system",
                        "compiler": "a compiler", "build_type": "Release", "load_before": 0.1},
            "figures": FIGURES, "clock": "wall", "repetitions": 5, "tiny": False,
            "skipped": {"freefem": "not installed"}}, rows)
        for what in ("a processor", "a compiler", "Release", "a BLAS", "freefem: not installed", "PETSc tron"):
            self.assertIn(what, text)
        for row in rows:
            self.assertIn(row.measure, text)
        self.assertIn("| 500 1/s | fail |", text)


if __name__ == "__main__":
    unittest.main()

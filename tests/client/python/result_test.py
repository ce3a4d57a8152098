# SPDX-License-Identifier: GPL-3.0-or-later
"""Result files of the command and answers from the server are the same objects."""
import copy
import dataclasses
import json
import os
import pathlib
import re
import sys
import warnings

import h5py
import numpy

import anticrack
from anticrack.text import interval
from processes import ANTICRACK, Daemon, FolderTest, run

EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])
SAME = pathlib.Path(os.environ["SAME"])
ACCURATE = """
[geometry]
boundary = [[-1,-1], [1,-1], [1,1], [-1,1]]
interface = [[-1,0], [1,0]]
[[geometry.inclusion]]
name = "fibre"
from = [-0.5, 0]
to = [0.5, 0]
[[load]]
name = "skew"
f = "x * y > 0 ? 1 : -1"
[accuracy]
energy = 0.05
[units]
length = "mm"
force = "N"
"""


def units_in(path):
    """Of each dataset of a file, by all its names."""
    def walk(group, name):
        if isinstance(group, h5py.Dataset):
            units = group.attrs["units"]
            return {name: units if isinstance(units, str) else dict(zip(group.dtype.names, units))}
        return {key: unit for part in group for key, unit in walk(group[part], f"{name}/{part}").items()}

    with h5py.File(path) as file:
        return walk(file, "")


class Results(FolderTest):
    def assert_same(self, ours, theirs, where):
        """Records, lists, dictionaries and arrays; NaN is NaN."""
        if dataclasses.is_dataclass(ours):
            for field in dataclasses.fields(ours):
                self.assert_same(getattr(ours, field.name), getattr(theirs, field.name), f"{where}.{field.name}")
        elif isinstance(ours, dict):
            self.assertEqual(list(ours) if where == ".loads" else sorted(ours),
                             list(theirs) if where == ".loads" else sorted(theirs), where)
            for key, value in ours.items():
                self.assert_same(value, theirs[key], f"{where}[{key}]")
        elif isinstance(ours, (list, tuple)):
            self.assertEqual(len(ours), len(theirs), where)
            for i, value in enumerate(ours):
                self.assert_same(value, theirs[i], f"{where}[{i}]")
        elif isinstance(ours, (numpy.ndarray, float)):
            numpy.testing.assert_array_equal(ours, theirs, where)
        else:
            self.assertEqual(ours, theirs, where)

    def both(self, case, *arguments, wanted=0):
        """As the command saved it, and as the server tells it."""
        path = self.folder / "result.h5"
        with Daemon(self.folder) as daemon, anticrack.connect(f"127.0.0.1:{daemon.port}") as client:
            ended = run(ANTICRACK, "--server", f"127.0.0.1:{daemon.port}", *arguments, case, "-o", path)
            self.assertEqual(ended.returncode, wanted, ended.stderr)
            file = anticrack.read(path)
            told = client.job(file.job).result()
        told.case, told.total_seconds = file.case, file.total_seconds  # which the server does not tell
        for info in (file.mesh.info, told.mesh.info):  # they are told at different times
            info.ClearField("state"), info.ClearField("operator_bytes")
        return file, told

    def assert_saved(self, result):
        """A file of ours is read back as it was, and the command takes it for its own."""
        path = self.folder / "saved.h5"
        result.save(path)
        self.assert_same(result, anticrack.read(path), "")
        ours, theirs = units_in(path), units_in(self.folder / "result.h5")
        self.assertEqual(ours, {name: theirs[name] for name in ours})
        shown = [run(ANTICRACK, "--json", "show", file) for file in (path, self.folder / "result.h5")]
        self.assertEqual([ended.returncode for ended in shown], [0, 0], shown[0].stderr)
        ours, theirs = (json.loads(ended.stdout) for ended in shown)
        for told in (ours, theirs):
            told.pop("file")
            for name in ("state", "operator_bytes"):
                told["mesh"].pop(name)
            told.get("sweep", {}).pop("source", None)
        self.assertEqual(ours, theirs)
        for command in ("plot", "export") if all(load.fields for load in result.loads.values()) else ("plot",):
            ended = run(ANTICRACK, command, path, "-o", self.folder / command)
            self.assertEqual(ended.returncode, 0, ended.stderr)

    def test_of_load_cases(self):
        for name in ("several-inclusions", "tilt", "floating", "paper-2"):
            file, told = self.both(EXAMPLES / f"{name}.toml", "run")
            self.assert_same(file, told, "")
            self.assertTrue(file.case.startswith("# SPDX"))
            self.assert_saved(told)

    def test_of_load_cases_that_failed_and_did_not_converge(self):
        case = self.folder / "failing.toml"
        text = ACCURATE.partition("[accuracy]")[0] + """
[[load]]
name = "infinite"
f = "1 / (x - x)"
[solver]
method = "uzawa"
max_iterations = 3
"""
        case.write_text(text, encoding="utf-8")
        file, told = self.both(case, "run", wanted=1)
        self.assert_same(file, told, "")
        self.assertEqual((told["skew"].status, told["infinite"].status), ("not_converged", "failed"))
        self.assert_saved(told)

    def test_of_stages(self):
        case = self.folder / "accurate.toml"
        case.write_text(ACCURATE, encoding="utf-8")
        file, told = self.both(case, "run")
        self.assert_same(file, told, "")
        self.assertGreater(len(file["skew"].stages["triangles"]), 1)
        self.assert_saved(told)

    def test_of_sweeps(self):
        table = EXAMPLES / "load-ratio.csv"
        file, told = self.both(EXAMPLES / "load-ratio.toml", "sweep", "--coefficients", table, "--traces", "0,2",
                               "--bounds")
        self.assertTrue((file.sweep.energy_lower < file.sweep.energy).all())
        self.assertEqual(file.sweep.kept, [0, 2])
        told.sweep.coefficients = file.sweep.coefficients  # which the server does not tell
        self.assert_same(file, told, "")
        self.assert_saved(told)

    def test_of_another_case_are_kept(self):
        file, _ = self.both(EXAMPLES / "slit.toml", "run")
        path = self.folder / "saved.h5"
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            file.save(path)
            file.job = "jobs/other"
            file.save(path)  # the same case
        file.job, file.case = "jobs/third", "another"
        with self.assertWarnsRegex(UserWarning, "^kept .*saved.h5~, what saved.h5 was before$") as caught:
            file.save(path)
        self.assertEqual(caught.filename, __file__)
        self.assertEqual(anticrack.read(f"{path}~").job, "jobs/other")
        path.write_text("not a result")
        with self.assertWarns(UserWarning):
            file.save(path)
        self.assertEqual(pathlib.Path(f"{path}~").read_text(), "not a result")
        self.assertEqual(anticrack.read(path).case, "another")

    def test_as_a_table(self):
        file, _ = self.both(EXAMPLES / "several-inclusions.toml", "run")
        frame = file.frame()
        self.assertEqual(list(frame.index), ["opening", "pulled"])
        self.assertEqual(frame.loc["pulled", "A of short"], file["pulled"].inclusions["short"].A)
        self.assertEqual(frame["energy"].tolist(), [load.energy for load in file.loads.values()])
        self.assertEqual(frame.attrs["meanings"]["energy_mesh"], "Pi of u on the mesh")
        self.assertLess(set(frame.attrs["meanings"]) - {"name", *(f"kkt_{name}{end}" for name in anticrack.result.KKT
                                                                  for end in ("", "_relative"))}, set(frame.columns))

    def test_are_told_in_a_few_lines(self):
        case = self.folder / "accurate.toml"
        case.write_text(ACCURATE, encoding="utf-8")
        file, told = self.both(case, "run")
        shown = run(ANTICRACK, "show", self.folder / "result.h5").stdout
        for result in (file, told):
            title, load, part = repr(result).split("\n")
            self.assertEqual(title, f"result: {len(result.mesh.triangles)} triangles, 1 load case")
            self.assertRegex(load, r"^skew: converged, energy = -[\d.]+ \+- [\d.]+ N mm \(-[\d.]+ on the mesh\)")
            self.assertRegex(part, r"^  fibre: A = .* mm \(.* on the mesh\), probably .* mm$")
            result["skew"].contact_length = 1234.5
            self.assertIn("contact length 1230 mm", repr(result["skew"]), "without bounds, so three digits")
            for line in (load, part):  # the words of the command
                self.assertIn(re.search(r"= (\(.*?\)e-\d+|.*? \+- [\d.]+)", line)[1], shown)
            self.assertIn("<td>fibre</td>", result["skew"]._repr_html_())
            self.assertIn("<th>A of fibre [mm]</th>", result._repr_html_())
            for item in (result.mesh, *result.interfaces, *result["skew"].traces, result["skew"].inclusions["fibre"]):
                self.assertLess(len(repr(item)), 200)

    def test_texts_of_others_are_harmless_where_they_are_shown(self):
        bad = "a\u202eb\u2066\u061c\u200b\u2028\x1b[2J\nFORGED\U000e0041"
        file, _ = self.both(EXAMPLES / "several-inclusions.toml", "run")
        result = copy.deepcopy(file)
        result.title = result.not_reached = bad
        result.mesh.info.inclusions[0] = result.mesh.info.subdomains[0].name = bad
        load = result["pulled"]
        load.name = load.reason = load.traces[0].name = result.interfaces[0].name = load.fields[0].subdomain = bad
        part = next(iter(load.inclusions.values()))
        part.name = bad
        error = anticrack.ServerError("INTERNAL", bad)
        shown = [repr(thing) for thing in (result, result.mesh, result.interfaces, load, load.traces, load.fields, part,
                                           load.inclusions)]
        for text in (*shown, str(error), result._repr_html_(), load._repr_html_()):
            self.assertIn("a?b", text)
            self.assertTrue(all(c.isprintable() or c == "\n" for c in text), text)
        for text in shown:
            self.assertNotRegex(text, "(?m)^FORGED")

    def test_are_found_by_name(self):
        file, _ = self.both(EXAMPLES / "several-inclusions.toml", "run")
        load = copy.deepcopy(file["pulled"])
        self.assertEqual(load.traces["upper"].u_plus.tolist(), file["pulled"].traces[1].u_plus.tolist())
        self.assertEqual(file.interfaces["upper"].name, "upper")
        self.assertIs(load.fields[file.mesh.subdomain_names[1]], load.fields[1])
        for find, said in ((lambda: file["pushed"], "no load 'pushed'; did you mean pulled"),
                           (lambda: load.inclusions["shrt"], "'shrt'; did you mean short"),
                           (lambda: load.traces["lower"], "no interface 'lower'; known are middle, upper$"),
                           (lambda: load.fields["x"], "no subdomain 'x'; known are ")):
            with self.assertRaisesRegex(anticrack.Error, said) as caught:
                find()
            self.assertIsInstance(caught.exception, KeyError)
        with self.assertRaisesRegex(IndexError, "no interface 17; there are 2 interfaces, counted from 0"):
            load.traces[17]

    def test_an_interval_is_the_text_that_the_command_writes(self):
        cases = [line for line in (SAME / "intervals.txt").read_text().splitlines() if not line.startswith("#")]
        self.assertGreater(len(cases), 10)
        for case in cases:
            numbers, text = case.split(" | ")
            lower, upper = map(float, numbers.split())
            self.assertEqual(interval(lower + (upper - lower) / 2, lower, upper, 0).rsplit(" (", 1)[0], text, case)

    def test_an_interval_contains_the_bounds(self):
        self.assertEqual(interval(0.44822, 0.44447, 0.45197, 0.4457, " mm"), "0.4482 +- 0.0038 mm (0.4457 on the mesh)")
        self.assertEqual(interval(1.1e-7, 1e-7, 1.2e-7, 1.15e-7), "(1.10 +- 0.10)e-7 (1.15e-7 on the mesh)")
        self.assertEqual(interval(0.25, float("nan"), 1, 0.5, " mm"), "0.25 mm")
        self.assertEqual(interval(0, 0, 0, 0), "0 +- 0 (0 on the mesh)")

    def test_an_inclusion_tells_the_relative_error_of_its_own_a(self):
        def told(a, half, error, scale=2.0):
            return repr(anticrack.result.Inclusion("fibre", A=a, A_lower=a - half, A_upper=a + half, A_mesh=a,
                                                   A_error_relative=error, A_scale=scale))
        self.assertEqual(told(0.5, 0.03125, 0.0625), "fibre: A = 0.500 +- 0.032 (6.2 %; 0.500 on the mesh)")
        self.assertEqual(told(0.0, 0.03, 0.015), "fibre: A = 0.000 +- 0.030 (1.5 % of 2; 0.000 on the mesh)")
        self.assertEqual(told(0.1, 0.01, 0.055), "fibre: A = 0.100 +- 0.010 (10 %; 5.5 % of 2; 0.100 on the mesh)")
        self.assertEqual(told(0.5, 0.04, float("nan")), "fibre: A = 0.500 +- 0.040 (0.500 on the mesh)")

    def test_a_traction_is_found_in_the_case_of_a_file(self):
        result, _ = self.both(EXAMPLES / "slit.toml", "run")
        self.assertIs(result.traction, False)
        for case, traction in (('[[load]]\ntraction = "1"', True), ("", None)):
            with h5py.File(self.folder / "result.h5", "a") as file:
                file.attrs["case"] = case
            self.assertIs(anticrack.read(self.folder / "result.h5").traction, traction)

    def test_a_package_that_is_missing_is_named(self):
        self.both(EXAMPLES / "slit.toml", "run")
        script = """
import sys, anticrack
result = anticrack.read("result.h5")
for name, use in (("pandas", result.frame), ("matplotlib", lambda: anticrack.draw.traces(result)),
                  ("h5py", lambda: anticrack.read("result.h5")), ("h5py", lambda: result.save("other.h5"))):
    for module in [module for module in sys.modules if module.partition(".")[0] == name]:
        del sys.modules[module]
    sys.modules[name] = None  # as if it were not installed
    try:
        use()
    except ImportError as error:
        print(error)
"""
        ended = run(sys.executable, "-c", script, cwd=self.folder)
        self.assertEqual(ended.stdout.splitlines(), [
            f"this takes {name}, which is not installed; install it with 'apt install python3-{name}' or 'pip install "
            f"{name}'" for name in ("pandas", "matplotlib", "h5py", "h5py")], ended.stderr)

    def test_other_files_are_refused(self):
        other = self.folder / "other.h5"
        for form, said in (("other", "is no result file"), ("anticrack-result/1", "run the case again"),
                           ("anticrack-result/9", "use a newer one")):
            with h5py.File(other, "w") as file:
                file.attrs["format"] = form
            with self.assertRaisesRegex(anticrack.Error, f"other.h5: .*{said}"):
                anticrack.read(other)
        for path, said in ((self.folder / "none.h5", "^there is no file .*none.h5; "),
                           (EXAMPLES / "arc.toml", "arc.toml: this is a case and no result; solve it"),
                           (EXAMPLES / "load-ratio.csv", "load-ratio.csv: cannot be read")):
            with self.assertRaisesRegex(anticrack.Error, said):
                anticrack.read(path)
        with self.assertRaisesRegex(anticrack.Error, f"there is no folder {self.folder}/none; make it"):
            self.both(EXAMPLES / "slit.toml", "run")[0].save(self.folder / "none" / "result.h5")

# SPDX-License-Identifier: GPL-3.0-or-later
"""The shape of what --json prints -- its keys and the types of their values -- is what
golden/*.json says, is documented in client/JSON.md and RESULT.md, and is all that is on standard output.
How to renew the files: see golden.py."""
import json
import pathlib
import re

import h5py

from golden import FOLDER, GoldenTest

MANUALS = [pathlib.Path(__file__).parents[3] / "client" / name for name in ("JSON.md", "RESULT.md")]
USER_NAMES = {"fibre", "top"}  # of the case, where the shape is a map from names

TEXTS = [(r"jobs/[0-9a-f]{16}", "job"), (r"meshes/[0-9a-f]{16}", "mesh"), (r"[0-9a-f]{64}", "sha256"),
         (r"uploads/[0-9a-f]{64}", "upload"), (r"\d+", "integer in quotes"), (r"\d+(\.\d+)?s", "duration"),
         (r"\d{4}-\d\d-\d\dT[\d:.]+Z", "time"), (r"[A-Z]+(_[A-Z]+)+", "constant")]


def joined(shapes):
    """One shape for all of a list: keys that not all have end in "?", types that differ stand side by side."""
    shapes = [shape for i, shape in enumerate(shapes) if shape not in shapes[:i]]
    if len(shapes) == 1:
        return shapes[0]
    if all(isinstance(shape, dict) for shape in shapes):
        keys = sorted({key.rstrip("?") for shape in shapes for key in shape})
        found = {key: [shape.get(key, shape.get(key + "?")) for shape in shapes] for key in keys}
        return {key + ("?" if None in values or any(key + "?" in shape for shape in shapes) else ""):
                joined([value for value in values if value is not None]) for key, values in found.items()}
    if all(isinstance(shape, list) for shape in shapes):
        entries = [entry for shape in shapes for entry in shape]
        return [joined(entries)] if entries else []
    return " | ".join(sorted(json.dumps(shape).strip('"') for shape in shapes))


def shape_of(value):
    """Of a value of json."""
    if isinstance(value, dict):
        return {"NAME" if key in USER_NAMES else key: shape_of(value[key]) for key in sorted(value)}
    if isinstance(value, list):
        return [joined([shape_of(entry) for entry in value])] if value else []
    if isinstance(value, str):
        return next((name for pattern, name in TEXTS if re.fullmatch(pattern, value)), "text")
    return {bool: "true or false", int: "number", float: "number", type(None): "null"}[type(value)]


def keys_of(shape):
    """All keys in a shape, however deep."""
    if isinstance(shape, dict):
        for key, value in shape.items():
            yield key.rstrip("?")
            yield from keys_of(value)
    elif isinstance(shape, list):
        for entry in shape:
            yield from keys_of(entry)


class JsonGolden(GoldenTest):

    def document(self, name, *words, code=0):
        """What the command prints, checked against golden/NAME.json."""
        ended = self.anticrack(*words, "--json")
        self.assertEqual(ended.returncode, code, ended.stderr)
        document = json.loads(ended.stdout)  # throws where there is anything else
        self.compare(name + ".json", json.dumps(shape_of(document), indent=1, sort_keys=True) + "\n")
        return document

    def test_meshes(self):
        mesh = self.document("mesh-create", "mesh", "create", "plate.toml")["name"]
        self.document("mesh-upload", "mesh", "upload", "plate.msh")
        self.document("mesh-list", "mesh", "list")
        self.document("mesh-show", "mesh", "show", mesh)
        self.document("mesh-show", "mesh", "show", mesh, "-o", "figures")
        self.assertTrue((self.folder / "figures" / (mesh.replace("meshes/", "mesh-") + ".svg")).exists())
        self.document("mesh-evict", "mesh", "evict", mesh)
        self.document("mesh-warm", "mesh", "warm", mesh)
        self.document("mesh-show-case", "mesh", "show", "plate.toml")
        self.document("deleted-mesh", "mesh", "delete", mesh)

    def test_jobs(self):
        job = self.document("job-submit", "job", "submit", "plate.toml")["name"]
        self.document("job-show", "job", "watch", job)
        self.document("job-show", "job", "show", job)
        self.document("job-show", "job", "cancel", job)  # has ended: as it is
        self.document("run", "job", "fetch", job, "-o", "fetched.h5")
        self.document("job-list", "job", "list")
        self.document("deleted-job", "job", "delete", job)

    def test_runs_and_their_files(self):
        self.document("run", "run", "plate.toml", "-o", "plate.h5")
        self.document("run", "show", "plate.h5")
        self.document("files", "plot", "plate.h5", "--load", "opening", "--only", "plan,traces", "-o", "figures")
        self.document("files", "export", "plate.h5", "-o", "paraview")
        uzawa = ("run", "plate.toml", "-o", "uzawa.h5", "--set", 'solver={method="uzawa", theta=1.5}')
        self.document("run-uzawa", *uzawa)
        self.document("run-uzawa", *uzawa, "--set", "solver.max_iterations=3", code=3)
        self.document("run-failed", "run", "failing.toml", "-o", "failed.h5", code=1)
        self.document("job-failed", "run", "failing.toml", "--set", "load.skew.f=1 / (x - x)", code=1)

    def test_stages(self):
        answers = self.document("run-accuracy", "run", "accuracy.toml", "-o", "accuracy.h5")
        self.assertGreater(len(answers["answers"][0]["stages"]), 1)
        job = self.document("job-show-accuracy", "job", "show", answers["job"])
        self.assertEqual(answers["mesh"]["name"], job["status"]["stages"][-1]["mesh"], "not that of the first stage")
        self.assertNotEqual(answers["mesh"]["name"], job["spec"]["mesh"])
        self.document("job-show-accuracy", "job", "watch", answers["job"])
        self.document("run-accuracy", "job", "fetch", answers["job"], "-o", "fetched.h5")
        self.document("run-accuracy", "show", "accuracy.h5")
        short = self.document("run-not-reached", "run", "accuracy.toml", "-o", "short.h5", "--set",
                              "accuracy.max_triangles=100", code=3)
        self.assertIn("max_triangles", short["not_reached"])

    def test_sweeps(self):
        rows = ("sweep", "plate.toml", "--coefficients", "rows.csv")
        answers = self.document("sweep", *rows, "--traces", "0", "-o", "rows.h5", "--csv", "answers.csv")["sweep"]
        # The same rows as a dataset that says whose its columns are, in another order.
        with h5py.File(self.folder / "named.h5", "w") as file:
            file["coefficients"] = [[0.0, 1.0], [0.5, 0.5], [1.0, 0.0]]
            file["coefficients"].attrs["loads"] = ["skew", "opening"]
        same = self.document("sweep", "sweep", "plate.toml", "--combinations", "named.h5", "--traces", "0")["sweep"]
        told = {"source": "", "solve_seconds": 0}
        self.assertEqual(same | told, answers | told)
        self.document("sweep", "show", "rows.h5")
        bounded = self.document("sweep-bounds", *rows, "--bounds", "--tips", "--traces", "0", "-o", "bounded.h5")
        self.assertEqual(bounded["sweep"]["bounded"], 1, "a point force is in the others")
        self.assertLess(bounded["answers"][0]["energy_lower"], bounded["answers"][0]["energy"])
        self.assertIsNone(answers["energy_width"])
        told = self.anticrack(*rows, "--detach", "--set", "accuracy.energy=0.1").stdout
        self.assertRegex(told, r"\[accuracy\] is not used: .* --bounds .* smaller mesh\.size, or .* \[\[load\]\]s")
        job = self.document("sweep-detach", *rows, "--detach")["name"]
        self.document("job-show-sweep", "job", "watch", job)

    def test_what_is_left(self):
        self.document("server", "server")
        for shell in ("bash", "zsh", "fish"):
            self.document("completion", "completion", shell)
        self.document("manual", "manual", "man1")

    def test_errors(self):
        self.document("error-usage", "rnu", code=2)
        self.document("error-fields", "run", "plate.toml", "--set", "load.opening.f=sin(", code=2)
        self.document("error-file", "show", "no.h5", code=2)
        self.document("error-server", "--server", "unix:no.socket", "--retry-for", "1ms", "server", code=4)

    def test_every_key_is_in_the_manual(self):
        documented = set(re.findall(r"`([^`\s]+)`", "".join(each.read_text(encoding="utf-8") for each in MANUALS)))
        for path in sorted(FOLDER.glob("*.json")):
            shape = json.loads(path.read_text(encoding="utf-8"))
            with self.subTest(path.name):
                self.assertEqual(sorted(set(keys_of(shape)) - documented - {"NAME"}), [])

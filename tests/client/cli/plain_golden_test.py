# SPDX-License-Identifier: GPL-3.0-or-later
"""What people read -- tables and the lines around them -- is what golden/*.txt says, letter by letter
but for what differs from run to run. How to renew the files: see golden.py."""
import json
import re

from golden import GoldenTest

# Each is replaced by text of the same width where columns depend on it.
MASKS = [
    (r"(?<=jobs/|shes/)[0-9a-f]{16}", lambda m: "I" * 16),
    (r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d", lambda m: "YYYY-MM-DD hh:mm:ss"),
    (r"127\.0\.0\.1:\d+", lambda m: "SERVER"),
    (r"(?<=^anticrack )\S+|(?<=^version {12})\S.*", lambda m: "VERSION"),
    (r"(?<=residuals at most )\S+", lambda m: "R"),
    (r"\S*\d s\b", lambda m: "T s"),
    (r"\d\.\d\de[-+]\d\d", lambda m: "R" * len(m[0])),  # down to rounding
    (r"^[\d.]+ *(?=  (queued|waiting|running|done))", lambda m: "T".ljust(len(m[0]))),  # seconds of a timeline
]
# Lines of what goes on: how many there are depends on how fast it is.
PROGRESS = re.compile(r"^(jobs/\S+: (queued|waiting|running|done)|meshes/\S+: (?!ready|evicted|deleted)"
                      r"|\S+: (step|iteration|converged)|\d+ of \d+ rows).*\n", re.M)


def masked(text):
    """Without what differs from run to run."""
    for pattern, by in MASKS:
        text = re.sub(pattern, by, text, flags=re.M)
    if "wall time\n" in text:  # the last column
        text = re.sub(r"\S+\d$", lambda m: "T".rjust(len(m[0])), text, flags=re.M)
    return text


class PlainGolden(GoldenTest):

    def said(self, name, *words, code=0):
        """What the command prints, checked against golden/NAME.txt."""
        ended = self.anticrack(*words)
        self.assertEqual((ended.returncode, ended.stderr), (code, ""), ended.stdout)
        self.compare(name + ".txt", masked(PROGRESS.sub("", ended.stdout)))
        return ended.stdout

    def test_a_fresh_server(self):  # comes first
        self.said("server", "server")

    def test_what_may_be_a_slip_is_noted_beside_the_output(self):
        forgets = ["plate.toml", "--set", "geometry.region.1.name=below", "--set", "geometry.region.1.at=[0, -0.5]"]
        created = self.anticrack("mesh", "create", *forgets)
        self.assertEqual(created.returncode, 0, created.stderr)
        note = "anticrack: note: --set geometry.region.1.at=[0, -0.5]: geometry.region.below: it gives no tension, "
        self.assertTrue(created.stderr.startswith(note), created.stderr)
        self.assertNotIn("note", created.stdout)
        refused = self.anticrack("job", "submit", *forgets, "--set", "load.skew.point_forces.0.at=[3, 3]", "--set",
                                 "load.opening.f=x +* 2")
        self.assertEqual(refused.returncode, 2)
        self.assertNotIn("note", refused.stderr, "the error alone")
        self.assertEqual(self.anticrack("--quiet", "mesh", "create", *forgets).stderr, "")

    def test_results_without_fields(self):
        bare = self.anticrack("run", "plate.toml", "--set", "output.fields=false", "-o", "bare.h5")
        self.assertEqual(bare.returncode, 0, bare.stderr)
        refused = self.anticrack("export", "bare.h5", "-o", "later")
        self.assertEqual(refused.returncode, 2)
        command = re.search(r"anticrack (job fetch jobs/\w+ --fields -o \S+),", refused.stderr)[1].split()
        self.assertIn(" ".join(command), self.anticrack("plot", "bare.h5", "-o", "later").stdout)
        job, file = command[2], command[-1]
        fetched = self.anticrack(*command)
        self.assertEqual(fetched.returncode, 0, fetched.stderr)
        self.assertRegex(fetched.stdout, rf"\A{job} has no fields; jobs/\w+ solves it again\n")
        exported = self.anticrack("export", file, "-o", "later")
        self.assertEqual((exported.returncode, exported.stderr), (0, ""))
        self.assertIn("opening.vtu", exported.stdout)
        answers = [json.loads(self.anticrack("show", name, "--json").stdout)["answers"] for name in ("bare.h5", file)]
        for answer in answers[0] + answers[1]:
            answer["solve_seconds"] = 0
        self.assertEqual(*answers, "the same answers to the last bit")
        again = json.loads(self.anticrack("show", file, "--json").stdout)["job"]
        self.assertNotIn("solves it again", self.anticrack("job", "fetch", again, "--fields", "-o", "same.h5").stdout)
        sweep = self.anticrack("sweep", "plate.toml", "--coefficients", "rows.csv", "-o", "no.h5", "--json")
        refused = self.anticrack("job", "fetch", json.loads(sweep.stdout)["job"], "--fields", "-o", "no.h5")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("is a sweep, which has no fields; run a case", refused.stderr)

    def test_quiet(self):
        def quiet(*words, code=0, error=""):
            ended = self.anticrack(*words, "--quiet")
            self.assertEqual(ended.returncode, code, ended.stderr)
            self.assertRegex(ended.stderr, rf"\A{error}\Z")
            return ended.stdout

        uzawa = ("--set", 'solver={method="uzawa", max_iterations=2}')
        stopped = r"(anticrack: \w+ did not converge: .+\n){2}"
        self.assertEqual(quiet("run", "plate.toml", "-o", "quiet.h5"), "")
        self.assertEqual(quiet("run", "plate.toml", "-o", "stopped.h5", *uzawa, code=3, error=stopped), "")
        self.assertEqual(quiet("run", "failing.toml", "-o", "failed.h5", code=1,
                               error=r"anticrack: jobs/\w+ failed: .+\n(anticrack: opening failed: .+\n)?"), "")
        self.assertEqual(quiet("run", "no.toml", code=2, error="anticrack: no.toml.+\n"), "")
        self.assertEqual(quiet("sweep", "plate.toml", "--coefficients", "rows.csv", "-o", "quiet-rows.h5", "--csv",
                               "quiet.csv"), "")
        job = quiet("job", "submit", "plate.toml")
        self.assertRegex(job, r"\Ajobs/\w+\n\Z")
        job = job.strip()
        self.assertEqual(quiet("job", "watch", job), "")
        self.assertIn(job, quiet("job", "show", job))
        self.assertIn(job, quiet("job", "list"))
        self.assertEqual(quiet("job", "fetch", job, "-o", "quiet-fetched.h5"), "")
        self.assertEqual(quiet("job", "cancel", job), "")
        self.assertEqual(quiet("job", "delete", job), "")
        mesh = quiet("mesh", "create", "plate.toml")
        self.assertRegex(mesh, r"\Ameshes/\w+\n\Z")
        for verb in ("warm", "evict"):
            self.assertEqual(quiet("mesh", verb, mesh.strip()), "")
        self.assertIn("44 triangles", quiet("mesh", "show", mesh.strip()))
        self.assertIn("opening", quiet("show", "quiet.h5"))
        self.assertIn("answers", json.loads(quiet("run", "plate.toml", "-o", "quiet.h5", "--json")))
        self.assertEqual(quiet("export", "quiet.h5", "-o", "quiet"), "")
        self.assertEqual(quiet("plot", "quiet.h5", "--load", "skew", "-o", "quiet"), "")

    def test_version(self):
        self.said("version", "--version")

    def test_meshes_and_jobs(self):
        mesh = self.said("mesh-create", "mesh", "create", "plate.toml").split(":")[0]
        self.said("mesh-show", "mesh", "show", mesh)
        self.said("mesh-upload", "mesh", "upload", "plate.msh", "--title", "Two triangles")
        job = self.said("job-submit", "job", "submit", "plate.toml").split()[0]
        self.said("job-show", "job", "watch", job)
        self.said("job-show", "job", "show", job)
        self.said("job-fetch", "job", "fetch", job, "-o", "plate.h5")
        self.said("show", "show", "plate.h5")
        self.said("show-load", "show", "plate.h5", "--load", "skew")
        self.said("run", "run", "plate.toml")
        self.said("run-uzawa", "run", "plate.toml", "-o", "uzawa.h5", "--set", 'solver={method="uzawa", theta=1.5}')
        self.said("run-accuracy", "run", "accuracy.toml")
        self.said("run-not-reached", "run", "accuracy.toml", "--set", "accuracy.max_triangles=100", code=3)
        self.said("export", "export", "plate.h5", "-o", "paraview")
        self.said("plot", "plot", "plate.h5", "--load", "skew")
        self.said("sweep", "sweep", "plate.toml", "--coefficients", "rows.csv", "--traces", "all", "-o", "rows.h5",
                  "--csv", "answers.csv")
        self.said("show-sweep", "show", "rows.h5")
        self.said("sweep-bounds", "sweep", "plate.toml", "--coefficients", "rows.csv", "--bounds", "--tips", "-o", "bounded.h5")
        self.said("show-sweep-load", "show", "rows.h5", "--load", "row-1")
        self.said("job-list", "job", "list")
        self.said("mesh-list", "mesh", "list")
        self.said("job-delete", "job", "delete", job)
        self.said("mesh-evict", "mesh", "evict", mesh)
        self.said("mesh-delete", "mesh", "delete", mesh)

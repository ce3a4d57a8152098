# SPDX-License-Identifier: GPL-3.0-or-later
"""The live view on a pseudo-terminal: what stands on the screen of who runs, detaches, attaches again and
cancels."""
import json
import os
import pathlib
import re
import shlex

from processes import ANTICRACK, Daemon, FolderTest, run
from terminals import Terminal

EXAMPLES = pathlib.Path(__file__).parents[3] / "client/examples"
CTRL_C, CTRL_Z = "\x03", "\x1a"
LOADS = [f"example-{i}" for i in range(1, 5)]


def forever(case="paper.toml", iterations=10**9):
    """An iteration that converges as good as never."""
    return (EXAMPLES / case, "--set", "solver.theta=1e-6", "--set", "solver.epsilon=1e-300",
            "--set", f"solver.max_iterations={iterations}")


def iteration(rows):
    """Of the first load case, as the view tells it; None before there is one."""
    found = [re.search(r"\b(?:iteration|it) +(\d+)", row) for row in rows]
    return next((int(match[1]) for match in found if match), None)


BRIEF = r"  it +\d+  \d\.\de-\d+  contact +\d+$"
CRITERION = r"  \d\.\de-\d+$"
LABELS = r"  iteration +\d+  criterion \d\.\de-\d+  contact +\d+  \[#*-+\]$"


def view_of(rows, form=LABELS, told=None):
    """The rows of the view, from its head line on. None as long as it is not there as a whole in this form, or
    anything of another frame is left over: above it there may only be what was `told` before it, wrapped or
    cut."""
    heads = [y for y, row in enumerate(rows) if re.search(r"\bended\b", row)]
    if len(heads) != 1:
        return None
    above, view = rows[:heads[0]], rows[heads[0]:]
    clean = all(row in told for row in above) if told else len(above) == 2
    whole = len(view) == 5 and all(row.startswith(f"  {name}  running") and re.search(form, row)
                                   for name, row in zip(LOADS, view[1:]))
    return view if clean and whole else None


class TerminalView(FolderTest):
    def setUp(self):
        super().setUp()
        self.daemon = self.start_daemon()

    def start_daemon(self, **options):
        daemon = Daemon(self.folder, "--iterations", str(10**9), **options)
        self.addCleanup(daemon.__exit__)
        self.server = f"127.0.0.1:{daemon.port}"  # resolving a name, c-ares leaks, which AddressSanitizer minds
        return daemon

    def run_case(self, case, *flags, **options):
        """`anticrack run` of a case on a terminal."""
        return Terminal(ANTICRACK, "run", *case, "-o", self.folder / "out.h5", "--server", self.server, *flags,
                        **options)

    def client(self, *words):
        ended = run(ANTICRACK, *words, "--server", self.server, "--json")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        return json.loads(ended.stdout)

    def jobs(self):
        return self.client("job", "list").get("jobs", [])

    def test_a_line_per_load_case_is_redrawn_in_place(self):
        with self.run_case(forever()) as terminal:
            first = terminal.wait(lambda rows: view_of(rows) and iteration(rows))
            head, *_ = terminal.wait(lambda rows: iteration(rows) > first and view_of(rows))
            self.assertRegex(head, r"^jobs/\w+: running, [\w ]+ s, 0 of 4 load cases ended$")
            # Keys that are typed meanwhile neither show nor tear the view.
            self.assertFalse(terminal.echoes())
            terminal.type("what?\n\n")
            typed = iteration(terminal.rows())
            terminal.wait(lambda rows: iteration(rows) > typed and view_of(rows))
            self.cancel(terminal)
            self.assertTrue(terminal.echoes(), "the terminal is as it was")

    def cancel(self, terminal):
        job, = (job["name"] for job in self.jobs() if job["status"]["state"] == "STATE_RUNNING")
        self.client("job", "cancel", job)
        code = terminal.end()
        self.assertIn(b"cancelled", terminal.output)
        return code

    def test_resizing_leaves_nothing_over(self):
        for reflow in (False, True):
            with self.subTest(reflow=reflow), self.run_case(forever(), reflow=reflow) as terminal:
                terminal.wait(view_of)
                told = "\n".join(terminal.rows()[:2])
                for columns, lines, form in ((60, 30, BRIEF), (40, 12, CRITERION), (120, 30, LABELS),
                                             (40, 30, CRITERION), (200, 8, LABELS), (101, 40, LABELS)):
                    terminal.resize(columns, lines)
                    terminal.wait(lambda rows: view_of(rows, form, told))
                self.assertEqual(self.cancel(terminal), 1)

    def test_more_load_cases_than_lines_and_a_terminal_as_narrow_as_can_be(self):
        with self.run_case(forever(), columns=20, lines=5) as terminal:
            terminal.wait(lambda rows: re.fullmatch(r"running, .*\n(  example~  running\n){2}  and 2 more: 2 .*",
                                                    "\n".join(rows[-4:])))
            self.cancel(terminal)

    def test_ctrl_c_detaches_and_what_it_prints_attaches_again(self):
        with Terminal(ANTICRACK, "run", *forever(), "-o", self.folder / "out.h5", columns=150,
                      environment={"ANTICRACK_SERVER": self.server}) as terminal:
            terminal.wait(view_of)
            terminal.type(CTRL_C)
            terminal.wait_for("Detaching; press Ctrl-C again now to cancel the job instead")
            self.assertEqual(terminal.end(), 130)
            command = re.search(r"To attach again: (anticrack job watch jobs/\w+.*)", terminal.text())[1]
            self.assertNotIn("Detaching", terminal.text())
            self.assertNotIn(b"^C", terminal.output)
        job, = self.jobs()
        self.assertEqual(job["status"]["state"], "STATE_RUNNING")
        self.assertIn(job["name"], command)

        path = os.path.dirname(ANTICRACK) + ":" + os.environ["PATH"]
        with Terminal("sh", "-c", command, environment={"PATH": path}) as terminal:
            terminal.wait(lambda rows: iteration(rows) and len([row for row in rows if "running" in row]) == 5)
            self.assertEqual(self.cancel(terminal), 1)

    def test_ctrl_c_twice_cancels(self):
        with self.run_case(forever()) as terminal:
            terminal.wait(view_of)
            code = self.interrupt_twice(terminal)
            self.assertIn("was cancelled", terminal.text())
        job, = self.jobs()
        while code is None:  # the second one came after two seconds: the machine is busy
            with Terminal(ANTICRACK, "job", "watch", job["name"], "--server", self.server) as terminal:
                terminal.wait(iteration)
                code = self.interrupt_twice(terminal)
        self.assertEqual(code, 130)
        self.assertEqual(self.client("job", "show", job["name"])["status"]["state"], "STATE_CANCELLED")

    def interrupt_twice(self, terminal):
        terminal.type(CTRL_C)
        terminal.wait_for("press Ctrl-C again now")
        terminal.type(CTRL_C)
        code = terminal.end()
        return None if "The job goes on" in terminal.text() else code

    def test_ctrl_c_with_a_private_server_cancels_at_once(self):
        with Terminal(ANTICRACK, "--local", "run", *forever(iterations=10**6), "-o",
                      self.folder / "out.h5") as terminal:
            terminal.wait(view_of)
            terminal.type(CTRL_C)
            self.assertEqual(terminal.end(), 130)
            self.assertRegex(terminal.text(), r"anticrack: jobs/\w+ was cancelled$")
            self.assertNotIn("attach", terminal.text())

    def test_a_server_that_crashes_under_the_watch_is_found_again(self):
        case = forever("paper-1.toml", iterations=500_000)
        with self.run_case(case) as terminal:
            terminal.wait(iteration)
            self.daemon.kill()
            terminal.wait_for(f"  server {self.server} gone, trying again for up to 5 min")
            self.start_daemon(port=self.daemon.port)
            terminal.wait(lambda rows: any(", attempt 2" in row for row in rows))
            self.assertEqual(terminal.end(), 3, terminal.text())
            self.assertRegex(terminal.text(), r"jobs/\w+: not converged, attempt 2, ")
            self.assertNotIn("gone", terminal.text())
            self.assertTrue((self.folder / "out.h5").is_file())
        self.assertEqual([job["status"]["attempt"] for job in self.jobs()], [2], "one job, run twice")

    def test_a_line_per_stage_also_after_a_crash(self):
        with self.run_case((EXAMPLES / "accuracy.toml", "--set", "accuracy.energy=1e-4")) as terminal:
            terminal.wait_for("  stage  2")
            self.daemon.kill()
            terminal.wait_for("gone, trying again")
            self.start_daemon(port=self.daemon.port)
            self.assertEqual(terminal.end(), 0, terminal.text())
            view = terminal.rows()[2:]
            self.assertRegex(view[0], r"^jobs/\w+: done, attempt 2, ")
            stages = [row for row in view if row.startswith("  stage ")]
            self.assertEqual([int(row.split()[1]) for row in stages], list(range(1, len(stages) + 1)))
            for row in stages:
                self.assertRegex(row, r"^  stage +\d+ +\d+ triangles   energy +\S+ % \(asked 0.01 %\) .*\[#*-*\]$")
            self.assertTrue(stages[-1].endswith("#]"), "it is reached")
            self.assertRegex(view[1 + len(stages)], "^  example-3  converged ")

    def test_the_view_is_stopped_and_goes_on_below_what_others_wrote(self):
        command = [ANTICRACK, "run", *forever(), "-o", self.folder / "out.h5", "--server", self.server]
        with Terminal("bash", "--norc", "-i", columns=150, environment={"PS1": "$ "}) as shell:
            shell.type("clear; " + " ".join(shlex.quote(str(word)) for word in command) + "\n")
            shell.wait(iteration)
            shell.type(CTRL_Z)
            shell.wait_for("Stopped")
            self.client("job", "cancel", self.jobs()[0]["name"])
            shell.type("echo written by $((1 + 1)) others; fg\n")
            shell.wait_for("written by 2 others")
            shell.wait_for("was cancelled")
            rows = shell.wait(lambda rows: rows[-1].endswith("$") and rows)
            order = [next(y for y, row in enumerate(rows) if re.search(text, row)) for text in
                     (r": running, .* 0 of 4", "Stopped", "^written by 2 others", ": cancelled, .* 4 of 4")]
            self.assertEqual(order, sorted(order), shell.text())
            self.assertEqual(sum(": cancelled, " in row for row in rows), 1, shell.text())
            shell.type("exit 0\n")
            self.assertEqual(shell.end(), 0)

    def test_a_mesh_is_waited_for_on_one_line(self):
        fine = ("--set", "mesh.preset=uniform", "--set", "mesh.size=0.005")
        with Terminal(ANTICRACK, "mesh", "create", EXAMPLES / "paper.toml", *fine, "--server",
                      self.server) as terminal:
            terminal.wait(lambda rows: len(rows) == 1 and re.fullmatch(r"meshes/\w+: meshing, \d+ s", rows[0]))
            terminal.type(CTRL_C)
            self.assertEqual(terminal.end(), 130)
            self.assertRegex(terminal.text(), r"^meshes/\w+: meshing, \d+ s\nanticrack: interrupted$")

    def test_plain_lines_where_no_frames_are_wanted(self):
        case = (EXAMPLES / "paper-1.toml",)
        for name, environment in (("NO_COLOR", {"NO_COLOR": "1"}), ("dumb", {"TERM": "dumb"})):
            with self.subTest(name), self.run_case(case, environment=environment) as terminal:
                self.assertEqual(terminal.end(), 0)
                self.assertIn(b"example-1: converged after ", terminal.output)
                self.assertNotIn(b"\x1b", terminal.output)
        with self.subTest("quiet"), self.run_case(case, "--quiet") as terminal:
            self.assertEqual(terminal.end(), 0)
            self.assertEqual(terminal.output, b"")
        with self.subTest("an empty NO_COLOR says nothing"), \
                self.run_case(case, environment={"NO_COLOR": ""}) as terminal:
            self.assertEqual(terminal.end(), 0)
            self.assertIn(b"\x1b", terminal.output)

    def test_frames_go_where_people_are_told(self):
        words = shlex.join(str(word) for word in (ANTICRACK, "run", EXAMPLES / "paper-1.toml", "-o",
                                                  self.folder / "out.h5", "--server", self.server))
        with self.subTest("output to a file"), Terminal("sh", "-c", f"{words} > {self.folder}/log") as terminal:
            self.assertEqual(terminal.end(), 0)
            self.assertEqual(terminal.output, b"")
            log = (self.folder / "log").read_text(encoding="utf-8")
            self.assertIn("example-1: converged after ", log)
            self.assertNotIn("\x1b", log)
        with self.subTest("--json to a file"), \
                Terminal("sh", "-c", f"{words} --json > {self.folder}/json") as terminal:
            self.assertEqual(terminal.end(), 0)
            self.assertRegex(terminal.text(), r"jobs/\w+: done, ")
            self.assertIn(b"\x1b", terminal.output)
            json.loads((self.folder / "json").read_text(encoding="utf-8"))
        with self.subTest("errors to a file"), Terminal("sh", "-c", f"{words} 2> {self.folder}/errors") as terminal:
            self.assertEqual(terminal.end(), 0)
            self.assertRegex(terminal.text(), r"jobs/\w+: done, ")
            self.assertEqual((self.folder / "errors").read_text(encoding="utf-8"), "")

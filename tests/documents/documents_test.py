# SPDX-License-Identifier: GPL-3.0-or-later
"""What the documents say, tried: every command of their shell blocks is typed as it stands, every case is
solved, every line of output and every row of a table marked "printed above" is one that the commands print, every
link and every name of the code leads somewhere.

In a document `jobs/ID` and `meshes/ID` stand for the last one that a command printed, `exit code N` in the
comment of a command for how it ends (0 otherwise)."""
import os
import pathlib
import re
import subprocess
import sys
import tomllib

from processes import DEBIAN_12, FolderTest

PROJECT = pathlib.Path(os.environ["PROJECT"])
BIN = pathlib.Path(os.environ["BIN"])
PYTHON = pathlib.Path(os.environ["PYTHON"])
DOCUMENTS = [PROJECT / "README.md", *sorted(document for folder in (".github", "client", "server", "proto", "deploy", "tests")
                                            for document in (PROJECT / folder).rglob("*.md"))]
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.M | re.S)
TABLE = re.compile(r"^<!-- printed above -->\n\|.*\n\|-.*\n((?:\|.*\n)+)", re.M)

# Commands that build, install, want root or serve until they are stopped: what runs them instead.
ELSEWHERE = {
    "./deploy/quickstart": ".ci/run",
    "anticrack view": "tests/client/view/page_test.py",
    "anticrack --local view": "tests/client/view/page_test.py",
}

# One command after another in one shell, so that export, cd and & mean what they mean for who types them.
SHELL = r"""
step() {  # exit code wanted, command
  local wanted=$1 text=$2 kind
  for kind in jobs meshes; do
    text=${text//$kind\/ID/$(grep -ohE "$kind/[0-9a-f-]{16,}" "$OUTPUT" | tail -n 1)}
  done
  echo "\$ $text" >>"$OUTPUT"
  eval "$text" >>"$OUTPUT" 2>&1
  local code=$?
  [ "$code" = "$wanted" ] || { tail -n 20 "$OUTPUT" >&2; echo "exit code $code, not $wanted: $text" >&2; exit 1; }
  case $text in *"&") until [ -S "$SOCKET" ]; do kill -0 $! || exit 1; sleep 0.02; done ;; esac
}
trap 'kill $(jobs -p) 2>/dev/null; wait' EXIT
touch "$OUTPUT"
"""


def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def commands(block):
    """Of a shell block: (command, comment) of each."""
    for line in block.replace("\\\n", " ").splitlines():
        command, _, comment = re.sub(r"\s+#\s", "\0", line, count=1).partition("\0")
        if command.strip() and not command.startswith("#"):
            yield command.strip(), comment


def steady(line):
    """A line of output without what differs from run to run: columns' widths, KKT and wall time of an answer."""
    words = [re.sub(r"^\d\.\d+e-1\d$", "KKT", word) for word in line.split()]
    return " ".join(words[:-1] if words[1:2] == ["converged"] else words)


class Commands(FolderTest):
    """One test a document, made below."""
    maxDiff = None

    def try_document(self, document):
        project = self.folder / "project"
        programs = project / "build/release/bin"
        programs.mkdir(parents=True)
        for entry in PROJECT.iterdir():
            if entry.name not in ("build", "results", ".git"):
                (project / entry.name).symlink_to(entry)
        for name in ("anticrack", "anticrack-mesher"):
            (programs / name).symlink_to(BIN / name)
        (project / "build/release/python").symlink_to(PYTHON)
        socket = self.folder / "socket"  # in place of the port that everybody's server has
        daemon = programs / "anticrackd"
        daemon.write_text(f'#!/bin/sh\ncase "$*" in *--listen*|*--private*) ;; *) set -- "$@" --listen unix:{socket} ;; esac\n'
                          f'exec {BIN}/anticrackd "$@"\n', encoding="utf-8")
        daemon.chmod(0o755)

        text = document.read_text(encoding="utf-8")
        script, output = [SHELL], []
        for kind, block in BLOCK.findall(text):
            if kind == "sh":
                for command, comment in commands(block):
                    if not any(command.startswith(name) for name in ELSEWHERE):
                        code = re.search(r"exit code (\d+)", comment)
                        script.append(f"step {code.group(1) if code else 0} {quoted(command)}")
            elif kind == "text" and len(script) > 1:  # what begins with a space is a live view, or units
                output += re.findall(r"^\S.*$", block, re.M)
            elif kind == "python":
                script.append(f"step 0 {quoted(sys.executable + ' -c ' + quoted(block))}")
            elif kind == "toml" and "[geometry]" in block and "[[load]]" in block:  # all of a case
                (project / "case.toml").write_text(block, encoding="utf-8")
                script.append("step 0 'anticrack --local run case.toml -o case.h5'")
        debian = self.folder / "debian"  # whose Python has the packages that the documents name
        debian.mkdir()
        (debian / "python3").symlink_to(sys.executable)
        environment = {"HOME": str(self.folder), "OUTPUT": str(self.folder / "output"), "SOCKET": str(socket),
                       "ANTICRACK_SERVER": f"unix:{socket}", "PATH": f"{debian}:{os.environ['PATH']}",
                       "LC_ALL": "C.UTF-8", "MPLBACKEND": "Agg"}
        if document != PROJECT / "README.md":  # which says how to set it
            environment["PATH"] = f"{programs}:{environment['PATH']}"
            environment["PYTHONPATH"] = str(PYTHON)
        ended = subprocess.run(["bash", "-c", "\n".join(script)], cwd=project, env=environment, text=True,
                               capture_output=True, check=False)
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        if not DEBIAN_12:
            return  # the figures are of its gmsh
        printed = pathlib.Path(environment["OUTPUT"]).read_text(encoding="utf-8").splitlines()
        shown = {steady(line) for line in printed}
        self.assertEqual([line for line in output if steady(line) not in shown], [])
        # The last column of such a table is not computed.
        rows = {re.sub(r"\|[^|]*\|$", "|", row) for table in TABLE.findall(text) for row in table.splitlines()}
        self.assertEqual(rows, {line for line in printed if line.startswith("| ")})


def of(document):
    return lambda test: test.try_document(document)


for each in DOCUMENTS:
    name = re.sub(r"\W", "_", "_".join(each.relative_to(PROJECT).with_suffix("").parts)).lower()
    setattr(Commands, f"test_{name}", of(each))


class Words(FolderTest):
    def test_the_blocks_of_the_tutorial_are_its_case(self):
        blocks = BLOCK.findall((PROJECT / "client/TUTORIAL.md").read_text(encoding="utf-8"))
        typed = "".join(block for kind, block in blocks if kind == "toml")
        self.assertEqual(tomllib.loads(typed),
                         tomllib.loads((PROJECT / "client/examples/sheet.toml").read_text(encoding="utf-8")))

    def test_figures_of_the_paper_are_those_of_its_page(self):
        """Which the commands of that page print. Examples and the first pages quote them."""
        page = (PROJECT / "client/PAPER.md").read_text(encoding="utf-8")
        theirs, triangles, ours, more = re.search(
            r"Example 3: (\d+) % off on (\d+) triangles .*, ([\d.]+) % on (\d+)", page).groups()
        lower, upper = re.search(r"\| example-3 .*?\| ([\d.]+) to ([\d.]+) \|", page).groups()
        for place, figures in {
                "README.md": (f"{theirs} % off", f"{int(triangles):,}", f"{ours} % off", f"{int(more):,}", f"{lower} and {upper}"),
                "client/BASICS.md": (f"{int(triangles):,}", f"by {theirs} %"),
                "client/examples/paper-3.toml": (f"{theirs} % off",),
                "client/examples/accuracy.toml": (f"{theirs} % off",)}.items():
            text = " ".join((PROJECT / place).read_text(encoding="utf-8").replace("\n#", "\n").split())
            for figure in figures:
                self.assertIn(figure, text, place)

    def test_cited_is_this_version(self):
        version = re.search(r"project\(anticrack VERSION ([\d.]+)", (PROJECT / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)
        self.assertIn(f"\nversion: {version}\n", (PROJECT / ".github/CITATION.cff").read_text(encoding="utf-8"))

    def test_options_of_the_tests_and_releases_of_debian_are_what_there_is(self):
        workflow = PROJECT / ".github/workflows/test.yml"
        script = (PROJECT / "deploy/test").read_text(encoding="utf-8")
        named = [(place, option) for place in (*DOCUMENTS, workflow, PROJECT / ".ci/run")
                 for option in re.findall(r'deploy/test"? (--[a-z-]+)', place.read_text(encoding="utf-8"))]
        self.assertIn((workflow, "--lint-changed"), named)
        for place, option in named:
            self.assertRegex(script, rf'(?m)^  {option}\)|"\$\{{1:-\}}" = {option} \]', place)
        releases = re.findall(r"^  (\d+)\) codename=", (PROJECT / "deploy/fresh-debian").read_text(encoding="utf-8"), re.M)
        self.assertEqual(re.findall(r'"(\d+)"', re.search(r"debian: \[(.*)\]", workflow.read_text(encoding="utf-8")).group(1)),
                         releases)

    def test_what_is_run_elsewhere_is_run_there(self):
        for command, place in ELSEWHERE.items():
            self.assertIn(command.removeprefix("./"), (PROJECT / place).read_text(encoding="utf-8"))

    def test_links_lead_somewhere(self):
        for document in DOCUMENTS:
            for target in re.findall(r'(?:\]\(|src=")([^)#\s"]+)', document.read_text(encoding="utf-8")):
                if "://" not in target:
                    self.assertTrue((document.parent / target).exists(), f"{document}: {target}")

    def test_files_that_are_named_exist(self):
        """`folder/name` in code spans: from the project's folder, from the document's, or below server/."""
        for document in DOCUMENTS:
            for path in re.findall(r"`([\w.-]+(?:/[\w.-]+)+)/?`", document.read_text(encoding="utf-8")):
                folders = (PROJECT, document.parent, PROJECT / "server")
                first = path.split("/")[0]
                ours = any((root / first).is_dir() for root in (PROJECT, PROJECT / "server"))
                if path.endswith("/ID") or first in ("build", "results") or not ours:
                    continue  # no file of ours: meshes/ID, application/json; or made by a build
                self.assertTrue(any(list(folder.glob(path)) + list(folder.glob(path + ".*")) for folder in folders),
                                f"{document}: {path}")

    def test_names_of_the_code_exist(self):
        """`folder::Type` and `folder::Type::member`: the words stand in a header of server/folder."""
        for document in DOCUMENTS:
            for words in re.findall(r"`((?:\w+::)+\w+)`", document.read_text(encoding="utf-8")):
                folder, *names = words.split("::")
                headers = "\n".join(header.read_text(encoding="utf-8") for root in ("server", "client")
                                    for header in (PROJECT / root / folder).glob("*.hpp"))
                for word in names:
                    self.assertRegex(headers, rf"\b{word}\b", f"{document}: {words}")

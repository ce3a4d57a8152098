# SPDX-License-Identifier: GPL-3.0-or-later
"""The server of --local: it ends with the command however that ends, and the command with it; nothing is left."""
import os
import pathlib
import signal
import subprocess
import time
import unittest

from processes import ANTICRACK, ANTICRACKD, FolderTest, run

LONG = """
[geometry]
boundary = [[-1,-1], [1,-1], [1,1], [-1,1]]
interface = [[-1,0], [1,0]]
[[geometry.inclusion]]
name = "fibre"
from = [-0.5,0]
to = [0.5,0]
[[load]]
name = "opening"
f = "y > 0 ? 1 : -1"
[solver]
method = "uzawa"
theta = 1e-9
epsilon = 1e-30
max_iterations = 1000000
"""
QUICK = LONG[:LONG.index("[solver]")] + "[mesh]\nsize = 0.2\n"


def eventually(condition, what):
    limit = time.monotonic() + 120
    while not condition():
        if time.monotonic() > limit:
            raise AssertionError(what)
        time.sleep(0.02)


def alive(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    state = pathlib.Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0]
    return state != "Z"  # whose new parent has not looked yet


class PrivateServer(FolderTest):
    def setUp(self):
        super().setUp()
        self.temporary = self.folder / "temporary"
        self.temporary.mkdir()
        (self.folder / "long.toml").write_text(LONG, encoding="utf-8")
        (self.folder / "quick.toml").write_text(QUICK, encoding="utf-8")

    def left(self):
        return [path.name for path in self.temporary.iterdir()]

    def environment(self, **others):
        return {**os.environ, "TMPDIR": str(self.temporary), **others}

    def start(self, *words):
        """The command and its server, once that solves."""
        client = subprocess.Popen([ANTICRACK, "--local", *words], cwd=self.folder, env=self.environment(), text=True,
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(client.communicate)
        self.addCleanup(client.kill)
        for line in client.stdout:
            if "iteration" in line:
                break
        else:
            self.fail(client.stderr.read())
        children = pathlib.Path(f"/proc/{client.pid}/task/{client.pid}/children").read_text(encoding="utf-8")
        return client, int(children.split()[0])

    def test_that_dies_ends_the_command_with_the_reason(self):
        for number, name in ((signal.SIGKILL, r"signal 9 \(Killed\), perhaps because memory ran out"),
                             (signal.SIGABRT, r"signal 6 \(Aborted\)")):  # none that AddressSanitizer takes
            client, server = self.start("run", "long.toml", "-o", "r.h5")
            os.kill(server, number)
            output, error = client.communicate()
            self.assertEqual(client.returncode, 4, error)
            self.assertRegex(error, rf"^anticrack: the server of --local died of {name}")
            self.assertNotIn("trying again", output + error)
            self.assertEqual(self.left(), [])

    def test_that_stops_by_itself_ends_the_command(self):
        client, server = self.start("run", "long.toml")
        os.kill(server, signal.SIGTERM)
        _, error = client.communicate()
        self.assertEqual(client.returncode, 4, error)
        self.assertIn("the server of --local ended with exit code 0", error)

    def test_that_dies_while_it_is_asked_to_cancel(self):
        client, server = self.start("run", "long.toml")
        os.kill(server, signal.SIGSTOP)
        client.terminate()
        os.kill(server, signal.SIGKILL)
        client.communicate()
        self.assertEqual(client.returncode, 4)

    def test_ends_with_a_command_that_is_killed_and_leaves_nothing(self):
        for number in (signal.SIGKILL, signal.SIGSEGV):
            client, server = self.start("run", "long.toml")
            self.assertEqual(len(self.left()), 1)
            os.kill(client.pid, number)
            client.wait()
            eventually(lambda server=server: not alive(server), "the server goes on")
            eventually(lambda: self.left() == [], "its folder is left")

    def test_ends_with_a_command_that_is_interrupted(self):
        for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
            client, server = self.start("run", "long.toml")
            client.send_signal(number)
            client.communicate()
            self.assertEqual(client.returncode, 130)
            self.assertFalse(alive(server))
            self.assertEqual(self.left(), [])

    def test_leftovers_are_swept_at_the_next_start_and_nothing_else(self):
        client, server = self.start("run", "long.toml")
        os.kill(client.pid, signal.SIGSTOP)
        os.kill(server, signal.SIGKILL)
        os.kill(client.pid, signal.SIGKILL)
        client.wait()
        eventually(lambda: not alive(server), "it is killed")
        self.assertEqual(len(self.left()), 1)
        other, other_server = self.start("run", "long.toml")  # one that is in use
        others = [self.temporary / "anticrack-private-file", self.temporary / "other"]
        others[0].write_text("", encoding="utf-8")
        others[1].mkdir()
        (self.temporary / "anticrack-private-link").symlink_to(others[1])
        (self.temporary / "anticrack-private-young").mkdir()
        os.utime(self.temporary / "anticrack-private-young", 2 * (time.time() + 3600,))  # however slow this is
        kept = {"anticrack-private-file", "other", "anticrack-private-link", "anticrack-private-young"}
        ended = run(ANTICRACK, "--local", "--quiet", "run", "quick.toml", cwd=self.folder, env=self.environment())
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertEqual(len(set(self.left()) - kept), 1, "the one in use")
        self.assertEqual(set(self.left()) & kept, kept)
        self.assertTrue(alive(other_server))
        os.utime(self.temporary / "anticrack-private-young", (0, 0))
        run(ANTICRACK, "--local", "--quiet", "server", cwd=self.folder, env=self.environment())
        self.assertNotIn("anticrack-private-young", self.left())
        other.kill()

    def run_in(self, folder, **others):
        return run(ANTICRACK, "--local", "--quiet", "run", "quick.toml", cwd=self.folder,
                   env=self.environment(TMPDIR=str(folder), **others))

    def test_lives_in_any_temporary_folder(self):
        names = ["x" * 120, "with blanks", "per%20cent", "a?b#c", "ünïcode", "quote'", "colon:1", "-"]
        for name in names:
            (self.folder / name).mkdir()
        for folder in ["", *(self.folder / name for name in names), "."]:
            ended = self.run_in(folder)
            self.assertEqual((ended.returncode, ended.stderr), (0, ""), folder)
        self.assertEqual([list((self.folder / name).iterdir()) for name in names], [[]] * len(names))
        deep = self.folder / ("y" * 250)
        deep.mkdir()
        runtime = self.folder / "runtime"
        runtime.mkdir()
        for variable in (str(runtime), "", "relative", str(self.folder / "none")):
            self.assertEqual(self.run_in(deep, XDG_RUNTIME_DIR=variable).returncode, 0)
        self.assertEqual(list(runtime.iterdir()), [])

    def test_names_a_temporary_folder_that_is_none(self):
        (self.folder / "file").write_text("", encoding="utf-8")
        (self.folder / "dangling").symlink_to("nowhere")
        deep = self.folder.joinpath(*["y" * 200] * 3)
        deep.mkdir(parents=True)
        wrong = {deep: "its path is too long", self.folder / "missing": "No such file",
                 self.folder / "file": "Not a directory", self.folder / "dangling": "No such file", "/proc": "",
                 "relative/missing": "No such file"}
        if os.geteuid() != 0:
            (self.folder / "closed").mkdir(mode=0o500)
            wrong[self.folder / "closed"] = "Permission denied"
        for folder, cause in wrong.items():
            ended = self.run_in(folder)
            self.assertEqual(ended.returncode, 4, folder)
            self.assertRegex(ended.stderr, f"TMPDIR is .*{folder}: .*{cause}.*; set it to a folder you may write in, "
                                           "or unset it")

    def test_is_found_where_the_command_is_started_without_signals_of_children(self):
        ended = subprocess.run([ANTICRACK, "--local", "--quiet", "server"], env=self.environment(), check=False,
                               capture_output=True, preexec_fn=lambda: signal.signal(signal.SIGCHLD, signal.SIG_IGN))
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertEqual(self.left(), [])

    def test_alone_ends_with_its_input(self):
        server = subprocess.Popen([ANTICRACKD, "--private"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                  stderr=subprocess.DEVNULL, env=self.environment(), text=True)
        address = server.stdout.readline().rpartition(" ")[2].strip()
        self.assertTrue(pathlib.Path(address.removeprefix("unix:")).is_socket())
        self.assertEqual(run(ANTICRACK, "--server", address, "--quiet", "server").returncode, 0)
        server.communicate()
        self.assertEqual((server.returncode, self.left()), (0, []))


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever a daemon inherits and wherever its folder lies: it works, or says at its start what is wrong."""
import contextlib
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import time
import unittest

from processes import ANTICRACK, ANTICRACKD, FolderTest, run

CASE = """
[geometry]
boundary = [[-1,-1], [1,-1], [1,1], [-1,1]]
[mesh]
size = 0.5
[[load]]
name = "one"
f = "1"
"""


class Surroundings(FolderTest):
    def setUp(self):
        super().setUp()
        self.socket = self.folder / "socket"
        self.case = self.folder / "case.toml"
        self.case.write_text(CASE, encoding="utf-8")

    def command(self, *flags):
        data = [] if "--data-dir" in flags else ["--data-dir", self.folder / "data"]
        return [str(word) for word in (ANTICRACKD, "--listen", f"unix:{self.socket}", *data, *flags)]

    def refusal(self, *flags, **options):
        """What it says where it does not start: one line."""
        ended = run(*self.command(*flags), timeout=120, **options)
        self.assertNotEqual(ended.returncode, 0, ended.stderr)
        self.assertGreater(ended.returncode, 0, "it was killed")
        self.assertEqual(ended.stderr.count("\n"), 1, ended.stderr)
        return ended.stderr

    @contextlib.contextmanager
    def server(self, *flags, words=(), **options):
        """A daemon as these options of subprocess start it, behind `words`. It meshes and solves, and a signal ends
        it; the body gets the file of its standard error."""
        log = self.folder / "log"
        with open(log, "wb") as error:
            options = {"stdout": subprocess.DEVNULL, "stderr": error} | options
            process = subprocess.Popen([*words, *self.command(*flags)], **options)
        try:
            limit = time.monotonic() + 120
            while not self.socket.exists():
                self.assertIsNone(process.poll(), log.read_text(encoding="utf-8"))
                self.assertLess(time.monotonic(), limit)
                time.sleep(0.02)
            ended = run(ANTICRACK, "--server", f"unix:{self.socket}", "run", self.case, "-o", self.folder / "r.h5",
                        timeout=300)
            self.assertEqual(ended.returncode, 0, ended.stderr + log.read_text(encoding="utf-8"))
            yield log
            process.send_signal(signal.SIGTERM)
            self.assertEqual(process.wait(120), 0)
        finally:
            process.kill()
            process.wait()

    def test_standard_descriptors_that_are_closed(self):
        for closed in ((0,), (1,), (2,), (0, 1, 2)):
            def close(numbers=closed):
                for number in numbers:
                    os.close(number)
            with self.subTest(closed), self.server(preexec_fn=close):
                pass

    def test_signals_that_are_ignored_or_blocked(self):
        every = set(signal.valid_signals()) - {signal.SIGKILL, signal.SIGSTOP}

        def ignore():
            for number in every:
                with contextlib.suppress(OSError, ValueError):
                    signal.signal(number, signal.SIG_IGN)
        with self.subTest("ignored"), self.server(preexec_fn=ignore, restore_signals=False):
            pass
        with self.subTest("blocked"), self.server(preexec_fn=lambda: signal.pthread_sigmask(signal.SIG_BLOCK, every)):
            pass

    def test_descriptors_that_are_passed_on(self):
        with contextlib.ExitStack() as stack:
            held = [stack.enter_context(open("/dev/null", "rb")).fileno() for _ in range(200)]
            for number in held:
                os.set_inheritable(number, True)
            with self.server(close_fds=False):
                pass

    def test_environments(self):
        for odd in ({}, {"PATH": ""}, {"LC_ALL": "tr_TR.UTF-8", "LANG": "nowhere"}, {"TZ": ":/nowhere"},
                    {"TMPDIR": "/nowhere"}, {"OMP_NUM_THREADS": "64", "OPENBLAS_NUM_THREADS": "64"},
                    {"OMP_NUM_THREADS": "none", "OPENBLAS_NUM_THREADS": "-3"}, {"HOME": "nowhere"},
                    {"WATCHDOG_USEC": "soon"}, {"http_proxy": "http://127.0.0.1:9"}):
            with self.subTest(odd), self.server(env=odd):
                pass

    def test_systemd_that_is_not_there(self):
        with self.server(env={"NOTIFY_SOCKET": "/nowhere/notify"}) as log:
            self.assertIn("NOTIFY_SOCKET", log.read_text(encoding="utf-8"))

    def test_sockets_that_are_passed_on(self):
        words = ("/bin/sh", "-c", 'LISTEN_FDS=1 LISTEN_PID=$$ exec "$@"', "sh")
        with self.server(words=words) as log:
            self.assertIn("LISTEN_FDS", log.read_text(encoding="utf-8"))

    def test_new_files_are_the_users_alone(self):
        with self.server(preexec_fn=lambda: os.umask(0)):
            for path in (self.folder / "data").rglob("*"):
                self.assertEqual(path.stat().st_mode & 0o077, 0, path)

    def test_limits(self):
        def limited(what, soft, hard=None):
            return lambda: resource.setrlimit(what, (soft, soft if hard is None else hard))
        mib = 1 << 20
        unlimited = resource.RLIM_INFINITY
        for what, soft, hard in ((resource.RLIMIT_STACK, 256 << 10, unlimited), (resource.RLIMIT_STACK, 4 * mib, None),
                                 (resource.RLIMIT_CORE, 0, None), (resource.RLIMIT_MEMLOCK, 0, None),
                                 (resource.RLIMIT_FSIZE, 512 * mib, None), (resource.RLIMIT_NOFILE, 400, 4096)):
            with self.subTest((what, soft)), self.server(preexec_fn=limited(what, soft, hard)):
                pass
        for what, value, cure in ((resource.RLIMIT_FSIZE, mib, "ulimit -f"), (resource.RLIMIT_NOFILE, 128, "ulimit -n"),
                                  (resource.RLIMIT_STACK, 512 << 10, "ulimit -s")):
            with self.subTest((what, value)):
                self.assertIn(cure, self.refusal(preexec_fn=limited(what, value)))

    @unittest.skipUnless(os.geteuid() == 0, "the limit holds for the processes of a user, and root has none")
    def test_too_few_threads(self):
        os.chmod(self.folder, 0o777)

        def nobody():
            resource.setrlimit(resource.RLIMIT_NPROC, (20, 20))
            os.setgroups([])
            os.setuid(65534)
        try:
            ended = run(*self.command(), preexec_fn=nobody, timeout=120)  # libraries may complain, too
            self.assertEqual(ended.returncode, 2, ended.stderr)
            self.assertIn("ulimit -u", ended.stderr)
        except PermissionError as error:
            self.skipTest(f"another user may not run the server: {error}")

    def test_folders_that_do_not_do(self):
        (self.folder / "file").write_text("", encoding="utf-8")
        (self.folder / "nothing").symlink_to(self.folder / "nowhere")
        for path, said in ((self.folder / "file", "not a folder"), (self.folder / "file/data", "ot a "),
                           (self.folder / "nothing", "symbolic link"),
                           (self.folder / ("long" * 100), "too long"), ("/proc/data", "data-dir: /proc/data")):
            with self.subTest(path):
                told = self.refusal("--data-dir", path)
                self.assertIn(said, told)
                self.assertIn("--data-dir", told)

    def test_a_folder_that_others_may_write_in(self):
        (self.folder / "data").mkdir()
        (self.folder / "data").chmod(0o777)
        with self.server() as log:
            self.assertIn("chmod o-w", log.read_text(encoding="utf-8"))

    def test_a_folder_behind_a_symbolic_link(self):
        (self.folder / "real").mkdir(mode=0o700)
        (self.folder / "link").symlink_to(self.folder / "real")
        with self.server("--data-dir", self.folder / "link"):
            pass

    def test_a_folder_that_is_gone(self):
        gone = self.folder / "gone"
        gone.mkdir()
        script = f'cd {gone} && rmdir {gone} && exec "$@"'
        ended = run("/bin/sh", "-c", script, "sh", *self.command("--data-dir", "data"), timeout=120)
        self.assertEqual(ended.returncode, 2, ended.stderr)
        self.assertIn("started is gone", ended.stderr)
        with self.server(words=("/bin/sh", "-c", script.replace(str(gone), str(gone) + "2").replace(
                "cd", f"mkdir {gone}2 && cd"), "sh")):
            pass

    def test_no_home(self):
        ended = run(ANTICRACKD, "--listen", "127.0.0.1:0", env={}, timeout=120)
        self.assertEqual(ended.returncode, 2)
        self.assertIn("--data-dir", ended.stderr)

    @unittest.skipUnless(os.geteuid() == 0, "takes mount")
    def test_file_systems(self):
        point = self.folder / "mounted"
        point.mkdir()
        for options, said in (("size=64k", "there is space"), ("ro", "Read-only")):
            mounted = run("mount", "-t", "tmpfs", "-o", f"mode=700,{options}", "none", point)
            if mounted.returncode != 0:
                self.skipTest(mounted.stderr)
            try:
                with self.subTest(options):
                    self.assertIn(said, self.refusal("--data-dir", point))
            finally:
                run("umount", point)
        run("mount", "-t", "tmpfs", "-o", "mode=700,noexec", "none", point)
        try:
            with self.server("--data-dir", point) as log:
                self.assertIn("lies in memory", log.read_text(encoding="utf-8"))
        finally:
            run("umount", "-l", point)

    def test_a_mesher_that_is_another_program(self):
        for path in ("/bin/true", "/bin/sh"):
            with self.subTest(path):
                self.assertIn("--mesher", self.refusal("--mesher", path))
        self.assertIn("--mesher", self.refusal("--mesher", self.folder))

    @unittest.skipUnless(os.geteuid() == 0 and shutil.which("unshare"), "takes a namespace of processes")
    def test_children_of_others_that_end_in_a_container(self):
        def children(pid):
            return pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii").split()

        log = open(self.folder / "log", "wb")
        outer = subprocess.Popen(["unshare", "--pid", "--fork", "--kill-child", *self.command()], stderr=log,
                                 stdout=subprocess.PIPE)
        with log, outer:
            self.assertIn(b"listening", outer.stdout.readline())
            first = children(outer.pid)[0]
            entered = run("nsenter", "--target", first, "--pid", "sh", "-c", "sleep 0.1 & sleep 0.2 & sleep 0.3 &")
            self.assertEqual(entered.returncode, 0, entered.stderr)
            limit = time.monotonic() + 120
            while children(first):  # those that have ended, too
                self.assertLess(time.monotonic(), limit)
                time.sleep(0.1)
            os.kill(int(first), signal.SIGTERM)
            self.assertEqual(outer.wait(120), 0)

    def test_without_a_terminal(self):
        for words in (("nohup",), ("setsid", "-w")):
            with self.subTest(words), self.server(words=words):
                pass


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""What cpack puts into the Debian packages, and what these say of themselves."""
import fnmatch
import os
import pathlib
import re
import tempfile
import unittest

from processes import FolderTest, run

DOC = "usr/share/doc"
SHARE = "usr/share"
PYTHON = "usr/lib/python3/dist-packages"
EXECUTABLE, PLAIN, LINK = "-rwxr-xr-x", "-rw-r--r--", "lrwxrwxrwx"

# Every file of a package has its pattern, every pattern its file.
FILES = {
    "anticrack-server": {
        EXECUTABLE: ["usr/bin/anticrackd", "usr/libexec/anticrack/anticrack-mesher", f"{SHARE}/anticrack/make-certificates"],
        PLAIN: ["etc/anticrack/anticrackd.toml", "usr/lib/systemd/system/anticrackd.service",
                f"{SHARE}/man/man5/anticrackd.toml.5.gz", f"{SHARE}/man/man8/anticrackd.8.gz",
                f"{DOC}/anticrack-server/copyright", f"{DOC}/anticrack-server/changelog.gz",
                f"{DOC}/anticrack-server/examples/prometheus-alerts.yaml", f"{DOC}/anticrack-server/examples/haproxy.cfg",
                f"{DOC}/anticrack-server/examples/kubernetes/*.yaml",
                f"{DOC}/anticrack-server/examples/grafana-dashboard.json"],
    },
    "anticrack-client": {
        EXECUTABLE: ["usr/bin/anticrack"],
        PLAIN: [f"{SHARE}/man/man1/anticrack.1.gz", f"{SHARE}/man/man1/anticrack-run.1.gz",
                f"{SHARE}/man/man1/anticrack-*.1.gz", f"{SHARE}/bash-completion/completions/anticrack",
                f"{SHARE}/zsh/vendor-completions/_anticrack", f"{SHARE}/fish/vendor_completions.d/anticrack.fish",
                f"{SHARE}/anticrack/proto/anticrack/v1/*.proto", f"{SHARE}/anticrack/examples/paper.toml",
                f"{SHARE}/anticrack/examples/*.toml", f"{SHARE}/anticrack/examples/load-ratio.csv",
                f"{SHARE}/anticrack/examples/*", f"{DOC}/anticrack-client/copyright", f"{DOC}/anticrack-client/changelog.gz"],
    },
    "libanticrack-dev": {
        EXECUTABLE: [],
        PLAIN: [*(f"usr/lib/libanticrack_{part}.a" for part in ("client", "digest", "messages", "proto")),
                "usr/lib/cmake/anticrack/Findre2.cmake",
                *(f"usr/lib/cmake/anticrack/anticrack-{part}.cmake"
                  for part in ("config", "config-version", "targets", "targets-release")),
                *(f"usr/include/anticrack/client/{part}.hpp" for part in
                  ("block", "connection", "credentials", "error", "jobs", "meshes", "retry")),
                *(f"usr/include/anticrack/v1/{part}.{kind}.h" for part in ("case", "error", "job", "mesh", "server", "solve", "upload")
                  for kind in ("pb", "grpc.pb")),
                f"{SHARE}/anticrack/examples/library/CMakeLists.txt", f"{SHARE}/anticrack/examples/library/main.cpp",
                f"{DOC}/libanticrack-dev/copyright", f"{DOC}/libanticrack-dev/changelog.gz"],
    },
    "python3-anticrack": {
        EXECUTABLE: ["usr/bin/anticrack-study", "usr/bin/anticrack-view"],
        PLAIN: [*(f"{PYTHON}/anticrack/view/page/{part}" for part in ("index.html", "*")),
                f"{PYTHON}/anticrack/py.typed",
                *(f"{PYTHON}/anticrack/{part}.py" for part in ("__init__", "client", "*")),
                *(f"{PYTHON}/anticrack/v1/{part}" for part in ("__init__.py", "solve_pb2.py", "solve_pb2.pyi", "solve_pb2_grpc.py",
                                                               "comments.desc", "*_pb2*.py*")),
                *(f"{PYTHON}/anticrack.egg-info/{part}" for part in ("PKG-INFO", "*.txt")),
                f"{DOC}/python3-anticrack/copyright", f"{DOC}/python3-anticrack/changelog.gz"],
    },
    "anticrack-doc": {
        LINK: ["../../../anticrack/examples"],
        PLAIN: [*(f"{DOC}/anticrack/{path}" for path in (
                    "README.md", ".github/CONTRIBUTING.md", ".github/CITATION.cff", "client/README.md",
                    "client/TUTORIAL.md", "client/VIEW.md", "client/view.png", "client/BASICS.md", "client/PAPER.md",
                    "client/RESULT.md", "client/JSON.md",
                    "deploy/README.md", "deploy/CHANGELOG.md", "deploy/packages.txt", "deploy/COPYING", "proto/REFERENCE.md",
                    "server/PROMISES.md", "server/COMPATIBILITY.md", "server/README.md", "server/THEORY.md")),
                f"{DOC}/anticrack-doc/copyright", f"{DOC}/anticrack-doc/changelog.gz"],
    },
}


BUILD = pathlib.Path(os.environ["BUILD"])


class Build(unittest.TestCase):
    def test_is_completed_by_cpack(self):
        """A build of the two programs only, as that of quickstart, lacks other files of the packages."""
        self.assertRegex((BUILD / "CPackConfig.cmake").read_text(encoding="utf-8"),
                         r'set\(CPACK_INSTALL_COMMANDS ".* --target product"\)')

        def ninja(*words):
            return run("ninja", "-C", BUILD, "-t", *words).stdout
        made = {line.split(": ")[0] for line in ninja("targets", "all").splitlines()}
        script = (BUILD / "deploy/cmake_install.cmake").read_text(encoding="utf-8")
        packed = set(re.findall(rf'"{re.escape(str(BUILD))}/([^"]+)"', script)) & made
        self.assertIn("deploy/changelog.gz", packed)
        commands = ninja("commands", "product")
        self.assertEqual({path for path in packed if path not in commands}, set())


class Packages(FolderTest):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="anticrack-test-")
        cls.addClassCleanup(folder.cleanup)
        made = run(os.environ["CPACK"], "--config", BUILD / "CPackConfig.cmake", "-B", folder.name,
                   "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip", umask=0o077)  # half the time of xz
        assert made.returncode == 0, made.stdout + made.stderr
        assert "WARNING" not in made.stdout + made.stderr, made.stderr
        cls.packages = {path.name.split("_")[0]: path for path in pathlib.Path(folder.name).glob("*.deb")}

    def field(self, package, name):
        return run("dpkg-deb", "-f", self.packages[package], name).stdout.strip()

    def test_are_these(self):
        self.assertEqual(set(self.packages), set(FILES))

    def test_hold_each_file_at_its_place(self):
        for package, expected in FILES.items():
            listed = run("dpkg-deb", "-c", self.packages[package]).stdout.splitlines()
            patterns = [(mode, pattern) for mode in expected for pattern in expected[mode]]
            used = set()
            for line in listed:
                mode, owner, *_, path = line.split()
                self.assertEqual(owner, "root/root", line)
                if mode.startswith("d"):
                    self.assertEqual(mode, "drwxr-xr-x", line)
                    continue
                fitting = {(m, p) for m, p in patterns if m == mode and fnmatch.fnmatch(path.removeprefix("./"), p)}
                self.assertTrue(fitting, f"{package}: {line}")
                used |= fitting
            self.assertEqual(used, set(patterns), package)

    def test_have_what_links_of_the_documents_lead_to(self):
        for package in self.packages.values():
            self.assertEqual(run("dpkg-deb", "-x", package, self.folder).returncode, 0)
        ours = self.folder / DOC / "anticrack"
        documents = [*ours.rglob("*.md"), *(ours / "client/examples").glob("*.md")]
        self.assertGreater(len(documents), 10)
        for document in documents:
            for target in re.findall(r'(?:\]\(|src=")([^)#\s"]+)', document.read_text(encoding="utf-8")):
                if "://" not in target:
                    self.assertTrue(os.path.exists(os.path.normpath(document.parent / target)), f"{document}: {target}")

    def test_share_no_file(self):
        listed = [line.split()[-1] for package in FILES
                  for line in run("dpkg-deb", "-c", self.packages[package]).stdout.splitlines() if line.startswith("-")]
        self.assertEqual(len(listed), len(set(listed)))

    def test_say_what_they_are(self):
        for package in FILES:
            self.assertRegex(self.field(package, "Version"), r"^\d+\.\d+\.\d+$")
            self.assertIn("anticrack", self.field(package, "Description").splitlines()[0] + package)
            self.assertLess(len(self.field(package, "Description").splitlines()[0]), 80)
            self.assertRegex(self.field(package, "Maintainer"), r"^.+ <.+@.+>$")
        self.assertEqual(self.field("libanticrack-dev", "Section"), "libdevel")

    def test_depend_on_what_they_use(self):
        def needs(package):
            return set(re.findall(r"([a-z0-9.+-]+)[^,]*(?:, |$)", self.field(package, "Depends")))
        for package, libraries in (  # with the version in the name, and t64 since times have 64 bits everywhere
                ("anticrack-server", r"libgrpc\+\+1\.\d+ libgmsh4\.\d+ libcholmod\d libopenblas0 libsqlite3-0 libseccomp2 libsystemd0"),
                ("anticrack-client", r"libhdf5-\d+(-\d)?")):
            for library in libraries.split():
                self.assertTrue(any(re.fullmatch(f"{library}(t64)?", name) for name in needs(package)), library)
        for library in needs("anticrack-client"):  # a thin client: nothing numerical
            self.assertNotRegex(library, "gmsh|cholmod|blas|lapack|muparser")
        self.assertEqual(needs("libanticrack-dev"), {"libgrpc++-dev", "libprotobuf-dev", "libisal-dev", "libssl-dev",
                                                     "pkg-config", "protobuf-compiler-grpc"})
        self.assertEqual(self.field("anticrack-client", "Recommends"), "anticrack-doc, python3-anticrack")
        self.assertEqual(needs("python3-anticrack"), {"python3", "python3-grpcio", "python3-h5py", "python3-numpy",
                                                      "python3-protobuf"})
        for package in ("anticrack-doc", "python3-anticrack"):
            self.assertEqual(self.field(package, "Architecture"), "all")

    def test_of_the_server_keeps_its_configuration_and_starts_its_unit(self):
        control, files = self.folder / "control", self.folder / "files"
        for flag, folder in (("-e", control), ("-x", files)):
            self.assertEqual(run("dpkg-deb", flag, self.packages["anticrack-server"], folder).returncode, 0)
        self.assertEqual((control / "conffiles").read_text(encoding="utf-8"), "/etc/anticrack/anticrackd.toml\n")
        for script in ("postinst", "prerm", "postrm"):
            self.assertTrue(os.access(control / script, os.X_OK), script)
            self.assertEqual(run("sh", "-n", control / script).returncode, 0, script)
        unit = (files / "usr/lib/systemd/system/anticrackd.service").read_text(encoding="utf-8")
        self.assertIn("\nExecStart=/usr/bin/anticrackd --config /etc/anticrack/anticrackd.toml ", unit)
        self.assertNotIn("/usr/local", unit)

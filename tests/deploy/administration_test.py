# SPDX-License-Identifier: GPL-3.0-or-later
"""What an administrator does with a server that runs: new certificates and tokens, and who uses it how much."""
import hashlib
import json
import urllib.request

import grpc

from places import DEPLOY, EXAMPLES
from processes import ANTICRACK, Daemon, FolderTest, run

SCRIPT = DEPLOY / "make-certificates"
SERVER_INFO = "/anticrack.v1.ServerService/GetServerInfo"


def token_line(name, role, token, *last_day):
    return " ".join([name, role, hashlib.sha256(token.encode()).hexdigest(), *last_day]) + "\n"


def refusal(port, token):
    """The code and message of a call; none where it is answered."""
    with grpc.insecure_channel(f"127.0.0.1:{port}") as channel:
        ask = channel.unary_unary(SERVER_INFO, request_serializer=bytes, response_deserializer=bytes)
        try:
            ask(b"", metadata=[("authorization", "Bearer " + token)], timeout=60)
            return None
        except grpc.RpcError as error:
            return error.code(), error.details()


class Administration(FolderTest):
    def tokens(self, *lines):
        path = self.folder / "tokens"
        path.write_text("".join(lines), encoding="utf-8")
        return path

    def test_tokens_are_read_again(self):
        path = self.tokens(token_line("ann", "user", "old"))
        with Daemon(self.folder, "--tokens", path) as daemon:
            self.assertIsNone(refusal(daemon.port, "old"))
            self.tokens(token_line("ann", "user", "new"))
            self.assertEqual(refusal(daemon.port, "new")[0], grpc.StatusCode.UNAUTHENTICATED, "not yet")
            self.assertNotIn("not read again", daemon.hang_up())
            self.assertIsNone(refusal(daemon.port, "new"))
            self.assertEqual(refusal(daemon.port, "old")[0], grpc.StatusCode.UNAUTHENTICATED)
            for bad, why in (("ann king 00\n", "line 1"), ("", "holds no token")):
                self.tokens(bad)
                said = daemon.hang_up()
                self.assertIn("not read again", said)
                self.assertIn(why, said)
                self.assertIsNone(refusal(daemon.port, "new"), "the old ones stay")
                self.assertEqual(refusal(daemon.port, "")[0], grpc.StatusCode.UNAUTHENTICATED)

    def test_tokens_expire(self):
        path = self.tokens(token_line("ann", "user", "past", "2020-02-29"), token_line("ann", "user", "now", "9999-12-31"))
        with Daemon(self.folder, "--tokens", path) as daemon:
            self.assertIsNone(refusal(daemon.port, "now"))
            code, message = refusal(daemon.port, "past")
            self.assertEqual(code, grpc.StatusCode.UNAUTHENTICATED)
            self.assertIn("expired at the end of 2020-02-29", message)

    def test_makes_tokens_that_expire(self):
        line = run(SCRIPT, "token", "ann", "user", "2027-12-31").stdout.splitlines()[1]
        self.assertRegex(line, r" ann user [0-9a-f]{64} 2027-12-31$")
        self.assertEqual(run(SCRIPT, "token", "ann", "user", "tomorrow").returncode, 1)

    def test_certificates_are_read_again(self):
        made = {name: self.folder / name for name in ("first", "second")}
        for folder in made.values():
            self.assertEqual(run(SCRIPT, folder).returncode, 0)
        used = {end: self.folder / f"server.{end}" for end in ("crt", "key")}
        roots = self.folder / "roots.crt"

        def use(name):
            for end, path in used.items():
                path.write_bytes((made[name] / f"server.{end}").read_bytes())
                path.chmod(0o600)
            roots.write_bytes((made[name] / "ca.crt").read_bytes())

        def channel(name):
            read = [(made[name] / file).read_bytes() for file in ("ca.crt", "client-trial.key", "client-trial.crt")]
            return grpc.secure_channel(f"localhost:{daemon.port}", grpc.ssl_channel_credentials(*read),
                                       options=[("grpc.use_local_subchannel_pool", 1)])

        def ask(there):
            method = there.unary_unary(SERVER_INFO, request_serializer=bytes, response_deserializer=bytes)
            try:
                method(b"", timeout=60)
                return grpc.StatusCode.OK
            except grpc.RpcError as error:
                return error.code()

        def code(name):
            with channel(name) as there:
                return ask(there)

        use("first")
        with Daemon(self.folder, "--tls-certificate", used["crt"], "--tls-key", used["key"],
                    "--tls-client-roots", roots) as daemon, channel("first") as open_before:
            self.assertEqual(ask(open_before), grpc.StatusCode.OK)
            self.assertEqual(code("second"), grpc.StatusCode.UNAVAILABLE)
            use("second")
            self.assertEqual(code("first"), grpc.StatusCode.OK, "not read yet")
            self.assertNotIn("not read again", daemon.hang_up())
            self.assertEqual(code("second"), grpc.StatusCode.OK)
            self.assertEqual(code("first"), grpc.StatusCode.UNAVAILABLE)
            self.assertEqual(ask(open_before), grpc.StatusCode.OK, "connections stay")
            used["key"].write_bytes((made["first"] / "server.key").read_bytes())
            said = daemon.hang_up()
            self.assertIn("not read again", said)
            self.assertIn("tls-key: the key belongs to another certificate", said)
            self.assertEqual(code("second"), grpc.StatusCode.OK, "the old ones stay")

    def test_sees_who_has_what(self):
        tokens = {"ann": "a-token", "bob": "b-token", "root": "r-token"}
        path = self.tokens(*(token_line(name, "admin" if name == "root" else "user", token)
                             for name, token in tokens.items()))
        for name, token in tokens.items():
            (self.folder / name).write_text(token, encoding="utf-8")
            (self.folder / name).chmod(0o600)
        with Daemon(self.folder, "--tokens", path, "--metrics-listen", "127.0.0.1:0") as daemon:
            def client(name, *words):
                ended = run(ANTICRACK, "--server", f"127.0.0.1:{daemon.port}", "--token-file", self.folder / name, *words)
                self.assertEqual(ended.returncode, 0, ended.stderr)
                return ended.stdout

            for name in ("ann", "bob"):
                client(name, "run", EXAMPLES / "slit.toml", "--set", "mesh.preset=uniform", "--set", "mesh.size=0.2",
                       "-o", self.folder / f"{name}.h5")
            self.assertRegex(client("root", "job", "list"), r"(?s)owner.*\bbob\b.*\bann\b")
            jobs = json.loads(client("root", "--json", "job", "list", "--owner", "ann"))["jobs"]
            self.assertEqual([job["owner"] for job in jobs], ["ann"])
            for collection in ("job", "mesh"):
                mine = client("root", collection, "list", "--owner", "bob")
                self.assertIn("bob", mine)
                self.assertNotIn("ann", mine)
            with urllib.request.urlopen(daemon.metrics_url(), timeout=60) as answer:
                page = answer.read().decode()
        for name in ("ann", "bob"):
            self.assertIn(f'anticrack_owner_jobs{{owner="{name}"}} 1\n', page)
            self.assertIn(f'anticrack_owner_unfinished_jobs{{owner="{name}"}} 0\n', page)
            self.assertRegex(page, r"\nanticrack_unfinished_jobs_limit [1-9]\d*\n")
            self.assertRegex(page, rf'anticrack_owner_result_bytes\{{owner="{name}"\}} [1-9]')

# SPDX-License-Identifier: GPL-3.0-or-later
"""deploy/make-certificates, and a server and clients that live by what it makes."""
import hashlib
import os
import re
import stat

import grpc

from places import DEPLOY
from processes import Daemon, FolderTest, run

SCRIPT = DEPLOY / "make-certificates"
SERVER_INFO = "/anticrack.v1.ServerService/GetServerInfo"
HEALTH = "/grpc.health.v1.Health/Check"


def call(channel, method, token=None):
    """OK, or the status code of a call with an empty request."""
    ask = channel.unary_unary(method, request_serializer=bytes, response_deserializer=bytes)
    metadata = [("authorization", "Bearer " + token)] if token else []
    try:
        ask(b"", metadata=metadata, timeout=60)
        return grpc.StatusCode.OK
    except grpc.RpcError as error:
        return error.code()


class Certificates(FolderTest):
    def setUp(self):
        super().setUp()
        self.made = self.folder / "made"
        ended = run(SCRIPT, self.made)
        self.assertEqual(ended.returncode, 0, ended.stderr)

    def read(self, name):
        return (self.made / name).read_bytes()

    def verify(self, purpose, *certificates):
        return run("openssl", "verify", "-x509_strict", "-CAfile", self.made / "ca.crt", "-purpose", purpose,
                   *(self.made / name for name in certificates))

    def test_are_what_openssl_takes_them_for(self):
        ended = self.verify("sslserver", "server.crt")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        ended = self.verify("sslclient", "client-trial.crt")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertNotEqual(self.verify("sslclient", "server.crt").returncode, 0, "a server is not a client")
        self.assertNotEqual(self.verify("sslserver", "client-trial.crt").returncode, 0, "a client is not a server")

    def test_keep_their_keys_to_themselves(self):
        keys = sorted(self.made.glob("*.key"))
        self.assertEqual(len(keys), 3)
        for key in keys:
            self.assertEqual(stat.S_IMODE(os.stat(key).st_mode), 0o600, key)
        self.assertEqual(list(self.made.glob("new-*")), [], "nothing temporary is left")

    def test_are_never_overwritten(self):
        before = {path: path.read_bytes() for path in self.made.iterdir()}
        self.assertEqual(run(SCRIPT, self.made).returncode, 0)
        self.assertEqual({path: path.read_bytes() for path in self.made.iterdir()}, before)
        (self.made / "server.crt").unlink()
        ended = run(SCRIPT, self.made)
        self.assertEqual(ended.returncode, 1)
        self.assertIn("only one of", ended.stderr)
        self.assertEqual(self.read("server.key"), before[self.made / "server.key"])

    def test_are_made_for_names_and_further_clients(self):
        ended = run(SCRIPT, self.folder / "other", "solver.example.org", "10.0.0.7")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        names = run("openssl", "x509", "-in", self.folder / "other/server.crt", "-noout", "-ext", "subjectAltName").stdout
        self.assertIn("DNS:solver.example.org, IP Address:10.0.0.7", names)
        self.assertEqual(run(SCRIPT, "client", self.made, "ann").returncode, 0)
        self.assertEqual(self.verify("sslclient", "client-ann.crt").returncode, 0)

    def test_refuse_what_would_end_up_elsewhere(self):
        for arguments in (["client", self.made, "../ann"], ["client", self.folder / "none", "ann"],
                          ["token", "a b", "user"], ["token", "ann", "king"], [self.folder / "x", "a,DNS:evil"]):
            self.assertEqual(run(SCRIPT, *arguments).returncode, 1, arguments)

    def make_token(self, name, role):
        """The token, and its line in the file of tokens."""
        ended = run(SCRIPT, "token", name, role)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        token, line = re.fullmatch(r"token.*: (\w{64})\nline.*: (.*)\n", ended.stdout).groups()
        self.assertEqual(line, f"{name} {role} {hashlib.sha256(token.encode()).hexdigest()}")
        return token, line

    def tls_flags(self, *more):
        return ["--tls-certificate", self.made / "server.crt", "--tls-key", self.made / "server.key", *more]

    def test_and_a_token_open_a_server(self):
        token, line = self.make_token("ann", "user")
        (self.folder / "tokens").write_text(line + "\n", encoding="utf-8")
        with Daemon(self.folder, *self.tls_flags("--tokens", self.folder / "tokens")) as daemon:
            address = f"localhost:{daemon.port}"
            trusting = grpc.ssl_channel_credentials(self.read("ca.crt"))
            with grpc.secure_channel(address, trusting) as channel:
                self.assertEqual(call(channel, SERVER_INFO, token), grpc.StatusCode.OK)
                self.assertEqual(call(channel, SERVER_INFO, token[::-1]), grpc.StatusCode.UNAUTHENTICATED)
                self.assertEqual(call(channel, SERVER_INFO), grpc.StatusCode.UNAUTHENTICATED)
                self.assertEqual(call(channel, HEALTH), grpc.StatusCode.OK)
            with grpc.insecure_channel(address) as channel:
                self.assertEqual(call(channel, HEALTH), grpc.StatusCode.UNAVAILABLE, "without TLS")
            self.assertNotIn(token, daemon.log())

    def test_alone_open_a_server_that_asks_for_them(self):
        self.assertEqual(run(SCRIPT, self.folder / "stranger").returncode, 0)
        with Daemon(self.folder, *self.tls_flags("--tls-client-roots", self.made / "ca.crt")) as daemon:
            def with_certificate(of):
                return grpc.ssl_channel_credentials(self.read("ca.crt"), (of / "client-trial.key").read_bytes(),
                                                    (of / "client-trial.crt").read_bytes())
            address = f"localhost:{daemon.port}"
            with grpc.secure_channel(address, with_certificate(self.made)) as channel:
                self.assertEqual(call(channel, SERVER_INFO), grpc.StatusCode.OK)
            with grpc.secure_channel(address, with_certificate(self.folder / "stranger")) as channel:
                self.assertEqual(call(channel, SERVER_INFO), grpc.StatusCode.UNAVAILABLE)
            with grpc.secure_channel(address, grpc.ssl_channel_credentials(self.read("ca.crt"))) as channel:
                self.assertEqual(call(channel, SERVER_INFO), grpc.StatusCode.UNAVAILABLE)

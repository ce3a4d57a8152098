# SPDX-License-Identifier: GPL-3.0-or-later
"""A server that was told to stop: what balancers, clients and Prometheus see until it does."""
import time
import urllib.request

import grpc

from processes import Daemon, FolderTest

SERVING, NOT_SERVING = b"\x08\x01", b"\x08\x02"  # grpc.health.v1.HealthCheckResponse


class Stopping(FolderTest):
    def test_serves_on_but_is_not_ready(self):
        flags = ["--drain-delay", "1d", "--metrics-listen", "127.0.0.1:0"]
        with Daemon(self.folder, *flags) as daemon, grpc.insecure_channel(f"127.0.0.1:{daemon.port}") as channel:
            def ask(method):
                return channel.unary_unary(method, request_serializer=bytes, response_deserializer=bytes)(
                    b"", timeout=60, wait_for_ready=True)

            self.assertEqual(ask("/grpc.health.v1.Health/Check"), SERVING)
            daemon.terminate()
            limit = time.monotonic() + 120
            while ask("/grpc.health.v1.Health/Check") != NOT_SERVING:
                self.assertLess(time.monotonic(), limit, "still ready")
                time.sleep(0.01)
            self.assertTrue(ask("/anticrack.v1.ServerService/GetServerInfo"), "serves on")
            with urllib.request.urlopen(daemon.metrics_url(), timeout=60) as answer:
                self.assertIn("anticrack_ready 0\n", answer.read().decode())
            daemon.terminate()
            self.assertEqual(daemon.wait(), 128 + 15, "at once, with a day of delay left")

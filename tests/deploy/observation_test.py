# SPDX-License-Identifier: GPL-3.0-or-later
"""The alerts fire when they should, and ask, as the dashboard does, for metrics there are."""
import json
import re
import urllib.request

from places import DEPLOY, SERVER
from processes import Daemon, FolderTest, run

ALERTS = DEPLOY / "prometheus-alerts.yaml"
DASHBOARD = DEPLOY / "grafana-dashboard.json"
NAME = re.compile(r"\b(?:anticrack|process)_[a-z_]+\b")


def known_metrics():
    """The names in the server's sources; of a histogram also those Prometheus makes of it."""
    sources = "".join(path.read_text(encoding="utf-8") for path in (SERVER / "metrics").glob("*.cpp"))
    names = set(re.findall(r'"((?:anticrack|process)_[a-z_]+)"', sources))
    return names | {name + end for name in names for end in ("_bucket", "_sum", "_count")}


class Observation(FolderTest):
    def test_alerts_are_well_formed(self):
        ended = run("promtool", "check", "rules", ALERTS)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)

    def test_alerts_fire_when_they_should(self):
        ended = run("promtool", "test", "rules", "alerts.yaml")
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)

    def test_every_alert_is_tested(self):
        with open("alerts.yaml", encoding="utf-8") as tests:
            tested = set(re.findall(r"alertname: (\w+)", tests.read()))
        self.assertEqual(tested, set(re.findall(r"alert: (\w+)", ALERTS.read_text(encoding="utf-8"))))

    def test_alerts_and_dashboard_name_metrics_there_are(self):
        board = json.loads(DASHBOARD.read_text(encoding="utf-8"))
        expressions = [target["expr"] for panel in board["panels"] for target in panel["targets"]]
        self.assertGreater(len(expressions), 10)
        used = set(NAME.findall(" ".join(expressions))) | set(NAME.findall(ALERTS.read_text(encoding="utf-8")))
        self.assertEqual(used - known_metrics(), set())

    def test_dashboard_asks_what_prometheus_understands(self):
        board = json.loads(DASHBOARD.read_text(encoding="utf-8"))
        rules = [{"record": f"a{number}", "expr": target["expr"]} for number, target in
                 enumerate(target for panel in board["panels"] for target in panel["targets"])]
        path = self.folder / "rules.yaml"  # JSON is YAML
        path.write_text(json.dumps({"groups": [{"name": "dashboard", "rules": rules}]}), encoding="utf-8")
        ended = run("promtool", "check", "rules", path)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)

    def test_a_real_server_is_ready_and_lints(self):
        with Daemon(self.folder, "--metrics-listen", "127.0.0.1:0") as daemon:
            with urllib.request.urlopen(daemon.metrics_url(), timeout=60) as answer:
                page = answer.read().decode()
        self.assertIn("anticrack_ready 1\n", page)
        ended = run("promtool", "check", "metrics", input=page)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)

# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of `anticrack view`: who may ask it, what it shows in Chromium, and what hostile text does there."""
import contextlib
import http.client
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import time
import unittest
import warnings

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By

import anticrack
from processes import ANTICRACK, ANTICRACKD, Daemon, FolderTest, run

EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])
PAGE = pathlib.Path(os.environ["PAGE"])
HOSTILE = '<img src=x onerror="window.harmed=1"><script>window.harmed=1</script>\u202e\u2066'


@contextlib.contextmanager
def viewing(*words, command=(sys.executable, "-m", "anticrack", "view")):
    """Runs anticrack view; yields the process and its address."""
    programs = os.path.dirname(ANTICRACKD)
    process = subprocess.Popen([*command, "--no-browser", *map(str, words)], text=True,
                               stdout=subprocess.PIPE, env={**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"})
    try:
        yield process, process.stdout.readline().rpartition(" ")[2].strip()
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(20)
        process.stdout.close()


def chromium():
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    for word in ("--headless=new", "--enable-unsafe-swiftshader", "--no-sandbox", "--window-size=1400,900"):
        options.add_argument(word)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


class Gate(FolderTest):
    def ask(self, path, method="GET", **headers):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=10)
        connection.putrequest(method, path, skip_host=True)
        for name, value in {"Host": f"127.0.0.1:{self.port}", **headers}.items():
            connection.putheader(name.replace("_", "-"), value)
        connection.endheaders()
        answer = connection.getresponse()
        answer.body = answer.read()
        connection.close()
        return answer

    def test_only_the_browser_that_entered_may_ask(self):
        with viewing() as (_, address):
            self.port, token = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/\?token=(\S+)", address).groups()
            for path in ("/", "/?token=wrong", "/api/begin", "/main.js"):
                self.assertEqual(self.ask(path).status, 403, path)
            self.assertEqual(self.ask(f"/?token={token}", Host=f"localhost:{self.port}").status, 403)
            entered = self.ask(f"/?token={token}")
            self.assertEqual(entered.status, 303)
            given = entered.getheader("Set-Cookie")
            self.assertTrue("HttpOnly" in given and "SameSite=Strict" in given, given)
            cookie = given.partition(";")[0]
            self.assertEqual(self.ask(f"/?token={token}").status, 403)  # once
            page = self.ask("/", Cookie=cookie)
            self.assertEqual(page.status, 200)
            self.assertIn("default-src 'self'", page.getheader("Content-Security-Policy"))
            for headers in ({"Origin": "http://127.0.0.1:1"}, {"Origin": "null"}, {"Host": "evil.example"},
                            {"Host": "127.0.0.1"}, {"Sec_Fetch_Site": "same-site"}, {"Cookie": cookie + "x"}):
                self.assertEqual(self.ask("/api/begin", **{"Cookie": cookie, **headers}).status, 403, headers)
            self.assertEqual(self.ask("/api/job", "POST", Cookie=cookie).status, 403)  # names no origin
            for path in ("/../gate.py", "/%2e%2e/gate.py", "/..%2fgate.py", "/%2fetc%2fpasswd", "/.clang-format"):
                self.assertEqual(self.ask(path, Cookie=cookie).status, 404, path)

    def test_a_file_that_is_no_result(self):
        (self.folder / "no.h5").write_text("no result")
        ended = run(sys.executable, "-m", "anticrack", "view", "--no-browser", self.folder / "no.h5")
        self.assertEqual((ended.returncode, ended.stdout), (2, ""))
        self.assertIn("no.h5", ended.stderr)


class InChromium(FolderTest):
    def setUp(self):
        super().setUp()
        self.browser = chromium()
        self.addCleanup(self.browser.quit)

    def until(self, what, seconds=30):
        limit = time.monotonic() + seconds
        while not (found := self.script(what)):
            self.assertLess(time.monotonic(), limit, f"{what}: {self.script('return document.body.innerText')}")
            time.sleep(0.05)
        return found

    def script(self, text):
        return self.browser.execute_script(text)

    def open(self, address):
        self.browser.get(address)

    def tabs(self):
        """Clicks every tab; returns their names."""
        names = self.script("return [...document.querySelectorAll('[role=tab]')].map(tab => tab.id)")
        for name in names:
            self.browser.find_element(By.ID, name).click()
            self.until(f"return document.getElementById('{name}').ariaSelected === 'true'")
            time.sleep(0.3)
        return [name.removeprefix("tab-") for name in names]

    def require_clean(self, expected=()):
        """Nothing is said on the console, and nothing is asked of other hosts."""
        said = [entry["message"] for entry in self.browser.get_log("browser")
                if "ReadPixels" not in entry["message"] and not any(word in entry["message"] for word in expected)]
        self.assertEqual(said, [])
        for entry in self.browser.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                self.assertRegex(message["params"]["request"]["url"],
                                 r"^(http://127\.0\.0\.1:\d+/|data:|chrome|about:)")

    def test_values_of_the_page_are_those_of_the_file(self):
        with anticrack.local(program=ANTICRACKD) as client:
            case = anticrack.Case.read(EXAMPLES / "several-inclusions.toml")
            result = client.run(case, progress=False)
        result.save(self.folder / "result.h5")
        load = next(iter(result.loads.values()))
        with viewing(self.folder / "result.h5") as (_, address):
            self.open(address)
            self.until("return document.getElementById('scene').dataset.frames > 0")
            self.assertEqual(self.tabs(), ["membrane", "interfaces", "convergence", "tables", "case"])
            self.script("location.hash = 'of=file&tab=tables&table=inclusions'")
            self.until("return document.querySelector('#panel tbody td.number')")
            table = self.script("return [...document.querySelectorAll('#panel tbody tr')].map(row => "
                                "[...row.children].map(cell => cell.title || cell.textContent))")
            self.assertEqual([(row[0], row[1], float(row[2])) for row in table], [
                (each.name, part.name, part.A) for each in result.loads.values() for part in each.inclusions.values()])
            own = self.browser.execute_async_script(
                "const done = arguments[0]; fetch('/api/array?of=file&what=trace&load=0&interface=0')"
                ".then(a => a.arrayBuffer()).then(b => done([...new Float64Array(b)]))")
            trace = load.traces[0]
            self.assertEqual(own[:2 * len(trace.jump)], [*trace.u_minus.tolist(), *trace.u_plus.tolist()])
            self.require_clean()

    def test_hostile_text_does_nothing(self):
        with anticrack.local(program=ANTICRACKD) as client:
            result = client.run(EXAMPLES / "slit.toml", progress=False)
        result.title, load = HOSTILE + "x" * 65536, next(iter(result.loads.values()))
        load.warnings.append(HOSTILE * 100)
        result.case = HOSTILE
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            result.save(self.folder / "hostile.h5")
        with viewing(self.folder / "hostile.h5") as (_, address):
            self.open(address)
            self.until("return document.getElementById('title').textContent.startsWith('<img')")
            self.tabs()
            self.assertIsNone(self.script("return window.harmed ?? null"))
            shown = self.script("return document.body.innerText")
            self.assertNotRegex(shown, "[\u202e\u2066]")
            self.assertIn("\u27e6202E\u27e7", shown)
            self.assertLess(len(self.script("return document.getElementById('title').textContent")), 200)
            self.require_clean()

    def test_a_server_that_dies_and_comes_back_and_a_job_that_goes(self):
        with Daemon(self.folder) as first:
            with anticrack.connect(f"127.0.0.1:{first.port}") as client:
                job = client.submit(EXAMPLES / "slit.toml").wait(False)
            with viewing("--server", f"127.0.0.1:{first.port}", job.name) as (_, address):
                self.open(address)
                self.until("return !document.getElementById('export').hidden")
                first.kill()
                self.until("return document.getElementById('connection').className === 'lost'")
                with Daemon(self.folder, port=first.port):
                    self.until("return document.getElementById('connection').textContent.includes('restored')")
                    with anticrack.connect(f"127.0.0.1:{first.port}") as client:
                        client.job(job.name).delete()
                    self.until("return document.getElementById('notices').textContent.includes('deleted')")

    def test_a_case_is_corrected_and_run(self):
        with viewing(command=(ANTICRACK, "--local", "view")) as (_, address):  # anticrack --local view
            self.open(address)
            self.until("return document.querySelector('textarea')")
            write = "const t = document.querySelector('textarea'); t.value = {}; t.dispatchEvent(new Event('input'))"
            text = (EXAMPLES / "slit.toml").read_text(encoding="utf-8")
            wrong = text + "\nnonsense = 1\n"
            self.script(write.format(json.dumps(wrong)))
            line = wrong.count("\n")
            self.until(f"return document.querySelector('.errors .error')?.textContent.includes('line {line}')")
            self.script(write.format(json.dumps(text)))
            self.until("return document.querySelector('.errors .good')")
            self.browser.find_element(By.CSS_SELECTOR, "button.main").click()
            self.until("return document.getElementById('scene').dataset.frames > 0")
            self.require_clean()


class Code(unittest.TestCase):
    def test_types(self):
        ended = run("tsc", "--checkJs", "--allowJs", "--noEmit", "--strict", "--noImplicitAny", "false",
                    "--target", "es2022", "--module", "es2022", "--lib", "es2022,dom,dom.iterable",
                    *sorted(PAGE.glob("*.js")))
        self.assertEqual(ended.returncode, 0, ended.stdout)

    def test_layout(self):
        ended = run("clang-format", "--dry-run", "-Werror", *sorted(PAGE.glob("*.js")))
        self.assertEqual(ended.returncode, 0, ended.stderr)

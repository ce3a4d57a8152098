# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of `anticrack view`: who may ask it, what it shows in Chromium, and what hostile text does there."""
import http.client
import json
import os
import pathlib
import re
import sys
import unittest
import warnings

from selenium.webdriver.common.by import By

import anticrack
from browser import InChromium, viewing
from hostile import HOSTILE, LONG, hostile
from processes import ANTICRACK, ANTICRACKD, Daemon, FolderTest, run

EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])
PAGE = pathlib.Path(os.environ["PAGE"])


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


class Shown(InChromium):
    def test_values_of_the_page_are_those_of_the_file(self):
        with anticrack.local(program=ANTICRACKD) as client:
            case = anticrack.Case.read(EXAMPLES / "several-inclusions.toml")
            result = client.run(case, progress=False)
        result.save(self.folder / "result.h5")
        load = next(iter(result.loads.values()))
        with self.page(self.folder / "result.h5"):
            self.until("return document.getElementById('scene').dataset.frames > 0")
            self.assertEqual(self.tabs(), ["membrane", "interfaces", "convergence", "tables", "case"])
            self.script("location.hash = 'of=file&tab=tables&table=inclusions'")
            self.until("return document.querySelector('#panel tbody td.number')")
            self.assertEqual([tuple(row[:3]) for row in self.numbers_of_table()], [
                (each.name, part.name, part.A) for each in result.loads.values() for part in each.inclusions.values()])
            own = self.later("fetch('/api/array?of=file&what=trace&load=0&interface=0').then(a => a.arrayBuffer())"
                             ".then(b => [...new Float64Array(b)])")
            trace = load.traces[0]
            self.assertEqual(own[:2 * len(trace.jump)], [*trace.u_minus.tolist(), *trace.u_plus.tolist()])
            self.require_clean()

    def test_hostile_text_does_nothing(self):
        with anticrack.local(program=ANTICRACKD) as client:
            result = client.run(EXAMPLES / "slit.toml", progress=False)
        result.title, load = LONG, next(iter(result.loads.values()))
        load.warnings.append(HOSTILE * 100)
        result.case = HOSTILE
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            result.save(self.folder / "hostile.h5")
        with self.page(self.folder / "hostile.h5"):
            self.until("return document.getElementById('title').textContent.startsWith('<img')")
            self.tabs()
            self.assertIsNone(self.script("return window.harmed ?? null"))
            shown = self.script("return document.body.innerText")
            self.assertNotRegex(shown, "[\u202e\u2066]")
            self.assertIn("\u27e6202E\u27e7", shown)
            self.assertLess(len(self.script("return document.getElementById('title').textContent")), 200)
            self.require_clean()

    def test_hostile_text_of_a_server_does_nothing(self):
        marks = "return document.body.innerText.match(/[\\u202a-\\u202e\\u2066-\\u2069]/)"
        with Daemon(self.folder) as server, anticrack.connect(f"127.0.0.1:{server.port}") as client:
            job = client.submit(EXAMPLES / "opening.toml").wait(False)
            sweep = client.submit(EXAMPLES / "load-ratio.toml", coefficients=[[1, -0.5], [1, 0.5]], traces=[1])
            with hostile(server.port) as port, self.page("--server", f"127.0.0.1:{port}"):
                for job in (job, sweep.wait(False)):
                    self.script("location.hash = arguments[0]", f"of={job.name}")
                    self.until(f"return document.querySelector('.here [data-key=\"{job.name}\"] strong')"
                               "?.textContent.startsWith('<img') && !document.getElementById('export').hidden")
                    for tab in self.tabs():
                        self.assertIsNone(self.script(marks), tab)
                        self.assertIsNone(self.script("return window.harmed ?? document.querySelector("
                                                      "'img[src=x], #columns script, #columns [onerror]')"), tab)
                    self.assertLess(self.script("return document.documentElement.scrollWidth"), 1500)
                self.assertTrue(self.script("return document.body.innerText.includes('\u27e6202E\u27e7')"))
                self.assertLess(self.script("return document.body.innerText.length"), 100_000)
                self.click(f"[data-key='{sweep.name}Delete\u2026']")
                asked = self.browser.switch_to.alert
                self.assertIn("<img", asked.text)
                self.assertNotRegex(asked.text, "[\u202a-\u202e\u2066-\u2069]")
                asked.dismiss()
                self.script("location.hash = 'of=jobs/none'")  # an error of the server itself
                self.until("return document.getElementById('notices').textContent.includes('<img')")
                self.assertIsNone(self.script("return window.harmed ?? null"))
                self.assertIsNone(self.script(marks))
                self.require_clean()

    def test_a_server_that_dies_and_comes_back_and_a_job_that_goes(self):
        with Daemon(self.folder) as first:
            with anticrack.connect(f"127.0.0.1:{first.port}") as client:
                job = client.submit(EXAMPLES / "slit.toml").wait(False)
            with self.page("--server", f"127.0.0.1:{first.port}", job.name):
                self.until("return !document.getElementById('export').hidden")
                first.kill()
                self.until("return document.getElementById('connection').className === 'lost'")
                with Daemon(self.folder, port=first.port):
                    self.until("return document.getElementById('connection').textContent.includes('restored')")
                    with anticrack.connect(f"127.0.0.1:{first.port}") as client:
                        client.job(job.name).delete()
                    self.until("return document.getElementById('notices').textContent.includes('deleted')")

    def test_a_case_is_corrected_and_run(self):
        with self.page(command=(ANTICRACK, "--local", "view")):  # anticrack --local view
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

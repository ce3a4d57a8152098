# SPDX-License-Identifier: GPL-3.0-or-later
"""`anticrack view` as a process, and Chromium that looks at it."""
import contextlib
import json
import os
import re
import signal
import subprocess
import sys
import time

from selenium import webdriver
from selenium.common.exceptions import StaleElementReferenceException
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By

from processes import ANTICRACKD, FolderTest

LOOPBACK = re.compile(r"^(http://127\.0\.0\.1:\d+/|blob:http://127\.0\.0\.1|data:|chrome|about:)")


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


class InChromium(FolderTest):
    """Tests of one class share a browser."""
    @classmethod
    def setUpClass(cls):
        cls.browser = chromium()
        cls.addClassCleanup(cls.browser.quit)

    @contextlib.contextmanager
    def page(self, *words, **options):
        """Runs anticrack view and opens its page, which is left before the program ends."""
        with viewing(*words, **options) as (process, address):
            self.browser.get(address)
            try:
                yield process
            finally:
                self.browser.get("about:blank")
                self.browser.get_log("browser")  # what a test that failed left there is no other's

    def script(self, text, *words):
        return self.browser.execute_script(text, *words)

    def later(self, text):
        """The value of a promise."""
        return self.browser.execute_async_script(
            f"const done = arguments[0]; ({text}).then(done, e => done(String(e)))")

    def until(self, what, seconds=30):
        limit = time.monotonic() + seconds
        while not (found := self.script(what)):
            self.assertLess(time.monotonic(), limit, f"{what}: {self.script('return document.body.innerText')}")
            time.sleep(0.05)
        return found

    def fragment(self):
        return self.script("return Object.fromEntries(new URLSearchParams(location.hash.slice(1)))")

    def go(self, fragment, what):
        """Shows what the fragment says; waits for `what`."""
        self.script("location.hash = arguments[0]", fragment)
        return self.until(what)

    def click(self, selector):
        """Also what is drawn anew meanwhile."""
        for left in reversed(range(5)):
            try:
                return self.browser.find_element(By.CSS_SELECTOR, selector).click()
            except StaleElementReferenceException:
                self.assertTrue(left)

    def button(self, text, within="body"):
        self.until(f"return [...document.querySelectorAll('{within} button')].some(b => b.textContent === '{text}')")
        self.script(f"[...document.querySelectorAll('{within} button')].find(b => b.textContent === '{text}').click()")

    def tabs(self):
        """Clicks every tab; returns their names."""
        names = self.script("return [...document.querySelectorAll('[role=tab]')].map(tab => tab.id)")
        for name in names:
            self.click(f"#{name}")
            self.until(f"return document.getElementById('{name}').ariaSelected === 'true'")
            time.sleep(0.2)
        return [name.removeprefix("tab-") for name in names]

    def numbers_of_table(self):
        """The rows of the table that is shown, as numbers where they are."""
        rows = self.script("return [...document.querySelectorAll('#panel tbody tr')].map(row => "
                           "[...row.children].map(cell => [cell.title, cell.textContent]))")
        return [[float(exact) if exact else text for exact, text in row] for row in rows]

    def require_clean(self):
        """Nothing is said on the console, and nothing is asked of other hosts."""
        said = [entry["message"] for entry in self.browser.get_log("browser") if "ReadPixels" not in entry["message"]]
        self.assertEqual(said, [])
        for entry in self.browser.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                self.assertRegex(message["params"]["request"]["url"], LOOPBACK)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the programs that measure."""
import json
import os
import shutil
import subprocess


class Missing(Exception):
    """Not installed or not built; the message says what to do."""


class Failed(Exception):
    """A program failed; the message holds what it said."""


class Programs:
    def __init__(self, build, time_limit):
        self._bin = os.path.join(build, "bin")
        self._time_limit = time_limit

    def path(self, name, cure):
        path = os.path.join(self._bin, name)
        if not os.access(path, os.X_OK):
            raise Missing(f"{name} is not built: {cure}")
        return path

    def run(self, argv, threads=1):
        """What it prints on standard output. `threads`: of BLAS, where the program leaves it be."""
        environment = dict(os.environ, OPENBLAS_NUM_THREADS=str(threads), OMP_NUM_THREADS=str(threads),
                           LC_ALL="C")
        try:
            done = subprocess.run(argv, env=environment, capture_output=True, text=True,
                                  timeout=self._time_limit, check=False)
        except subprocess.TimeoutExpired as late:
            raise Failed(f"{argv[0]} is not done after {self._time_limit} s") from late
        if done.returncode != 0:
            raise Failed(f"{' '.join(argv)} ended with {done.returncode}: {done.stderr.strip()[-2000:]}")
        return done.stdout

    def figures(self, name, arguments, threads=1, cure="build the whole project"):
        """The JSON object a program of ours prints."""
        text = self.run([self.path(name, cure)] + [str(a) for a in arguments], threads)
        try:
            return json.loads(text)
        except ValueError as wrong:
            raise Failed(f"{name} printed no JSON: {text[:200]!r}") from wrong


def freefem():
    path = shutil.which("FreeFem++")
    if path is None:
        raise Missing("FreeFEM++ is not installed (Debian package freefem++)")
    return path

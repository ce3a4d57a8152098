# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs python3 -m anticrack, which the commands `anticrack plot`, `anticrack mesh show` and `anticrack export` call."""
import sys

from .commands import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

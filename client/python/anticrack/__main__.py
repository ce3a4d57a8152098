# SPDX-License-Identifier: GPL-3.0-or-later
"""python3 -m anticrack plot, which `anticrack plot` runs, and what `anticrack mesh show` draws with."""
import sys

from .commands import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

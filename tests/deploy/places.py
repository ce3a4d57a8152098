# SPDX-License-Identifier: GPL-3.0-or-later
"""Where things are."""
import os
import pathlib

DEPLOY = pathlib.Path(os.environ["DEPLOY"])
SERVER = pathlib.Path(os.environ["SERVER"])
EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])

# SPDX-License-Identifier: GPL-3.0-or-later
"""An array of numpy; docstrings say its shape."""
from typing import Any

import numpy.typing

Array = numpy.typing.NDArray[Any]

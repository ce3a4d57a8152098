# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases as a server reads them."""
import functools

import anticrack
from anticrack.transport import finished
from processes import ANTICRACKD


@functools.cache
def _session():
    return anticrack.local(program=ANTICRACKD)._session  # ends with the program


def read(case, loads_optional=False):
    """A ReadCase: the requests for a mesh and a job, and their arrays."""
    return finished(_session().read(case, loads_optional))

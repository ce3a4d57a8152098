# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases that several tests solve, and cases as a server reads them."""
import functools

import anticrack
from anticrack.transport import finished
from processes import ANTICRACKD

GROWTH = """
[geometry]
boundary = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
[[geometry.inclusion]]
name = "fibre"
points = [[-0.5, 0], [0.5, 0]]
delaminated = true
[mesh]
size = 0.08
[[growth.path]]
interface = "fibre"
from = [-0.5, 0]
to = [0, 0]
Gc = 0.1
[[load]]
name = "shear"
boundary_value = "y"
"""


@functools.cache
def _session():
    return anticrack.local(program=ANTICRACKD)._session  # ends with the program


def read(case, loads_optional=False):
    """A ReadCase: the requests for a mesh and a job, and their arrays."""
    return finished(_session().read(case, loads_optional))

# SPDX-License-Identifier: GPL-3.0-or-later
"""anticrack: elastic membranes with cracks and thin rigid inclusions, solved by anticrackd.

    with anticrack.local() as client:
        result = client.run("case.toml")
        print(result["opening"].energy)
        anticrack.draw.membrane(result, "opening")
"""
from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from .case import (Accuracy, ActiveSet, Case, Crack, Geometry, Growth, Hole, Inclusion, Interface, Load, Mesh, Path,
                   Probe, Region, Side, Units, Uzawa)
from .client import Client, Job, connect, local
from .errors import CaseError, Error, LocalServerError, ServerError
from .msh import Msh
from .result import Result

if TYPE_CHECKING:
    from . import aio, draw
    from .study import Study

__all__ = ["Accuracy", "ActiveSet", "Case", "CaseError", "Client", "Crack", "Error", "Geometry", "Growth", "Hole",
           "Inclusion", "Interface", "Job", "Load", "LocalServerError", "Mesh", "Msh", "Path", "Probe", "Region",
           "Result", "ServerError", "Side", "Study", "Units", "Uzawa", "aio", "connect", "draw", "local", "read"]
__version__ = "0.1.0"

read = Result.read


def __getattr__(name: str) -> Any:
    """Imports modules that take long to import only when they are used."""
    if name in ("aio", "draw"):
        return importlib.import_module("." + name, __name__)
    if name == "Study":
        return importlib.import_module(".study", __name__).Study
    raise AttributeError(f"module 'anticrack' has no attribute '{name}'")

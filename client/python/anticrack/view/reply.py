# SPDX-License-Identifier: GPL-3.0-or-later
"""JSON as browsers read it: numbers that are not finite are null."""
from __future__ import annotations

import json
import math
from typing import Any

from aiohttp import web


def finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: finite(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(entry) for entry in value]
    return value


def text_of(value: Any) -> str:
    return json.dumps(finite(value), allow_nan=False, separators=(",", ":"))


def reply(value: Any) -> web.Response:
    return web.Response(text=text_of(value), content_type="application/json")

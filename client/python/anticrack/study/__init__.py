# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies: a case solved for many values of its keys, each row as a job of its own."""
from .record import Row, Study

__all__ = ["Row", "Study"]

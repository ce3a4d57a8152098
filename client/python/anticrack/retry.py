# SPDX-License-Identifier: GPL-3.0-or-later
"""Says when a failed call is tried again. Every call can be repeated: jobs have a request id, meshes and uploads are
named by their content, a watch goes on after a sequence number, a read at an offset."""
from __future__ import annotations

import random
import time
from dataclasses import dataclass

from .errors import ServerError

FIRST, LONGEST = 0.1, 1.0  # delay before the second try, and the longest delay [s]


@dataclass
class Backoff:
    """Delays that double; each is drawn from the upper half of its range. patience: gives up after failing for longer
    [s]; first_contact: the patience until the server has answered once (met), as a wrong address should fail soon."""
    patience: float
    first_contact: float
    met: bool = False
    _delay: float = FIRST
    _since: float = 0.0

    def fresh(self) -> Backoff:
        """A new Backoff for another call to the same server."""
        return Backoff(self.patience, self.first_contact, self.met)

    @property
    def failing(self) -> bool:
        """Whether a call has failed since the last success."""
        return self._since > 0

    def succeeded(self) -> None:
        self.met, self._delay, self._since = True, FIRST, 0.0

    def next(self, error: ServerError) -> float:
        """The seconds to wait before the next try; raises `error` if it is time to give up."""
        now = time.monotonic()
        self._since = self._since or now
        delay = max(random.uniform(self._delay / 2, self._delay), error.retry_delay)
        self._delay = min(2 * self._delay, LONGEST)
        limit = self.patience if self.met or not error.lost else self.first_contact
        if not error.may_retry or now - self._since + delay > limit:
            raise error
        return delay

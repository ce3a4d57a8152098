# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs on a pseudo-terminal whose screen can be read."""
import fcntl
import os
import pty
import select
import signal
import struct
import termios
import time

import pyte

LIMIT = 240  # seconds; only so that a broken test ends


class Screen(pyte.Screen):
    """A screen that keeps the cursor on its text when the size changes, as terminals do: with `reflow` long
    lines are wrapped anew (VTE, tmux), else they are cut (xterm)."""

    def __init__(self, columns, lines, reflow):
        self._reflow = reflow
        super().__init__(columns, lines)

    def resize(self, lines=None, columns=None):
        rows, at = [], 0
        for y, row in enumerate(self.display):
            at = len(rows) if y == self.cursor.y else at
            row = row.rstrip()
            starts = range(0, max(len(row), 1), columns) if self._reflow else (0,)
            rows += [row[start:start + columns] for start in starts]
        while len(rows) > at + 1 and not rows[-1]:
            rows.pop()
        top = min(max(len(rows) - lines, 0), at)
        super().resize(lines, columns)
        self.erase_in_display(2)
        for y, row in enumerate(rows[top:top + lines]):
            self.cursor_position(y + 1, 1)
            self.draw(row)
        self.cursor_position(at - top + 1, 1)


class Terminal:
    """A command on a terminal of its own, ended at the end of the scope."""

    def __init__(self, *command, columns=100, lines=30, reflow=False, environment=None):
        self.screen = Screen(columns, lines, reflow)
        self.output = b""
        self._stream = pyte.ByteStream(self.screen)
        command = [str(word) for word in command]
        self.pid, self._terminal = pty.fork()
        if self.pid == 0:
            self._tell_size(0)
            os.environ.update({"TERM": "xterm", **(environment or {})})
            os.execvp(command[0], command)
        self._status = None

    def _tell_size(self, terminal):
        size = struct.pack("HHHH", self.screen.lines, self.screen.columns, 0, 0)
        fcntl.ioctl(terminal, termios.TIOCSWINSZ, size)

    def rows(self):
        """What stands on the screen, without empty rows at its end."""
        rows = [row.rstrip() for row in self.screen.display]
        while rows and not rows[-1]:
            rows.pop()
        return rows

    def text(self):
        return "\n".join(self.rows())

    def wait(self, condition):
        """Until it holds for the rows; returns its value."""
        limit = time.monotonic() + LIMIT
        while not (value := condition(self.rows())):
            if not self._read(limit - time.monotonic()):
                if value := condition(self.rows()):
                    break
                raise AssertionError("never came on the screen, on which stands:\n" + self.text())
        return value

    def wait_for(self, text):
        self.wait(lambda rows: any(text in row for row in rows))

    def end(self):
        """The exit code, once the command has ended."""
        limit = time.monotonic() + LIMIT
        while self._read(limit - time.monotonic()):
            pass
        if time.monotonic() > limit:
            raise AssertionError("did not end; on the screen stands:\n" + self.text())
        return self._code()

    def type(self, keys):
        os.write(self._terminal, keys.encode())

    def resize(self, columns, lines):
        self.screen.resize(lines, columns)
        self._tell_size(self._terminal)

    def echoes(self):
        return bool(termios.tcgetattr(self._terminal)[3] & termios.ECHO)

    def _read(self, seconds):
        """Whether there was something to read in time."""
        if not select.select([self._terminal], [], [], max(seconds, 0))[0]:
            return False
        try:
            data = os.read(self._terminal, 65536)
        except OSError:  # nobody has the other side open any more
            return False
        self.output += data
        self._stream.feed(data)
        return bool(data)

    def _code(self):
        if self._status is None:
            self._status = os.waitpid(self.pid, 0)[1]
        return os.waitstatus_to_exitcode(self._status)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self._status is None:
            os.kill(self.pid, signal.SIGKILL)
            self._code()
        os.close(self._terminal)

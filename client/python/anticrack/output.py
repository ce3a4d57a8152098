# SPDX-License-Identifier: GPL-3.0-or-later
"""The one place where files are written."""
from __future__ import annotations

import contextlib
import errno
import itertools
import os
import re
import stat
import sys
from collections.abc import Iterable

from .errors import Error

_numbers = itertools.count()  # make temporary names unique


def target_of(path: str | os.PathLike[str]) -> tuple[str, bool]:
    """Follows all symbolic links of a path; returns the target and whether it is a device or a pipe, which is written
    as a stream."""
    found = os.fsdecode(path)
    for _ in range(40):  # the kernel follows no more links either
        if _descriptor(found) is not None:  # its link may name another file than the open one
            return found, True
        try:
            found = os.path.join(os.path.dirname(found), os.readlink(found))
        except OSError:  # not a link
            break
    try:
        mode = os.stat(found).st_mode
    except FileNotFoundError:
        return found, False
    except OSError as error:
        raise _unwritable(path, error) from None
    for is_one, what in ((stat.S_ISDIR, "folder"), (stat.S_ISBLK, "disk"), (stat.S_ISSOCK, "socket")):
        if is_one(mode):
            raise Error(f"{os.fsdecode(path)} is a {what}; name a file")
    return found, not stat.S_ISREG(mode)


def write(path: str | os.PathLike[str], content: bytes | memoryview, keep: bool = False) -> None:
    """Writes a file whole or not at all, following symbolic links; an existing file keeps its permissions. A device or
    pipe is written as a stream. keep: renames the existing file to PATH~."""
    target, stream = target_of(path)
    try:
        if stream:
            _write_stream(target, content)
        else:
            _replace(target, content, keep)
    except OSError as error:
        raise _unwritable(path, error) from None


def make_folder(path: str) -> None:
    """Makes the folder unless it exists."""
    if path == "-":
        raise Error("-: is standard output, and several files are to be written; name a folder")
    try:
        os.makedirs(path, exist_ok=True)
    except OSError as error:
        what = NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR)) if os.path.exists(path) else error
        raise Error(f"{path}: cannot be made a folder: {what.strerror}; choose another folder") from None
    if not os.access(path, os.W_OK | os.X_OK):
        raise Error(f"{path}: Permission denied; make the folder writable, or choose another one")


class Made:
    """Files of a result, each written whole or not at all. files: in the order of the loads; notes: what was left out
    and why."""

    def __init__(self, folder: str) -> None:
        self.folder, self.files, self.notes = folder, list[str](), list[str]()

    def add(self, stem: str, files: dict[str, bytes]) -> None:
        for kind, content in files.items():
            self.files.append(os.path.join(self.folder, f"{stem}.{kind}"))
            write(self.files[-1], content)


def stems(names: Iterable[str], suffixes: list[str]) -> list[str]:
    """Makes a file name [A-Za-z0-9][A-Za-z0-9_.-]* for each name. No two of them, with any of the suffixes or none, are
    equal, even if case is ignored."""
    taken: set[str] = set()
    found = []
    for name in names:
        base = re.sub("[^A-Za-z0-9.-]", "_", name)
        base = base if re.match("[A-Za-z0-9]", base) else f"load{base}"
        stem, copy = base, 2
        while taken & (files := {(stem + suffix).lower() for suffix in ("", *suffixes)}):
            stem, copy = f"{base}-{copy}", copy + 1
        taken |= files
        found.append(stem)
    return found


def _descriptor(path: str) -> int | None:
    """The file descriptor of this process that the path names, or None."""
    with contextlib.suppress(OSError):
        if re.fullmatch("[0-9]+", os.path.basename(path)) and os.path.samefile(
                os.path.dirname(path) or ".", "/proc/self/fd"):
            return int(os.path.basename(path))
    return None


def _unwritable(path: str | os.PathLike[str], error: OSError) -> Error:
    folder = os.path.dirname(os.path.abspath(os.fsdecode(path)))
    if isinstance(error, FileNotFoundError) and not os.path.isdir(folder):
        return Error(f"{os.fsdecode(path)}: there is no folder {folder}; make it, or name another")
    return Error(f"{os.fsdecode(path)} cannot be written: {error.strerror}; free space there, or name another file")


def _write_stream(target: str, content: bytes | memoryview) -> None:
    for text in (sys.stdout, sys.stderr):  # earlier prints have to come first
        if text is not None:
            text.flush()
    number = _descriptor(target)
    with open(os.open(target, os.O_WRONLY) if number is None else os.dup(number), "wb", buffering=0) as file:
        rest = memoryview(content)
        while rest:
            rest = rest[file.write(rest):]


def _replace(target: str, content: bytes | memoryview, keep: bool) -> None:
    made = os.path.join(os.path.dirname(target), f".{os.getpid()}-{next(_numbers)}.anticrack-partial")
    descriptor = os.open(made, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o666)
    try:
        with open(descriptor, "wb") as file:
            with contextlib.suppress(FileNotFoundError):
                os.fchmod(descriptor, stat.S_IMODE(os.stat(target).st_mode))
            file.write(content)
            file.flush()
            os.fsync(descriptor)
        if keep:
            _keep(target)
        os.replace(made, target)
    except BaseException:
        with contextlib.suppress(OSError):
            os.remove(made)
        raise


def _keep(target: str) -> None:
    backup = target + "~"
    with contextlib.suppress(FileNotFoundError):
        os.remove(backup)
    try:
        os.link(target, backup)
    except OSError:  # not every file system has hard links
        os.replace(target, backup)

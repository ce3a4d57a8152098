# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays as people have them: all that are taken go through `array_of`, or `plain` where lists are as good. What
numpy would read as something else than it means - masked entries, units, times, records - is refused."""
from __future__ import annotations

import contextlib
import numbers
import os
from collections.abc import Callable, Iterator, Mapping, Set
from typing import Any

import numpy as np
import numpy.typing

Array = numpy.typing.NDArray[Any]  # docstrings say its shape
Fail = Callable[[str], Exception]  # makes the exception of a problem and its cure

_NO_NUMBERS = {"b": "true and false", "c": "complex numbers", "S": "bytes", "U": "text", "M": "times", "m": "times",
               "V": "records of a structured array"}


def is_array(value: Any) -> bool:
    """A list, or what numpy reads as an array of at least one dimension."""
    if isinstance(value, (list, tuple, range)):
        return True
    if isinstance(value, (str, bytes, bytearray, Mapping, np.generic)):
        return False
    return getattr(value, "ndim", 1) != 0 and any(
        hasattr(value, name) for name in ("__array__", "__array_interface__", "__array_struct__", "typecode", "shape"))


def is_number(value: Any) -> bool:
    """A real one of Python or numpy."""
    return isinstance(value, numbers.Real) and not isinstance(value, (bool, np.timedelta64))


def array_of(values: Any, wanted: tuple[str | int, ...], fail: Fail, whole: bool = False,
             in_order: bool = False) -> Array:
    """A copy in memory of its own: float64, or int64 of whole numbers, finite and C-contiguous, whatever type, order
    of bytes or of axes, stride or class `values` has.

    wanted: the shape, a word for a length that is free; none of them is 0. in_order: the order is that of the mesh."""
    array = _read(_checked(values, fail, in_order), fail)
    if array.dtype.kind == "O":
        array = _of_objects(array, values, fail)
    if array.dtype.kind not in ("iu" if whole else "fiu") and array.size:
        what = _NO_NUMBERS.get(array.dtype.kind, "no whole numbers")
        cure = "write .astype(int) where they are whole" if array.dtype.kind == "f" else (
            "write .real of what is meant" if array.dtype.kind == "c" else "give numbers")
        raise fail(f"an array of {array.dtype} holds {what}; {cure}")
    if array.ndim != len(wanted) or not array.size or any(
            isinstance(length, int) and length != found for length, found in zip(wanted, array.shape)):
        shape = f"({', '.join(map(str, wanted))}{',' if len(wanted) == 1 else ''})"
        raise fail(f"an array of shape {array.shape} is not {shape}" + ("" if array.size else ": it is empty"))
    with np.errstate(over="ignore"):
        out = np.array(array, dtype="<i8" if whole else "<f8", order="C", copy=True)
    if not np.isfinite(out).all():
        at = tuple(int(i) for i in np.argwhere(~np.isfinite(out))[0])
        raise fail(f"{array[at]} at {list(at)} is not a finite number; give one for each entry")
    return out


def plain(value: Any, fail: Fail) -> Any:
    """Of an array the same as lists, of a single number or text that one; all else as it is."""
    if isinstance(value, (list, tuple, str, np.generic)) or not (hasattr(value, "__array__") or is_array(value)):
        return value
    array = _read(_checked(value, fail), fail)
    if array.dtype.kind in "MmV":
        raise fail(f"an array of {array.dtype} holds {_NO_NUMBERS[array.dtype.kind]}; give numbers")
    return array.tolist()


def _read(values: Any, fail: Fail) -> Array:
    """Without the class that it has."""
    try:
        return np.asarray(values)
    except Exception as error:  # of lists of several lengths, or whatever an __array__ raises
        uneven = isinstance(error, ValueError) and "inhomogeneous" in str(error)
        told = "its lists are not all of one length" if uneven else str(error) or type(error).__name__
        raise fail(f"{_kind(values)} cannot be read as an array: {told}") from None


def _kind(values: Any) -> str:
    name = type(values).__name__
    return f"{'an' if name[:1].lower() in 'aeiou' else 'a'} {name}"


def _of_objects(array: Array, values: Any, fail: Fail) -> Array:
    """Of numbers of Python, as pandas has them beside entries that are missing; the others are told."""
    if array.ndim == 0:
        raise fail(f"{_kind(values)} is no array of numbers; give a list, or what numpy.asarray makes an array of")
    for at, value in np.ndenumerate(array):
        if not is_number(value):
            raise fail(f"{value!r} at {list(at)} ({type(value).__name__}) is not a number; give one for each entry")
    whole = all(isinstance(value, numbers.Integral) for value in array.flat)
    for kind in (np.int64, np.float64) if whole else (np.float64,):
        with contextlib.suppress(OverflowError):
            return array.astype(kind)
    raise fail("a number is larger than any of float64; give numbers below 1e308")


def _checked(values: Any, fail: Fail, in_order: bool = False) -> Any:
    """Refuses what numpy would take, though it means something else; in lists as well, in which it would not see
    what is no sequence as an array."""
    if isinstance(values, (list, tuple)):
        if all(type(item) in (float, int) for item in values):
            return values
        return [_checked(item, fail) for item in values]
    if isinstance(values, np.ma.MaskedArray):
        count = np.count_nonzero(values.mask) if values.dtype.names is None else 0
        if count:
            raise fail(f"{count} of {values.size} entries are masked; give values for them, as .filled(0)")
    elif isinstance(values, (bytes, bytearray, os.PathLike)):
        raise fail(f"{_kind(values)} is no array; give numbers")
    elif isinstance(values, Iterator):
        raise fail(f"{_kind(values)} gives its values only once; write list(...) around it")
    elif isinstance(values, (Set, Mapping)):
        raise fail(f"{_kind(values)} has no order; give a list or an array")
    elif hasattr(values, "iloc"):
        _refuse_labels(values, fail, in_order)
    else:
        _refuse_units(values, fail)
    return _read(values, fail) if hasattr(values, "__array__") and not hasattr(values, "__len__") else values


def _refuse_units(values: Any, fail: Fail) -> None:
    """Of astropy, pint, unyt: numpy leaves them out."""
    for name in ("units", "unit"):
        given = isinstance(values, np.ndarray) or hasattr(type(values), name)
        unit = str(getattr(values, name, "") or "") if given else ""
        if unit not in ("", "dimensionless"):
            raise fail(f"{_kind(values)} has the unit {unit}; convert it to the units of the case and give the "
                       "numbers alone")


def _refuse_labels(values: Any, fail: Fail, in_order: bool) -> None:
    """Of pandas: labels that say another order than that of the entries."""
    axes = {axis: getattr(values, axis) for axis in ("index", "columns") if hasattr(values, axis)}
    for axis, labels in axes.items():
        if in_order and np.asarray(labels).dtype.kind in "iuf" and not labels.is_monotonic_increasing:
            raise fail(f"the {axis} of {_kind(values)} is not in the order of the mesh; write .sort_index("
                       f"{'axis=1' if axis == 'columns' else ''}), or .to_numpy() if the entries are")
    labels = list(axes.get("columns", axes["index"]))
    if sorted(map(str, labels)) == ["x", "y"] and labels != ["x", "y"]:
        raise fail(f"{_kind(values)} has y before x; write [['x', 'y']] behind it")

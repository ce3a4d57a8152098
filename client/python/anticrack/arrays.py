# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes arrays as people have them. All of them pass through `array_of`, or through `plain` where lists will do.
Values whose meaning numpy would change - masked entries, units, times, records - are refused."""
from __future__ import annotations

import contextlib
import numbers
import os
from collections.abc import Callable, Iterator, Mapping, Set
from typing import Any

import numpy as np
import numpy.typing

Array = numpy.typing.NDArray[Any]  # docstrings state the shape
Fail = Callable[[str], Exception]  # makes the exception for a text with problem and cure

_NO_NUMBERS = {"b": "true and false", "c": "complex numbers", "S": "bytes", "U": "text", "M": "times", "m": "times",
               "V": "records of a structured array"}


def is_array(value: Any) -> bool:
    """Whether the value is a list, or numpy reads it as an array of at least one dimension."""
    if isinstance(value, (list, tuple, range)):
        return True
    if isinstance(value, (str, bytes, bytearray, Mapping, np.generic)):
        return False
    return getattr(value, "ndim", 1) != 0 and any(
        hasattr(value, name) for name in ("__array__", "__array_interface__", "__array_struct__", "typecode", "shape"))


def is_number(value: Any) -> bool:
    """Whether the value is a real number of Python or numpy."""
    return isinstance(value, numbers.Real) and not isinstance(value, (bool, np.timedelta64))


def array_of(values: Any, wanted: tuple[str | int, ...], fail: Fail, whole: bool = False,
             in_order: bool = False) -> Array:
    """Copies `values`, of whatever type, byte order, axis order, stride or class, to a finite C-contiguous array of
    float64, or of int64 if `whole`.

    wanted: the shape, with a word for each length that is free; no length may be 0. in_order: the entries have the
    order of the mesh, so labels that say another order are refused."""
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
    """Turns an array into lists, and an array of no dimension into its number or text; returns all else as it is."""
    if isinstance(value, (list, tuple, str, np.generic)) or not (hasattr(value, "__array__") or is_array(value)):
        return value
    array = _read(_checked(value, fail), fail)
    if array.dtype.kind in "MmV":
        raise fail(f"an array of {array.dtype} holds {_NO_NUMBERS[array.dtype.kind]}; give numbers")
    return array.tolist()


def _read(values: Any, fail: Fail) -> Array:
    """Reads values as a plain numpy array, dropping any subclass."""
    try:
        return np.asarray(values)
    except Exception as error:  # lists differ in length, or __array__ raises anything
        uneven = isinstance(error, ValueError) and "inhomogeneous" in str(error)
        told = "its lists are not all of one length" if uneven else str(error) or type(error).__name__
        raise fail(f"{_kind(values)} cannot be read as an array: {told}") from None


def _kind(values: Any) -> str:
    name = type(values).__name__
    return f"{'an' if name[:1].lower() in 'aeiou' else 'a'} {name}"


def _of_objects(array: Array, values: Any, fail: Fail) -> Array:
    """Reads an array of Python objects as numbers, as pandas has them beside missing entries; raises for others."""
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
    """Refuses values that numpy would take though they mean something else. Looks into lists too, in which numpy would
    not read an object that is no sequence as an array."""
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
    """Refuses units of astropy, pint and unyt, which numpy would drop."""
    for name in ("units", "unit"):
        given = isinstance(values, np.ndarray) or hasattr(type(values), name)
        unit = str(getattr(values, name, "") or "") if given else ""
        if unit not in ("", "dimensionless"):
            raise fail(f"{_kind(values)} has the unit {unit}; convert it to the units of the case and give the "
                       "numbers alone")


def _refuse_labels(values: Any, fail: Fail, in_order: bool) -> None:
    """Refuses labels of pandas that say another order than that of the entries."""
    axes = {axis: getattr(values, axis) for axis in ("index", "columns") if hasattr(values, axis)}
    for axis, labels in axes.items():
        if in_order and np.asarray(labels).dtype.kind in "iuf" and not labels.is_monotonic_increasing:
            raise fail(f"the {axis} of {_kind(values)} is not in the order of the mesh; write .sort_index("
                       f"{'axis=1' if axis == 'columns' else ''}), or .to_numpy() if the entries are")
    labels = list(axes.get("columns", axes["index"]))
    if sorted(map(str, labels)) == ["x", "y"] and labels != ["x", "y"]:
        raise fail(f"{_kind(values)} has y before x; write [['x', 'y']] behind it")

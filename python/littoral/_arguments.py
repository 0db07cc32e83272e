"""Single arguments, checked: numbers, names, paths, callbacks."""

from __future__ import annotations

import inspect
import operator
import os
from typing import Any

import numpy as np

from ._arrays import as_array
from ._errors import ArgumentError, InputError, IoError, coded


def number(value: Any, name: str) -> float:
    """One real number, finite or not; ArgumentError for anything else."""
    if type(value) is float or type(value) is int:
        return _as_float(value, name)
    array = as_array(value, name)
    if array.ndim == 0 and array.dtype.kind == "O" and hasattr(value, "__float__"):
        return _as_float(value, name)  # a fraction, a decimal number
    if array.ndim != 0 or array.dtype.kind not in "fiub":
        raise ArgumentError(f"{name}: expected one number, got {value!r}")
    return _as_float(array.item(), name)


def _as_float(value: Any, name: str) -> float:
    try:
        return float(value)
    except OverflowError:
        raise InputError(f"{name}: the number has {len(str(value))} digits, too many") from None


def number_or_none(value: Any, name: str) -> float | None:
    """The same where nothing may be given."""
    return None if value is None else number(value, name)


def whole(value: Any, name: str, what: str, least: int = -(2**31), most: int = 2**31 - 1) -> int:
    """A whole number, also as a float, that the library has room for; InputError for others."""
    array = as_array(value, name)
    known = array.ndim == 0 and array.dtype.kind in "biuf"
    if not known or not least <= value <= most or int(value) != value:
        got = value if known else repr(value)
        raise InputError(f"{name}: expected a whole number{what}, got {got}")
    return int(value)


def integer(value: Any, name: str) -> int:
    """An integer that numbers something, however large; ArgumentError for anything else."""
    try:
        if not isinstance(value, (bool, np.bool_)):
            return operator.index(value)
    except TypeError:
        pass
    raise ArgumentError(f"{name}: expected an integer, got {value!r}")


def truth(value: Any, name: str) -> bool:
    """True or False, of Python or numpy, or a number; ArgumentError for words and arrays."""
    if isinstance(value, (bool, np.bool_, int, np.integer)):
        return bool(value)
    raise ArgumentError(f"{name}: expected True or False, got {value!r}")


def name_of_method(value: Any) -> str:
    """A method as the library reads it, empty for its own choice."""
    if value is None:
        return ""
    return text(value, "method")


def text(value: Any, name: str) -> str:
    """A text; ArgumentError for anything else."""
    if not isinstance(value, str):
        raise ArgumentError(f"{name}: expected a text, got {value!r}")
    return value


def path_of(value: Any, name: str = "path") -> str:
    """A path as text; ArgumentError for what names no file."""
    try:
        return os.fsdecode(value)
    except TypeError:
        raise ArgumentError(f"{name}: expected the name of a file, got {value!r}") from None


def path_to_write(value: Any) -> str:
    """A path as text; IoError, before anything is made, where there is no folder to write to."""
    to = path_of(value)
    folder = os.path.dirname(to.rstrip(os.sep))
    if folder and not os.path.isdir(folder):
        raise coded(IoError(f"cannot write {to}: there is no folder {folder}"), "cannot-write")
    return to


def listener(callback: Any) -> Any:
    """What is told of progress, if it can be; ArgumentError if not, before the work begins."""
    if callback is None:
        return None
    expected = "progress: expected a function of the share of the work and what is being done"
    if not callable(callback):
        raise ArgumentError(f"{expected}, got {callback!r}")
    try:
        signature = inspect.signature(callback)
    except (TypeError, ValueError):  # of what is not written in Python
        return callback
    try:
        signature.bind(0.0, "")
    except TypeError:
        raise ArgumentError(f"{expected}, got one of {signature}") from None
    return callback

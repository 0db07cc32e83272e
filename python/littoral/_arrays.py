"""Arrays of any kind as the contiguous float64 and int32 arrays that the library takes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ._errors import ArgumentError, IndexOutOfRange, InputError

Floats: TypeAlias = npt.NDArray[np.float64]
Ints: TypeAlias = npt.NDArray[np.int32]
Array: TypeAlias = npt.NDArray[Any]


def as_array(value: Any, name: str) -> Array:
    """Anything with `__array__` or `__dlpack__`, or nested sequences, as a plain numpy array.

    What a masked array hides must not be taken for numbers: InputError.
    """
    if type(value) is np.ndarray:
        return value
    if isinstance(value, np.ndarray):
        hidden = np.broadcast_to(getattr(value, "mask", False), value.shape)
        if hidden.dtype == bool and hidden.any():
            first = np.argwhere(hidden)[0]
            at = ", ".join(str(i) for i in first)
            raise InputError(f"{name}[{at}] is masked: expected numbers, fill or leave them out")
        return np.asarray(value)
    if hasattr(value, "detach") and hasattr(value, "numpy"):  # a torch tensor, perhaps with a graph
        return as_array(value.detach().cpu().numpy(), name)
    if not hasattr(value, "__array__") and hasattr(value, "__dlpack__"):
        return np.from_dlpack(value)
    try:
        return np.asarray(value)
    except ValueError as error:
        raise InputError(f"{name}: expected an array, got rows of different lengths") from error


def contiguous(array: Array, dtype: npt.DTypeLike) -> Array:
    """In C order and aligned, as the module reads it; itself where it is both."""
    out = np.ascontiguousarray(array, dtype=dtype)
    return out if out.flags.aligned else out.copy()


def _described(array: Array) -> str:
    if array.ndim == 0 and array.dtype.kind not in "fiubc":
        return repr(array.item())
    return f"{array.dtype} of shape {array.shape}"


def _shaped(array: Array, name: str, columns: int | None, kinds: str, what: str) -> Array:
    """The array if its numbers are of these kinds and its shape is n, or n x columns."""
    shape = "n" if columns is None else f"n x {columns}"
    if array.dtype.kind not in kinds:
        if array.size:
            raise ArgumentError(f"{name}: expected {what} ({shape}), got {_described(array)}")
        array = array.astype(np.int32)  # of nothing
    if columns is not None and array.size == 0 and array.ndim < 2:
        array = array.reshape(0, columns)
    if array.ndim != (1 if columns is None else 2) or (
        columns is not None and array.shape[1] != columns
    ):
        raise InputError(f"{name}: expected shape {shape}, got {_described(array)}")
    return array


def floats(value: Any, name: str, columns: int | None = None, finite: bool = True) -> Floats:
    """Float64 in C order: n x columns, or n without columns.

    Raises ArgumentError for anything but real numbers, InputError for a wrong shape, and for the
    first number that is not finite unless `finite` is off.
    """
    array = as_array(value, name)
    if (  # what needs nothing done to it, quickly
        not finite
        and array.dtype == np.float64
        and array.flags.c_contiguous
        and array.flags.aligned
        and array.ndim == (1 if columns is None else 2)
        and (columns is None or array.shape[1] == columns)
    ):
        return array
    array = _shaped(array, name, columns, "fiub", "real numbers")
    out = contiguous(array, np.float64)
    if finite and not np.isfinite(out).all():
        first = np.argwhere(~np.isfinite(out))[0]
        at = ", ".join(str(i) for i in first)
        raise InputError(f"{name}[{at}] is {out[tuple(first)]}: expected finite numbers")
    return out


def ints(value: Any, name: str, columns: int | None = None) -> Ints:
    """Int32 in C order: n x columns, or of shape n without columns.

    Raises ArgumentError for anything but integers, InputError for a wrong shape and IndexOutOfRange
    for numbers beyond 32 bits.
    """
    array = _shaped(as_array(value, name), name, columns, "iu", "integers")
    return narrowed(array, name)


def narrowed(array: Array, name: str) -> Ints:
    """Integers of any kind as int32; raises IndexOutOfRange for those beyond."""
    if array.dtype.itemsize >= 4 and array.dtype != np.int32 and array.size:
        limits = np.iinfo(np.int32)
        low, high = array.min(), array.max()
        if low < limits.min or high > limits.max:
            worst = low if low < limits.min else high
            raise IndexOutOfRange(f"{name}: {worst} does not fit into 32 bits")
    return contiguous(array, np.int32)


def check_range(indices: Array, count: int, name: str, of: str) -> None:
    """Raises IndexOutOfRange naming the first index that is not one of `count` elements."""
    if indices.size == 0 or (indices.min() >= 0 and indices.max() < count):
        return
    bad = np.argwhere((indices < 0) | (indices >= count))[0]
    at = ", ".join(str(i) for i in bad)
    raise IndexOutOfRange(
        f"{name}[{at}] is {indices[tuple(bad)]}: there are {count} {of}"
        + (f", 0 to {count - 1}" if count else "")
    )


def result_type(*inputs: Any) -> npt.DTypeLike:
    """float32 if the first input that has a floating type is of that, otherwise float64."""
    for value in inputs:
        if type(value) is np.ndarray:
            if value.dtype.kind == "f":
                return np.float32 if value.dtype == np.float32 else np.float64
            continue
        kind = str(getattr(value, "dtype", "")).lower()
        if kind.endswith("float32"):  # of torch, jax and open3d
            return np.float32
        if "float" in kind:
            return np.float64
    return np.float64


def like(values: Array, dtype: npt.DTypeLike) -> Array:
    """The values in another floating type, themselves where they are of it."""
    return values.astype(dtype, copy=False)


def unwrapped(value: Any, name: str) -> Any:
    """Arrays of other libraries as those of numpy; everything else as it is."""
    if hasattr(value, "__array__") or hasattr(value, "__dlpack__"):
        return as_array(value, name)
    return value


def is_vertex_list(value: Any) -> bool:
    """One or many plain integers: vertices by number."""
    if isinstance(value, np.ndarray):
        return value.dtype.kind in "iu" and value.ndim <= 1
    if isinstance(value, Sequence) and not isinstance(value, str):
        return all(_is_integer(v) for v in value)
    return _is_integer(value)


def _is_integer(value: Any) -> bool:
    return isinstance(value, (int, np.integer)) and not isinstance(value, (bool, np.bool_))

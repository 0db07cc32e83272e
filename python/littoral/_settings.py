"""How calls run: threads, memory, and whom they tell of their progress."""

from __future__ import annotations

import contextlib
import contextvars
import sys
from collections.abc import Callable, Iterator
from typing import TypeAlias

import numpy as np

from . import _core
from ._arguments import listener
from ._errors import InputError

Progress: TypeAlias = Callable[[float, str], object]

_progress: contextvars.ContextVar[Progress | None] = contextvars.ContextVar(
    "littoral_progress", default=None
)
_defaults = {"threads": 0, "memory_limit": 0.0}


def told(callback: Progress | None = None) -> Progress | None:
    """Whom a call tells of its progress."""
    return listener(callback) or _progress.get()


def part(callback: Progress | None, begin: float, end: float) -> Progress | None:
    """Whom a call tells that is a part of another one's work, from one share of it to another."""
    whole = told(callback)
    if whole is None:
        return None
    return lambda share, stage: whole(begin + (end - begin) * share, stage)


def settings(threads: int | None = None, callback: Progress | None = None) -> _core.Settings | None:
    """What a call is run with; None where everything is as by default."""
    hearing = told(callback)
    if (
        threads is None
        and hearing is None
        and not (_defaults["threads"] or _defaults["memory_limit"])
    ):
        return None
    used = _defaults["threads"] if threads is None else threads
    if isinstance(used, bool) or not isinstance(used, (int, np.integer)) or not 0 <= used < 2**31:
        raise InputError(f"threads: expected a number of threads or 0 for all cores, got {used!r}")
    return _core.Settings(int(used), hearing, float(_defaults["memory_limit"]))


def set_threads(threads: int) -> None:
    """Threads of every call that does not say otherwise; 0: all cores. InputError for less.

    Results do not depend on it.

    >>> import littoral
    >>> littoral.set_threads(2)
    >>> littoral.set_threads(0)
    """
    settings(threads)  # complains
    _defaults["threads"] = threads


def set_memory_limit(limit: float) -> None:
    """Work foreseen to need more [bytes] raises IoError before it is begun; 0: what there is.

    Raises InputError for a negative limit.

    >>> import littoral
    >>> littoral.set_memory_limit(4e9)
    >>> littoral.set_memory_limit(0)
    """
    is_number = isinstance(limit, (int, float, np.integer, np.floating))
    if not is_number or isinstance(limit, bool) or not limit >= 0:
        raise InputError(f"limit: expected bytes or 0, got {limit!r}")
    _defaults["memory_limit"] = float(limit)


class Bar:
    """A line that shows how far a call is, in a terminal or a notebook."""

    def __init__(self) -> None:
        self._shown = ""

    def __call__(self, fraction: float, stage: str) -> None:
        filled = int(30 * fraction)
        line = f"\r{100 * fraction:3.0f}% |{'#' * filled}{' ' * (30 - filled)}| {stage}"
        sys.stderr.write(line.ljust(len(self._shown)))
        sys.stderr.flush()
        self._shown = line

    def close(self) -> None:
        """Ends the line."""
        if self._shown:
            sys.stderr.write("\n")
            sys.stderr.flush()


def progress(callback: Progress | None = None) -> contextlib.AbstractContextManager[None]:
    """Within this context, long calls tell how far they are.

    Without a callback a bar is drawn on the standard error. A callback gets two arguments, the
    share of the work that is done, 0 to 1, and what is being done, a text; what it raises stops the
    call and is raised by it. ArgumentError for what cannot be called with two.

    >>> import littoral
    >>> seen = []
    >>> with littoral.progress(lambda share, stage: seen.append(share)):
    ...     field = littoral.distance(littoral.examples.square(4), points=0)
    >>> seen[-1]
    1.0
    """
    return _progress_told(listener(callback))


@contextlib.contextmanager
def _progress_told(callback: Progress | None) -> Iterator[None]:
    bar = Bar() if callback is None else None
    token = _progress.set(callback or bar)
    try:
        yield
    finally:
        _progress.reset(token)
        if bar is not None:
            bar.close()

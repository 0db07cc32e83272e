"""The errors that littoral raises; each is one of Python's own kinds as well."""

from __future__ import annotations

from typing import TypeVar


class Error(Exception):
    """Root of all errors raised by littoral; the page of messages explains each `code`."""

    code: str = "internal"


class InputError(Error, ValueError):
    """Bad input: the message names the file, line or element."""

    code: str = "bad-input"


class ArgumentError(InputError, TypeError):
    """An argument of another kind than is taken: the message names it and says what is expected."""


class IndexOutOfRange(InputError, IndexError):
    """An index that names nothing: the message gives the first such and what there is."""

    code: str = "no-such-element"


class UnsupportedError(Error, NotImplementedError):
    """A combination that is not supported: the message says what would work."""

    code: str = "unsupported"


class SolveError(Error, ArithmeticError):
    """A solve broke down; `residual` is what was reached, -1 where that is not known."""

    code: str = "solve-failed"
    residual: float = -1.0


class IoError(Error, OSError):
    """A file could not be read or written, or a size will not fit into memory."""

    code: str = "io-error"


class Cancelled(Error):
    """The call was stopped."""

    code: str = "cancelled"


for _kind in (Error, InputError, ArgumentError, IndexOutOfRange, UnsupportedError, SolveError):
    _kind.__module__ = "littoral"  # as tracebacks name them
IoError.__module__ = Cancelled.__module__ = "littoral"

E = TypeVar("E", bound=Error)


def coded(error: E, code: str) -> E:
    """The error with a code of the page of messages."""
    error.code = code
    return error

"""What `littoral.batch` is given, checked before any work."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable, Mapping
from typing import Any

from ._arguments import number, path_of, truth, whole
from ._errors import ArgumentError, InputError


def items_of(items: Any) -> Any:
    """A folder or pattern, a dict, or a list of anything else that holds several items."""
    if isinstance(items, Mapping):
        return items
    if isinstance(items, (str, os.PathLike)):
        return path_of(items, "items")
    if not isinstance(items, Iterable):
        raise ArgumentError(f"items: expected a folder, paths or values, got {items!r}")
    return list(items)


def options_of(options: Any) -> dict[str, Any]:
    """Options by name."""
    if options is not None and not isinstance(options, Mapping):
        raise ArgumentError(f"options: expected a dict of names and values, got {options!r}")
    return dict(options or {})


def words_of(options: Mapping[str, Any]) -> list[str]:
    """Options as words that tell whether work was done with the same ones before."""
    words = []
    for name, value in options.items():
        try:
            words.append(f"--{name}={json.dumps(value)}")
        except (TypeError, ValueError) as error:
            raise ArgumentError(
                f"options: expected what JSON can hold, got {name}={value!r}: {error}"
            ) from None
    return words


def extensions_of(to: Any) -> list[str]:
    """One extension, several or none."""
    found = [to] if isinstance(to, str) else list(to) if isinstance(to, Iterable) else [to]
    if not all(isinstance(each, str) for each in found):
        raise ArgumentError(f"to: expected an extension or several, got {to!r}")
    return [each for each in found if each]


def how_of(
    processes: Any,
    time_limit: Any,
    memory_limit: Any,
    retries: Any,
    shard: Any,
    resume: Any,
    fail_fast: Any,
) -> dict[str, Any]:
    """How a batch is run, as the library takes it; InputError for what is out of range."""
    if isinstance(shard, str) or not isinstance(shard, Iterable) or len(pair := list(shard)) != 2:
        raise ArgumentError(f"shard: expected two numbers, as (3, 8), got {shard!r}")
    return {
        "shard": whole(pair[0], "shard", " from 0 on", 0),
        "shards": whole(pair[1], "shard", " from 0 on", 0),
        "resume": truth(resume, "resume"),
        "retries": whole(retries, "retries", " from 0 on", 0),
        "fail_fast": truth(fail_fast, "fail_fast"),
        "processes": whole(processes, "processes", " from 0 on", 0),
        "time_limit": _limit(time_limit, "time_limit"),
        "memory_limit": _limit(memory_limit, "memory_limit"),
    }


def _limit(value: Any, name: str) -> float:
    limit = number(value, name)
    if not 0 <= limit < math.inf:
        raise InputError(f"{name}: expected a positive number, or 0 for none, got {limit}")
    return limit

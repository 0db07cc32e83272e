"""A verb of the program for many files: the program's own batch."""

from __future__ import annotations

import ctypes
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ._errors import InputError, IoError, SolveError, UnsupportedError
from ._settings import Progress

_kinds = {"input": InputError, "usage": InputError, "unsupported": UnsupportedError,
          "solve": SolveError, "io": IoError}  # fmt: skip


def _words(options: Mapping[str, Any]) -> list[str]:
    """Options as on the command line: True and False are on and off, a list is one given several
    times, None is none."""
    words = []
    for key, value in options.items():
        for each in value if isinstance(value, (list, tuple)) else [value]:
            if each is None:
                continue
            text = ("" if each else "=off") if isinstance(each, bool) else f"={each}"
            words.append(f"--{key.replace('_', '-')}{text}")
    return words


def _end_with_parent() -> None:
    """In the child: a worker that is ended by force leaves nothing that holds its status file."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG


def batch_of_verb(
    items: str | Iterable[tuple[str, str | None]],
    verb: str,
    out: str,
    to: Iterable[str],
    options: Mapping[str, Any],
    words: Iterable[str],
    progress: Progress | None = None,
) -> dict[str, Any]:
    """The summary of `littoral batch`; items: what it calls JOBS, or paths with names or None."""
    name = os.environ.get("LITTORAL", "littoral")
    program = shutil.which(name)
    if program is None:
        raise UnsupportedError(f"work: the verb {verb!r} needs the program {name} on the path")
    with tempfile.TemporaryDirectory() as folder:
        jobs = items if isinstance(items, str) else os.path.join(folder, "items.jsonl")
        if not isinstance(items, str):
            lines = [{"input": path} | ({"name": n} if n else {}) for path, n in items]
            Path(jobs).write_text("".join(json.dumps(line) + "\n" for line in lines))
        command = [
            program, "batch", f"--verb={verb}", f"--output={out}", *(f"--to={each}" for each in to),
            *words, *_words(options), "--json",
            "--progress=always" if progress else "--quiet", "--", jobs,
        ]  # fmt: skip
        said = Path(folder, "summary.json")
        with said.open("wb") as stdout:
            status, errors = _watched(command, stdout, progress)
        text = said.read_text()
    summary: dict[str, Any] = json.loads(text) if text else {}
    if status not in (0, 1) or "jobs" not in summary:
        error = summary.get("error", {})
        message = error.get("message") or f"{program} ended with status {status}: {errors[-300:]}"
        raise _kinds.get(error.get("kind", ""), IoError)(message)
    return summary


def _watched(command: list[str], stdout: Any, progress: Progress | None) -> tuple[int, str]:
    """Exit status and messages of a program that ends when this call does."""
    errors = b""
    with subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=stdout, stderr=subprocess.PIPE,
        preexec_fn=_end_with_parent,
    ) as process:  # fmt: skip
        assert process.stderr is not None
        try:
            while got := os.read(process.stderr.fileno(), 65536):
                errors = (errors + got)[-65536:]
                bars = re.findall(rb"\] +(\d+) % (\S[^\r\n\x1b]*)", got) if progress else []
                if bars and progress:
                    progress(int(bars[-1][0]) / 100, bars[-1][1].decode().strip())
        except BaseException:
            process.terminate()
            raise
    return process.returncode, errors.decode(errors="replace")

"""Many inputs, each in a process of its own."""

from __future__ import annotations

import dataclasses
import errno
import glob
import hashlib
import json
import math
import os
import re
import shutil
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from . import _core
from ._arguments import path_of
from ._batch_arguments import extensions_of, how_of, items_of, options_of, words_of
from ._batch_status import status_folder
from ._batch_verb import batch_of_verb
from ._errors import ArgumentError, Error, InputError, IoError, SolveError, UnsupportedError
from ._settings import Progress, settings, told

Work = Callable[..., Any]


@dataclasses.dataclass(frozen=True)
class BatchFailures:
    """Failures that say the same but for names and numbers."""

    status: str  #: the kind: "input", "memory", "time", "crash", ...
    message: str  #: of the first
    example: str  #: its input
    count: int


@dataclasses.dataclass(frozen=True)
class BatchSummary:
    """What became of a batch."""

    jobs: int  #: of this shard
    done: int
    unchanged: int  #: were done before
    failed: int
    seconds: float  #: by the clock
    start_seconds: float  #: from asking for a process to its work, on average
    peak_memory: float  #: of the largest process [bytes]
    failures: tuple[BatchFailures, ...]  #: the most frequent first


@dataclasses.dataclass(frozen=True)
class _Item:
    value: Any
    label: str  # its "input" in status.jsonl
    name: str  # of its results

    @property
    def is_file(self) -> bool:
        return isinstance(self.value, (str, os.PathLike))


def _is_url(path: str) -> bool:
    return "://" in path


def _without_extension(path: str) -> str:
    parts = [p for p in path.split("://")[-1].split("/") if p not in ("", ".", "..")]
    if not parts:
        raise InputError(f"items: {path!r} names no file")
    head, _, _ = parts[-1].rpartition(".")
    return "/".join([*parts[:-1], head or parts[-1]])


def _item(value: Any, name: str | None) -> _Item:
    if isinstance(value, (str, os.PathLike)):
        label = os.fspath(value)
        return _Item(value, label, name or _without_extension(label))
    try:
        label = json.dumps(value, sort_keys=True)
    except TypeError as error:
        raise ArgumentError(f"items: expected paths or what JSON can hold: {error}") from None
    return _Item(value, label, name or hashlib.sha256(label.encode()).hexdigest()[:16])


def _listed(items: Any, out: str) -> list[_Item]:
    """Items with names below the folder of results; those that two would have keep extensions."""
    if isinstance(items, Mapping):
        return [_item(value, name) for name, value in items.items()]
    if isinstance(items, (str, os.PathLike)):
        files = _files(os.fspath(items), out)
        found = [_item(path, _without_extension(below)) for path, below in files]
    else:
        found = [_item(value, None) for value in items]
    # a.obj and a.ply keep theirs, and then a.obj.gz as well.
    while doubled := {name for name, n in Counter(x.name for x in found).items() if n > 1}:
        longer = [_with_extension(x) if x.is_file and x.name in doubled else x for x in found]
        if longer == found:
            break
        found = longer
    return found


def _with_extension(item: _Item) -> _Item:
    suffix = Path(item.label).suffix
    is_whole = item.name.endswith(suffix) and item.name.endswith(Path(item.label).name)
    return item if is_whole else dataclasses.replace(item, name=item.name + suffix)


def _files(where: str, out: str) -> list[tuple[str, str]]:
    """The files of a folder or pattern, local or by a URL, sorted; each with its path below that.

    Hidden ones, and those of the folder of results, are left out.
    """
    if _is_url(where):
        import fsspec

        fs, path = fsspec.core.url_to_fs(where)
        found = fs.find(path) if fs.isdir(path) else fs.glob(path)
        root, paths = fs.unstrip_protocol(path), sorted(fs.unstrip_protocol(p) for p in found)
    elif os.path.isdir(where):
        root, paths = where, sorted(_below(where, out, ()))
    else:
        found = [where] if os.path.isfile(where) else glob.glob(where, recursive=True)
        root, paths = where, sorted(p for p in found if os.path.isfile(p))
    if not paths:
        raise InputError(f"there are no files in {where}")
    if root in paths:
        return [(path, os.path.basename(path)) for path in paths]
    if any(c in root for c in "*?["):
        root = re.split(r"[*?\[]", root)[0].rpartition("/")[0]
    return [(path, path[len(root) :] if path.startswith(root) else path) for path in paths]


def _below(folder: str, out: str, above: tuple[str, ...]) -> Iterator[str]:
    """The files below a folder; a link to a folder that it lies in is not followed."""
    real = os.path.realpath(folder)
    if real in above or real == os.path.realpath(out):
        return
    for entry in os.scandir(folder):
        if entry.name.startswith("."):
            continue
        if entry.is_dir():
            yield from _below(entry.path, out, (*above, real))
        elif entry.is_file():
            yield entry.path


def _one_by_program(verb: str, to: list[str]) -> Work:
    """A verb as work, for files that are fetched first: the program's batch of one."""

    def run(path: str, output: str, **options: Any) -> Any:
        folder, name = os.path.split(output)
        with tempfile.TemporaryDirectory() as made:
            batch_of_verb([(path, name)], verb, made, to, options, [])
            [line] = map(json.loads, Path(made, "status.jsonl").read_text().splitlines())
            if line["status"] != "done":
                raise _Failure(line["status"], line["message"])
            for result in line["outputs"]:
                shutil.move(os.path.join(made, result), os.path.join(folder, result))
        return line["report"]

    run.__module__, run.__qualname__ = "littoral", verb
    return run


def _is_remote(items: Any) -> bool:
    if isinstance(items, (str, os.PathLike)):
        return _is_url(os.fspath(items))
    values = items.values() if isinstance(items, Mapping) else items
    return any(isinstance(value, str) and _is_url(value) for value in values)


def _jobs(items: Any) -> str | list[tuple[str, str | None]]:
    """Items as the program's batch takes them."""
    if isinstance(items, (str, os.PathLike)):
        return os.fspath(items)
    named = items.items() if isinstance(items, Mapping) else ((None, value) for value in items)
    return [(path_of(value, "items"), name) for name, value in named]


_STATUS = {UnsupportedError: "unsupported", InputError: "input", SolveError: "solve"}


class _Failure(Exception):
    """A failure with its kind."""


def _outcome(call: Callable[[], Any]) -> tuple[str, str, str]:
    """Status, message and report of a call."""
    try:
        return "done", "", json.dumps(_finite(call()), default=str)
    except BaseException as error:
        status, message = _failure(error)
        # Names of files may hold bytes that are no text.
        return status, message.encode("utf-8", "backslashreplace").decode(), ""


def _finite(value: Any) -> Any:
    """The same with words for the numbers that JSON does not have, as the program writes them."""
    if isinstance(value, dict):
        return {key: _finite(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(each) for each in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value


def _failure(error: BaseException) -> tuple[str, str]:
    """Status and message."""
    if isinstance(error, _Failure):
        return str(error.args[0]), str(error.args[1])
    if isinstance(error, MemoryError):
        return "memory", str(error) or "not enough memory"
    if isinstance(error, OSError):
        is_memory = error.errno == errno.ENOMEM or getattr(error, "code", "") == "too-large"
        return "memory" if is_memory else "io", str(error)
    for kind, status in _STATUS.items():
        if isinstance(error, kind):
            return status, str(error)
    status = "failed" if isinstance(error, Error) else "internal"
    return status, f"{type(error).__name__}: {error}"


def _sha256(path: str) -> str:
    digest = hashlib.sha256()
    try:
        if not os.path.isfile(path):
            raise InputError(f"cannot read {path}: there is no such file")
        with open(path, "rb") as file:
            while block := file.read(1 << 20):
                digest.update(block)
    except OSError as error:
        raise IoError(f"cannot read {path}: {error.strerror}") from None
    return digest.hexdigest()


class _Job:
    """What happens in a process of its own: hash first, then the work."""

    def __init__(
        self, items: list[_Item], work: Work, to: str, options: dict[str, Any], out: str
    ) -> None:
        self.items = {item.name: item for item in items}
        self.by_label = {item.label: item for item in items}
        self.work, self.to, self.options = work, to, options
        self.out = out  # a URL, or empty where results stay in the folder

    def fetched(self, item: _Item, folder: str) -> str:
        """A local file with the input's content."""
        if not _is_url(item.label):
            return item.label
        import fsspec

        local = folder + ".input" + Path(item.label).suffix
        if not os.path.exists(local):
            fs, path = fsspec.core.url_to_fs(item.label)
            if not fs.exists(path):
                raise InputError(f"cannot read {item.label}: there is no such file")
            fs.get_file(path, local)
        return local

    def hash(self, label: str, folder: str) -> str:
        item = self.by_label[label]
        if item.is_file:
            return _sha256(self.fetched(item, folder))
        return hashlib.sha256(label.encode()).hexdigest()

    def run(self, label: str, name: str, folder: str) -> tuple[str, str, str]:
        item = self.items[name]

        def call() -> Any:
            given = self.fetched(item, folder) if item.is_file else item.value
            output = os.path.join(folder, os.path.basename(name) + self.to)
            report = self.work(given, output, **self.options)
            if self.out:
                self.upload(name, folder)
            return report

        outcome = _outcome(call)
        for stream in (sys.stdout, sys.stderr):
            if stream is not None:
                stream.flush()
        if _is_url(item.label):
            Path(folder + ".input" + Path(item.label).suffix).unlink(missing_ok=True)
        return outcome

    def upload(self, name: str, folder: str) -> None:
        """Results under another name first, then into place."""
        import fsspec

        fs, root = fsspec.core.url_to_fs(self.out)
        place = "/".join([root.rstrip("/"), *name.split("/")[:-1]])
        fs.makedirs(place, exist_ok=True)
        for path in sorted(Path(folder).rglob("*")):
            if not path.is_file():
                continue
            target = f"{place}/{path.relative_to(folder).as_posix()}"
            fs.makedirs(target.rpartition("/")[0], exist_ok=True)
            fs.put_file(str(path), target + ".part")
            fs.mv(target + ".part", target)
        for path in Path(folder).iterdir():
            shutil.rmtree(path) if path.is_dir() else path.unlink()


def batch(
    items: str | os.PathLike[str] | Iterable[Any] | Mapping[str, Any],
    work: Work | str,
    out: str | os.PathLike[str],
    *,
    to: str | Iterable[str] = "",
    options: Mapping[str, Any] | None = None,
    processes: int = 0,
    time_limit: float = 0.0,
    memory_limit: float = 0.0,
    retries: int = 0,
    shard: tuple[int, int] = (1, 1),
    resume: bool = True,
    fail_fast: bool = False,
    state: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
) -> BatchSummary:
    """Calls a function for each of many items, each in a process of its own.

    items: a folder, a pattern, paths, values that JSON can hold, or a dict from names to any of
    these. work: `work(item, output, **options)`, where `output` is the path to write to, the item's
    name and `to` in a folder of its own; what it returns is the report. Or a verb of the program,
    which then does the same as `littoral batch`: items may be a list .txt, .csv or .jsonl, and `to`
    several extensions or none, for the verb's usual one. An exception, a crash, more seconds than
    time_limit, more bytes than memory_limit are a line in `out`/status.jsonl. Results are moved
    into `out` when they are whole; with the same options and content an item is done once, by all
    runs together. shard: (3, 8) is the third of eight parts. Paths and out may be URLs of fsspec;
    where out is one, the status is put there when the batch ends, and until then is in the local
    folder `state` or a temporary one. Raises InputError for no items and for two of one name,
    IoError where `out` cannot be written to.

    >>> import json, tempfile, littoral
    >>> def area(path, output):
    ...     littoral.SDF(littoral.read(path)).sample(8).save(output)
    ...     return {"vertices": littoral.read(path).n_vertices}
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     littoral.examples.cube().save(f"{folder}/cube.obj")
    ...     done = littoral.batch([f"{folder}/cube.obj"], area, f"{folder}/out", to=".npz")
    >>> done.done, done.failed
    (1, 0)
    """
    given, items, extensions = options_of(options), items_of(items), extensions_of(to)
    place = path_of(out, "out")
    remote = place if _is_url(place) else ""
    if state is not None and not remote:
        raise InputError(
            f"state: a folder for status.jsonl goes with an out that is a URL, not with {place}"
        )
    how = how_of(processes, time_limit, memory_limit, retries, shard, resume, fail_fast)
    part = how["shard"], how["shards"]
    if isinstance(work, str):
        if not remote and not _is_remote(items):
            words = [
                f"--shard={part[0]}/{part[1]}", "--resume" if resume else "--no-resume",
                f"--retry={how['retries']}", f"--jobs={how['processes']}",
                f"--time-limit={how['time_limit']}", f"--memory-limit={int(how['memory_limit'])}",
                *(["--fail-fast"] if fail_fast else []),
            ]  # fmt: skip
            made = batch_of_verb(
                _jobs(items), work, place, extensions, given, words, told(progress)
            )
            made["failures"] = tuple(BatchFailures(**each) for each in made["failures"])
            return BatchSummary(**made)
        work, to = _one_by_program(work, extensions), ""
        marks = [f"--to={each}" for each in extensions]
    else:
        if not callable(work):
            raise ArgumentError(f"work: expected a function or the name of a verb, got {work!r}")
        if not isinstance(to, str):
            raise ArgumentError("to: a function writes one path; expected one extension")
        marks = [f"--to={to}"]
    listed = _listed(items, place)
    job = _Job(listed, work, to, given, remote)
    identity = f"{getattr(work, '__module__', '')}.{getattr(work, '__qualname__', repr(work))}"
    words = [identity, *marks, *words_of(given)]
    if remote:
        words.append(f"--out={remote}")
    jobs = [(item.label, item.name, words) for item in listed]
    with status_folder(place, bool(remote), state, part) as folder:
        made = _core.batch(jobs, job.run, job.hash, folder, how, settings(None, progress))
    made["failures"] = tuple(BatchFailures(*each) for each in made["failures"])
    return BatchSummary(**made)

"""Where status.jsonl of a batch is, and how it gets to where results are."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from . import _core


def _status_files(fs: Any, root: str) -> dict[str, int]:
    """Those of all parts that lie in a folder, with their sizes; none where there is no folder."""
    try:
        found = fs.ls(root, detail=True, refresh=True)
    except FileNotFoundError:
        return {}
    sizes = {entry["name"].rpartition("/")[2]: int(entry["size"] or 0) for entry in found}
    return {name: size for name, size in sizes.items() if _core.is_batch_status_file(name)}


@contextmanager
def status_folder(
    out: str, is_remote: bool, state: str | os.PathLike[str] | None, shard: tuple[int, int]
) -> Iterator[str]:
    """A local folder for the status of a batch.

    Where results go to a URL, what others wrote of their parts is fetched from there first, and
    what was written of this part is put there in the end, however that comes.
    """
    if not is_remote:
        yield out
        return
    import fsspec

    fs, root = fsspec.core.url_to_fs(out)
    root = root.rstrip("/")
    with tempfile.TemporaryDirectory(prefix="littoral-") as temporary:
        folder = Path(state if state is not None else temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for name, size in _status_files(fs, root).items():
            local = folder / name
            if not local.exists() or local.stat().st_size < size:
                fs.get_file(f"{root}/{name}", str(local))
        mine = folder / _core.batch_status_file(*shard)
        before = mine.stat().st_size if mine.exists() else 0
        try:
            yield os.fspath(folder)
        finally:
            if mine.exists() and mine.stat().st_size != before:
                fs.makedirs(root, exist_ok=True)
                fs.put_file(str(mine), f"{root}/{mine.name}.part")
                fs.mv(f"{root}/{mine.name}.part", f"{root}/{mine.name}")

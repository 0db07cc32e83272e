"""The code on pages of the documentation: finds it and runs it.

Blocks of `sh` and `python` run in the order of the page, in a folder that holds `examples` and
`out`; names of Python live as long as the page. Blocks of `cpp` are excerpts of files that the
tests or the examples compile. A comment `<!-- not run: why -->` before a block leaves it out; one
with `needs data` does so without the data collection, which is the folder `data` where there is
one. As drawing takes long, only scripts/gallery.py runs the commands of those.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import time
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
NOT_RUN = {"text", "cmake", "bibtex", "js"}  # JavaScript: the stage `web` does
BLOCK = re.compile(
    r"(?:<!-- (?P<mark>not run: [^>]+|needs data) -->\s*)?"
    r"^(?P<indent> *)```(?P<language>\w*)[^\n]*\n"
    r"(?P<code>.*?)^(?P=indent)```$",
    re.M | re.S,
)


class Block(NamedTuple):
    language: str
    code: str
    line: int
    skipped: bool
    needs_data: bool = False


def blocks(text: str) -> list[Block]:
    """The fenced blocks of a page in their order, also those within tabs."""
    return [
        Block(
            match["language"],
            re.sub(f"^{match['indent']}", "", match["code"], flags=re.M),
            text.count("\n", 0, match.start("language")) + 1,
            (match["mark"] or "").startswith("not run"),
            match["mark"] == "needs data",
        )
        for match in BLOCK.finditer(text)
    ]


def run_shell(code: str, folder: Path, program: str) -> None:
    """Runs commands with the program on the path; RuntimeError with what they said."""
    path = f"{Path(program).resolve().parent}:{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", code],
        cwd=folder,
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
        timeout=600,
    )
    if done.returncode:
        raise RuntimeError(done.stderr or done.stdout)


def is_compiled(code: str) -> bool:
    """Whether a block of C++ stands in a file that the examples or the tests compile."""
    sources = [*(ROOT / "examples").rglob("*.cpp"), *(ROOT / "tests").glob("*.cpp")]
    return any(code in source.read_text(encoding="utf-8") for source in sources)


def data_collection() -> Path | None:
    """The folder of the larger data collection, if there is one."""
    shared = os.environ.get("LITTORAL_SHARED") or ROOT.parent / "shared"
    data = Path(shared) / "data"
    return data if data.is_dir() else None


def run_page(
    page: Path, folder: Path, program: str, data: Path | None = None, draw: Path | None = None
) -> None:
    """Runs the code of a page in a folder, which must be the working directory.

    Commands that need data only run with `draw`, a folder whose pictures are then those that the
    commands made, not those that Python makes of the same name.
    """
    (folder / "out").mkdir(exist_ok=True)
    (folder / "examples").symlink_to(ROOT / "examples")
    if data:
        (folder / "data").symlink_to(data)
    names: dict[str, object] = {}
    for block in blocks(page.read_text(encoding="utf-8")):
        where = f"{page.name}:{block.line}"
        if block.skipped or (block.needs_data and not data):
            continue
        if block.needs_data and block.language == "sh" and draw is None:
            continue
        if block.language == "sh":
            begin = time.time()
            try:
                run_shell(block.code, folder, program)
            except RuntimeError as error:
                raise RuntimeError(f"{where}: {error}") from None
            if draw:
                for picture in (folder / "out").glob("*.png"):
                    if picture.stat().st_mtime >= begin and (draw / picture.name).exists():
                        shutil.copy(picture, draw)
        elif block.language == "python":
            exec(compile(block.code, where, "exec"), names)
        elif block.language == "cpp":
            if not is_compiled(block.code):
                raise RuntimeError(f"{where}: in no file of examples or tests")
        elif block.language == "json":
            json.loads(block.code)
        elif block.language not in NOT_RUN:
            raise RuntimeError(f"{where}: what is '{block.language}'?")

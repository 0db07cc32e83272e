"""The code on the pages of the documentation runs.

Blocks of `sh` and `python` run in the order of the page, in a folder of their own that holds
`examples`; names of Python live as long as the page. Blocks of `cpp` are excerpts of files that the
tests or the examples compile. A comment `<!-- not run: why -->` before a block leaves it out.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).resolve().parents[2]
PRINTED = {"verbs.md", "formats.md", "support.md"}
NOT_RUN = {"text", "cmake", "mermaid", "bibtex"}
BLOCK = re.compile(
    r"(?P<skip><!-- not run: [^>]+ -->\s*)?^(?P<indent> *)```(?P<language>\w*)[^\n]*\n"
    r"(?P<code>.*?)^(?P=indent)```$",
    re.M | re.S,
)


class Block(NamedTuple):
    language: str
    code: str
    line: int
    skipped: bool


def pages() -> list[str]:
    found = [page for page in sorted((ROOT / "docs").rglob("*.md")) if page.name not in PRINTED]
    return [page.relative_to(ROOT).as_posix() for page in [ROOT / "README.md", *found]]


def blocks(text: str) -> list[Block]:
    return [
        Block(
            match["language"],
            re.sub(f"^{match['indent']}", "", match["code"], flags=re.M),
            text.count("\n", 0, match.start("language")) + 1,
            bool(match["skip"]),
        )
        for match in BLOCK.finditer(text)
    ]


def run_shell(code: str, folder: Path) -> None:
    path = f"{Path(os.environ['LITTORAL']).resolve().parent}:{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", code],
        cwd=folder,
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr or done.stdout


def run_python(code: str, name: str, names: dict[str, object]) -> None:
    exec(compile(code, name, "exec"), names)


def is_compiled(code: str) -> bool:
    sources = [*(ROOT / "examples").rglob("*.cpp"), *(ROOT / "tests").glob("*.cpp")]
    return any(code in source.read_text() for source in sources)


@pytest.mark.parametrize("page", pages())
def test_the_code_of_a_page_runs(page, monkeypatch, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("webbrowser.open", lambda address: True)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr(sys, "argv", ["page"])
    names: dict[str, object] = {}
    for block in blocks((ROOT / page).read_text()):
        where = f"{page}:{block.line}"
        if block.skipped:
            continue
        if block.language == "sh":
            run_shell(block.code, tmp_path)
        elif block.language == "python":
            run_python(block.code, where, names)
        elif block.language == "cpp":
            assert is_compiled(block.code), f"{where}: in no file of examples or tests"
        elif block.language == "json":
            json.loads(block.code)
        else:
            assert block.language in NOT_RUN, f"{where}: what is '{block.language}'?"


def test_blocks_are_found_with_their_language_and_reason():
    text = "a\n```sh\nls\n```\n<!-- not run: slow -->\n```python\nx\n```\n"
    text += "=== A\n\n    ```cpp\n    y\n    ```\n"
    assert blocks(text) == [
        Block("sh", "ls\n", 2, False),
        Block("python", "x\n", 6, True),
        Block("cpp", "y\n", 11, False),
    ]

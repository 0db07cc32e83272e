"""The Python code of README.md and docs/python.md runs, from top to bottom."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("page", ["README.md", "docs/python.md"])
def test_the_code_runs(page, monkeypatch, tmp_path, capsys):
    pytest.importorskip("scipy")
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    code = re.findall(r"^```python\n(.*?)^```", (ROOT / page).read_text(), re.M | re.S)
    names: dict[str, object] = {}
    for block in code:
        exec(compile(block, page, "exec"), names)
    assert code
    assert "littoral.Field" in capsys.readouterr().out

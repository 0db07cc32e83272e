"""The README is short, and what it names exists."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text()


def test_it_is_short() -> None:
    assert len(README.splitlines()) <= 120


def test_files_it_names_exist() -> None:
    named = re.findall(r"`((?:src|docs|examples)/[\w./-]+)`|\]\(([\w./-]+)\)", README)
    missing = [a or b for a, b in named if not (ROOT / (a or b)).exists()]
    assert not missing

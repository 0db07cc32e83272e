"""What the README shows is what the repository holds."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text()


def test_the_example_is_the_one_that_is_compiled() -> None:
    (shown,) = re.findall(r"```cpp\n(.*?)```", README, re.DOTALL)
    assert shown == (ROOT / "examples" / "hello.cpp").read_text()


def test_files_it_names_exist() -> None:
    named = re.findall(r"`((?:src|docs|examples)/[\w./-]+)`|\]\(([\w./-]+)\)", README)
    missing = [a or b for a, b in named if not (ROOT / (a or b)).exists()]
    assert not missing

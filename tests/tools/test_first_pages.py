"""What the first pages write goes into a folder that they make, in each language."""

from pathlib import Path

import page_code
import pytest

ROOT = Path(__file__).resolve().parents[2]
MAKES = {"sh": "mkdir -p out", "python": 'Path("out").mkdir(exist_ok=True)'}


@pytest.mark.parametrize("page", ["README.md", "docs/start/first_result.md"])
@pytest.mark.parametrize("language", MAKES)
def test_folders_are_made_before_they_are_written_to(page: str, language: str) -> None:
    code = "".join(
        block.code
        for block in page_code.blocks((ROOT / page).read_text())
        if block.language == language and not block.skipped
    )
    made, written = code.find(MAKES[language]), code.find("out/")
    assert written < 0 or 0 <= made < written

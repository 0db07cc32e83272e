"""What a newcomer asks is answered within two links from the front page of the documentation."""

import re
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"
ANSWERS = {
    "How do I install it?": ("start/install.md", "make wheel"),
    "How do I get a first result?": ("start/first_result.md", "littoral.distance("),
    "Which method should I take?": ("guides/choosing.md", "## Defaults"),
    "My mesh has holes; will it work?": ("guides/broken_input.md", "| holes |"),
    "What does this message mean?": ("guides/troubleshooting.md", "what to do"),
    "Which side is positive, in which unit?": ("guides/conventions.md", "to the **left**"),
    "How do I write a file of curves?": ("reference/curves.md", "signed_curve"),
    "How sure is the result?": ("guides/confidence.md", "erf"),
    "What is trimesh's call here?": ("guides/coming_from.md", "proximity.signed_distance"),
    "How do I get a printable shell?": ("tutorials/3-offsets.md", ".stl"),
    "How fast is it?": ("guides/performance_tips.md", "ms"),
    "What does it link, under which licence?": ("project/dependencies.md", "licence"),
}


def linked(page: str) -> set[str]:
    found = re.findall(r"\]\(([\w./-]+\.md)(?:#[\w-]*)?\)", (DOCS / page).read_text())
    folder = (DOCS / page).parent
    targets = [(folder / target).resolve() for target in found]
    return {
        t.relative_to(DOCS).as_posix() for t in targets if t.is_relative_to(DOCS) and t.is_file()
    }


@pytest.mark.parametrize("question", ANSWERS)
def test_the_answer_is_two_clicks_away(question: str) -> None:
    page, words = ANSWERS[question]
    near = linked("index.md")
    assert page in near.union(*(linked(each) for each in near))
    assert words in (DOCS / page).read_text()

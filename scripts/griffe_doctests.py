"""For the site: the doctests of docstrings become blocks of code, which Markdown would quote."""

from __future__ import annotations

import re
from typing import Any

import griffe

DOCTEST = re.compile(r"(?:^ *>>> .*\n?(?:^(?! *$).*\n?)*)+", re.M)


class Doctests(griffe.Extension):
    """Fences every run of lines that begins with `>>>` and ends before an empty line."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        if obj.docstring is not None and "```" not in obj.docstring.value:
            obj.docstring.value = DOCTEST.sub(
                lambda found: f"\n```pycon\n{found[0].rstrip()}\n```\n", obj.docstring.value
            )

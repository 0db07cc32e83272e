"""Checks the tracked files: length, paths of machines; pages: repeated lines, line width.

usage: check_files.py [ROOT]    prints one line per finding; exit status 1 if there are any
"""

import re
import subprocess
import sys
from pathlib import Path

LONGEST = 400  # lines
SOURCES = {".h", ".cpp", ".py", ".sh", ".js", ".mjs", ".ts", ".css", ".html", ".cmake"}
DATA = ("examples/data/", "tests/fixtures/", "fuzz/corpus/")
GENERATED = {"package-lock.json"}
LONG_LINE = 70  # characters; a longer line twice in one page is a repetition
WIDEST = 100  # characters of a line of prose in a page
PRINTED = {"docs/reference/verbs.md", "docs/reference/formats.md", "docs/reference/support.md"}
PRINTED |= {"docs/guides/messages.md"}
UNBREAKABLE = ("|", "#", "![", "[", "<")  # rows of tables, headings, pictures, links, comments
MACHINE_PATH = re.compile(r"(?<![\w.$}])/(?:work|home|root|Users|tmp|mnt|workspace)/\w")


def tracked(root: Path) -> list[Path]:
    """The files git knows, those deleted in the working tree left out."""
    names = subprocess.run(
        ["git", "-C", str(root), "ls-files", "-z"], check=True, capture_output=True, text=True
    ).stdout.split("\0")
    return [Path(name) for name in names if name and (root / name).is_file()]


def repeated_lines(lines: list[str]) -> list[tuple[int, int]]:
    """The numbers of long lines of a page that stood before, and where; tables and code aside."""
    first: dict[str, int] = {}
    found = []
    code = False
    for number, line in enumerate(lines, 1):
        text = line.strip()
        code ^= text.startswith("```")
        if code or len(text) <= LONG_LINE or text.startswith("|"):
            continue
        if text in first:
            found.append((number, first[text]))
        first.setdefault(text, number)
    return found


def wide_lines(lines: list[str]) -> list[int]:
    """The numbers of lines of prose that are not wrapped; tables, code and headings aside."""
    found = []
    code = False
    for number, line in enumerate(lines, 1):
        text = line.strip()
        code ^= text.startswith("```")
        breaks = " " in text and not text.startswith(UNBREAKABLE)
        if not code and len(line) > WIDEST and breaks:
            found.append(number)
    return found


def findings(root: Path) -> list[str]:
    """One line per file that is too long and per line with a machine path or that stands twice."""
    found = []
    for path in tracked(root):
        if path.as_posix().startswith(DATA) or path.name in GENERATED:
            continue
        content = (root / path).read_bytes()
        if b"\0" in content:
            continue
        lines = content.decode("utf-8", errors="replace").splitlines()
        if path.suffix in SOURCES and len(lines) > LONGEST:
            found.append(f"{path}: {len(lines)} lines; split this file (at most {LONGEST})")
        if path.suffix == ".md":
            for number, before in repeated_lines(lines):
                found.append(f"{path}:{number}: the same as line {before}")
        if path.suffix == ".md" and path.parts[0] == "docs" and path.as_posix() not in PRINTED:
            for number in wide_lines(lines):
                found.append(f"{path}:{number}: over {WIDEST} characters; wrap it")
        for number, line in enumerate(lines, 1):
            if match := MACHINE_PATH.search(line):
                found.append(f"{path}:{number}: a path of one machine: {match[0]}...")
    return found


def main(arguments: list[str]) -> int:
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    found = findings(root)
    print(
        "\n".join(found)
        if found
        else f"files: none over {LONGEST} lines, no machine paths, no repeated or long lines"
    )
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

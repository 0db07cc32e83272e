"""Codes of errors and warnings: one table, the page printed from it, all places that issue one."""

import json
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import Run

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs/guides/messages.md"
CODE = re.compile(r"[a-z]+(-[a-z]+)*")


def codes(kind: str) -> list[str]:
    """Of the page's section."""
    section = PAGE.read_text().split(f"## {kind}\n")[1].split("\n## ")[0]
    return re.findall(r"^\| `([^`]+)` \|", section, re.M)


def calls(beginning: str) -> Iterator[tuple[str, str]]:
    """The file and the arguments of every call in the sources that begins so."""
    for path in sorted((ROOT / "src").rglob("*")):
        if path.suffix not in (".cpp", ".h"):
            continue
        text = path.read_text()
        for match in re.finditer(beginning, text):
            depth, end, quoted = 1, match.end(), False
            while depth:
                c = text[end]
                if quoted:
                    end += c == "\\"
                    quoted = c != '"'
                elif c == "'":
                    end = text.index("'", end + 1 + (text[end + 1] == "\\"))
                elif c == '"':
                    quoted = True
                else:
                    depth += (c in "([{") - (c in ")]}")
                end += 1
            yield path.name, text[match.end() : end - 1]


def test_the_page_is_what_the_program_prints(run: Run) -> None:
    assert PAGE.read_text() == run("help", "--messages").stdout


def test_every_warning_has_a_code_of_the_table() -> None:
    found = set()
    for file, arguments in calls(r"(?:\.|->)warn\("):
        first = arguments.split(",")[0].strip()
        if first in ("code", "code_"):  # passed on
            continue
        code = re.fullmatch(r'"([a-z-]+)"', first)
        assert code, f"{file}: warn({arguments[:60]}"
        found.add(code[1])
    for _, arguments in calls(r"\b(?:traced|dropped|vanished)_\{"):
        found.add(arguments.strip('"'))
    assert found == set(codes("Warnings"))


def test_every_error_has_a_code_of_the_table() -> None:
    found = set(re.findall(r'"([a-z-]+)"', (ROOT / "include/littoral/error.h").read_text()))
    for _, arguments in calls(r"throw (?:Input|Unsupported|Solve|Io|Output)Error\("):
        code = re.search(r',\s*"([a-z-]+)"$', arguments)
        found |= {code[1]} if code else set()
    for _, arguments in calls(r"return say\("):  # kind and code
        found |= set(re.findall(r'"([a-z-]+)"', arguments)[1:2])
    assert found == set(codes("Errors"))


def test_codes_are_single_and_rows_are_whole() -> None:
    every = codes("Errors") + codes("Warnings")
    assert len(every) == len(set(every)) > 60
    assert all(CODE.fullmatch(code) for code in every)
    for row in PAGE.read_text().splitlines():
        if row.startswith("| `"):
            assert all(cell.strip() for cell in row.strip("|").split(" | ")), row


@pytest.mark.parametrize(
    ("arguments", "status", "code"),
    [
        (("distance", "no.obj", "--vertex=0", "-o", "a.txt"), 2, "cannot-read"),
        (("distance", "square.obj", "-o", "a.txt"), 2, "nothing-given"),
        (("distance", "square.obj", "--vertex=999", "-o", "a.txt"), 2, "no-such-element"),
        (("distance", "square.obj", "--vertex=0", "-o", "a.png2"), 2, "unknown-format"),
        (("distance", "square.obj", "--vertex=0", "-o", "no/a.txt"), 1, "cannot-write"),
        (("sdf", "square.obj"), 2, "usage"),
        (("sdf", "square.obj", "--resolution=1", "-o", "a.vti"), 2, "option-value"),
        (("quary",), 2, "unknown-name"),
        (("info", "bad.obj"), 2, "bad-file"),
    ],
)
def test_errors_end_with_their_code(
    run: Run, mesh: Path, arguments: tuple[str, ...], status: int, code: str
) -> None:
    (mesh.parent / "bad.obj").write_text("v 0 0\n")
    failed = run(*arguments, "--json", status=status)
    assert failed.stderr.endswith(f" [{code}]\n")
    assert json.loads(failed.stdout)["error"]["code"] == code
    assert code in codes("Errors")


def test_warnings_end_with_their_code(run: Run, mesh: Path) -> None:
    (mesh.parent / "more.obj").write_text(mesh.read_text() + "v 5 5 5\n")
    done = run("distance", "more.obj", "--vertex=0", "--json", "-o", "a.txt")
    assert done.stderr.endswith(" [isolated-vertices]\n")
    (warning,) = json.loads(done.stdout)["warnings"]
    assert warning["code"] == "isolated-vertices"
    assert f"{warning['message']} [{warning['code']}]\n" in done.stderr

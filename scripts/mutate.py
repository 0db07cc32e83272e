"""Would the tests notice? Random single changes to the sources, each built and tested.

An operator, a bound, a constant or a `!` of one line changes. The changed file is compiled with
those that are compiled together with it, and linked before the library, whose object is then not
used; nothing in the work tree is written. A change is killed if a test fails, crashes or takes too
long. Suites of test files that include the changed file's folder, or a header that is implemented
with the changed file's, or share a word with its name run first, the others only if those notice
nothing.

usage: mutate.py [--build build/release] [--seed N] [--count N] [--folders FOLDER...]
                 [--under PATTERN] [--limit SECONDS] [--near] [--least SHARE] [--list]

The build folder holds littoral_tests; what is changed is the work tree it was made of. Prints a
line for each change and the share that was killed; changes that do not compile do not count, nor
do those of files whose tests fail as they are. The exit status is 1 below the least share. With
--list changes are printed, those that do not compile among them, and not made.
"""

import argparse
import os
import random
import re
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path

FOLDERS = ("methods", "operators", "sources", "solve", "contour", "domain")
CHANGES = (
    (r"(?<= )<(?= )", ("<=", ">")),
    (r"(?<= )>(?= )", (">=", "<")),
    (r"<=", ("<", ">")),
    (r">=", (">", "<")),
    (r"==", ("!=",)),
    (r"!=", ("==",)),
    (r"&&(?= )", ("||",)),
    (r"\|\|", ("&&",)),
    (r"(?<= )\+(?= )", ("-",)),
    (r"(?<= )-(?= )", ("+",)),
    (r"(?<= )\*(?= )", ("/",)),
    (r"(?<= )/(?= )", ("*",)),
    (r"(?<= )\+=", ("-=",)),
    (r"(?<= )-=", ("+=",)),
    (r"\bstd::min\b", ("std::max",)),
    (r"\bstd::max\b", ("std::min",)),
    (r"(?<=[(\s])!(?=[a-z(])", ("",)),
    (r"(?<=[(\s])-(?=[\d(a-z])", ("",)),
    (r"(?<![\w.])0\.5(?![\w.])", ("1", "0.25")),
    (r"(?<![\w.\[])[1-4](?![\w.])", ("0", "5")),
    (r"(?<![\w.\[])0(?![\w.])", ("1",)),
    (r"\b\d\.?\d*e-?\d+\b", ("0", "1")),
)
# Comments, strings, includes, checks of types: a change there is none, or does not compile.
SKIPPED = re.compile(r'^\s*(//|#|using|template|static_assert|namespace)|"|throw |task\.|stage\(')


# Random properties draw the same cases in every run, so that runs can be repeated.
ENVIRONMENT = dict(os.environ, RC_PARAMS="seed=20240801")


def candidates(lines: list[str]) -> Iterator[tuple[int, int, int, str]]:
    """Line, from, to, and what comes there instead."""
    for number, line in enumerate(lines):
        if SKIPPED.search(line):
            continue
        code = line.split("//")[0]
        for pattern, others in CHANGES:
            for match in re.finditer(pattern, code):
                for other in others:
                    yield number, match.start(), match.end(), other


class Builder:
    """Compiles one changed file and links the tests with it."""

    def __init__(self, build: Path, work: Path) -> None:
        self.build, self.work = build, work
        cache = (build / "CMakeCache.txt").read_text()
        self.root = Path(re.findall(r"^CMAKE_HOME_DIRECTORY:INTERNAL=(.*)$", cache, re.M)[0])
        listed = subprocess.run(
            ["ninja", "-t", "commands", "littoral_tests"],
            cwd=build,
            check=True,
            capture_output=True,
            text=True,
        ).stdout.splitlines()
        self.link = listed[-1]
        self.compile: dict[Path, tuple[Path, list[str]]] = {}  # source -> what is compiled, words
        for line in listed[:-1]:
            words = shlex.split(line)
            if "-c" not in words:
                continue
            unit = build / words[words.index("-c") + 1]
            self.compile[unit.resolve()] = unit, words
            if unit.name.startswith("unity_"):
                for name in re.findall(r'#include "(.*)"', unit.read_text()):
                    self.compile[Path(name).resolve()] = unit, words

    def program(self, source: Path, text: str) -> Path | None:
        """The tests with this text in place of the source; None if it does not compile."""
        changed, compiled = self.work / source.name, self.work / "changed.o"
        changed.write_text(text)
        unit, given = self.compile[source]
        if unit != source:
            together = self.work / unit.name
            together.write_text(unit.read_text().replace(f'"{source}"', f'"{changed}"'))
            changed = together
        words = list(given)
        words = words[words.index(next(w for w in words if w.endswith("c++"))) :]
        for flag in ("-MT", "-MF", "-o"):
            words[words.index(flag) + 1] = str(compiled) + (".d" if flag == "-MF" else "")
        words[words.index("-c") + 1] = str(changed)
        words += ["-Wno-error", "-w", "-D_GLIBCXX_ASSERTIONS", "-UNDEBUG"]  # as with sanitizers
        if subprocess.run(words, cwd=self.build, capture_output=True, check=False).returncode:
            return None
        out = self.work / "tests"
        link = self.link.replace(" -o tests/littoral_tests", f" -o {out}", 1).replace(
            " tests/CMakeFiles", f" {compiled} tests/CMakeFiles", 1
        )
        done = subprocess.run(link, cwd=self.build, shell=True, capture_output=True, check=False)
        return None if done.returncode else out


def words_of(name: str) -> set[str]:
    """Those that say something."""
    return {word for word in name.split("_") if len(word) > 3 and word != "test"}


@cache
def headers_by_use(root: Path) -> dict[str, set[str]]:
    """Header -> the headers of the sources that include it."""
    users: dict[str, set[str]] = {}
    for user in (root / "src").rglob("*.cpp"):
        for name in re.findall(r'^#include "(.+)"', user.read_text(), re.MULTILINE):
            users.setdefault(name, set()).add(str(user.relative_to(root / "src").with_suffix(".h")))
    return users


def filters(root: Path, source: Path) -> list[str]:
    """What GoogleTest runs first, and then: without suites that take long."""
    near: set[str] = set()
    folder = str(source.parent.relative_to(root / "src"))
    header = str(source.relative_to(root / "src").with_suffix(".h"))
    folders = re.findall(rf'^#include "({folder}/\w+\.h)"', source.read_text(), re.MULTILINE)
    parts = [header] if (root / "src" / header).exists() else folders
    users = set().union(*(headers_by_use(root).get(part, set()) for part in parts))
    words = words_of(source.stem) | words_of(source.parent.name)
    for test in sorted((root / "tests").glob("*_test.cpp")):
        text = test.read_text()
        helpers = "".join(
            (root / "tests" / name).read_text()
            for name in re.findall(r'#include "(\w+\.h)"', text)
            if (root / "tests" / name).exists()
        )
        included = header in text + helpers or f'"{folder}/' in text
        used = any(f'"{user}"' in text + helpers for user in users)
        suites = set(re.findall(r"^TEST(?:_[FP])?\((\w+),", text, re.MULTILINE))
        if included or used or words & words_of(test.stem):
            near |= suites
        near |= {suite for suite in suites if source.stem.replace("_", "") in suite.lower()}
    first = ":".join(f"{s}.*:*/{s}.*" for s in sorted(near) if "Slow" not in s)
    rest = "*-*Slow*:MethodCases.*" + "".join(f":{s}.*:*/{s}.*" for s in sorted(near))
    return [first, rest] if first else [rest]


def noticed(program: Path, chosen: list[str], limit: float) -> str:
    """Which test fails first; empty: none."""
    for suites in chosen:
        try:
            done = subprocess.run(
                [program, f"--gtest_filter={suites}", "--gtest_fail_fast", "--gtest_brief=1"],
                capture_output=True,
                text=True,
                timeout=limit,
                env=ENVIRONMENT,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return "time"
        if done.returncode:
            failed = re.search(r"\[  FAILED  \] (\S+)", done.stdout)
            return failed.group(1).rstrip(",") if failed else f"exit {done.returncode}"
    return ""


def main() -> None:
    """Options."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=Path, default=Path("build/release"))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--folders", nargs="+", default=FOLDERS, help="below src")
    parser.add_argument("--under", default="", help="a regular expression on paths below src")
    parser.add_argument("--limit", type=float, default=600)
    parser.add_argument("--near", action="store_true", help="only the suites that run first")
    parser.add_argument("--least", type=float, default=0)
    parser.add_argument("--list", action="store_true", help="only print the changes")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as work:
        share = run(given, Builder(given.build.resolve(), Path(work)))
    sys.exit(share < given.least)


def run(given: argparse.Namespace, builder: Builder) -> float:
    """Changes, one after the other. The share that was killed."""
    root = builder.root
    sources = [
        source
        for folder in given.folders
        for source in sorted((root / "src" / folder).rglob("*.cpp"))
        if re.search(given.under, str(source.relative_to(root / "src")))
    ]
    lines = {source: source.read_text().splitlines(keepends=True) for source in sources}
    every = [(source, change) for source in sources for change in candidates(lines[source])]
    chosen = random.Random(given.seed)

    @cache
    def failing(suites: tuple[str, ...]) -> str:
        return noticed(builder.build / "tests" / "littoral_tests", list(suites), given.limit)

    killed = survived = 0
    print(f"{len(every)} possible changes in {len(sources)} files", flush=True)
    while every and killed + survived < given.count:
        source, (number, begin, end, other) = chosen.choice(every)
        text = list(lines[source])
        text[number] = text[number][:begin] + other + text[number][end:]
        where = f"{source.relative_to(root)}:{number + 1}"
        change = f"{where}\n    {lines[source][number].strip()}\n    {text[number].strip()}"
        if given.list:
            print(change)
            survived += 1
            continue
        suites = filters(root, source)[: 1 if given.near else None]
        program = builder.program(source, "".join(text))
        if program is None:
            continue
        by = noticed(program, suites, given.limit)
        if by and (fails := failing((by,) if "." in by else tuple(suites))):
            print(f"{source.relative_to(root)}: fails unchanged: {fails}", flush=True)
            every = [one for one in every if one[0] != source]
            continue
        killed, survived = killed + bool(by), survived + (not by)
        print(f"{'killed by ' + by if by else 'SURVIVED'}  {change}", flush=True)
    if given.list:
        return 1
    print(f"{killed} of {killed + survived} killed")
    return float(killed) / float(given.count)


if __name__ == "__main__":
    main()

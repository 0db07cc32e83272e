"""Adds up the closing lines of ctest, pytest and node's test runner found in logs.

usage: count_tests.py LOG...
"""

import re
import sys
from collections import Counter
from pathlib import Path

CTEST = re.compile(r"tests passed, (\d+) tests? failed out of (\d+)$")
CTEST_SKIPPED = re.compile(r"^\s*\d+ - .+ \((?:Skipped|Not Run|Disabled)\)$")
PYTEST = re.compile(r"^=*\s*(?:\d+ [a-z]+, )*\d+ [a-z]+(?:, \d+ [a-z]+)* in [\d.]+s")
PYTEST_PART = re.compile(r"(\d+) (passed|failed|skipped|errors?)")
NODE = re.compile(r"^[#ℹ] (pass|fail|skipped) (\d+)$")
NODE_NAMES = {"pass": "passed", "fail": "failed", "skipped": "skipped"}


def count(text: str) -> Counter[str]:
    """Tests passed, failed and skipped in the output of any number of test programs."""
    total: Counter[str] = Counter()
    for line in text.splitlines():
        if match := CTEST.search(line):
            failed, run = int(match[1]), int(match[2])
            total.update(failed=failed, passed=run - failed)
        elif CTEST_SKIPPED.match(line):
            total.update(skipped=1, passed=-1)  # ctest counts them among the passed
        elif match := NODE.match(line):
            total[NODE_NAMES[match[1]]] += int(match[2])
        elif PYTEST.match(line):
            for number, kind in PYTEST_PART.findall(line):
                total["failed" if kind.startswith("error") else kind] += int(number)
    return total


if __name__ == "__main__":
    paths = [Path(name) for name in sys.argv[1:]]
    sums = sum((count(path.read_text(errors="replace")) for path in paths), Counter())
    print(", ".join(f"{sums[kind]} {kind}" for kind in ("passed", "failed", "skipped")))

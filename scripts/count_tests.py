"""Adds up the closing lines of ctest, pytest and node's test runner found in the logs of stages.

A stage that states no counts is one test, and so is one that failed although none of its tests did.

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
STAGE = re.compile(r"^stage \w+ (passed|FAILED)$")
NODE_NAMES = {"pass": "passed", "fail": "failed", "skipped": "skipped"}


def count(text: str) -> Counter[str]:
    """Tests passed, failed and skipped in the log of one stage."""
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
        elif match := STAGE.match(line):
            if match[1] == "FAILED" and total["failed"] == 0:
                total["failed"] = 1
            elif match[1] == "passed" and total.total() == 0:
                total["passed"] = 1
    return total


if __name__ == "__main__":
    paths = [Path(name) for name in sys.argv[1:]]
    sums: Counter[str] = Counter()
    for path in paths:
        sums += count(path.read_text(errors="replace"))
    print(", ".join(f"{sums[kind]} {kind}" for kind in ("passed", "failed", "skipped")))

"""Runs a GoogleTest program suite by suite, several at once: what failed, and how long it took.

A suite is one process. If it crashes, or one of its tests takes longer than the limit, that test
has failed, and the ones after it still run. Suites that took longest the last time, here or else in
another build, begin first.

usage: run_tests.py PROGRAM [--jobs N] [--only REGEX] [--without REGEX] [--limit SECONDS]
                    [--run "COMMAND"]

--only, --without: on names SUITE.TEST.   --run: what runs the program, e.g. "qemu-aarch64 -L DIR".
The exit status is 1 if a test failed or none ran.
"""

import argparse
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

Result = tuple[str, str, float, str]  # test, "passed" | "failed" | "skipped", seconds, output
BEGIN = re.compile(r"^\[ RUN      \] (\S+)$")
END = re.compile(r"^\[ *(OK|FAILED|SKIPPED) *\] (\S+?)(?:, where .*)? \((\d+) ms\)$")
OUTCOMES = {"OK": "passed", "FAILED": "failed", "SKIPPED": "skipped"}
SLOWEST_SHOWN = 10


def names(listing: str) -> list[str]:
    """What --gtest_list_tests prints, as SUITE.TEST; disabled tests are none."""
    found, suite = [], ""
    for line in listing.splitlines():
        word = line.split("#")[0].rstrip()
        if word and not line.startswith(" "):
            suite = word if word.endswith(".") else ""
        elif suite and word and "DISABLED_" not in suite + word:
            found.append(suite + word.strip())
    return found


def suites(tests: Iterable[str]) -> dict[str, list[str]]:
    by_suite: dict[str, list[str]] = {}
    for test in tests:
        by_suite.setdefault(test.partition(".")[0], []).append(test)
    return by_suite


def results(output: str) -> tuple[list[Result], str, str]:
    """The tests that ended, the one that did not (or ""), and what that one had printed."""
    ended: list[Result] = []
    running, lines = "", list[str]()
    for line in output.splitlines():
        if match := BEGIN.match(line):
            running, lines = match[1], []
        elif running and (match := END.match(line)) and match[2] == running:
            text = "\n".join(lines)
            ended.append((running, OUTCOMES[match[1]], int(match[3]) / 1000, text))
            running = ""
        else:
            lines.append(line)
    return ended, running, "\n".join(lines)


def run_once(command: list[str], tests: list[str], limit: float) -> tuple[str, str]:
    """What one process printed, and how it ended: "" is well."""
    environment = dict(os.environ, RC_PARAMS="seed=20240801", GTEST_COLOR="no")
    with tempfile.TemporaryFile() as out:
        process = subprocess.Popen(
            [*command, "--gtest_filter=" + ":".join(tests)],
            stdout=out,
            stderr=subprocess.STDOUT,
            env=environment,
        )
        size, since, end = 0, time.monotonic(), ""
        while True:
            try:
                process.wait(timeout=0.5)
                break
            except subprocess.TimeoutExpired:
                now = os.fstat(out.fileno()).st_size
                if now != size:
                    size, since = now, time.monotonic()
                elif time.monotonic() - since > limit:
                    process.kill()
                    process.wait()
                    end = f"stopped after {limit:g} s"
                    break
        out.seek(0)
        text = out.read().decode(errors="replace")
    if not end and process.returncode not in (0, 1):
        end = f"ended with status {process.returncode}"
    return text, end


def run_suite(command: list[str], tests: list[str], limit: float) -> list[Result]:
    all_results: list[Result] = []
    left = tests
    while left:
        text, end = run_once(command, left, limit)
        ended, running, said = results(text)
        if not ended and not running:
            running, said = left[0], text
            end = end or "did not begin"
        if running:
            ended.append((running, "failed", 0.0, f"{said}\n{end or 'ended without a result'}"))
        elif end:  # after its last test, for example a leak
            name = ended.pop()[0]
            ended.append((name, "failed", 0.0, f"{text[-4000:]}\n{end}"))
        all_results += ended
        done = {name for name, *_ in ended}
        left = [test for test in left if test not in done]
    return all_results


def seconds_before(times_file: Path) -> dict[str, float]:
    """How long each test took the last time; at first, how long it took in another build."""
    others = times_file.absolute().parents[2].glob(f"*/tests/{times_file.name}")
    known = [times_file] if times_file.is_file() else list(others)
    newest = max(known, key=lambda file: file.stat().st_mtime, default=None)
    return json.loads(newest.read_text()) if newest else {}


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=Path)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--only", default="")
    parser.add_argument("--without", default="")
    parser.add_argument("--limit", type=float, default=300)
    parser.add_argument("--run", default="")
    options = parser.parse_args(arguments)
    command = [*shlex.split(options.run), str(options.program.resolve())]
    begin = time.monotonic()

    listing = subprocess.run(
        [*command, "--gtest_list_tests"], check=True, capture_output=True, text=True
    ).stdout
    chosen = [
        test
        for test in names(listing)
        if re.search(options.only, test)
        and not (options.without and re.search(options.without, test))
    ]
    times_file = options.program.with_name(options.program.name + "-seconds.json")
    times = seconds_before(times_file)
    by_suite = sorted(
        suites(chosen).values(), key=lambda tests: -sum(times.get(test, 0.1) for test in tests)
    )
    counts = {"passed": 0, "failed": 0, "skipped": 0}
    failed = []
    with ThreadPoolExecutor(options.jobs) as pool:
        for suite in pool.map(lambda tests: run_suite(command, tests, options.limit), by_suite):
            for test, outcome, seconds, output in suite:
                counts[outcome] += 1
                times[test] = seconds
                if outcome == "failed":
                    failed.append(test)
                    print(f"---- {test}\n{output}\n", flush=True)
                elif outcome == "skipped":
                    print(f"skipped: {test}", flush=True)
    times_file.write_text(json.dumps(times, indent=0, sort_keys=True))
    for test in sorted(chosen, key=lambda test: -times.get(test, 0))[:SLOWEST_SHOWN]:
        print(f"{times.get(test, 0):8.2f} s  {test}")
    for test in failed:
        print(f"FAILED: {test}")
    line = ", ".join(f"{n} {kind}" for kind, n in counts.items() if n or kind == "passed")
    print(f"{line} in {time.monotonic() - begin:.2f}s")
    return 1 if failed or not chosen else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

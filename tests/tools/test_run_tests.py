"""Every test of a program gets its result, whatever the program does."""

import stat
from pathlib import Path

import pytest
import run_tests

PROGRAM = """#!/usr/bin/env python3
import os, sys, time
TESTS = ["A.Passes", "A.Crashes", "A.Fails", "A.Skips", "B.Hangs", "B.Passes"]
if "--gtest_list_tests" in sys.argv:
    print("Running main() from somewhere.cc")
    print("A.\\n  Passes\\n  Crashes\\n  Fails\\n  Skips\\n  DISABLED_No\\nB.\\n  Hangs\\n  Passes")
    sys.exit(0)
(chosen,) = [a.split("=")[1].split(":") for a in sys.argv if a.startswith("--gtest_filter=")]
for test in chosen:
    print("[ RUN      ]", test, flush=True)
    if test.endswith("Crashes"):
        os.abort()
    if test.endswith("Hangs"):
        time.sleep(60)
    words = {"Fails": "FAILED  ", "Skips": "SKIPPED "}
    word = words.get(test.split(".")[1], "      OK")
    print("[ " + word + " ]", test, "(10 ms)", flush=True)
sys.exit(1 if "A.Fails" in chosen else 0)
"""


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "tests"
    path.write_text(PROGRAM)
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path


def test_crashes_and_hangs_have_names_and_the_others_run(
    program: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_tests.main([str(program), "--limit", "5"]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert [line for line in lines if line.startswith("FAILED: ")] == [
        "FAILED: A.Crashes",
        "FAILED: A.Fails",
        "FAILED: B.Hangs",
    ]
    assert lines[-1].startswith("2 passed, 3 failed, 1 skipped in ")


def test_a_choice_of_tests(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run_tests.main([str(program), "--only", "^A", "--without", "Crash|Fail"]) == 0
    assert capsys.readouterr().out.splitlines()[-1].startswith("1 passed, 1 skipped in ")


def test_no_test_at_all_is_a_failure(program: Path) -> None:
    assert run_tests.main([str(program), "--only", "Nothing"]) == 1


def test_what_took_long_in_another_build_begins_first(tmp_path: Path) -> None:
    here, other = tmp_path / "asan/tests", tmp_path / "release/tests"
    here.mkdir(parents=True)
    other.mkdir(parents=True)
    times = here / "littoral_tests-seconds.json"
    assert run_tests.seconds_before(times) == {}
    (other / times.name).write_text('{"A.B": 7.5}')
    assert run_tests.seconds_before(times) == {"A.B": 7.5}
    times.write_text('{"A.B": 80.0}')
    assert run_tests.seconds_before(times) == {"A.B": 80.0}

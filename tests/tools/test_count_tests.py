"""The closing lines of the test programs add up."""

import count_tests


def test_ctest_skips_are_not_passes() -> None:
    text = "100% tests passed, 0 tests failed out of 5\n\t  3 - Mesh.Shared (Skipped)\n"
    assert count_tests.count(text) == {"passed": 4, "failed": 0, "skipped": 1}


def test_pytest_with_and_without_bars() -> None:
    text = "=== 1 failed, 7 passed, 2 skipped in 3.21s ===\n4 passed in 0.10s\n1 error in 0.10s\n"
    assert count_tests.count(text) == {"failed": 2, "passed": 11, "skipped": 2}


def test_node() -> None:
    text = "ℹ tests 4\nℹ pass 3\nℹ fail 1\nℹ skipped 0\n# pass 2\n"
    assert count_tests.count(text) == {"passed": 5, "failed": 1, "skipped": 0}


def test_a_stage_without_counts_is_one_test() -> None:
    assert count_tests.count("all fine\nstage docs passed\n").total() == 1
    assert count_tests.count("stage docs FAILED\n") == {"failed": 1}
    assert count_tests.count("2 passed in 0.1s\nstage cli FAILED\n") == {"passed": 2, "failed": 1}
    assert count_tests.count("1 failed in 0.1s\nstage cli FAILED\n") == {"failed": 1}


def test_other_output_counts_for_nothing() -> None:
    assert not count_tests.count("built 12 files in 3 s\nall passed\n")

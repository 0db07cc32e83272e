"""Changes to the sources are changes of code, and of one place."""

import mutate


def changed(line: str) -> set[str]:
    """The line after each change there may be."""
    return {line[:a] + other + line[b:] for _, a, b, other in mutate.candidates([line])}


def test_operators_bounds_and_constants() -> None:
    assert changed("  if (a < b) return;") == {"  if (a <= b) return;", "  if (a > b) return;"}
    assert changed("  x = a - b;") == {"  x = a + b;"}
    assert "  return 1 * x;" in changed("  return 0.5 * x;")
    assert "  return 0.5 / x;" in changed("  return 0.5 * x;")
    assert changed("  y = std::min(a, b);") == {"  y = std::max(a, b);"}


def test_what_is_no_code_stays() -> None:
    for line in ("  // a < b", '#include "a/b.h"', 'throw InputError("1 + 1");', "a();  // 1 + 1"):
        assert not changed(line)
    assert not changed("std::vector<int> list;")

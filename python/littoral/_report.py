"""What a computation says about itself."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any


class ReportWarning(str):
    """A warning: a sentence, whose `code` stays the same when its wording changes.

    The page of messages explains the codes.

    >>> import littoral
    >>> mesh = littoral.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [9, 9, 9]], [[0, 1, 2]])
    >>> [warning.code for warning in littoral.distance(mesh, points=0).warnings]
    ['isolated-vertices']
    """

    code: str

    def __new__(cls, text: str, code: str = "") -> ReportWarning:
        """The text as a string, with its code."""
        self = super().__new__(cls, text)
        self.code = code
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        """What copies and pickles are made of."""
        return type(self), (str(self), self.code)


def counted(n: int, noun: str) -> str:
    """A number and what is counted, as "1 warning" and "2 warnings"."""
    return f"{n} {noun}{'s' * (n != 1)}"


@dataclass
class Report:
    """Facts gathered while a method ran.

    `status` is "converged", "not converged" (the answer is the best iterate) or "uncertain" (see
    `warnings`). `timings` are seconds by stage, `residuals` relative ones by equation.

    >>> import littoral
    >>> report = littoral.distance(littoral.examples.square(4), points=0).report
    >>> report.status, report.sizes["vertices"]
    ('converged', 25.0)
    """

    method: str = ""
    domain: str = ""
    status: str = "converged"
    options: dict[str, str] = field(default_factory=dict)
    sizes: dict[str, float] = field(default_factory=dict)
    timings: dict[str, float] = field(default_factory=dict)
    iterations: dict[str, float] = field(default_factory=dict)
    residuals: dict[str, float] = field(default_factory=dict)
    warnings: list[ReportWarning] = field(default_factory=list)
    unreachable_components: list[int] = field(default_factory=list)

    def as_dict(self) -> dict[str, Any]:
        """Everything as plain data, for JSON."""
        data = asdict(self)
        data["warnings"] = [{"code": each.code, "message": str(each)} for each in self.warnings]
        return data

    def __repr__(self) -> str:
        sizes = ", ".join(f"{value:.0f} {name}" for name, value in self.sizes.items())
        text = f"<littoral.Report: {self.method} on {self.domain}, {self.status}; {sizes}"
        doubts = len(self.warnings)
        return text + (f"; {counted(doubts, 'warning')}>" if doubts else ">")

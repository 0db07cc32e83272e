"""What a computation says about itself."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any


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
    warnings: list[str] = field(default_factory=list)
    unreachable_components: list[int] = field(default_factory=list)

    def as_dict(self) -> dict[str, Any]:
        """Everything as plain data, for JSON."""
        return asdict(self)

    def __repr__(self) -> str:
        sizes = ", ".join(f"{value:.0f} {name}" for name, value in self.sizes.items())
        text = f"<littoral.Report: {self.method} on {self.domain}, {self.status}; {sizes}"
        return text + (f"; {len(self.warnings)} warnings>" if self.warnings else ">")

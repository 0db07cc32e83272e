"""Signed distance as a function that torch differentiates with respect to the query points."""

from __future__ import annotations

from typing import Any

import torch

from ._space import SDF as _SDF


class _Distance(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, points: Any, sdf: _SDF) -> Any:
        flat = points.detach().cpu().reshape(-1, 3)
        values, gradients = sdf.with_gradient(flat.double().numpy())
        ctx.save_for_backward(torch.as_tensor(gradients).to(points).reshape(points.shape))
        return torch.as_tensor(values).to(points).reshape(points.shape[:-1])

    @staticmethod
    def backward(ctx: Any, *upstream: Any) -> tuple[Any, None]:
        (gradients,) = ctx.saved_tensors
        return gradients * upstream[0].unsqueeze(-1), None


class SDF(torch.nn.Module):
    """A `littoral.SDF` as a module: points ... x 3 -> distances ..., on any device [length].

    Computed on the CPU. The gradient with respect to the points is exact where the distance is
    smooth; there is none with respect to the shape.
    """

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__()
        made = len(args) == 1 and isinstance(args[0], _SDF) and not options
        self.sdf: _SDF = args[0] if made else _SDF(*args, **options)

    def forward(self, points: Any) -> Any:
        """Distances at points ... x 3."""
        if points.ndim == 0 or points.shape[-1] != 3:
            raise ValueError(f"points: expected shape ... x 3, got {tuple(points.shape)}")
        return _Distance.apply(points, self.sdf)

"""Signed distance as a function that torch differentiates with respect to the query points."""

from __future__ import annotations

from typing import Any, NoReturn

import torch

from ._errors import ArgumentError, InputError, UnsupportedError
from ._space import SDF as _SDF


class _Gradient(torch.autograd.Function):
    """The gradient as a function of the points, so that second derivatives are an error, not 0."""

    @staticmethod
    def forward(ctx: Any, points: Any, gradients: Any) -> Any:
        return gradients.clone()

    @staticmethod
    def backward(ctx: Any, *upstream: Any) -> NoReturn:
        raise UnsupportedError(
            "second derivatives of a distance are not known; use first ones only"
        )


class _Distance(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, points: Any, sdf: _SDF) -> Any:
        flat = points.detach().cpu().reshape(-1, 3).double().numpy()
        if ctx.needs_input_grad[0]:
            values, gradients = sdf.with_gradient(flat)
            like_points = torch.as_tensor(gradients).to(points).reshape(points.shape)
            ctx.save_for_backward(points, like_points)
        else:
            values = sdf(flat)
        return torch.as_tensor(values).to(points).reshape(points.shape[:-1])

    @staticmethod
    def backward(ctx: Any, *upstream: Any) -> tuple[Any, None]:
        return _Gradient.apply(*ctx.saved_tensors) * upstream[0].unsqueeze(-1), None


class SDF(torch.nn.Module):
    """A `littoral.SDF` as a module: points ... x 3 -> distances ..., on any device [length].

    Computed on the CPU, in double precision. Results have the type of the points, and torch's
    default type for integers. The gradient with respect to the points is exact where the distance
    is smooth; there is none with respect to the shape, and second ones raise
    UnsupportedError.
    """

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__()
        made = len(args) == 1 and isinstance(args[0], _SDF) and not options
        self.sdf: _SDF = args[0] if made else _SDF(*args, **options)

    def forward(self, points: Any) -> Any:
        """Distances at points ... x 3; ArgumentError and InputError for anything else."""
        if not isinstance(points, torch.Tensor) or points.is_complex():
            kind = getattr(points, "dtype", type(points).__name__)
            raise ArgumentError(f"points: expected a tensor of real numbers, got {kind}")
        if points.ndim == 0 or points.shape[-1] != 3:
            raise InputError(f"points: expected shape ... x 3, got {tuple(points.shape)}")
        if not points.is_floating_point():
            points = points.to(torch.get_default_dtype())
        return _Distance.apply(points, self.sdf)

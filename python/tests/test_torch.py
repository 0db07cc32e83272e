"""Signed distance as a module of torch."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import littoral

torch = pytest.importorskip("torch")
littoral_torch = pytest.importorskip("littoral.torch")


@pytest.fixture(scope="module")
def shape():
    return littoral_torch.SDF(littoral.examples.sphere(2))


def points(*size, seed=0):
    generator = torch.Generator().manual_seed(seed)
    return torch.rand(*size, 3, generator=generator, dtype=torch.double) * 3 - 1.5


def test_values_are_those_of_numpy(shape):
    x = points(40)
    np.testing.assert_array_equal(shape(x).numpy(), shape.sdf(x.numpy()))


@pytest.mark.parametrize("size", [(), (7,), (2, 3), (2, 1, 4), (0,)])
def test_shapes(shape, size):
    assert shape(points(*size)).shape == size


@pytest.mark.parametrize("name", ["float16", "bfloat16", "float32", "float64"])
def test_results_have_the_type_of_the_points(shape, name):
    dtype = getattr(torch, name)
    x = points(5).to(dtype)
    assert shape(x).dtype == dtype
    np.testing.assert_allclose(shape(x).double(), shape(x.double()), rtol=0.01)


def test_integers_are_not_cut_off(shape):
    got = shape(torch.tensor([[1, 1, 1]]))
    assert got.dtype == torch.get_default_dtype()
    assert 0.7 < float(got) < 0.8


def test_gradient_is_right(shape):
    x = points(9).requires_grad_()
    assert torch.autograd.gradcheck(shape, (x,), eps=1e-7, atol=1e-5)
    shape(x.reshape(3, 3, 3)).sum().backward()
    np.testing.assert_allclose(x.grad, shape.sdf.gradient(x.detach().numpy()), atol=1e-15)


def test_no_graph_without_a_need(shape):
    assert not shape(points(3)).requires_grad
    with torch.no_grad():
        assert not shape(points(3).requires_grad_()).requires_grad


def test_second_derivatives_are_an_error(shape):
    z = points(3).requires_grad_()
    x = z**2  # so that a missing term would go unnoticed
    (first,) = torch.autograd.grad(shape(x).sum(), z, create_graph=True)
    with pytest.raises(NotImplementedError, match="second derivatives"):
        first.square().sum().backward()


def test_points_descend_to_the_surface(shape):
    x = points(20, seed=3).requires_grad_()
    before = shape(x).abs().mean()
    optimizer = torch.optim.Adam([x], lr=0.02)
    for _ in range(60):
        optimizer.zero_grad()
        shape(x).square().mean().backward()
        optimizer.step()
    assert shape(x).abs().mean() < 0.1 * before


def test_bad_points(shape):
    with pytest.raises(ValueError, match=r"\.\.\. x 3"):
        shape(torch.zeros(2, 2))
    with pytest.raises(TypeError, match="list"):
        shape([[0.0, 0.0, 0.0]])
    with pytest.raises(TypeError, match="complex"):
        shape(torch.zeros(1, 3, dtype=torch.complex64))
    with pytest.raises(ValueError, match="finite"):
        shape(torch.full((1, 3), float("nan")))


def test_made_of_anything_and_pickled():
    V, F = (np.array(a) for a in (littoral.examples.cube().points, littoral.examples.cube().faces))
    x = points(5)
    expected = littoral.SDF(V, F)(x.numpy())
    for args in ((V, F), (littoral.SDF(V, F),), (torch.tensor(V), torch.tensor(F))):
        module = littoral_torch.SDF(*args)
        np.testing.assert_array_equal(module(x), expected)
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(module))(x), expected)
    assert list(module.parameters()) == []


def test_tensors_as_a_surface():
    cube = littoral.examples.cube()
    V = torch.tensor(np.array(cube.points), dtype=torch.float32, requires_grad=True)
    mesh = littoral.as_surface((V, torch.tensor(np.array(cube.faces))))
    np.testing.assert_array_equal(mesh.points, cube.points)
    assert littoral.distance(mesh, points=0).values.dtype == np.float32
    assert littoral.SDF(mesh)(points(4)).dtype == np.float64


@pytest.mark.skipif(not torch.cuda.is_available(), reason="there is no GPU")
def test_other_devices(shape):
    x = points(5)
    on_gpu = x.cuda().requires_grad_()
    values = shape(on_gpu)
    values.sum().backward()
    assert values.device == on_gpu.grad.device == on_gpu.device
    np.testing.assert_array_equal(values.detach().cpu(), shape(x))

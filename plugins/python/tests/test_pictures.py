"""Pictures by the painter of the engine and by matplotlib."""

import sys

import matplotlib.pyplot as plt
import numpy as np
import pytest
from conftest import floor_world, torn_world, vector

import fuwafuwa as fw


def pixels(png):
    import io

    return plt.imread(io.BytesIO(png))


def test_picture_shows_the_body(fwd):
    world, ball, _ = torn_world(fwd)
    image = pixels(world._repr_png_())
    assert image.shape[1] == 480 and image[..., :3].std() > 0.05
    empty = pixels(fwd.World().png(width=64))
    assert empty.shape[1] == 64 and empty[..., :3].std() < 0.05
    assert world.png(elements=True) != world.png()


def test_picture_is_saved(fwd, tmp_path):
    world = floor_world(fwd)
    world.save_png(tmp_path / "world.png", width=32, view=(np.full(fwd.dim, -1), np.full(fwd.dim, 1)))
    assert (tmp_path / "world.png").read_bytes()[1:4] == b"PNG"
    with pytest.raises(FileNotFoundError):
        world.save_png(tmp_path / "missing" / "world.png")
    with pytest.raises(fw.Error, match="width must be 16 to 4096 pixels, given 1"):
        world.png(width=1)
    with pytest.raises(fw.Error, match="view must be a low and a high corner"):
        world.png(view=(np.ones(fwd.dim), np.ones(fwd.dim)))


@pytest.mark.parametrize("color", ["material", "strain", "damage", "piece"])
def test_plot_draws_into_axes(fwd, color):
    world, _, _ = torn_world(fwd)
    turn = 0.3 if fwd.dim == 2 else (0.3, 0, 0)
    half = np.full(fwd.dim, 0.1)
    shapes = [
        fwd.Shape.box(half, vector(fwd.dim, 2, 0), turn),
        fwd.Shape.capsule(vector(fwd.dim, 2, 1), vector(fwd.dim, 3, 1), 0.1),
    ]
    for shape in shapes:
        world.add_rigid_body(fwd.RigidBody.fixed(shape))
    ax = world.plot(color=color)
    assert len(ax.collections) + len(ax.patches) > 3
    assert world.plot(ax, color=color) is ax
    assert ax.get_xlim()[1] > 3
    ax.figure.canvas.draw()
    plt.close(ax.figure)


def test_plot_of_an_empty_world(fwd):
    ax = fwd.World().plot()
    ax.figure.canvas.draw()
    plt.close(ax.figure)


def test_plot_rejects_unknown_colours_and_flat_axes(fwd):
    with pytest.raises(fw.Error, match="color must be one of .*, given 'heat'"):
        fwd.World().plot(color="heat")
    if fwd.dim == 3:
        figure, ax = plt.subplots()
        with pytest.raises(fw.Error, match="3d"):
            fwd.World().plot(ax)
        plt.close(figure)


def test_plot_says_what_is_missing(fwd, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    with pytest.raises(ImportError, match="requires matplotlib: install it with"):
        fwd.World().plot()

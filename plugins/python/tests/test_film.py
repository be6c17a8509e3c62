"""Films, and pictures as arrays."""

import base64
import io
import shutil
import sys

import fuwafuwa as fw
import matplotlib.pyplot as plt
import numpy as np
import pytest
from conftest import floor_world, torn_world, vector

Image = pytest.importorskip("PIL.Image", reason="matplotlib brings Pillow, which reads the GIF files")


def frames_of(gif):
    """Return the frames of a GIF file as arrays, and their durations [s]."""
    image = Image.open(io.BytesIO(gif))
    frames, seconds = [], []
    for index in range(image.n_frames):
        image.seek(index)
        frames.append(np.asarray(image.convert("RGB")))
        seconds.append(image.info["duration"] / 1000)
    return frames, seconds


def test_rgb_has_the_pixels_of_the_png(fwd):
    world, _, _ = torn_world(fwd)
    for options in ({}, {"elements": True}, {"width": 50, "view": (np.full(fwd.dim, -1), np.full(fwd.dim, 2))}):
        rgb = world.rgb(**options)
        png = plt.imread(io.BytesIO(world.png(**options)))
        assert rgb.dtype == np.uint8 and rgb.shape == (*png.shape[:2], 3) and rgb.shape[1] == options.get("width", 480)
        np.testing.assert_array_equal(rgb, np.rint(png[..., :3] * 255))
        assert (png[..., 3] == 1).all()


def test_default_view_shows_all_bodies(fwd):
    world, ball, hand = torn_world(fwd)
    low, high = world.view
    for points in (world[ball].surface_positions, np.array(world[hand].shape.bounds)):
        assert (points > low).all() and (points < high).all()
    np.testing.assert_array_equal(world.rgb(), world.rgb(view=world.view))


def test_film_shows_a_fall_at_the_right_speed(fwd):
    world = fwd.World()
    world.add_rigid_body(fwd.RigidBody.dynamic(fwd.Shape.ball(0.2), 1.0, position=vector(fwd.dim, 0, 0)))
    film = fw.Film(fps=25, width=64, view=(vector(fwd.dim, -3, -6, -3), vector(fwd.dim, 3, 1, 3)))
    film.record(world, 1.0)
    assert world.ticks == 60 and len(film) == 25 and film.seconds == 1
    frames, seconds = frames_of(film.gif())
    assert len(frames) == 25 and sum(seconds) == pytest.approx(1)
    assert frames[0].shape == film[0].shape == world.rgb(width=64, view=film._view).shape
    np.testing.assert_array_equal(film[-1], world.rgb(width=64, view=film._view))

    def height(frame):
        """Return the mean row of the ball: of the pixels that differ from the median of all frames."""
        rows = np.nonzero(np.abs(frame.astype(int) - background).max(axis=2) > 60)[0]
        return rows.mean()

    background = np.median(np.stack(list(film)), axis=0)
    fallen = [height(film[index]) - height(film[4]) for index in (9, 14, 24)]
    # Free fall: the distance grows with the square of the time, (frame + 1) / 25 s.
    expected = [(index + 1) ** 2 - 5**2 for index in (9, 14, 24)]
    np.testing.assert_allclose(np.array(fallen[:2]) / fallen[2], np.array(expected[:2]) / expected[2], atol=0.03)


def test_record_calls_the_function_before_each_tick(fwd):
    world = floor_world(fwd)
    ticks = []
    fw.Film(width=16).record(world, 0.2, lambda world: ticks.append(world.ticks))
    assert ticks == list(range(12))


@pytest.mark.parametrize("fps", [24, 30, 50, 60, 240])
def test_gif_keeps_the_duration(fps):
    film = fw.Film(fps=fps)
    for shade in range(fps):
        film.add(np.full((4, 6, 3), shade, np.uint8))
    frames, seconds = frames_of(film.gif())
    assert sum(seconds) == pytest.approx(1, abs=0.021) and min(seconds) >= 0.02
    assert frames[-1].max() == fps - 1, "the last frame stays"


def test_gif_keeps_the_colours():
    image = np.zeros((20, 30, 3), np.uint8)
    image[:10] = (250, 10, 10)
    image[:, 15:] = (10, 10, 250)
    film = fw.Film()
    film.add(image)
    film.add(image[::-1])
    frames, _ = frames_of(film.gif())
    np.testing.assert_array_equal(frames[0], image)
    np.testing.assert_array_equal(frames[1], image[::-1])


def test_notebook_shows_the_film(fwd):
    film = fw.Film(width=32)
    assert "without frames" in film._repr_html_()
    film.record(floor_world(fwd), 0.1)
    data = film._repr_html_().removeprefix('<img src="data:image/gif;base64,').removesuffix('">')
    assert base64.b64decode(data) == film.gif()
    assert "3 frames" in repr(film)


def test_film_is_saved(fwd, tmp_path):
    film = fw.Film(width=33)
    film.record(floor_world(fwd), 0.1)
    film.save(tmp_path / "film.GIF")
    assert (tmp_path / "film.GIF").read_bytes() == film.gif()
    with pytest.raises(FileNotFoundError):
        film.save(tmp_path / "missing" / "film.gif")


def test_mp4_has_the_frames(tmp_path):
    imageio_ffmpeg = pytest.importorskip("imageio_ffmpeg")
    film = fw.Film(fps=20)
    for shade in range(0, 200, 20):
        film.add(np.full((33, 51, 3), shade, np.uint8))
    path = tmp_path / "film.mp4"
    film.save(path)
    count, seconds = imageio_ffmpeg.count_frames_and_secs(str(path))
    assert count == 10 and seconds == pytest.approx(0.5, abs=0.05)
    reader = imageio_ffmpeg.read_frames(str(path))
    assert next(reader)["size"] == (52, 34), "the size of a film is even"
    for shade, frame in zip(range(0, 200, 20), reader, strict=True):
        pixels = np.frombuffer(frame, np.uint8).reshape(34, 52, 3)[:33, :51]
        np.testing.assert_allclose(pixels[5:-5, 5:-5], shade, atol=4)
    with pytest.raises(FileNotFoundError):
        film.save(tmp_path / "missing" / "film.mp4")


def test_mp4_says_what_is_missing(tmp_path, monkeypatch):
    film = fw.Film()
    film.add(np.zeros((4, 4, 3), np.uint8))
    monkeypatch.setattr(shutil, "which", lambda name: None)
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(ImportError, match=r"requires ffmpeg: install it with `pip install fuwafuwa\[film\]`"):
        film.save(tmp_path / "film.mp4")


@pytest.mark.skipif(sys.platform == "win32", reason="the false ffmpeg is a program of POSIX")
def test_mp4_reports_the_error_of_ffmpeg(tmp_path, monkeypatch):
    film = fw.Film()
    film.add(np.zeros((4, 4, 3), np.uint8))
    program = tmp_path / "ffmpeg"
    program.write_text("#!/bin/sh\necho no encoder >&2\nexit 1\n")
    program.chmod(0o755)
    monkeypatch.setattr(shutil, "which", lambda name: str(program))
    with pytest.raises(fw.Error, match="ffmpeg could not write .*film.mp4': no encoder"):
        film.save(tmp_path / "film.mp4")


def test_film_rejects_other_frames(fwd):
    film = fw.Film()
    for fps in (0, float("nan"), 1000):
        with pytest.raises(fw.Error, match="fps must be 1 to 240, given"):
            fw.Film(fps=fps)
    with pytest.raises(fw.Error, match="needs at least one frame"):
        film.gif()
    with pytest.raises(fw.Error, match="must end in .gif or .mp4, given 'film.avi'"):
        film.save("film.avi")
    for wrong in (
        np.zeros((4, 4), np.uint8),
        np.zeros((4, 4, 4), np.uint8),
        np.zeros((4, 4, 3)),
        np.zeros((0, 4, 3), np.uint8),
    ):
        with pytest.raises(fw.Error, match=r"frame must be a uint8 array of shape \(height, width, 3\), given"):
            film.add(wrong)
    with pytest.raises(TypeError, match="a frame must be a World2, a World3 or an array, given str"):
        film.add("frame")
    film.add(np.zeros((4, 5, 3), np.uint8))
    with pytest.raises(fw.Error, match=r"the shape \(4, 5, 3\) of the first frame, given \(5, 5, 3\)"):
        film.add(np.zeros((5, 5, 3), np.uint8))
    for seconds in (-1, float("nan"), float("inf")):
        with pytest.raises(fw.Error, match="seconds must be 0 or more, and finite"):
            film.record(fwd.World(), seconds)
    assert len(film) == 1

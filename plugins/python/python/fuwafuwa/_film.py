"""Films of worlds: GIF without other packages, MP4 with ffmpeg."""

from __future__ import annotations

import base64
import shutil
import subprocess
import zlib
from collections.abc import Callable, Iterator
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._core import Error, World2, World3, _gif

#: Shortest time for which a browser shows a frame of a GIF [1/100 s]. Browsers show shorter frames for 1/10 s.
_SHORTEST_HUNDREDTHS = 2


class Film:
    """Frames of a world, for a GIF or an MP4 file. A notebook shows a film as a GIF.

    - fps: frames per second of the film, 1 to 240, default 30. Ticks are 1/60 s, so a frame after every second tick of
      a world gives a film in real time.
    - width of the frames [pixels], 16 to 4096, default 480
    - view: low and high corner of the visible region [m]. By default, the first frame decides: it shows all bodies,
      and all later frames show the same region.
    - elements: whether the elements are shown instead of the surface

    The frames are kept compressed.
    """

    def __init__(
        self,
        *,
        fps: float = 30.0,
        width: int = 480,
        view: tuple[ArrayLike, ArrayLike] | None = None,
        elements: bool = False,
    ) -> None:
        self._fps = float(fps)
        if not 1 <= self._fps <= 240:
            raise Error(f"fps must be 1 to 240, given {fps!r}")
        self._width = width
        self._view = view
        self._elements = elements
        self._shape: tuple[int, ...] | None = None
        self._frames: list[bytes] = []

    @property
    def fps(self) -> float:
        """Frames per second."""
        return self._fps

    @property
    def seconds(self) -> float:
        """Duration [s]."""
        return len(self) / self._fps

    def add(self, frame: World2 | World3 | NDArray[np.uint8]) -> None:
        """Add a frame: the present state of a world, or an image as a uint8 array (height, width, 3).

        All frames must have the size of the first one.
        """
        if isinstance(frame, (World2, World3)):
            if self._view is None:
                self._view = frame.view
            frame = frame.rgb(view=self._view, width=self._width, elements=self._elements)
        if not isinstance(frame, np.ndarray):
            raise TypeError(f"a frame must be a World2, a World3 or an array, given {type(frame).__name__}")
        if frame.dtype != np.uint8 or frame.ndim != 3 or frame.shape[2] != 3 or 0 in frame.shape:
            raise Error(
                "frame must be a uint8 array of shape (height, width, 3), "
                f"given {frame.dtype} of shape {list(frame.shape)}"
            )
        if self._shape not in (None, frame.shape):
            raise Error(f"frame must have the shape {self._shape} of the first frame, given {frame.shape}")
        self._shape = frame.shape
        self._frames.append(zlib.compress(frame.tobytes(), 1))

    def record(
        self,
        world: World2 | World3,
        seconds: float,
        act: Callable[[World2 | World3], object] | None = None,
    ) -> None:
        """Step a world for a time [s] and add its frames in real time.

        act: function that is called with the world before each tick, for example to set targets.
        """
        if not 0 <= seconds < float("inf"):
            raise Error(f"seconds must be 0 or more, and finite, given {seconds!r}")
        frames = 0
        for tick in range(1, round(seconds / world.tick) + 1):
            if act is not None:
                act(world)
            world.step()
            # The length of a tick is rounded to single precision.
            due = int(tick * world.tick * self._fps + 1e-3)
            while frames < due:
                self.add(world)
                frames += 1

    def __len__(self) -> int:
        return len(self._frames)

    def __getitem__(self, index: int, /) -> NDArray[np.uint8]:
        """Return a frame: uint8 array (height, width, 3)."""
        pixels = np.frombuffer(zlib.decompress(self._frames[index]), np.uint8)
        assert self._shape is not None
        return pixels.reshape(self._shape)

    def __iter__(self) -> Iterator[NDArray[np.uint8]]:
        return (self[index] for index in range(len(self)))

    def gif(self) -> bytes:
        """Return the film as a GIF file that repeats forever.

        A GIF has at most 50 frames per second and 256 colours per frame. Of a faster film, frames are left out.
        """
        self._require_frames()
        return _gif(self._timed_frames())

    def _timed_frames(self) -> Iterator[tuple[NDArray[np.uint8], int]]:
        """Yield the frames of a GIF, each with its duration [1/100 s]."""
        start = 0
        for index in range(len(self)):
            end = round(100 * (index + 1) / self._fps)
            is_last = index == len(self) - 1
            if is_last or end - start >= _SHORTEST_HUNDREDTHS:
                yield self[index], max(end - start, _SHORTEST_HUNDREDTHS)
                start = end

    def save(self, path: str | PathLike[str]) -> None:
        """Write the film into a file. The name ends in .gif, or in .mp4, which needs ffmpeg.

        Raises ImportError without ffmpeg.
        """
        path = Path(path)
        suffix = path.suffix.lower()
        if suffix == ".gif":
            path.write_bytes(self.gif())
        elif suffix == ".mp4":
            self._save_mp4(path)
        else:
            raise Error(f"path must end in .gif or .mp4, given {str(path)!r}")

    def _save_mp4(self, path: Path) -> None:
        program = _ffmpeg()
        self._require_frames()
        assert self._shape is not None
        height, width, _ = self._shape
        # The usual colour format of films has an even width and height.
        even = "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white"
        command = [program, "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24"]
        command += ["-s", f"{width}x{height}", "-r", f"{self._fps}", "-i", "-"]
        command += ["-vf", even, "-c:v", "libx264", "-crf", "20", "-pix_fmt", "yuv420p", "-movflags", "+faststart"]
        command += ["-f", "mp4", str(path.absolute())]
        with path.open("wb"):
            pass  # raises the usual error if the file cannot be written
        with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            assert process.stdin is not None and process.stderr is not None
            try:
                for frame in self:
                    process.stdin.write(frame.tobytes())
                process.stdin.close()
            except BrokenPipeError:
                pass  # ffmpeg has ended; its message says why
            message = process.stderr.read().decode(errors="replace").strip()
        if process.returncode != 0:
            raise Error(f"ffmpeg could not write {str(path)!r}: {message}")

    def _require_frames(self) -> None:
        if not self._frames:
            raise Error("a film needs at least one frame: call add() or record() first")

    def _repr_html_(self) -> str:
        if not self._frames:
            return "<p>film without frames</p>"
        return f'<img src="data:image/gif;base64,{base64.b64encode(self.gif()).decode()}">'

    def __repr__(self) -> str:
        size = "" if self._shape is None else f" of {self._shape[1]} × {self._shape[0]} pixels"
        return f"<Film: {len(self)} frames{size}, {self.seconds:.2f} s>"


def _ffmpeg() -> str:
    """Return the path of ffmpeg: the one on the PATH, or that of imageio-ffmpeg."""
    found = shutil.which("ffmpeg")
    if found is not None:
        return found
    try:
        import imageio_ffmpeg  # type: ignore[import-not-found,import-untyped]
    except ImportError as error:
        raise ImportError(
            "an MP4 file requires ffmpeg: install it with `pip install fuwafuwa[film]`, or put ffmpeg on the PATH; "
            "a GIF file needs nothing"
        ) from error
    program: Any = imageio_ffmpeg.get_ffmpeg_exe()
    return str(program)

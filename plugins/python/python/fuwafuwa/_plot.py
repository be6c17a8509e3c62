"""Pictures of worlds with matplotlib, which is an optional dependency."""

from __future__ import annotations

from typing import Any

import numpy as np

_COLOURS = ("material", "strain", "damage", "piece")
#: Labels of the colours that have a scale.
_SCALES = {"strain": "strain", "damage": "damage; nodes split at 1"}
#: Corners of a face or block, in the order around it.
_ROUND = [0, 1, 3, 2]
_OBSTACLE = "#8d8d8d"
_HAND = "#4a6fa5"


def plot(
    world: Any,
    ax: Any,
    color: str,
    cmap: str,
    vmin: float | None,
    vmax: float | None,
) -> Any:
    """Draw a world into axes of matplotlib, and return the axes."""
    from ._core import Error

    if color not in _COLOURS:
        names = ", ".join(repr(name) for name in _COLOURS)
        raise Error(f"color must be one of {names}, given {color!r}")
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise ImportError(
            "World.plot() requires matplotlib: install it with `pip install fuwafuwa[plot]`; "
            "World.png() and World.save_png() need nothing"
        ) from error
    is_flat = len(world.gravity) == 2
    is_own = ax is None
    if is_own:
        projection = None if is_flat else "3d"
        _, ax = plt.subplots(subplot_kw={"projection": projection})
    elif not is_flat and not hasattr(ax, "set_zlim"):
        raise Error('ax must be axes with projection="3d" for a World3, given 2D axes')
    low = 0.0 if vmin is None else vmin
    high = _highest(world, color) if vmax is None else vmax
    draw = _plane if is_flat else _space
    draw(world, ax, color, plt.get_cmap(cmap), low, high)
    if is_own and color in _SCALES:
        scale = plt.cm.ScalarMappable(plt.Normalize(low, high), cmap)
        ax.figure.colorbar(scale, ax=ax, label=_SCALES[color], shrink=0.7)
    return ax


def _highest(world: Any, color: str) -> float:
    """Return the value at the upper end of the scale: 1 for damage, otherwise the largest value of all bodies."""
    if color == "strain":
        highest = (float(world[handle].strain.max(initial=0.0)) for handle in world.soft_bodies)
        return max(highest, default=0.0) or 1e-6
    return 1.0


def _values(body: Any, color: str) -> np.ndarray:
    """Return the value of each element that decides its colour."""
    if color == "strain":
        return body.strain
    if color == "piece":
        return body.element_pieces.astype(np.float32)
    if color == "damage":
        elements = body.elements
        damage = np.where(elements >= 0, body.damage[elements], 0.0)
        return damage.max(axis=1)
    return body.element_materials.astype(np.float32)


def _face_colours(body: Any, owners: np.ndarray, color: str, cmap: Any, low: float, high: float) -> np.ndarray:
    values = _values(body, color)[owners]
    if color in ("material", "piece"):
        import matplotlib.pyplot as plt

        return plt.get_cmap("tab10")(values.astype(int) % 10)
    return cmap(np.clip((values - low) / max(high - low, 1e-12), 0.0, 1.0))


def _rigid_colour(body: Any) -> str:
    return _HAND if body.motion["type"] in ("coupled", "kinematic") else _OBSTACLE


def _plane(world: Any, ax: Any, color: str, cmap: Any, vmin: float, vmax: float) -> None:
    from matplotlib.collections import LineCollection, PolyCollection

    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for handle in world.soft_bodies:
        body = world[handle]
        corners, owners = body.cells()
        if len(corners) == 0:
            continue
        colours = _face_colours(body, owners, color, cmap, vmin, vmax)
        # The edge has the colour of the face and closes the seams between blocks.
        ax.add_collection(PolyCollection(corners[:, _ROUND], facecolors=colours, edgecolors=colours, linewidths=0.3))
        for torn, line_colour in ((False, "black"), (True, "crimson")):
            lines = []
            for outline in body.outlines():
                points = outline["points"]
                segments = np.stack([points, np.roll(points, -1, axis=0)], axis=1)
                lines.extend(segments[outline["torn"] == torn])
            ax.add_collection(LineCollection(lines, colors=line_colour, linewidths=0.8))
        low = np.minimum(low, corners.min(axis=(0, 1)))
        high = np.maximum(high, corners.max(axis=(0, 1)))
    unbounded = []
    for handle in world.rigid_bodies:
        body = world[handle]
        if body.is_sensor:
            continue
        shape = body.shape
        if shape.parameters["kind"] == "half_space":
            unbounded.append(body)
            continue
        for patch in _patches(shape):
            patch.set_facecolor(_rigid_colour(body))
            ax.add_patch(patch)
        bounds = shape.bounds
        low, high = np.minimum(low, bounds[0]), np.maximum(high, bounds[1])
    if not np.all(low <= high):
        low, high = np.full(2, -1.0), np.full(2, 1.0)
    margin = 0.1 * float(np.max(high - low))
    low, high = low - margin, high + margin
    for body in unbounded:
        polygon = _below_plane(body.shape.parameters, low, high)
        if len(polygon) > 2:
            ax.add_collection(PolyCollection([polygon], facecolors=_rigid_colour(body), zorder=0.5))
    ax.set_xlim(low[0], high[0])
    ax.set_ylim(low[1], high[1])
    ax.set_aspect("equal")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")


def _patches(shape: Any) -> list[Any]:
    """Return the patches of a bounded shape of the plane."""
    from matplotlib.patches import Circle, Polygon

    parameters = shape.parameters
    if parameters["kind"] == "ball":
        return [Circle(parameters["centre"], parameters["radius"])]
    if parameters["kind"] == "capsule":
        start, end, radius = parameters["from"], parameters["to"], parameters["radius"]
        along = (end - start) / max(float(np.linalg.norm(end - start)), 1e-12)
        side = radius * np.array([-along[1], along[0]])
        band = Polygon([start + side, end + side, end - side, start - side])
        return [Circle(start, radius), Circle(end, radius), band]
    half, angle = parameters["half"], parameters["rotation"]
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * half
    cosine, sine = np.cos(angle), np.sin(angle)
    turned = corners @ np.array([[cosine, sine], [-sine, cosine]])
    return [Polygon(turned + parameters["centre"])]


def _below_plane(parameters: dict[str, Any], low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return the part of the visible rectangle that lies inside a half-space."""
    corners = np.array([low, [high[0], low[1]], high, [low[0], high[1]]])
    heights = corners @ parameters["normal"] - parameters["offset"]
    inside = []
    for index in range(4):
        here, there = corners[index], corners[(index + 1) % 4]
        height, next_height = heights[index], heights[(index + 1) % 4]
        if height <= 0:
            inside.append(here)
        if (height <= 0) != (next_height <= 0):
            inside.append(here + (there - here) * height / (height - next_height))
    return np.array(inside)


def _space(world: Any, ax: Any, color: str, cmap: Any, vmin: float, vmax: float) -> None:
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    # Axes of matplotlib have z upwards, those of the engine have y.
    swap = [0, 2, 1]
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    light = np.array([0.4, 0.8, 0.45])
    for handle in world.soft_bodies:
        body = world[handle]
        nodes, owners, _ = body.facets()
        if len(nodes) == 0:
            continue
        corners = body.surface_positions[nodes]
        normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
        shade = 0.55 + 0.45 * np.clip(normals @ light, 0.0, 1.0)
        colours = _face_colours(body, owners, color, cmap, vmin, vmax)
        colours[:, :3] *= shade[:, None]
        ax.add_collection3d(
            Poly3DCollection(corners[:, :, swap], facecolors=colours, edgecolors=colours, linewidths=0.2)
        )
        low = np.minimum(low, corners.min(axis=(0, 1)))
        high = np.maximum(high, corners.max(axis=(0, 1)))
    for handle in world.rigid_bodies:
        body = world[handle]
        parameters = body.shape.parameters
        if body.is_sensor or parameters["kind"] == "half_space":
            continue
        faces = _faces(body.shape)
        ax.add_collection3d(Poly3DCollection(faces[:, :, swap], facecolors=_rigid_colour(body), alpha=0.7))
        bounds = body.shape.bounds
        low, high = np.minimum(low, bounds[0]), np.maximum(high, bounds[1])
    if not np.all(low <= high):
        low, high = np.full(3, -1.0), np.full(3, 1.0)
    margin = 0.05 * float(np.max(high - low))
    low, high = low - margin, high + margin
    ax.set_xlim(low[0], high[0])
    ax.set_ylim(high[2], low[2])
    ax.set_zlim(low[1], high[1])
    ax.set_box_aspect((high - low)[swap])
    ax.set_xlabel("x [m]")
    ax.set_ylabel("z [m]")
    ax.set_zlabel("y [m]")


def _faces(shape: Any) -> np.ndarray:
    """Return quads that cover the surface of a bounded shape of space."""
    parameters = shape.parameters
    if parameters["kind"] == "box":
        half, turn, centre = parameters["half"], parameters["rotation"], parameters["centre"]
        faces = []
        for axis in range(3):
            for side in (-1.0, 1.0):
                around = []
                for first, second in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                    corner = np.zeros(3)
                    corner[axis], corner[axis - 2], corner[axis - 1] = side, first, second
                    around.append(corner * half)
                faces.append(around)
        imaginary, real = turn[:3], turn[3]
        corners = np.array(faces)
        across = 2.0 * np.cross(imaginary, corners)
        return corners + real * across + np.cross(imaginary, across) + centre
    if parameters["kind"] == "ball":
        start = end = parameters["centre"]
    else:
        start, end = parameters["from"], parameters["to"]
    # A sphere, of which one half moves along the axis of the capsule.
    length = float(np.linalg.norm(end - start))
    pole = (end - start) / length if length > 0 else np.array([0.0, 1.0, 0.0])
    first = np.cross(pole, [1.0, 0.0, 0.0] if abs(pole[0]) < 0.9 else [0.0, 1.0, 0.0])
    first /= np.linalg.norm(first)
    second = np.cross(pole, first)
    latitude = np.linspace(-np.pi / 2, np.pi / 2, 10)
    longitude = np.linspace(0.0, 2 * np.pi, 17)
    ring = np.cos(longitude)[:, None] * first + np.sin(longitude)[:, None] * second
    sphere = np.sin(latitude)[:, None, None] * pole + np.cos(latitude)[:, None, None] * ring
    points = parameters["radius"] * sphere + np.where(latitude[:, None, None] < 0, start, end)
    quads = [points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]]
    return np.stack(quads, axis=2).reshape(-1, 4, 3)

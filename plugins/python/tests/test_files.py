"""Pictures, models, scans and scenes."""

import gzip
import struct
import zlib

import numpy as np
import pytest

import fuwafuwa as fw


def png(pixels):
    """Encode an array of red, green, blue and alpha as a PNG file."""

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    height, width, _ = pixels.shape
    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    chunks = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + chunks


def letter():
    """Return the picture of an L, as a sprite: the foot is in the lowest row."""
    pixels = np.zeros((5, 3, 4), np.uint8)
    pixels[:, 0] = (200, 0, 0, 255)
    pixels[4, :] = (0, 0, 200, 255)
    return pixels


def test_top_row_of_a_picture_is_the_highest(tmp_path):
    path = tmp_path / "letter.png"
    path.write_bytes(png(letter()))
    for source in (path, str(path), path.read_bytes()):
        grid = fw.VoxelGrid2.picture(source, voxel_size=0.1)
        expected = (letter()[::-1, :, 3] > 0).T
        np.testing.assert_array_equal(grid.array, expected)
    colours = {(255, 0, 0): 1, (0, 0, 255): 2}
    grid = fw.VoxelGrid2.pixels(path, voxel_size=0.1, colours=colours)
    assert grid.array[2, 0] == 2 and grid.array[0, 4] == 1 and grid.array[2, 4] == 0


def test_model_round_trip_keeps_voxels():
    array = np.zeros((3, 4, 5), np.uint8)
    array[:, 0, :] = 1
    array[0, :, 0] = 2
    model = fw.VoxelGrid3(array, 0.1).to_vox([(255, 0, 0), (0, 0, 255)])
    grid = fw.VoxelGrid3.vox(model, voxel_size=0.1, colours={1: 1, 2: 2})
    np.testing.assert_array_equal(grid.array, array)
    np.testing.assert_array_equal(fw.VoxelGrid3.vox(model).array, array)
    with pytest.raises(fw.Error, match="bytes"):
        fw.VoxelGrid3.vox(model[:30])


def nifti(values, spacing):
    """Encode an array [x, y, z] of uint8 as a NIfTI-1 file in the coordinates of the patient."""
    header = bytearray(348)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, *values.shape, 1, 1, 1, 1)
    struct.pack_into("<hh", header, 70, 2, 8)
    struct.pack_into("<8f", header, 76, 1, spacing, spacing, spacing, 1, 1, 1, 1)
    struct.pack_into("<f", header, 108, 352)
    struct.pack_into("<f", header, 112, 1)
    header[123] = 2
    struct.pack_into("<h", header, 254, 1)
    for axis in range(3):
        row = [0.0] * 4
        row[axis] = spacing
        struct.pack_into("<4f", header, 280 + 16 * axis, *row)
    header[344:348] = b"n+1\0"
    return bytes(header) + bytes(4) + values.tobytes(order="F")


def test_scan_becomes_a_grid_in_metres():
    values = np.zeros((20, 20, 40), np.uint8)
    values[5:15, 5:15, 5:35] = 1
    values[5:15, 5:15, 25:35] = 2
    file = nifti(values, 2.0)
    for source in (file, gzip.compress(file)):
        grid = fw.VoxelGrid3.nifti(source, labels={1: 1, 2: 2}, resolution=32)
        solid = np.argwhere(grid.array > 0)
        extent = (np.ptp(solid, axis=0) + 1) * grid.voxel_size
        np.testing.assert_allclose(extent, [0.02, 0.06, 0.02], atol=0.004)
        upper = np.argwhere(grid.array == 2)[:, 1].mean()
        assert upper > np.argwhere(grid.array == 1)[:, 1].mean(), "the head is up"
    grid = fw.VoxelGrid3.nifti(file, thresholds=[(0.5, 3.0, 1)], resolution=16)
    assert set(np.unique(grid.array)) == {0, 1}
    with pytest.raises(TypeError):
        fw.VoxelGrid3.nifti(file, labels={1: 1}, thresholds=[(0, 1, 1)])
    with pytest.raises(fw.Error, match="no voxel has a material"):
        fw.VoxelGrid3.nifti(file, labels={7: 1})
    with pytest.raises(fw.Error, match="8..=256"):
        fw.VoxelGrid3.nifti(file, labels={1: 1}, resolution=4)


# The text of a scene has at most 1 MiB, which the many bodies of a pile exceed.
@pytest.mark.parametrize("name", sorted(set(fw.Scene.names()) - {"pile", "pile-3d"}))
def test_scene_of_a_world_builds_the_same_world(name):
    scene = fw.Scene.read(name)
    world = scene.build()
    assert isinstance(world, fw.World2 if scene.dim == 2 else fw.World3)
    text = world.to_scene().text()
    assert fw.Scene.from_text(text).build().hash() == world.hash()
    before = world.hash()
    world.step(2)
    assert world.hash() != before


def test_scene_moves_its_hands():
    scene = fw.Scene.read("tear", ["body.n=16"])
    world = scene.build()
    split = 0
    for tick in range(scene.ticks):
        scene.set_hand_targets(world, tick)
        split += world.step().nodes_split
    assert split > 0
    assert scene.hand_targets(0).shape[1] == 2
    with pytest.raises(TypeError, match="takes a World2"):
        scene.set_hand_targets(fw.World3(), 0)


def test_scene_errors_name_the_line_and_the_field(tmp_path):
    path = tmp_path / "wrong.toml"
    path.write_text('dim = 2\n[[body]]\nshape = "blob"\n')
    with pytest.raises(fw.Error, match="wrong.toml"):
        fw.Scene.read(path).build()
    with pytest.raises(fw.Error, match="line 1"):
        fw.Scene.from_text("dim = ?")

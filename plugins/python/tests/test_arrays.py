"""Arrays of bodies, and the orientation of grids."""

import numpy as np
import pytest
from conftest import floor_world, torn_world, vector

import fuwafuwa as fw


def letter(dim):
    """Return an L: a tall stem at low x, with a foot along x. In 3D only at low z."""
    array = np.zeros((3, 5, 2)[:dim], np.uint8)
    array[0, :, ...] = 1
    array[:, 0, ...] = 2
    if dim == 3:
        array[:, :, 1] = 0
    return array


@pytest.mark.parametrize("order", ["C", "F", "strided"])
def test_array_axes_are_those_of_positions(fwd, order):
    array = letter(fwd.dim)
    if order == "strided":
        array = np.repeat(array, 2, axis=0)[::2]
    else:
        array = np.asarray(array, order=order)
    grid = fwd.VoxelGrid(array, 0.1)
    assert grid.size == array.shape
    np.testing.assert_array_equal(grid.array, array)
    body = fwd.SoftBody(grid, [fw.Material(), fw.Material(density=200.0)])
    extent = np.ptp(body.positions, axis=0)
    np.testing.assert_allclose(extent, [0.3, 0.5, 0.1][: fwd.dim], rtol=1e-6)
    foot = body.positions[body.positions[:, 0] > 0.15]
    assert foot[:, 1].max() < 0.11, "the foot lies at low y"
    second = body.rest_positions[np.unique(body.elements[body.element_materials == 2])[1:]]
    assert second[:, 1].max() < 0.11, "material 2 is at low y"


def test_image_becomes_an_array_as_documented():
    image = np.array([[0, 1, 0], [0, 1, 0], [0, 1, 1]], np.uint8)
    body = fw.SoftBody2.from_array(image[::-1].T, 1.0)
    foot = body.positions[body.positions[:, 0] > 2.5]
    assert foot[:, 1].max() == 1.0, "the last row of the image is at the bottom"


def test_arrays_agree_with_each_other(fwd):
    world, ball, _ = torn_world(fwd)
    body = world[ball]
    n, m, d = body.node_count, body.element_count, fwd.dim
    for name in ("positions", "velocities", "rest_positions", "surface_positions"):
        array = getattr(body, name)
        assert array.shape == (n, d) and array.dtype == np.float32, name
    for name in ("damage", "node_masses", "fixed", "node_pieces", "node_ids"):
        assert getattr(body, name).shape == (n,), name
    for name in ("strain", "levels", "element_pieces", "element_materials", "plastic_strain", "elastic_energy"):
        assert getattr(body, name).shape == (m,), name
    elements = body.elements
    assert elements.shape == (m, 3**d) and elements.min() == -1 and elements.max() == n - 1
    assert set(np.unique(elements)) == set(range(-1, n)), "each node carries an element"
    pieces = np.where(elements >= 0, body.node_pieces[elements], body.element_pieces[:, None])
    assert (pieces == body.element_pieces[:, None]).all(), "an element and its nodes are in one piece"
    summary = body.pieces()
    masses = np.bincount(body.node_pieces, body.node_masses, len(summary["mass"]))
    np.testing.assert_allclose(summary["mass"], masses, rtol=1e-5)
    assert body.piece_count == len(masses) > 1
    np.testing.assert_allclose(body.node_masses.sum(), body.mass, rtol=1e-5)
    centre = (body.positions * body.node_masses[:, None]).sum(axis=0) / body.mass
    np.testing.assert_allclose(body.centre_of_mass, centre, rtol=1e-4)
    assert (body.damage >= 0).all() and body.damage.max() > 0.5


def test_cells_fill_the_volume_of_the_undeformed_body(fwd):
    body = fwd.SoftBody.ball(12)
    corners, owners = body.cells()
    assert corners.shape[1:] == (2**fwd.dim, fwd.dim)
    volume = np.prod(np.ptp(corners, axis=1), axis=1).sum()
    assert volume == pytest.approx(body.grid.solid_count * body.grid.voxel_size**fwd.dim, rel=1e-5)
    assert set(owners) == set(range(body.element_count))


def test_facets_have_outward_corners(fwd):
    body = fwd.SoftBody.ball(12)
    nodes, owners, torn = body.facets()
    assert nodes.shape == (len(owners), 2 ** (fwd.dim - 1)) and not torn.any()
    corners = body.positions[nodes]
    if fwd.dim == 2:
        along = corners[:, 1] - corners[:, 0]
        normals = np.stack([along[:, 1], -along[:, 0]], axis=1)
    else:
        normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    outward = corners.mean(axis=1) - body.centre_of_mass
    assert ((normals * outward).sum(axis=1) > 0).all()


def test_outline_of_a_ring_has_two_lines():
    outlines = fw.SoftBody2(fw.VoxelGrid2.ring(24)).outlines()
    assert len(outlines) == 2
    assert all(outline["points"].shape == (len(outline["nodes"]), 2) for outline in outlines)
    assert fw.SoftBody3.ball(8).outlines() == []


def test_arrays_are_copies(fwd):
    world = floor_world(fwd)
    ball = world.add_soft_body(fwd.SoftBody.ball(8).translated(vector(fwd.dim, 0, 1)))
    before = world[ball].positions
    kept = before.copy()
    world.step(10)
    np.testing.assert_array_equal(before, kept)
    before[:] = 7
    assert world[ball].positions.max() < 7


def test_fixed_nodes_stay_and_their_force_is_the_weight(fwd):
    world = fwd.World()
    body = fwd.SoftBody.cube(8, 1.0, fw.Material(young=1e5, mass_damping=30.0, strength=float("inf")))
    body.fix_nodes(body.positions[:, 1] > 0.99)
    block = world.add_soft_body(body)
    kept = world[block].positions[world[block].fixed]
    world.step(240)
    np.testing.assert_array_equal(world[block].positions[world[block].fixed], kept)
    middle, half = np.full(fwd.dim, 0.5), np.full(fwd.dim, 2.0)
    force = world.fixed_node_reaction(block, fwd.Shape.box(half, middle))["force"]
    assert force[1] == pytest.approx(9.81 * body.mass, rel=0.02)
    world[block].free_nodes(np.flatnonzero(world[block].fixed))
    assert not world[block].fixed.any()
    world.step(10)
    assert world.velocity(block)[0][1] < -1


def test_set_node_states_stretches_a_body(fwd):
    body = fwd.SoftBody.cube(6)
    stretched = body.positions * np.array([1.1, 1.0, 1.0][: fwd.dim])
    body.set_node_states(positions=stretched)
    np.testing.assert_allclose(body.strain, 0.1, atol=1e-4)
    expected = np.eye(fwd.dim)
    expected[0, 0] = 1.1
    np.testing.assert_allclose(body.deformation, np.broadcast_to(expected, body.deformation.shape), atol=1e-4)
    assert (body.stress[:, 0, 0] > 400).all()
    np.testing.assert_allclose(body.energies(vector(fwd.dim, 0, 0))[:, 1].sum(), body.elastic_energy.sum(), rtol=1e-4)


def test_from_shape_covers_the_shape_in_place(fwd):
    centre = vector(fwd.dim, 3, 4, 5)
    body = fwd.SoftBody.from_shape(fwd.Shape.box(np.full(fwd.dim, 0.5), centre), 0.1)
    np.testing.assert_allclose(body.positions.min(axis=0), centre - 0.5, atol=1e-5)
    np.testing.assert_allclose(body.positions.max(axis=0), centre + 0.5, atol=1e-5)
    assert body.grid.has_surface and body.grid.solid_count == 10**fwd.dim


def test_from_distance_calls_the_function_and_passes_its_exceptions():
    grid = fw.VoxelGrid2.from_distance((16, 16), 1 / 16, lambda at: np.hypot(at[0] - 0.5, at[1] - 0.5) - 0.4)
    assert grid.solid_count == pytest.approx(np.pi * 0.16 * 256, rel=0.05) and grid.has_surface
    with pytest.raises(ZeroDivisionError):
        fw.VoxelGrid2.from_distance((4, 4), 0.1, lambda at: 1 / 0)

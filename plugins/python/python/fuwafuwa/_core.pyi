from collections.abc import Callable, Iterable, Mapping, Sequence
from os import PathLike
from typing import Any, Literal, TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "Error",
    "GripHandle",
    "Joint2",
    "Joint3",
    "JointHandle",
    "KnifeHandle",
    "Material",
    "RigidBody2",
    "RigidBody3",
    "RigidBodyHandle",
    "RigidBodyView2",
    "RigidBodyView3",
    "Scene",
    "Shape2",
    "Shape3",
    "SoftBody2",
    "SoftBody3",
    "SoftBodyHandle",
    "SoftBodyView2",
    "SoftBodyView3",
    "StepReport",
    "VoxelGrid2",
    "VoxelGrid3",
    "World2",
    "World3",
    "__version__",
    "library",
    "library_values",
]

__version__: str

_Vector: TypeAlias = ArrayLike
_Rotation: TypeAlias = ArrayLike
_F32: TypeAlias = NDArray[np.float32]
_F64: TypeAlias = NDArray[np.float64]
_I32: TypeAlias = NDArray[np.int32]
_U32: TypeAlias = NDArray[np.uint32]
_U8: TypeAlias = NDArray[np.uint8]
_Bool: TypeAlias = NDArray[np.bool_]
_File: TypeAlias = str | PathLike[str] | bytes
_Law: TypeAlias = Literal["corotational_vem", "endo_2004"]
_Grading: TypeAlias = Literal["graded", "uniform", "coarse"]
_StiffBodies: TypeAlias = Literal["exact", "mass_scaled", "softened"]
_Motion: TypeAlias = Literal["fixed", "kinematic", "coupled", "dynamic"]
_Body: TypeAlias = SoftBodyHandle | RigidBodyHandle
_Handle: TypeAlias = SoftBodyHandle | RigidBodyHandle | JointHandle | KnifeHandle | GripHandle
_Piece: TypeAlias = tuple[SoftBodyHandle, int]
_Object: TypeAlias = SoftBodyHandle | RigidBodyHandle | _Piece
_Anchor: TypeAlias = ArrayLike | tuple[_Body, ArrayLike] | tuple[SoftBodyHandle, ArrayLike, float]
_Materials: TypeAlias = Material | Sequence[Material] | None

class Error(ValueError):
    """A value is invalid, a handle is stale, or a file or a snapshot cannot be read.

    The text names the field, what was expected and what was given. A failed call changes nothing.
    """

@final
class SoftBodyHandle:
    """Handle of a soft body in a world.

    Handles of removed objects are stale: methods that get one raise `Error`. Handles can be compared, hashed,
    sorted and pickled, and are valid in copies and restored snapshots of their world.
    """

    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __lt__(self, other: SoftBodyHandle, /) -> bool: ...
    def __le__(self, other: SoftBodyHandle, /) -> bool: ...
    def __gt__(self, other: SoftBodyHandle, /) -> bool: ...
    def __ge__(self, other: SoftBodyHandle, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...

@final
class RigidBodyHandle:
    """Handle of a rigid body in a world.

    Handles of removed objects are stale: methods that get one raise `Error`. Handles can be compared, hashed,
    sorted and pickled, and are valid in copies and restored snapshots of their world.
    """

    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __lt__(self, other: RigidBodyHandle, /) -> bool: ...
    def __le__(self, other: RigidBodyHandle, /) -> bool: ...
    def __gt__(self, other: RigidBodyHandle, /) -> bool: ...
    def __ge__(self, other: RigidBodyHandle, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...

@final
class JointHandle:
    """Handle of a joint in a world.

    Handles of removed objects are stale: methods that get one raise `Error`. Handles can be compared, hashed,
    sorted and pickled, and are valid in copies and restored snapshots of their world.
    """

    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __lt__(self, other: JointHandle, /) -> bool: ...
    def __le__(self, other: JointHandle, /) -> bool: ...
    def __gt__(self, other: JointHandle, /) -> bool: ...
    def __ge__(self, other: JointHandle, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...

@final
class KnifeHandle:
    """Handle of a knife in a world.

    Handles of removed objects are stale: methods that get one raise `Error`. Handles can be compared, hashed,
    sorted and pickled, and are valid in copies and restored snapshots of their world.
    """

    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __lt__(self, other: KnifeHandle, /) -> bool: ...
    def __le__(self, other: KnifeHandle, /) -> bool: ...
    def __gt__(self, other: KnifeHandle, /) -> bool: ...
    def __ge__(self, other: KnifeHandle, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...

@final
class GripHandle:
    """Handle of a grip in a world.

    Handles of removed objects are stale: methods that get one raise `Error`. Handles can be compared, hashed,
    sorted and pickled, and are valid in copies and restored snapshots of their world.
    """

    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __lt__(self, other: GripHandle, /) -> bool: ...
    def __le__(self, other: GripHandle, /) -> bool: ...
    def __gt__(self, other: GripHandle, /) -> bool: ...
    def __ge__(self, other: GripHandle, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...

@final
class Material:
    """Material of a voxel. Materials cannot be changed; `replace` returns a changed copy.

    Fields, all of them keyword arguments:

    - young: Young's modulus [Pa], default 5000
    - poisson: Poisson's ratio, 0 to 0.49, default 0.3
    - stress_law: "corotational" (default), "neo_hookean", or ("yeoh", C2 / C1, C3 / C1)
    - prony: viscoelasticity, up to two pairs (ratio to the shear modulus at rest, relaxation time [s]), default ()
    - density [kg/m³], default 100; in 2D that of a sheet 1 m deep
    - mass_damping [1/s], default 4, and stiffness_damping [s], default 2e-4: Rayleigh damping
    - friction: Coulomb coefficient between soft surfaces, 0 to 2, default 0.4
    - rolling_resistance of pieces of one voxel [1/s], 0 to 1000, default 20
    - strength: tensile strength of a smooth surface [Pa], default 1000; infinite = no crack starts
    - hydrostatic_strength [Pa]: if given, the criterion of Drucker and Prager decides and cracks start inside, too;
      None (default) = the greatest tension decides
    - strength_scatter: largest relative amount by which the strength of a point is raised, 0 to 10, default 0.4
    - toughness: fracture toughness [Pa √m], default 150; infinite = cracks do not grow
    - rate_toughening: (speed [m/s], exponent) of the growth of the fracture energy with the speed of a crack;
      None (default) = no growth
    - yield_strain: strain beyond which the deformation is permanent; infinite (default) = elastic
    - plastic_limit: largest factor by which a width can shrink permanently, 1 to 4, default 2
    """

    def __new__(
        cls,
        *,
        young: float = ...,
        poisson: float = ...,
        stress_law: str | tuple[str, float, float] = ...,
        prony: Sequence[tuple[float, float]] = ...,
        density: float = ...,
        mass_damping: float = ...,
        stiffness_damping: float = ...,
        friction: float = ...,
        rolling_resistance: float = ...,
        strength: float = ...,
        hydrostatic_strength: float | None = ...,
        strength_scatter: float = ...,
        toughness: float = ...,
        rate_toughening: tuple[float, float] | None = ...,
        yield_strain: float = ...,
        plastic_limit: float = ...,
    ) -> Material: ...
    @staticmethod
    def library(name: str, /, **overrides: Any) -> Material:
        """Returns a material of the library, with other values of some fields. `fuwafuwa.library()` lists the names, and
        `fuwafuwa.library_values(name)` the sources. A changed field changes no other one: with another `young`, for
        example, the toughness stays and the fracture energy changes.
        """
    @staticmethod
    def clay(**overrides: Any) -> Material:
        """Returns soft clay for a game: it keeps the shape into which it is pressed, and does not tear."""
    def replace(self, /, **overrides: Any) -> Material:
        """Returns the material with other values of some fields."""
    def fields(self, /) -> dict[str, Any]:
        """Returns all fields by name."""
    def with_damping_ratio(self, /, ratio: float, low: float, high: float | None = None) -> Material:
        """Returns the material with the mass damping and the stiffness damping of a damping ratio.

        ratio: the ratio at the frequencies `low` and `high` [Hz]; it is lower between them and higher outside. Without
        `high`, mass damping alone gives the ratio at `low`; at other frequencies, the ratio is inversely proportional to
        the frequency.
        """
    def damping_ratio(self, /, frequency: float) -> float:
        """Returns the damping ratio of a vibration with a frequency [Hz]."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...
    @property
    def young(self, /) -> float:
        """Young's modulus [Pa]."""
    @property
    def poisson(self, /) -> float:
        """Poisson's ratio."""
    @property
    def stress_law(self, /) -> str | tuple[str, float, float]:
        """Relation between stress and large strain."""
    @property
    def prony(self, /) -> tuple[tuple[float, float], ...]:
        """Terms of the Prony series: pairs of the ratio to the shear modulus at rest and the relaxation time [s]."""
    @property
    def density(self, /) -> float:
        """Density [kg/m³]."""
    @property
    def mass_damping(self, /) -> float:
        """Mass damping [1/s]: damps slow vibrations most."""
    @property
    def stiffness_damping(self, /) -> float:
        """Stiffness damping [s]: damps fast vibrations most."""
    @property
    def friction(self, /) -> float:
        """Coulomb friction coefficient between soft surfaces."""
    @property
    def rolling_resistance(self, /) -> float:
        """Decay rate of the angular velocity of pieces of one voxel while they touch something [1/s]."""
    @property
    def strength(self, /) -> float:
        """Tensile strength of a smooth surface [Pa]."""
    @property
    def hydrostatic_strength(self, /) -> float | None:
        """Hydrostatic strength [Pa]; None if the greatest tension decides."""
    @property
    def strength_scatter(self, /) -> float:
        """Largest relative amount by which the strength of a point is raised."""
    @property
    def toughness(self, /) -> float:
        """Fracture toughness in plane strain [Pa √m]."""
    @property
    def rate_toughening(self, /) -> tuple[float, float] | None:
        """Speed [m/s] and exponent of the growth of the fracture energy with the speed of a crack; None without growth."""
    @property
    def yield_strain(self, /) -> float:
        """Strain beyond which the deformation is permanent."""
    @property
    def plastic_limit(self, /) -> float:
        """Largest factor by which a width can shrink permanently."""
    @property
    def fracture_energy(self, /) -> float:
        """Fracture energy per area of crack in plane strain [J/m²]."""
    @property
    def shear_modulus(self, /) -> float:
        """Shear modulus at small strain and at rest [Pa]."""
    @property
    def wave_speed(self, /) -> float:
        """Speed of a fast pressure wave [m/s]."""

def library() -> list[str]:
    """Returns the names of the materials of the library, for `Material.library`."""

def _gif(frames: Iterable[tuple[_U8, int]]) -> bytes:
    """Encodes frames as a GIF that repeats forever: an iterable of pairs of a uint8 array (height, width, 3) and its
    duration [1/100 s].
    """

def library_values(name: str) -> list[dict[str, Any]]:
    """Returns the published values of a material of the library: a list of dicts with the keys quantity, unit, value
    (two numbers; only the Yeoh law and the rate toughening use the second), spread (lowest and highest published value),
    temperature [°C], rate [1/s], strain (range of engineering strain of the fit) and source. Values that a source does
    not give are None.
    """

@final
class StepReport:
    """Report of `step`: sums over its ticks, except where a field says otherwise."""

    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    @property
    def ticks(self, /) -> int:
        """Number of ticks."""
    @property
    def substeps(self, /) -> int:
        """Number of substeps."""
    @property
    def nodes_split(self, /) -> int:
        """Number of nodes that were split."""
    @property
    def pieces_detached(self, /) -> int:
        """Number of pieces that were detached."""
    @property
    def inverted(self, /) -> int:
        """Number of elements that are turned inside out at the end of the last tick."""
    @property
    def slowed_impacts(self, /) -> int:
        """Number of pieces in impacts that were too fast for the substeps, counted once in each tick."""
    @property
    def speed_limited(self, /) -> int:
        """Number of nodes, summed over the substeps, whose speed was limited to a voxel per substep."""
    @property
    def quarantined(self, /) -> int:
        """Number of pieces that became non-finite or too fast and were frozen permanently."""
    @property
    def damping_limited(self, /) -> int:
        """Number of soft bodies with less stiffness damping than their materials specify, in the last tick."""
    @property
    def scaled_bodies(self, /) -> int:
        """Number of soft bodies whose mass or stiffness is scaled, in the last tick."""
    @property
    def largest_scale(self, /) -> float:
        """Largest scale of a soft body in the last tick; 1 if no body is scaled."""

@final
class Scene:
    """World as text, in the format of the scene files of fuwafuwa."""

    @staticmethod
    def read(path: str | PathLike[str], changes: Sequence[str] = ()) -> Scene:
        """Reads a scene from a file, with the files that it names, or opens a built-in scene by name. `changes` replace
        values, for example "material.young=9000".
        """
    @staticmethod
    def from_text(
        text: str, changes: Sequence[str] = (), *, name: str = "scene", folder: str | PathLike[str] | None = None
    ) -> Scene:
        """Reads a scene from its text. name: for error texts; folder: where the files are that the scene names."""
    @staticmethod
    def names() -> list[str]:
        """Returns the names of the built-in scenes."""
    def build(self, /) -> Any:
        """Builds the world: a World2 or a World3, as `dim` says."""
    def text(self, /) -> str:
        """Returns the text of the scene. `from_text` reads it again."""
    def hand_targets(self, /, tick: int) -> _F32:
        """Returns the target of each hand at a tick [m]: float32 array (hands, d)."""
    def set_hand_targets(self, /, world: World2 | World3, tick: int) -> None:
        """Sets the targets of the hands of a world that this scene has built to those at a tick."""
    def __reduce__(self, /) -> tuple[Any, ...]: ...
    @property
    def dim(self, /) -> int:
        """Number of dimensions: 2 or 3."""
    @property
    def seconds(self, /) -> float:
        """Duration [s]."""
    @property
    def ticks(self, /) -> int:
        """Duration in ticks."""
    @property
    def materials(self, /) -> list[Material]:
        """Materials of the scene, number 1 first."""
    @property
    def notes(self, /) -> list[str]:
        """Notes of the importers of pictures and models on what was left out or may surprise."""

@final
class Shape2:
    """Shape in 2D: a ball, box, capsule or half-space. Lengths are in metres.

    Vectors are sequences or arrays. Rotations are angles [rad] in 2D. In 3D they are quaternions x, y, z, w, or
    rotation vectors: an axis whose length is the angle [rad].
    """

    @staticmethod
    def ball(radius: float, centre: _Vector | None = None) -> Shape2:
        """Returns a ball (in 2D a disc) with a radius [m] and a centre [m], by default the origin."""
    @staticmethod
    def box(half: _Vector, centre: _Vector | None = None, rotation: _Rotation | None = None) -> Shape2:
        """Returns a box from half of its extents [m], its centre [m], by default the origin, and its rotation."""
    @staticmethod
    def capsule(start: _Vector, end: _Vector, radius: float) -> Shape2:
        """Returns a capsule: all points within `radius` [m] of the segment between two points [m]."""
    @staticmethod
    def half_space(normal: _Vector, point: _Vector | None = None) -> Shape2:
        """Returns the half-space on the far side of a plane through `point` [m], by default the origin. The normal points
        out of the solid side; its length has no effect. A floor is `half_space((0, 1))` in 2D.
        """
    def translated(self, /, by: _Vector) -> Shape2:
        """Returns the shape translated by a vector [m]."""
    def rotated(self, /, by: _Rotation) -> Shape2:
        """Returns the shape rotated about the origin."""
    def distance(self, /, point: _Vector) -> tuple[float, _F32]:
        """Returns the signed distance of a point [m], negative inside, and the outward normal there."""
    @property
    def bounds(self, /) -> tuple[_F32, _F32]:
        """Low and high corner of the bounding box [m]; infinite for half-spaces."""
    @property
    def parameters(self, /) -> dict[str, Any]:
        """Kind of the shape and its parameters, by name."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...

@final
class VoxelGrid2:
    """Grid of voxels in 2D: a material number for each voxel, 0 = empty.

    Arrays have the axes [x, y], as positions have these coordinates: index 0 is the low end of
    each axis, and y points up. An image, whose rows run downwards, becomes such an array by `image[::-1].T`.
    The low corner of a grid is at the origin of its body.
    """

    def __new__(cls, array: _U8 | _Bool, voxel_size: float) -> VoxelGrid2: ...
    @staticmethod
    def ball(n: int, diameter: float = 1.0) -> VoxelGrid2:
        """Returns a ball (in 2D a disc) with a diameter [m], `n` voxels across."""
    @staticmethod
    def cube(n: int, width: float = 1.0) -> VoxelGrid2:
        """Returns a cube (in 2D a square) with a width [m], `n` voxels wide."""
    @staticmethod
    def ring(n: int, diameter: float = 1.0) -> VoxelGrid2:
        """Returns a ring (in 3D a torus) with an outer diameter [m], `n` voxels across."""
    @staticmethod
    def heart(n: int, width: float = 1.0) -> VoxelGrid2:
        """Returns a heart with a width [m], `n` voxels wide."""
    @staticmethod
    def flower(n: int, width: float = 1.0) -> VoxelGrid2:
        """Returns a flower with a width [m], `n` voxels wide."""
    @staticmethod
    def from_shape(shape: Shape2, voxel_size: float) -> VoxelGrid2:
        """Returns a grid of material 1 that covers a bounded shape and knows its surface, from the shape and the edge
        length of a voxel [m]. The position of the shape
        is lost: `SoftBody2.from_shape` keeps it.
        """
    @staticmethod
    def from_distance(
        size: Sequence[int], voxel_size: float, distance: Callable[[tuple[float, ...]], float]
    ) -> VoxelGrid2:
        """Returns a grid of material 1 from its size [voxels] and a function that returns the signed distance of a
        point from the surface [m], negative inside. Points are tuples [m], measured from the low corner of the
        grid. The function is called several times for each voxel at the surface. The grid knows its surface to
        1/64 voxel.
        """
    @staticmethod
    def picture(
        source: _File,
        *,
        across: int = 64,
        voxel_size: float = 0.015625,
        colours: Mapping[tuple[int, int, int], int] | None = None,
        fill: bool = True,
    ) -> VoxelGrid2:
        """Returns the silhouette of a picture: PNG, JPEG, WebP, GIF or BMP, from a path or bytes.

        Opaque pixels of a sprite, or the ink of a drawing and what it encloses, are solid; the top row is the highest.
        The empty margin is trimmed. across: largest number of voxels on the longer side; voxel_size [m]; fill: whether
        closed outlines of a drawing are filled; colours: a dict from (red, green, blue) to material numbers (0 = empty),
        by which each pixel gets the material of the nearest colour.
        """
    @staticmethod
    def pixels(
        source: _File,
        *,
        across: int = 64,
        voxel_size: float = 0.015625,
        colours: Mapping[tuple[int, int, int], int] | None = None,
    ) -> VoxelGrid2:
        """Returns one voxel for each pixel of a picture, as for pixel art. The empty margin is kept, and outlines are not
        filled. The arguments are those of `picture`.
        """
    @property
    def array(self, /) -> _U8:
        """Material numbers: uint8 array [x, y], a copy. Voxels of removed pieces keep their numbers."""
    @property
    def present(self, /) -> _Bool:
        """Whether each voxel is solid and was not removed with its piece: bool array [x, y], a copy."""
    @property
    def size(self, /) -> tuple[int, ...]:
        """Number of voxels on each axis."""
    @property
    def voxel_size(self, /) -> float:
        """Edge length of a voxel [m]."""
    @property
    def solid_count(self, /) -> int:
        """Number of solid voxels."""
    @property
    def has_surface(self, /) -> bool:
        """Whether the grid knows its smooth surface. Grids from arrays do not; contacts then use the smoothed surface
        of the voxels.
        """
    @property
    def notes(self, /) -> list[str]:
        """Notes of the importer on what was left out or may surprise; they are also shown as warnings."""
    def scaled(self, /, factor: float) -> VoxelGrid2:
        """Returns the grid with all lengths multiplied by a factor, and the same voxels."""
    def with_materials(self, /, array: _U8 | _Bool) -> VoxelGrid2:
        """Returns the grid with other material numbers, from an array of the same shape. If the same voxels are
        solid, the grid keeps its surface.
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...

@final
class RigidBody2:
    """Definition of a rigid body in 2D, for `World2.add_rigid_body`.

    All constructors have the keyword arguments position [m], rotation (an angle [rad] in 2D, a quaternion
    x, y, z, w or a rotation vector in 3D), friction (default 0.2; 0.5 of dynamic bodies), restitution (0 to 1,
    default 0), layers (a pair of bit masks: memberships and filters; default member of layer 1, meets all), is_sensor and
    user_data (an integer of 64 bits). A wrong value raises `Error` when the body is added to a world.
    """

    @staticmethod
    def fixed(
        shape: Shape2,
        *,
        position: _Vector | None = None,
        rotation: _Rotation | None = None,
        friction: float = 0.2,
        restitution: float = 0.0,
        layers: tuple[int, int] | None = None,
        is_sensor: bool = False,
        user_data: int = 0,
    ) -> RigidBody2:
        """Returns a rigid body that never moves. Bodies resting on it may sleep."""
    @staticmethod
    def kinematic(
        shape: Shape2,
        *,
        position: _Vector | None = None,
        rotation: _Rotation | None = None,
        friction: float = 0.2,
        restitution: float = 0.0,
        layers: tuple[int, int] | None = None,
        is_sensor: bool = False,
        user_data: int = 0,
    ) -> RigidBody2:
        """Returns a rigid body that reaches its target pose at the end of each tick, through any obstacle."""
    @staticmethod
    def coupled(
        shape: Shape2,
        *,
        mass: float = 2.0,
        stiffness: float = 3000.0,
        damping: float = 0.9,
        max_force: float = 1000.0,
        position: _Vector | None = None,
        rotation: _Rotation | None = None,
        friction: float = 0.2,
        restitution: float = 0.0,
        layers: tuple[int, int] | None = None,
        is_sensor: bool = False,
        user_data: int = 0,
    ) -> RigidBody2:
        """Returns a rigid body that a spring and a damper pull towards its target position, and that contacts stop.

        mass [kg], 1e-6 to 1e6; stiffness of the spring [N/m]; damping ratio, above 0 and up to 10; max_force of
        the coupling [N], infinite = no limit. Contacts do not rotate the body.
        """
    @staticmethod
    def dynamic(
        shape: Shape2,
        mass: float,
        *,
        velocity: _Vector | None = None,
        angular_velocity: _Vector | None = None,
        position: _Vector | None = None,
        rotation: _Rotation | None = None,
        friction: float = 0.5,
        restitution: float = 0.0,
        layers: tuple[int, int] | None = None,
        is_sensor: bool = False,
        user_data: int = 0,
    ) -> RigidBody2:
        """Returns a rigid body that gravity and contacts move and rotate. The shape must be bounded. Its middle becomes
        the origin of the body, and is the default of position.

        mass [kg], 1e-6 to 1e6, with uniform density; velocity [m/s]; angular_velocity [rad/s], a number in 2D
        and a vector in 3D.
        """
    @property
    def motion(self, /) -> dict[str, Any]:
        """Motion type and its parameters, by name."""
    @property
    def shape(self, /) -> Shape2:
        """Shape in local coordinates."""
    @property
    def position(self, /) -> _F32:
        """Position [m]."""
    @property
    def rotation(self, /) -> float:
        """Rotation: an angle [rad] in 2D, a quaternion x, y, z, w in 3D."""
    @property
    def velocity(self, /) -> _F32:
        """Velocity [m/s]."""
    @property
    def angular_velocity(self, /) -> float:
        """Angular velocity [rad/s]: a number in 2D, a vector in 3D."""
    @property
    def friction(self, /) -> float:
        """Coulomb friction coefficient."""
    @property
    def restitution(self, /) -> float:
        """Coefficient of restitution."""
    @property
    def layers(self, /) -> tuple[int, int]:
        """Bit masks of the layers: memberships and filters."""
    @property
    def is_sensor(self, /) -> bool:
        """Whether the body only reports what enters it."""
    @property
    def user_data(self, /) -> int:
        """Number of the program."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...

@final
class Joint2:
    """Definition of a joint in 2D, for `World2.add_joint`.

    An anchor is a point of the world [m], a pair (handle of a body, point), or (handle of a soft body, point,
    radius [m]), which spreads the force over the nodes within the radius. Points are in world coordinates at
    the time at which the joint is added. `breaking_force` [N]: the joint breaks above it; infinite (default) =
    never.
    """

    @staticmethod
    def pin(first: _Anchor, second: _Anchor, *, breaking_force: float = ...) -> Joint2:
        """Returns a joint that holds both anchors together."""
    @staticmethod
    def rope(first: _Anchor, second: _Anchor, length: float, *, breaking_force: float = ...) -> Joint2:
        """Returns a joint that keeps both anchors within `length` [m] of each other."""
    @staticmethod
    def spring(
        first: _Anchor, second: _Anchor, stiffness: float, damping: float, length: float, *, breaking_force: float = ...
    ) -> Joint2:
        """Returns a spring with a stiffness [N/m], a damping [N s/m] and a rest length [m]."""
    @property
    def kind(self, /) -> Literal["pin", "rope", "spring"]:
        """Kind of the joint: "pin", "rope" or "spring"."""
    @property
    def parameters(self, /) -> dict[str, Any]:
        """Kind of the joint and its parameters, by name: length [m] of a rope; stiffness [N/m], damping [N s/m] and rest
        length [m] of a spring.
        """
    @property
    def anchors(self, /) -> tuple[_Anchor, _Anchor]:
        """First and second anchor, in the form of the arguments of the constructors."""
    @property
    def breaking_force(self, /) -> float:
        """Force above which the joint breaks [N]."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...

@final
class SoftBody2:
    """Soft body in 2D outside of a world, for `World2.add_soft_body`.

    grid: a VoxelGrid2; materials: a Material for all voxels, or a list of materials for the
    numbers 1, 2, …; law: "corotational_vem" or "endo_2004"; grading: "graded" (elements small at the surface and
    large inside), "uniform" (elements of one voxel), or "coarse" (for counting only: does not tear).

    A world takes a copy, so one body can be added many times. All arrays are copies. Node i of an array is the
    same node in all arrays that were read at one moment, likewise for elements and pieces.
    """

    def __new__(
        cls,
        grid: VoxelGrid2,
        materials: _Materials = None,
        *,
        law: _Law = "corotational_vem",
        grading: _Grading = "graded",
    ) -> SoftBody2: ...
    @staticmethod
    def from_array(
        array: _U8 | _Bool,
        voxel_size: float,
        materials: _Materials = None,
        *,
        law: _Law = "corotational_vem",
        grading: _Grading = "graded",
    ) -> SoftBody2:
        """Returns a body from an array of material numbers (uint8, or bool for material 1) and the edge length of a
        voxel [m]. The axes are [x, y].
        """
    @staticmethod
    def from_shape(
        shape: Shape2,
        voxel_size: float,
        materials: _Materials = None,
        *,
        law: _Law = "corotational_vem",
        grading: _Grading = "graded",
    ) -> SoftBody2:
        """Returns a body of voxels that covers a bounded shape, at the position of the shape. voxel_size [m]."""
    @staticmethod
    def ball(
        n: int,
        diameter: float = 1.0,
        materials: _Materials = None,
        *,
        law: _Law = "corotational_vem",
        grading: _Grading = "graded",
    ) -> SoftBody2:
        """Returns a ball (in 2D a disc) with a diameter [m], `n` voxels across. Its low corner is at the origin."""
    @staticmethod
    def cube(
        n: int,
        width: float = 1.0,
        materials: _Materials = None,
        *,
        law: _Law = "corotational_vem",
        grading: _Grading = "graded",
    ) -> SoftBody2:
        """Returns a cube (in 2D a square) with a width [m], `n` voxels wide. Its low corner is at the origin."""
    def translated(self, /, by: _Vector) -> SoftBody2:
        """Returns a copy, translated by a vector [m]."""
    def rotated(self, /, rotation: _Rotation, about: _Vector | None = None) -> SoftBody2:
        """Returns a copy, rotated about a point [m] (default the centre of mass). The rotation is an angle [rad] in
        2D, and a quaternion x, y, z, w or a rotation vector in 3D.
        """
    def with_velocity(self, /, linear: _Vector | None = None, angular: _Vector | None = None) -> SoftBody2:
        """Returns a copy with the velocity of a rigid motion: linear [m/s], and angular [rad/s] about the centre of
        mass (a number in 2D, a vector in 3D).
        """
    def with_layers(self, /, memberships: int, filters: int) -> SoftBody2:
        """Returns a copy with other layers: bit masks of memberships and filters."""
    def with_user_data(self, /, user_data: int) -> SoftBody2:
        """Returns a copy with another number of the program."""
    def copy(self, /) -> SoftBody2:
        """Returns a copy."""
    def __copy__(self, /) -> SoftBody2: ...
    def __deepcopy__(self, /, _memo: Any) -> SoftBody2: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...
    @property
    def node_count(self, /) -> int:
        """Number of nodes n."""
    @property
    def element_count(self, /) -> int:
        """Number of elements m."""
    @property
    def piece_count(self, /) -> int:
        """Number of pieces that were not removed."""
    @property
    def mass(self, /) -> float:
        """Mass [kg]."""
    @property
    def centre_of_mass(self, /) -> _F32:
        """Centre of mass [m]: float32 array (d,)."""
    @property
    def kinetic_energy(self, /) -> float:
        """Kinetic energy [J]."""
    @property
    def momentum(self, /) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Linear momentum [N s] and angular momentum about the origin [N m s], both as tuples of 3 numbers."""
    @property
    def grid(self, /) -> VoxelGrid2:
        """Voxels of the body."""
    @property
    def materials(self, /) -> list[Material]:
        """Materials, for the numbers 1, 2, …."""
    @property
    def law(self, /) -> _Law:
        """Elastic law: "corotational_vem" or "endo_2004"."""
    @property
    def grading(self, /) -> _Grading:
        """Grading of the elements: "graded", "uniform" or "coarse"."""
    @property
    def layers(self, /) -> tuple[int, int]:
        """Bit masks of the layers: memberships and filters."""
    @property
    def user_data(self, /) -> int:
        """Number of the program."""
    @property
    def gravity_scale(self, /) -> float:
        """Factor by which gravity is multiplied for this body, see `set_gravity_scale` of the world."""
    @property
    def mass_scale(self, /) -> float:
        """Factor s by which the inertia of deformation was raised to keep the substep stable, 1 = unchanged: vibrations
        are √s times slower. It acts with the setting stiff_bodies="mass_scaled".
        """
    @property
    def stiffness_scale(self, /) -> float:
        """Factor by which Young's modulus was lowered to keep the substep stable, 1 = unchanged. It acts with the
        setting stiff_bodies="softened".
        """
    @property
    def inverted_count(self, /) -> int:
        """Number of awake elements that are turned inside out."""
    @property
    def range(self, /) -> float:
        """Largest absolute coordinate at which the body may be added to a world or moved by hand [m]: 8192 voxels."""
    @property
    def node_ids(self, /) -> _U32:
        """Ids of the nodes: uint32 array (n,), ascending. Ids are reused after a node is removed."""
    @property
    def positions(self, /) -> _F32:
        """Positions of the nodes [m]: float32 array (n, d), a copy."""
    @property
    def velocities(self, /) -> _F32:
        """Velocities of the nodes [m/s]: float32 array (n, d), a copy."""
    @property
    def forces(self, /) -> _F32:
        """Elastic forces on the nodes in the last substep in which the body was awake [N]: float32 array (n, d), a copy."""
    @property
    def node_masses(self, /) -> _F32:
        """Masses of the nodes [kg]: float32 array (n,), a copy."""
    @property
    def rest_positions(self, /) -> _F32:
        """Positions of the nodes in the undeformed body, whose low corner is at the origin [m]: float32 array (n, d)."""
    @property
    def surface_positions(self, /) -> _F32:
        """Positions of the nodes on the smooth surface [m]: float32 array (n, d). Inner nodes have their own position."""
    @property
    def damage(self, /) -> _F32:
        """Damage of the nodes: float32 array (n,), a copy. 0 is intact. A node splits as soon as its damage is 1 or more,
        unless a node nearby has just split: then it waits for some milliseconds. Damage grows in steps of up to 6.25,
        so that waiting nodes have a damage above 1, seldom above 20. Nodes that are no longer overloaded heal.
        """
    @property
    def fixed(self, /) -> _Bool:
        """Whether each node is fixed: bool array (n,), a copy."""
    @property
    def node_pieces(self, /) -> _U32:
        """Piece number of each node: uint32 array (n,), a copy."""
    @property
    def element_ids(self, /) -> _U32:
        """Ids of the elements: uint32 array (m,), ascending. Ids are reused after an element is removed."""
    @property
    def elements(self, /) -> _I32:
        """Nodes of the elements: int32 array (m, 3**d) of rows of `positions`, -1 where an element has no node.

        Columns are the points of a 3 × 3 (× 3) lattice over the cell of the element, x fastest: in 2D, columns 0,
        2, 6 and 8 are the corners, 1, 3, 5 and 7 the middles of the edges. Elements of level 0 have nodes at
        all corners only. Larger elements may fill only a part of their cell.
        """
    @property
    def levels(self, /) -> _U8:
        """Levels of the elements: uint8 array (m,). The cell of an element is 2**level voxels wide."""
    @property
    def element_materials(self, /) -> _U8:
        """Material numbers of the elements: uint8 array (m,)."""
    @property
    def element_pieces(self, /) -> _U32:
        """Piece numbers of the elements: uint32 array (m,)."""
    @property
    def strain(self, /) -> _F32:
        """Elastic strain ‖F − R‖ of the elements: float32 array (m,). 0.1 is a stretch by a tenth."""
    @property
    def plastic_strain(self, /) -> _F32:
        """Plastic strain of the elements: float32 array (m,). 0 without permanent deformation."""
    @property
    def biot_strain(self, /) -> _F64:
        """Elastic Biot strain of the elements along the axes of the undeformed body, the symmetric part of RᵀF - 1: float64
        array (m, d, d). 0.1 is a stretch by a tenth. F is without the plastic part, and R is its rotation.
        """
    @property
    def deformation(self, /) -> _F64:
        """Deformation gradients F of the elements: float64 array (m, d, d)."""
    @property
    def stress(self, /) -> _F64:
        """Cauchy stress of the elements along the axes of the world [Pa]: float64 array (m, d, d)."""
    @property
    def elastic_energy(self, /) -> _F64:
        """Elastic energy of the elements [J]: float64 array (m,). In 2D for 1 m of depth."""
    def energies(self, /, gravity: _Vector) -> _F64:
        """Returns the kinetic, elastic and gravitational energy of each piece [J], for a gravity [m/s²]: float64
        array (pieces, 3).
        """
    def cells(self, /) -> tuple[_F32, _I32]:
        """Returns the blocks that the elements fill: corners [m] as float32 array (k, 2**d, d), the first axis fastest,
        and the row of the element of each block as int32 array (k,). In 2D, corners 0, 1, 3, 2 go around a block.
        """
    def facets(self, /) -> tuple[_I32, _I32, _Bool]:
        """Returns the exposed faces: int32 array (f, 2**(d-1)) of rows of nodes, counterclockwise as seen from
        outside, int32 array (f,) of rows of elements, and bool array (f,): whether the face was torn.
        """
    def outlines(self, /) -> list[dict[str, Any]]:
        """Returns the closed lines around all pieces of a 2D body and around their holes: a list of dicts with the
        keys piece, nodes (rows), points [m] (p, 2) and torn (p,). Empty in 3D.
        """
    def pieces(self, /) -> dict[str, NDArray[Any]]:
        """Returns the pieces: a dict of arrays whose row is the piece number. mass [kg]; centre of mass [m], velocity
        [m/s], and low and high corner of the bounding box [m], all (pieces, d); element_count; asleep; quarantined;
        removed. Removed pieces keep their row, with mass 0.
        """
    def nodes_in(self, /, region: Shape2) -> _I32:
        """Returns the rows of the nodes inside a shape or on its surface: int32 array."""
    def mass_inside(self, /, region: Shape2) -> float:
        """Returns the mass of the nodes inside a shape [kg]."""
    def sums_inside(self, /, region: Shape2) -> dict[str, Any]:
        """Returns sums over the part of the body inside a shape or on its surface: a dict with nodes, their number; mass
        [kg]; centre of mass [m]; momentum [kg m/s]; elastic_force [N], the force of the rest of the body on this part
        in the last substep; elastic_energy [J] of the elements whose centre is inside (in 2D for 1 m of depth).
        """
    def fix_nodes(self, /, nodes: ArrayLike) -> None:
        """Fixes nodes at their positions. nodes: n bools, or rows."""
    def free_nodes(self, /, nodes: ArrayLike) -> None:
        """Frees fixed nodes. nodes: n bools, or rows."""
    def set_node_states(self, /, positions: _F32 | _F64 | None = None, velocities: _F32 | _F64 | None = None) -> None:
        """Sets the positions [m] and velocities [m/s] of all nodes from arrays (n, d) of float32 or float64. Positions must
        be within `range`.
        """

@final
class SoftBodyView2:
    """View of a soft body in a World2: `world[handle]` or `world.soft_body(handle)`.

    Each access reads the present state of the world and raises `Error` if the body was removed. All arrays are
    copies, which stay as they are when the world steps. Node i of an array is the same node in all arrays that
    were read at one moment; when the body tears, nodes and elements come and go.
    """

    @property
    def handle(self, /) -> SoftBodyHandle:
        """Handle of the body."""
    @property
    def world(self, /) -> World2:
        """World of the body."""
    def copy(self, /) -> SoftBody2:
        """Returns a copy of the body, outside of the world."""
    @property
    def node_count(self, /) -> int:
        """Number of nodes n."""
    @property
    def element_count(self, /) -> int:
        """Number of elements m."""
    @property
    def piece_count(self, /) -> int:
        """Number of pieces that were not removed."""
    @property
    def mass(self, /) -> float:
        """Mass [kg]."""
    @property
    def centre_of_mass(self, /) -> _F32:
        """Centre of mass [m]: float32 array (d,)."""
    @property
    def kinetic_energy(self, /) -> float:
        """Kinetic energy [J]."""
    @property
    def momentum(self, /) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Linear momentum [N s] and angular momentum about the origin [N m s], both as tuples of 3 numbers."""
    @property
    def grid(self, /) -> VoxelGrid2:
        """Voxels of the body."""
    @property
    def materials(self, /) -> list[Material]:
        """Materials, for the numbers 1, 2, …."""
    @property
    def law(self, /) -> _Law:
        """Elastic law: "corotational_vem" or "endo_2004"."""
    @property
    def grading(self, /) -> _Grading:
        """Grading of the elements: "graded", "uniform" or "coarse"."""
    @property
    def layers(self, /) -> tuple[int, int]:
        """Bit masks of the layers: memberships and filters."""
    @property
    def user_data(self, /) -> int:
        """Number of the program."""
    @property
    def gravity_scale(self, /) -> float:
        """Factor by which gravity is multiplied for this body, see `set_gravity_scale` of the world."""
    @property
    def mass_scale(self, /) -> float:
        """Factor s by which the inertia of deformation was raised to keep the substep stable, 1 = unchanged: vibrations
        are √s times slower. It acts with the setting stiff_bodies="mass_scaled".
        """
    @property
    def stiffness_scale(self, /) -> float:
        """Factor by which Young's modulus was lowered to keep the substep stable, 1 = unchanged. It acts with the
        setting stiff_bodies="softened".
        """
    @property
    def inverted_count(self, /) -> int:
        """Number of awake elements that are turned inside out."""
    @property
    def range(self, /) -> float:
        """Largest absolute coordinate at which the body may be added to a world or moved by hand [m]: 8192 voxels."""
    @property
    def node_ids(self, /) -> _U32:
        """Ids of the nodes: uint32 array (n,), ascending. Ids are reused after a node is removed."""
    @property
    def positions(self, /) -> _F32:
        """Positions of the nodes [m]: float32 array (n, d), a copy."""
    @property
    def velocities(self, /) -> _F32:
        """Velocities of the nodes [m/s]: float32 array (n, d), a copy."""
    @property
    def forces(self, /) -> _F32:
        """Elastic forces on the nodes in the last substep in which the body was awake [N]: float32 array (n, d), a copy."""
    @property
    def node_masses(self, /) -> _F32:
        """Masses of the nodes [kg]: float32 array (n,), a copy."""
    @property
    def rest_positions(self, /) -> _F32:
        """Positions of the nodes in the undeformed body, whose low corner is at the origin [m]: float32 array (n, d)."""
    @property
    def surface_positions(self, /) -> _F32:
        """Positions of the nodes on the smooth surface [m]: float32 array (n, d). Inner nodes have their own position."""
    @property
    def damage(self, /) -> _F32:
        """Damage of the nodes: float32 array (n,), a copy. 0 is intact. A node splits as soon as its damage is 1 or more,
        unless a node nearby has just split: then it waits for some milliseconds. Damage grows in steps of up to 6.25,
        so that waiting nodes have a damage above 1, seldom above 20. Nodes that are no longer overloaded heal.
        """
    @property
    def fixed(self, /) -> _Bool:
        """Whether each node is fixed: bool array (n,), a copy."""
    @property
    def node_pieces(self, /) -> _U32:
        """Piece number of each node: uint32 array (n,), a copy."""
    @property
    def element_ids(self, /) -> _U32:
        """Ids of the elements: uint32 array (m,), ascending. Ids are reused after an element is removed."""
    @property
    def elements(self, /) -> _I32:
        """Nodes of the elements: int32 array (m, 3**d) of rows of `positions`, -1 where an element has no node.

        Columns are the points of a 3 × 3 (× 3) lattice over the cell of the element, x fastest: in 2D, columns 0,
        2, 6 and 8 are the corners, 1, 3, 5 and 7 the middles of the edges. Elements of level 0 have nodes at
        all corners only. Larger elements may fill only a part of their cell.
        """
    @property
    def levels(self, /) -> _U8:
        """Levels of the elements: uint8 array (m,). The cell of an element is 2**level voxels wide."""
    @property
    def element_materials(self, /) -> _U8:
        """Material numbers of the elements: uint8 array (m,)."""
    @property
    def element_pieces(self, /) -> _U32:
        """Piece numbers of the elements: uint32 array (m,)."""
    @property
    def strain(self, /) -> _F32:
        """Elastic strain ‖F − R‖ of the elements: float32 array (m,). 0.1 is a stretch by a tenth."""
    @property
    def plastic_strain(self, /) -> _F32:
        """Plastic strain of the elements: float32 array (m,). 0 without permanent deformation."""
    @property
    def biot_strain(self, /) -> _F64:
        """Elastic Biot strain of the elements along the axes of the undeformed body, the symmetric part of RᵀF - 1: float64
        array (m, d, d). 0.1 is a stretch by a tenth. F is without the plastic part, and R is its rotation.
        """
    @property
    def deformation(self, /) -> _F64:
        """Deformation gradients F of the elements: float64 array (m, d, d)."""
    @property
    def stress(self, /) -> _F64:
        """Cauchy stress of the elements along the axes of the world [Pa]: float64 array (m, d, d)."""
    @property
    def elastic_energy(self, /) -> _F64:
        """Elastic energy of the elements [J]: float64 array (m,). In 2D for 1 m of depth."""
    def energies(self, /, gravity: _Vector) -> _F64:
        """Returns the kinetic, elastic and gravitational energy of each piece [J], for a gravity [m/s²]: float64
        array (pieces, 3).
        """
    def cells(self, /) -> tuple[_F32, _I32]:
        """Returns the blocks that the elements fill: corners [m] as float32 array (k, 2**d, d), the first axis fastest,
        and the row of the element of each block as int32 array (k,). In 2D, corners 0, 1, 3, 2 go around a block.
        """
    def facets(self, /) -> tuple[_I32, _I32, _Bool]:
        """Returns the exposed faces: int32 array (f, 2**(d-1)) of rows of nodes, counterclockwise as seen from
        outside, int32 array (f,) of rows of elements, and bool array (f,): whether the face was torn.
        """
    def outlines(self, /) -> list[dict[str, Any]]:
        """Returns the closed lines around all pieces of a 2D body and around their holes: a list of dicts with the
        keys piece, nodes (rows), points [m] (p, 2) and torn (p,). Empty in 3D.
        """
    def pieces(self, /) -> dict[str, NDArray[Any]]:
        """Returns the pieces: a dict of arrays whose row is the piece number. mass [kg]; centre of mass [m], velocity
        [m/s], and low and high corner of the bounding box [m], all (pieces, d); element_count; asleep; quarantined;
        removed. Removed pieces keep their row, with mass 0.
        """
    def nodes_in(self, /, region: Shape2) -> _I32:
        """Returns the rows of the nodes inside a shape or on its surface: int32 array."""
    def mass_inside(self, /, region: Shape2) -> float:
        """Returns the mass of the nodes inside a shape [kg]."""
    def sums_inside(self, /, region: Shape2) -> dict[str, Any]:
        """Returns sums over the part of the body inside a shape or on its surface: a dict with nodes, their number; mass
        [kg]; centre of mass [m]; momentum [kg m/s]; elastic_force [N], the force of the rest of the body on this part
        in the last substep; elastic_energy [J] of the elements whose centre is inside (in 2D for 1 m of depth).
        """
    def fix_nodes(self, /, nodes: ArrayLike) -> None:
        """Fixes nodes at their positions. nodes: n bools, or rows."""
    def free_nodes(self, /, nodes: ArrayLike) -> None:
        """Frees fixed nodes. nodes: n bools, or rows."""
    def set_node_states(self, /, positions: _F32 | _F64 | None = None, velocities: _F32 | _F64 | None = None) -> None:
        """Sets the positions [m] and velocities [m/s] of all nodes from arrays (n, d) of float32 or float64. Positions must
        be within `range`.
        """

@final
class RigidBodyView2:
    """View of a rigid body in a World2: `world[handle]` or `world.rigid_body(handle)`.

    Each access reads the present state of the world and raises `Error` if the body was removed.
    """

    @property
    def handle(self, /) -> RigidBodyHandle:
        """Handle of the body."""
    @property
    def world(self, /) -> World2:
        """World of the body."""
    @property
    def motion(self, /) -> dict[str, Any]:
        """Motion type and its parameters, by name."""
    @property
    def asleep(self, /) -> bool:
        """Whether the body sleeps."""
    @property
    def position(self, /) -> _F32:
        """Position [m]."""
    @property
    def rotation(self, /) -> float:
        """Rotation: an angle [rad] in 2D, a quaternion x, y, z, w in 3D."""
    @property
    def velocity(self, /) -> _F32:
        """Velocity [m/s]."""
    @property
    def angular_velocity(self, /) -> float:
        """Angular velocity [rad/s]: a number in 2D, a vector in 3D."""
    @property
    def target_position(self, /) -> _F32:
        """Target position of a kinematic or coupled body [m]."""
    @property
    def target_rotation(self, /) -> float:
        """Target rotation of a kinematic or coupled body."""
    @property
    def shape(self, /) -> Shape2:
        """Shape in world coordinates."""
    @property
    def local_shape(self, /) -> Shape2:
        """Shape in local coordinates."""
    @property
    def friction(self, /) -> float:
        """Coulomb friction coefficient."""
    @property
    def restitution(self, /) -> float:
        """Coefficient of restitution."""
    @property
    def layers(self, /) -> tuple[int, int]:
        """Bit masks of the layers: memberships and filters."""
    @property
    def is_sensor(self, /) -> bool:
        """Whether the body only reports what enters it."""
    @property
    def user_data(self, /) -> int:
        """Number of the program."""
    def definition(self, /) -> RigidBody2:
        """Returns the definition of the body in its present state."""
    def reactions(self, /) -> dict[str, _F32]:
        """Returns the forces on the body in each substep of the last tick: a dict of float32 arrays with s rows.
        contact (s, d) [N]: force of all contacts; coupling (s, d) [N]: force of the virtual coupling, which a
        force-feedback device should play; torque [N m]: (s,) in 2D, (s, 3) in 3D. Empty for fixed bodies.
        """

@final
class World2:
    """World in 2D: soft bodies, rigid bodies, joints, knives and grips. `step` advances its time.

    Units are metres, kilograms, seconds, newtons and pascals; y points up. The same calls give the same bits on
    every computer. In 2D, bodies are sheets 1 m deep.

    - gravity [m/s²], default (0, -9.81)
    - drag: decay rate of all velocities [1/s], 0 to 10, default 0
    - max_substeps in 1/60 s, 8 to 1024, default 64
    - stiff_bodies: treatment of soft bodies that require more substeps: "mass_scaled" (default), "softened" or
      "exact"
    - tick: length of a tick [s], 1/240 to 1/30, default 1/60
    - sleep: whether bodies at rest fall asleep, default True

    Methods raise `Error` for stale handles and wrong values, and then change nothing. Several threads may step
    different worlds at once, because `step` releases the GIL. A second call on a world that steps raises
    RuntimeError.
    """

    def __new__(
        cls,
        *,
        gravity: _Vector | None = None,
        drag: float | None = None,
        max_substeps: int | None = None,
        stiff_bodies: _StiffBodies | None = None,
        tick: float | None = None,
        sleep: bool | None = None,
    ) -> World2: ...
    def set_config(
        self,
        /,
        *,
        gravity: _Vector | None = None,
        drag: float | None = None,
        max_substeps: int | None = None,
        stiff_bodies: _StiffBodies | None = None,
        tick: float | None = None,
        sleep: bool | None = None,
    ) -> None:
        """Changes settings of the world; the keywords are those of the constructor."""
    @property
    def gravity(self, /) -> _F32:
        """Gravity [m/s²]: float32 array (d,)."""
    @gravity.setter
    def gravity(self, value: _Vector, /) -> None: ...
    @property
    def drag(self, /) -> float:
        """Decay rate of all velocities [1/s]."""
    @property
    def max_substeps(self, /) -> int:
        """Maximum number of substeps in 1/60 s."""
    @property
    def stiff_bodies(self, /) -> _StiffBodies:
        """Treatment of soft bodies that require more than `max_substeps`."""
    @property
    def tick(self, /) -> float:
        """Length of a tick [s]."""
    @property
    def sleep(self, /) -> bool:
        """Whether bodies at rest fall asleep."""
    @property
    def ticks(self, /) -> int:
        """Number of ticks since the world was created."""
    @property
    def time(self, /) -> float:
        """Time since the world was created [s]: the number of ticks times the present length of a tick."""
    @property
    def substeps(self, /) -> int:
        """Number of substeps in the next tick, which the stiffest body determines."""
    @property
    def soft_bodies(self, /) -> list[SoftBodyHandle]:
        """Handles of all soft bodies."""
    @property
    def rigid_bodies(self, /) -> list[RigidBodyHandle]:
        """Handles of all rigid bodies."""
    @property
    def joints(self, /) -> list[JointHandle]:
        """Handles of all joints."""
    @property
    def knives(self, /) -> list[KnifeHandle]:
        """Handles of all knives."""
    @property
    def grips(self, /) -> list[GripHandle]:
        """Handles of all grips."""
    def step(self, /, n: int = 1) -> StepReport:
        """Advances the world by `n` ticks and returns a report. Other threads run meanwhile. Targets stay the same
        during all ticks: a kinematic body reaches its target in the first one. An interrupt from the keyboard ends
        the step between two ticks.
        """
    def events(self, /) -> list[dict[str, Any]]:
        """Returns the events of the last call of `step`, and of the actions after it: a list of dicts with the key
        "type" and the fields of the event.

        Bodies are handles. Pieces are tuples of a SoftBodyHandle and a piece number. Types: node_split,
        piece_detached, contact_force, contact_started, contact_ended, sensor_entered, sensor_exited, cut,
        joint_broke, grip_ended, fell_asleep, woke_up, piece_removed, soft_body_removed, rigid_body_removed,
        overlapped, left_range, quarantined, impact_slowed, stiff_body_scaled. A restored snapshot has the events
        of the last tick only.
        """
    def hash(self, /) -> int:
        """Returns the hash of the state: an integer of 64 bits, equal for equal worlds on every computer."""
    def add_soft_body(self, /, body: SoftBody2) -> SoftBodyHandle:
        """Adds a copy of a soft body and returns its handle."""
    def add_rigid_body(self, /, body: RigidBody2) -> RigidBodyHandle:
        """Adds a rigid body and returns its handle."""
    def add_joint(self, /, joint: Joint2) -> JointHandle:
        """Adds a joint and returns its handle. Its anchors stay attached to the points of the bodies where they are now."""
    def add_knife(
        self,
        /,
        holder: RigidBodyHandle,
        edge: tuple[_Vector, _Vector],
        toward: _Vector,
        *,
        radius: float = 0.0,
        height: float = 0.02,
    ) -> KnifeHandle:
        """Attaches a knife to a kinematic or coupled rigid body and returns its handle.

        edge: both ends of the cutting edge in local coordinates of the holder [m]; toward: cutting direction in
        local coordinates; radius of the edge [m], 0 to 1, 0 = sharp; height of the blade [m], 0 to 10. In 2D, only
        the midpoint of the edge is used.
        """
    def add_grip(
        self,
        /,
        body: SoftBodyHandle,
        region: Shape2,
        *,
        force: _Vector | None = None,
        carrier: RigidBodyHandle | None = None,
    ) -> GripHandle:
        """Grips the nodes of a soft body inside a shape, and returns the handle of the grip.

        Without force and carrier, the nodes are held where they are. carrier: handle of a rigid body that carries the
        nodes. force: force on all nodes together [N].
        """
    def set_grip_force(self, /, grip: GripHandle, force: _Vector) -> None:
        """Sets the force of a grip [N]."""
    def grip_reaction(self, /, grip: GripHandle) -> dict[str, Any]:
        """Returns the force with which a grip held or moved its nodes in the last tick: a dict with point [m], force [N]
        and torque about the point [N m].
        """
    def grip_node_count(self, /, grip: GripHandle) -> int:
        """Returns the number of nodes in a grip."""
    def joint(self, /, joint: JointHandle) -> Joint2:
        """Returns the definition of a joint as it was added."""
    def joint_reaction(self, /, joint: JointHandle) -> _F32:
        """Returns the force of a joint on its first anchor in the last substep [N]: float32 array (d,). The force on the
        second anchor is opposite.
        """
    def knife_reaction(self, /, knife: KnifeHandle) -> dict[str, Any]:
        """Returns the force of the cut material on a knife in the last substep: a dict with point, the position of the
        holder [m], force [N] and torque about the point [N m].
        """
    def acting_damping(self, /, body: SoftBodyHandle) -> list[tuple[float, float]]:
        """Returns the damping that acts in a soft body: a list of pairs of mass damping [1/s] and stiffness damping [s],
        one for each material. The substep limits stiffness damping; more substeps, larger voxels or a softer
        material raise the limit. In a body with a mass scale, mass damping is lower and stiffness damping higher.
        """
    def joint_anchors(self, /, joint: JointHandle) -> tuple[_F32, _F32] | None:
        """Returns the positions of both anchors of a joint [m]; None if an attached body was removed."""
    def remove(self, /, handle: _Handle) -> Any:
        """Removes a soft body, a rigid body, a joint, a knife or a grip. Returns the body or the joint as it was, and
        None for a knife or a grip.
        """
    def remove_piece(self, /, body: SoftBodyHandle, piece: int) -> dict[str, Any]:
        """Removes a piece of a soft body. Returns a dict with pieces, soft_bodies, rigid_bodies and mass [kg]."""
    def remove_small_pieces(
        self, /, *, voxels: int | None = None, volume: float | None = None, mass: float | None = None
    ) -> dict[str, Any]:
        """Removes all pieces with fewer voxels, less volume [m³] or less mass [kg] than given. Returns a dict with
        pieces, soft_bodies, rigid_bodies and mass [kg].
        """
    def remove_outside(self, /, region: Shape2) -> dict[str, Any]:
        """Removes the pieces and dynamic rigid bodies that are outside of a shape. Returns a dict with pieces,
        soft_bodies, rigid_bodies and mass [kg].
        """
    def soft_body(self, /, handle: SoftBodyHandle) -> SoftBodyView2:
        """Returns a view of a soft body."""
    def rigid_body(self, /, handle: RigidBodyHandle) -> RigidBodyView2:
        """Returns a view of a rigid body."""
    def __getitem__(self, handle: SoftBodyHandle | RigidBodyHandle, /) -> Any: ...
    def __contains__(self, handle: _Handle, /) -> bool: ...
    def set_target_position(self, /, body: RigidBodyHandle, position: _Vector) -> None:
        """Sets the position that a kinematic body reaches in the next tick, or to which a coupled body is pulled [m]."""
    def set_target_rotation(self, /, body: RigidBodyHandle, rotation: _Rotation) -> None:
        """Sets the rotation that a kinematic or coupled body reaches in the next tick: an angle [rad] in 2D, a
        quaternion x, y, z, w or a rotation vector in 3D.
        """
    def set_pose(self, /, body: RigidBodyHandle, position: _Vector, rotation: _Rotation | None = None) -> None:
        """Sets the position [m] and the rotation of a rigid body immediately."""
    def translate(self, /, body: _Body, by: _Vector) -> None:
        """Translates a body by a vector [m] immediately; obstacles do not stop it."""
    def rotate_about(self, /, body: _Body, rotation: _Rotation, point: _Vector) -> None:
        """Rotates a body and its velocities about a point [m] immediately; obstacles do not stop it."""
    def velocity(self, /, body: _Body) -> tuple[_F32, float]:
        """Returns the velocity of a body: linear [m/s], and angular [rad/s] (a number in 2D, a vector in 3D). For a soft
        body, that of the rigid motion with the same momentum.
        """
    def set_velocity(self, /, body: _Body, linear: _Vector | None = None, angular: _Vector | None = None) -> None:
        """Sets the velocity of a soft body or a dynamic rigid body: linear [m/s], and angular [rad/s] (a number in 2D, a
        vector in 3D). In a soft body, this ends all vibration.
        """
    def add_velocity(self, /, body: _Body, linear: _Vector | None = None, angular: _Vector | None = None) -> None:
        """Adds a velocity to that of a soft body or a dynamic rigid body."""
    def apply_impulse(self, /, body: _Body, point: _Vector, impulse: _Vector, radius: float = 0.0) -> None:
        """Applies an impulse [N s] at a point [m] of a soft body or a dynamic rigid body. A soft body takes it at the
        nodes within `radius` [m] of the point.
        """
    def set_motion(
        self,
        /,
        body: RigidBodyHandle,
        motion: _Motion,
        *,
        mass: float | None = None,
        stiffness: float = 3000.0,
        damping: float = 0.9,
        max_force: float = 1000.0,
    ) -> None:
        """Changes the motion type of a rigid body: "fixed", "kinematic", "coupled" or "dynamic". mass [kg] is required
        for dynamic bodies (default of coupled ones: 2). stiffness [N/m], damping ratio and max_force [N] are those of
        coupled bodies.
        """
    def set_friction(self, /, body: RigidBodyHandle, friction: float) -> None:
        """Sets the Coulomb friction coefficient of a rigid body, 0 or more."""
    def set_restitution(self, /, body: RigidBodyHandle, restitution: float) -> None:
        """Sets the coefficient of restitution of a rigid body, 0 to 1."""
    def set_sensor(self, /, body: RigidBodyHandle, is_sensor: bool) -> None:
        """Sets whether a rigid body only reports what enters it."""
    def set_layers(self, /, body: _Body, memberships: int, filters: int) -> None:
        """Sets the layers of a body: bit masks of memberships and filters."""
    def set_user_data(self, /, body: _Body, user_data: int) -> None:
        """Sets the number of the program of a body."""
    def set_gravity_scale(self, /, body: SoftBodyHandle, scale: float) -> None:
        """Sets the factor on gravity of a soft body, -100 to 100, default 1."""
    def wake_up(self, /, body: _Body) -> None:
        """Wakes a body."""
    def put_to_sleep(self, /, body: _Body) -> None:
        """Puts a body to sleep."""
    def cut(self, /, body: SoftBodyHandle, start: _Vector, end: _Vector) -> int:
        """Cuts a soft body along a segment between two points [m]. Returns the number of nodes that were split."""
    def reaction(self, /, object: _Object) -> dict[str, Any]:
        """Returns the contact force and torque on a rigid body, a soft body or a piece in the last tick: a dict with
        point [m], force [N] and torque about the point [N m].
        """
    def fixed_node_reaction(self, /, body: SoftBodyHandle, region: Shape2) -> dict[str, Any]:
        """Returns the force and torque that hold the fixed nodes of a soft body inside a shape: a dict with point [m],
        force [N] and torque about the point [N m].
        """
    def contacts_of(self, /, object: _Object) -> list[dict[str, Any]]:
        """Returns the contacts of a rigid body, a soft body or a piece: a list of dicts, like the events
        "contact_force".
        """
    def ray_cast(
        self,
        /,
        origin: _Vector,
        direction: _Vector,
        max_distance: float = ...,
        *,
        exclude: _Object | Sequence[_Object] | None = None,
        only: Literal["soft", "rigid"] | None = None,
        layers: tuple[int, int] | None = None,
        sensors: bool = False,
        predicate: Callable[[_Piece | RigidBodyHandle], object] | None = None,
    ) -> dict[str, Any] | None:
        """Returns the first object that a ray hits within `max_distance` [m], or None: a dict with object, element (id),
        material, point [m], normal and distance [m].

        The queries have the same filters. exclude: a body, a piece, or a list of them; only: "soft" or "rigid";
        layers: bit masks of memberships and filters, which the layers of an object must meet; sensors: whether
        sensors count; predicate: function that gets an object (a handle of a rigid body, or a tuple of a handle of
        a soft body and a piece number) and returns whether it counts. It may read the world, and it may be called
        several times for an object.
        """
    def closest_point(
        self,
        /,
        point: _Vector,
        max_distance: float = ...,
        *,
        exclude: _Object | Sequence[_Object] | None = None,
        only: Literal["soft", "rigid"] | None = None,
        layers: tuple[int, int] | None = None,
        sensors: bool = False,
        predicate: Callable[[_Piece | RigidBodyHandle], object] | None = None,
    ) -> dict[str, Any] | None:
        """Returns the point of a surface that is closest to a point, within `max_distance` [m], or None: a dict with
        object, element (id), material, point [m], normal and distance [m]. The filters are those of `ray_cast`.
        """
    def objects_at(
        self,
        /,
        point: _Vector,
        *,
        exclude: _Object | Sequence[_Object] | None = None,
        only: Literal["soft", "rigid"] | None = None,
        layers: tuple[int, int] | None = None,
        sensors: bool = False,
        predicate: Callable[[_Piece | RigidBodyHandle], object] | None = None,
    ) -> list[dict[str, Any]]:
        """Returns the objects that contain a point: a list of dicts with object, element (id) and material. The filters
        are those of `ray_cast`.
        """
    def overlaps(
        self,
        /,
        shape: Shape2,
        *,
        exclude: _Object | Sequence[_Object] | None = None,
        only: Literal["soft", "rigid"] | None = None,
        layers: tuple[int, int] | None = None,
        sensors: bool = False,
        predicate: Callable[[_Piece | RigidBodyHandle], object] | None = None,
    ) -> list[dict[str, Any]]:
        """Returns the objects that overlap a shape: a list of dicts with object, element (id) and material. The filters
        are those of `ray_cast`.
        """
    def snapshot(self, /) -> bytes:
        """Returns the state as bytes, for `restore`."""
    @staticmethod
    def restore(snapshot: bytes) -> World2:
        """Returns the world of a snapshot. It has the same hash and goes on with the same bits."""
    def copy(self, /) -> World2:
        """Returns a copy, which shares the mesh with this world until either tears. Handles are valid in both."""
    def __copy__(self, /) -> World2: ...
    def __deepcopy__(self, /, _memo: Any) -> World2: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...
    def to_scene(self, /) -> Scene:
        """Returns a scene that describes the present state of the world. A world that was not stepped since it was built
        is rebuilt with the same hash. Contacts, events, sleep timers and the number of ticks are not included: use
        `snapshot` to go on with the same bits.
        """
    @property
    def view(self, /) -> tuple[_F32, _F32]:
        """Low and high corner of the region that a picture shows by default [m]: that of all bodies, with a margin."""
    def rgb(self, /, *, view: tuple[_Vector, _Vector] | None = None, width: int = 480, elements: bool = False) -> _U8:
        """Returns a picture as an array: uint8 (height, width, 3), red, green and blue, the top row first.

        view: low and high corner of the visible region [m], by default that of all bodies; width [pixels], 16 to
        4096; elements: whether the elements are shown instead of the surface. The height follows from the view
        in 2D; in 3D, the picture is a square. Painted without a GPU.
        """
    def png(self, /, *, view: tuple[_Vector, _Vector] | None = None, width: int = 480, elements: bool = False) -> bytes:
        """Returns a picture as a PNG file. The keywords are those of `rgb`."""
    def _repr_png_(self, /) -> bytes: ...
    def save_png(
        self,
        /,
        path: str | PathLike[str],
        *,
        view: tuple[_Vector, _Vector] | None = None,
        width: int = 480,
        elements: bool = False,
    ) -> None:
        """Writes a picture into a PNG file. The keywords are those of `rgb`."""
    def plot(
        self,
        /,
        ax: Any = None,
        *,
        color: Literal["material", "strain", "damage", "piece"] = "material",
        cmap: str = "viridis",
        vmin: float | None = None,
        vmax: float | None = None,
    ) -> Any:
        """Draws the world with matplotlib and returns the axes.

        ax: axes to draw into, by default new ones; color: "material" (default), "strain", "damage" or "piece";
        cmap: colour map of strain and damage; vmin and vmax: range of the colours. Raises ImportError without
        matplotlib.
        """

@final
class Shape3:
    """Shape in 3D: a ball, box, capsule or half-space. Lengths are in metres.

    Vectors are sequences or arrays. Rotations are angles [rad] in 2D. In 3D they are quaternions x, y, z, w, or
    rotation vectors: an axis whose length is the angle [rad].
    """

    @staticmethod
    def ball(radius: float, centre: _Vector | None = None) -> Shape3:
        """Returns a ball (in 2D a disc) with a radius [m] and a centre [m], by default the origin."""
    @staticmethod
    def box(half: _Vector, centre: _Vector | None = None, rotation: _Rotation | None = None) -> Shape3:
        """Returns a box from half of its extents [m], its centre [m], by default the origin, and its rotation."""
    @staticmethod
    def capsule(start: _Vector, end: _Vector, radius: float) -> Shape3:
        """Returns a capsule: all points within `radius` [m] of the segment between two points [m]."""
    @staticmethod
    def half_space(normal: _Vector, point: _Vector | None = None) -> Shape3:
        """Returns the half-space on the far side of a plane through `point` [m], by default the origin. The normal points
        out of the solid side; its length has no effect. A floor is `half_space((0, 1))` in 2D.
        """
    def translated(self, /, by: _Vector) -> Shape3:
        """Returns the shape translated by a vector [m]."""
    def rotated(self, /, by: _Rotation) -> Shape3:
        """Returns the shape rotated about the origin."""
    def distance(self, /, point: _Vector) -> tuple[float, _F32]:
        """Returns the signed distance of a point [m], negative inside, and the outward normal there."""
    @property
    def bounds(self, /) -> tuple[_F32, _F32]:
        """Low and high corner of the bounding box [m]; infinite for half-spaces."""
    @property
    def parameters(self, /) -> dict[str, Any]:
        """Kind of the shape and its parameters, by name."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...

@final
class VoxelGrid3:
    """Grid of voxels in 3D: a material number for each voxel, 0 = empty.

    Arrays have the axes [x, y, z], as positions have these coordinates: index 0 is the low end of
    each axis, and y points up. An image, whose rows run downwards, becomes such an array by `image[::-1].T`.
    The low corner of a grid is at the origin of its body.
    """

    def __new__(cls, array: _U8 | _Bool, voxel_size: float) -> VoxelGrid3: ...
    @staticmethod
    def ball(n: int, diameter: float = 1.0) -> VoxelGrid3:
        """Returns a ball (in 2D a disc) with a diameter [m], `n` voxels across."""
    @staticmethod
    def cube(n: int, width: float = 1.0) -> VoxelGrid3:
        """Returns a cube (in 2D a square) with a width [m], `n` voxels wide."""
    @staticmethod
    def ring(n: int, diameter: float = 1.0) -> VoxelGrid3:
        """Returns a ring (in 3D a torus) with an outer diameter [m], `n` voxels across."""
    @staticmethod
    def heart(n: int, width: float = 1.0) -> VoxelGrid3:
        """Returns a heart with a width [m], `n` voxels wide."""
    @staticmethod
    def flower(n: int, width: float = 1.0) -> VoxelGrid3:
        """Returns a flower with a width [m], `n` voxels wide."""
    @staticmethod
    def from_shape(shape: Shape3, voxel_size: float) -> VoxelGrid3:
        """Returns a grid of material 1 that covers a bounded shape and knows its surface, from the shape and the edge
        length of a voxel [m]. The position of the shape
        is lost: `SoftBody3.from_shape` keeps it.
        """
    @staticmethod
    def from_distance(
        size: Sequence[int], voxel_size: float, distance: Callable[[tuple[float, ...]], float]
    ) -> VoxelGrid3:
        """Returns a grid of material 1 from its size [voxels] and a function that returns the signed distance of a
        point from the surface [m], negative inside. Points are tuples [m], measured from the low corner of the
        grid. The function is called several times for each voxel at the surface. The grid knows its surface to
        1/64 voxel.
        """
    @staticmethod
    def vox(
        source: _File,
        *,
        voxel_size: float = 0.015625,
        colours: Mapping[int | tuple[int, int, int], int] | None = None,
        part: str | None = None,
    ) -> VoxelGrid3:
        """Returns the model in a MagicaVoxel file (.vox), from a path or bytes.

        The z axis of MagicaVoxel becomes y. voxel_size [m]; colours: a dict from palette indices (1 to 255) or
        (red, green, blue) to material numbers (0 = empty); by default the palette index is the material
        number. part: name of an object in the file.
        """
    @staticmethod
    def nifti(
        source: _File | list[_File],
        *,
        labels: Mapping[int, int] | None = None,
        thresholds: Sequence[tuple[float, float, int]] | None = None,
        resolution: int = 64,
        fill_holes: bool = False,
    ) -> VoxelGrid3:
        """Returns the largest connected object in a medical scan: NIfTI-1 or NIfTI-2 (.nii, .nii.gz), from a path or
        bytes. This is not a medical device.

        One of three arguments decides the materials:

        - labels: a dict from integer labels to material numbers
        - thresholds: a list of (low, high, material number) of intensities; the first match decides
        - neither of both: `source` is a list of probability maps, one for each material

        resolution: number of voxels along the longest side, 8 to 256; fill_holes: whether enclosed holes are filled.
        Lengths are those of the patient in metres. x points to the patient's right, y to the head, z to the back.
        """
    def to_vox(self, /, colours: Sequence[tuple[int, int, int]] | None = None) -> bytes:
        """Returns the model as a MagicaVoxel file. colours: a list of (red, green, blue), for material number 1 first."""
    @property
    def array(self, /) -> _U8:
        """Material numbers: uint8 array [x, y, z], a copy. Voxels of removed pieces keep their numbers."""
    @property
    def present(self, /) -> _Bool:
        """Whether each voxel is solid and was not removed with its piece: bool array [x, y, z], a copy."""
    @property
    def size(self, /) -> tuple[int, ...]:
        """Number of voxels on each axis."""
    @property
    def voxel_size(self, /) -> float:
        """Edge length of a voxel [m]."""
    @property
    def solid_count(self, /) -> int:
        """Number of solid voxels."""
    @property
    def has_surface(self, /) -> bool:
        """Whether the grid knows its smooth surface. Grids from arrays do not; contacts then use the smoothed surface
        of the voxels.
        """
    @property
    def notes(self, /) -> list[str]:
        """Notes of the importer on what was left out or may surprise; they are also shown as warnings."""
    def scaled(self, /, factor: float) -> VoxelGrid3:
        """Returns the grid with all lengths multiplied by a factor, and the same voxels."""
    def with_materials(self, /, array: _U8 | _Bool) -> VoxelGrid3:
        """Returns the grid with other material numbers, from an array of the same shape. If the same voxels are
        solid, the grid keeps its surface.
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...

@final
class RigidBody3:
    """Definition of a rigid body in 3D, for `World3.add_rigid_body`.

    All constructors have the keyword arguments position [m], rotation (an angle [rad] in 2D, a quaternion
    x, y, z, w or a rotation vector in 3D), friction (default 0.2; 0.5 of dynamic bodies), restitution (0 to 1,
    default 0), layers (a pair of bit masks: memberships and filters; default member of layer 1, meets all), is_sensor and
    user_data (an integer of 64 bits). A wrong value raises `Error` when the body is added to a world.
    """

    @staticmethod
    def fixed(
        shape: Shape3,
        *,
        position: _Vector | None = None,
        rotation: _Rotation | None = None,
        friction: float = 0.2,
        restitution: float = 0.0,
        layers: tuple[int, int] | None = None,
        is_sensor: bool = False,
        user_data: int = 0,
    ) -> RigidBody3:
        """Returns a rigid body that never moves. Bodies resting on it may sleep."""
    @staticmethod
    def kinematic(
        shape: Shape3,
        *,
        position: _Vector | None = None,
        rotation: _Rotation | None = None,
        friction: float = 0.2,
        restitution: float = 0.0,
        layers: tuple[int, int] | None = None,
        is_sensor: bool = False,
        user_data: int = 0,
    ) -> RigidBody3:
        """Returns a rigid body that reaches its target pose at the end of each tick, through any obstacle."""
    @staticmethod
    def coupled(
        shape: Shape3,
        *,
        mass: float = 2.0,
        stiffness: float = 3000.0,
        damping: float = 0.9,
        max_force: float = 1000.0,
        position: _Vector | None = None,
        rotation: _Rotation | None = None,
        friction: float = 0.2,
        restitution: float = 0.0,
        layers: tuple[int, int] | None = None,
        is_sensor: bool = False,
        user_data: int = 0,
    ) -> RigidBody3:
        """Returns a rigid body that a spring and a damper pull towards its target position, and that contacts stop.

        mass [kg], 1e-6 to 1e6; stiffness of the spring [N/m]; damping ratio, above 0 and up to 10; max_force of
        the coupling [N], infinite = no limit. Contacts do not rotate the body.
        """
    @staticmethod
    def dynamic(
        shape: Shape3,
        mass: float,
        *,
        velocity: _Vector | None = None,
        angular_velocity: _Vector | None = None,
        position: _Vector | None = None,
        rotation: _Rotation | None = None,
        friction: float = 0.5,
        restitution: float = 0.0,
        layers: tuple[int, int] | None = None,
        is_sensor: bool = False,
        user_data: int = 0,
    ) -> RigidBody3:
        """Returns a rigid body that gravity and contacts move and rotate. The shape must be bounded. Its middle becomes
        the origin of the body, and is the default of position.

        mass [kg], 1e-6 to 1e6, with uniform density; velocity [m/s]; angular_velocity [rad/s], a number in 2D
        and a vector in 3D.
        """
    @property
    def motion(self, /) -> dict[str, Any]:
        """Motion type and its parameters, by name."""
    @property
    def shape(self, /) -> Shape3:
        """Shape in local coordinates."""
    @property
    def position(self, /) -> _F32:
        """Position [m]."""
    @property
    def rotation(self, /) -> _F32:
        """Rotation: an angle [rad] in 2D, a quaternion x, y, z, w in 3D."""
    @property
    def velocity(self, /) -> _F32:
        """Velocity [m/s]."""
    @property
    def angular_velocity(self, /) -> _F32:
        """Angular velocity [rad/s]: a number in 2D, a vector in 3D."""
    @property
    def friction(self, /) -> float:
        """Coulomb friction coefficient."""
    @property
    def restitution(self, /) -> float:
        """Coefficient of restitution."""
    @property
    def layers(self, /) -> tuple[int, int]:
        """Bit masks of the layers: memberships and filters."""
    @property
    def is_sensor(self, /) -> bool:
        """Whether the body only reports what enters it."""
    @property
    def user_data(self, /) -> int:
        """Number of the program."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...

@final
class Joint3:
    """Definition of a joint in 3D, for `World3.add_joint`.

    An anchor is a point of the world [m], a pair (handle of a body, point), or (handle of a soft body, point,
    radius [m]), which spreads the force over the nodes within the radius. Points are in world coordinates at
    the time at which the joint is added. `breaking_force` [N]: the joint breaks above it; infinite (default) =
    never.
    """

    @staticmethod
    def pin(first: _Anchor, second: _Anchor, *, breaking_force: float = ...) -> Joint3:
        """Returns a joint that holds both anchors together."""
    @staticmethod
    def rope(first: _Anchor, second: _Anchor, length: float, *, breaking_force: float = ...) -> Joint3:
        """Returns a joint that keeps both anchors within `length` [m] of each other."""
    @staticmethod
    def spring(
        first: _Anchor, second: _Anchor, stiffness: float, damping: float, length: float, *, breaking_force: float = ...
    ) -> Joint3:
        """Returns a spring with a stiffness [N/m], a damping [N s/m] and a rest length [m]."""
    @property
    def kind(self, /) -> Literal["pin", "rope", "spring"]:
        """Kind of the joint: "pin", "rope" or "spring"."""
    @property
    def parameters(self, /) -> dict[str, Any]:
        """Kind of the joint and its parameters, by name: length [m] of a rope; stiffness [N/m], damping [N s/m] and rest
        length [m] of a spring.
        """
    @property
    def anchors(self, /) -> tuple[_Anchor, _Anchor]:
        """First and second anchor, in the form of the arguments of the constructors."""
    @property
    def breaking_force(self, /) -> float:
        """Force above which the joint breaks [N]."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...

@final
class SoftBody3:
    """Soft body in 3D outside of a world, for `World3.add_soft_body`.

    grid: a VoxelGrid3; materials: a Material for all voxels, or a list of materials for the
    numbers 1, 2, …; law: "corotational_vem" or "endo_2004"; grading: "graded" (elements small at the surface and
    large inside), "uniform" (elements of one voxel), or "coarse" (for counting only: does not tear).

    A world takes a copy, so one body can be added many times. All arrays are copies. Node i of an array is the
    same node in all arrays that were read at one moment, likewise for elements and pieces.
    """

    def __new__(
        cls,
        grid: VoxelGrid3,
        materials: _Materials = None,
        *,
        law: _Law = "corotational_vem",
        grading: _Grading = "graded",
    ) -> SoftBody3: ...
    @staticmethod
    def from_array(
        array: _U8 | _Bool,
        voxel_size: float,
        materials: _Materials = None,
        *,
        law: _Law = "corotational_vem",
        grading: _Grading = "graded",
    ) -> SoftBody3:
        """Returns a body from an array of material numbers (uint8, or bool for material 1) and the edge length of a
        voxel [m]. The axes are [x, y, z].
        """
    @staticmethod
    def from_shape(
        shape: Shape3,
        voxel_size: float,
        materials: _Materials = None,
        *,
        law: _Law = "corotational_vem",
        grading: _Grading = "graded",
    ) -> SoftBody3:
        """Returns a body of voxels that covers a bounded shape, at the position of the shape. voxel_size [m]."""
    @staticmethod
    def ball(
        n: int,
        diameter: float = 1.0,
        materials: _Materials = None,
        *,
        law: _Law = "corotational_vem",
        grading: _Grading = "graded",
    ) -> SoftBody3:
        """Returns a ball (in 2D a disc) with a diameter [m], `n` voxels across. Its low corner is at the origin."""
    @staticmethod
    def cube(
        n: int,
        width: float = 1.0,
        materials: _Materials = None,
        *,
        law: _Law = "corotational_vem",
        grading: _Grading = "graded",
    ) -> SoftBody3:
        """Returns a cube (in 2D a square) with a width [m], `n` voxels wide. Its low corner is at the origin."""
    def translated(self, /, by: _Vector) -> SoftBody3:
        """Returns a copy, translated by a vector [m]."""
    def rotated(self, /, rotation: _Rotation, about: _Vector | None = None) -> SoftBody3:
        """Returns a copy, rotated about a point [m] (default the centre of mass). The rotation is an angle [rad] in
        2D, and a quaternion x, y, z, w or a rotation vector in 3D.
        """
    def with_velocity(self, /, linear: _Vector | None = None, angular: _Vector | None = None) -> SoftBody3:
        """Returns a copy with the velocity of a rigid motion: linear [m/s], and angular [rad/s] about the centre of
        mass (a number in 2D, a vector in 3D).
        """
    def with_layers(self, /, memberships: int, filters: int) -> SoftBody3:
        """Returns a copy with other layers: bit masks of memberships and filters."""
    def with_user_data(self, /, user_data: int) -> SoftBody3:
        """Returns a copy with another number of the program."""
    def copy(self, /) -> SoftBody3:
        """Returns a copy."""
    def __copy__(self, /) -> SoftBody3: ...
    def __deepcopy__(self, /, _memo: Any) -> SoftBody3: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...
    @property
    def node_count(self, /) -> int:
        """Number of nodes n."""
    @property
    def element_count(self, /) -> int:
        """Number of elements m."""
    @property
    def piece_count(self, /) -> int:
        """Number of pieces that were not removed."""
    @property
    def mass(self, /) -> float:
        """Mass [kg]."""
    @property
    def centre_of_mass(self, /) -> _F32:
        """Centre of mass [m]: float32 array (d,)."""
    @property
    def kinetic_energy(self, /) -> float:
        """Kinetic energy [J]."""
    @property
    def momentum(self, /) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Linear momentum [N s] and angular momentum about the origin [N m s], both as tuples of 3 numbers."""
    @property
    def grid(self, /) -> VoxelGrid3:
        """Voxels of the body."""
    @property
    def materials(self, /) -> list[Material]:
        """Materials, for the numbers 1, 2, …."""
    @property
    def law(self, /) -> _Law:
        """Elastic law: "corotational_vem" or "endo_2004"."""
    @property
    def grading(self, /) -> _Grading:
        """Grading of the elements: "graded", "uniform" or "coarse"."""
    @property
    def layers(self, /) -> tuple[int, int]:
        """Bit masks of the layers: memberships and filters."""
    @property
    def user_data(self, /) -> int:
        """Number of the program."""
    @property
    def gravity_scale(self, /) -> float:
        """Factor by which gravity is multiplied for this body, see `set_gravity_scale` of the world."""
    @property
    def mass_scale(self, /) -> float:
        """Factor s by which the inertia of deformation was raised to keep the substep stable, 1 = unchanged: vibrations
        are √s times slower. It acts with the setting stiff_bodies="mass_scaled".
        """
    @property
    def stiffness_scale(self, /) -> float:
        """Factor by which Young's modulus was lowered to keep the substep stable, 1 = unchanged. It acts with the
        setting stiff_bodies="softened".
        """
    @property
    def inverted_count(self, /) -> int:
        """Number of awake elements that are turned inside out."""
    @property
    def range(self, /) -> float:
        """Largest absolute coordinate at which the body may be added to a world or moved by hand [m]: 8192 voxels."""
    @property
    def node_ids(self, /) -> _U32:
        """Ids of the nodes: uint32 array (n,), ascending. Ids are reused after a node is removed."""
    @property
    def positions(self, /) -> _F32:
        """Positions of the nodes [m]: float32 array (n, d), a copy."""
    @property
    def velocities(self, /) -> _F32:
        """Velocities of the nodes [m/s]: float32 array (n, d), a copy."""
    @property
    def forces(self, /) -> _F32:
        """Elastic forces on the nodes in the last substep in which the body was awake [N]: float32 array (n, d), a copy."""
    @property
    def node_masses(self, /) -> _F32:
        """Masses of the nodes [kg]: float32 array (n,), a copy."""
    @property
    def rest_positions(self, /) -> _F32:
        """Positions of the nodes in the undeformed body, whose low corner is at the origin [m]: float32 array (n, d)."""
    @property
    def surface_positions(self, /) -> _F32:
        """Positions of the nodes on the smooth surface [m]: float32 array (n, d). Inner nodes have their own position."""
    @property
    def damage(self, /) -> _F32:
        """Damage of the nodes: float32 array (n,), a copy. 0 is intact. A node splits as soon as its damage is 1 or more,
        unless a node nearby has just split: then it waits for some milliseconds. Damage grows in steps of up to 6.25,
        so that waiting nodes have a damage above 1, seldom above 20. Nodes that are no longer overloaded heal.
        """
    @property
    def fixed(self, /) -> _Bool:
        """Whether each node is fixed: bool array (n,), a copy."""
    @property
    def node_pieces(self, /) -> _U32:
        """Piece number of each node: uint32 array (n,), a copy."""
    @property
    def element_ids(self, /) -> _U32:
        """Ids of the elements: uint32 array (m,), ascending. Ids are reused after an element is removed."""
    @property
    def elements(self, /) -> _I32:
        """Nodes of the elements: int32 array (m, 3**d) of rows of `positions`, -1 where an element has no node.

        Columns are the points of a 3 × 3 (× 3) lattice over the cell of the element, x fastest: in 2D, columns 0,
        2, 6 and 8 are the corners, 1, 3, 5 and 7 the middles of the edges. Elements of level 0 have nodes at
        all corners only. Larger elements may fill only a part of their cell.
        """
    @property
    def levels(self, /) -> _U8:
        """Levels of the elements: uint8 array (m,). The cell of an element is 2**level voxels wide."""
    @property
    def element_materials(self, /) -> _U8:
        """Material numbers of the elements: uint8 array (m,)."""
    @property
    def element_pieces(self, /) -> _U32:
        """Piece numbers of the elements: uint32 array (m,)."""
    @property
    def strain(self, /) -> _F32:
        """Elastic strain ‖F − R‖ of the elements: float32 array (m,). 0.1 is a stretch by a tenth."""
    @property
    def plastic_strain(self, /) -> _F32:
        """Plastic strain of the elements: float32 array (m,). 0 without permanent deformation."""
    @property
    def biot_strain(self, /) -> _F64:
        """Elastic Biot strain of the elements along the axes of the undeformed body, the symmetric part of RᵀF - 1: float64
        array (m, d, d). 0.1 is a stretch by a tenth. F is without the plastic part, and R is its rotation.
        """
    @property
    def deformation(self, /) -> _F64:
        """Deformation gradients F of the elements: float64 array (m, d, d)."""
    @property
    def stress(self, /) -> _F64:
        """Cauchy stress of the elements along the axes of the world [Pa]: float64 array (m, d, d)."""
    @property
    def elastic_energy(self, /) -> _F64:
        """Elastic energy of the elements [J]: float64 array (m,). In 2D for 1 m of depth."""
    def energies(self, /, gravity: _Vector) -> _F64:
        """Returns the kinetic, elastic and gravitational energy of each piece [J], for a gravity [m/s²]: float64
        array (pieces, 3).
        """
    def cells(self, /) -> tuple[_F32, _I32]:
        """Returns the blocks that the elements fill: corners [m] as float32 array (k, 2**d, d), the first axis fastest,
        and the row of the element of each block as int32 array (k,). In 2D, corners 0, 1, 3, 2 go around a block.
        """
    def facets(self, /) -> tuple[_I32, _I32, _Bool]:
        """Returns the exposed faces: int32 array (f, 2**(d-1)) of rows of nodes, counterclockwise as seen from
        outside, int32 array (f,) of rows of elements, and bool array (f,): whether the face was torn.
        """
    def outlines(self, /) -> list[dict[str, Any]]:
        """Returns the closed lines around all pieces of a 2D body and around their holes: a list of dicts with the
        keys piece, nodes (rows), points [m] (p, 2) and torn (p,). Empty in 3D.
        """
    def pieces(self, /) -> dict[str, NDArray[Any]]:
        """Returns the pieces: a dict of arrays whose row is the piece number. mass [kg]; centre of mass [m], velocity
        [m/s], and low and high corner of the bounding box [m], all (pieces, d); element_count; asleep; quarantined;
        removed. Removed pieces keep their row, with mass 0.
        """
    def nodes_in(self, /, region: Shape3) -> _I32:
        """Returns the rows of the nodes inside a shape or on its surface: int32 array."""
    def mass_inside(self, /, region: Shape3) -> float:
        """Returns the mass of the nodes inside a shape [kg]."""
    def sums_inside(self, /, region: Shape3) -> dict[str, Any]:
        """Returns sums over the part of the body inside a shape or on its surface: a dict with nodes, their number; mass
        [kg]; centre of mass [m]; momentum [kg m/s]; elastic_force [N], the force of the rest of the body on this part
        in the last substep; elastic_energy [J] of the elements whose centre is inside (in 2D for 1 m of depth).
        """
    def fix_nodes(self, /, nodes: ArrayLike) -> None:
        """Fixes nodes at their positions. nodes: n bools, or rows."""
    def free_nodes(self, /, nodes: ArrayLike) -> None:
        """Frees fixed nodes. nodes: n bools, or rows."""
    def set_node_states(self, /, positions: _F32 | _F64 | None = None, velocities: _F32 | _F64 | None = None) -> None:
        """Sets the positions [m] and velocities [m/s] of all nodes from arrays (n, d) of float32 or float64. Positions must
        be within `range`.
        """

@final
class SoftBodyView3:
    """View of a soft body in a World3: `world[handle]` or `world.soft_body(handle)`.

    Each access reads the present state of the world and raises `Error` if the body was removed. All arrays are
    copies, which stay as they are when the world steps. Node i of an array is the same node in all arrays that
    were read at one moment; when the body tears, nodes and elements come and go.
    """

    @property
    def handle(self, /) -> SoftBodyHandle:
        """Handle of the body."""
    @property
    def world(self, /) -> World3:
        """World of the body."""
    def copy(self, /) -> SoftBody3:
        """Returns a copy of the body, outside of the world."""
    @property
    def node_count(self, /) -> int:
        """Number of nodes n."""
    @property
    def element_count(self, /) -> int:
        """Number of elements m."""
    @property
    def piece_count(self, /) -> int:
        """Number of pieces that were not removed."""
    @property
    def mass(self, /) -> float:
        """Mass [kg]."""
    @property
    def centre_of_mass(self, /) -> _F32:
        """Centre of mass [m]: float32 array (d,)."""
    @property
    def kinetic_energy(self, /) -> float:
        """Kinetic energy [J]."""
    @property
    def momentum(self, /) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Linear momentum [N s] and angular momentum about the origin [N m s], both as tuples of 3 numbers."""
    @property
    def grid(self, /) -> VoxelGrid3:
        """Voxels of the body."""
    @property
    def materials(self, /) -> list[Material]:
        """Materials, for the numbers 1, 2, …."""
    @property
    def law(self, /) -> _Law:
        """Elastic law: "corotational_vem" or "endo_2004"."""
    @property
    def grading(self, /) -> _Grading:
        """Grading of the elements: "graded", "uniform" or "coarse"."""
    @property
    def layers(self, /) -> tuple[int, int]:
        """Bit masks of the layers: memberships and filters."""
    @property
    def user_data(self, /) -> int:
        """Number of the program."""
    @property
    def gravity_scale(self, /) -> float:
        """Factor by which gravity is multiplied for this body, see `set_gravity_scale` of the world."""
    @property
    def mass_scale(self, /) -> float:
        """Factor s by which the inertia of deformation was raised to keep the substep stable, 1 = unchanged: vibrations
        are √s times slower. It acts with the setting stiff_bodies="mass_scaled".
        """
    @property
    def stiffness_scale(self, /) -> float:
        """Factor by which Young's modulus was lowered to keep the substep stable, 1 = unchanged. It acts with the
        setting stiff_bodies="softened".
        """
    @property
    def inverted_count(self, /) -> int:
        """Number of awake elements that are turned inside out."""
    @property
    def range(self, /) -> float:
        """Largest absolute coordinate at which the body may be added to a world or moved by hand [m]: 8192 voxels."""
    @property
    def node_ids(self, /) -> _U32:
        """Ids of the nodes: uint32 array (n,), ascending. Ids are reused after a node is removed."""
    @property
    def positions(self, /) -> _F32:
        """Positions of the nodes [m]: float32 array (n, d), a copy."""
    @property
    def velocities(self, /) -> _F32:
        """Velocities of the nodes [m/s]: float32 array (n, d), a copy."""
    @property
    def forces(self, /) -> _F32:
        """Elastic forces on the nodes in the last substep in which the body was awake [N]: float32 array (n, d), a copy."""
    @property
    def node_masses(self, /) -> _F32:
        """Masses of the nodes [kg]: float32 array (n,), a copy."""
    @property
    def rest_positions(self, /) -> _F32:
        """Positions of the nodes in the undeformed body, whose low corner is at the origin [m]: float32 array (n, d)."""
    @property
    def surface_positions(self, /) -> _F32:
        """Positions of the nodes on the smooth surface [m]: float32 array (n, d). Inner nodes have their own position."""
    @property
    def damage(self, /) -> _F32:
        """Damage of the nodes: float32 array (n,), a copy. 0 is intact. A node splits as soon as its damage is 1 or more,
        unless a node nearby has just split: then it waits for some milliseconds. Damage grows in steps of up to 6.25,
        so that waiting nodes have a damage above 1, seldom above 20. Nodes that are no longer overloaded heal.
        """
    @property
    def fixed(self, /) -> _Bool:
        """Whether each node is fixed: bool array (n,), a copy."""
    @property
    def node_pieces(self, /) -> _U32:
        """Piece number of each node: uint32 array (n,), a copy."""
    @property
    def element_ids(self, /) -> _U32:
        """Ids of the elements: uint32 array (m,), ascending. Ids are reused after an element is removed."""
    @property
    def elements(self, /) -> _I32:
        """Nodes of the elements: int32 array (m, 3**d) of rows of `positions`, -1 where an element has no node.

        Columns are the points of a 3 × 3 (× 3) lattice over the cell of the element, x fastest: in 2D, columns 0,
        2, 6 and 8 are the corners, 1, 3, 5 and 7 the middles of the edges. Elements of level 0 have nodes at
        all corners only. Larger elements may fill only a part of their cell.
        """
    @property
    def levels(self, /) -> _U8:
        """Levels of the elements: uint8 array (m,). The cell of an element is 2**level voxels wide."""
    @property
    def element_materials(self, /) -> _U8:
        """Material numbers of the elements: uint8 array (m,)."""
    @property
    def element_pieces(self, /) -> _U32:
        """Piece numbers of the elements: uint32 array (m,)."""
    @property
    def strain(self, /) -> _F32:
        """Elastic strain ‖F − R‖ of the elements: float32 array (m,). 0.1 is a stretch by a tenth."""
    @property
    def plastic_strain(self, /) -> _F32:
        """Plastic strain of the elements: float32 array (m,). 0 without permanent deformation."""
    @property
    def biot_strain(self, /) -> _F64:
        """Elastic Biot strain of the elements along the axes of the undeformed body, the symmetric part of RᵀF - 1: float64
        array (m, d, d). 0.1 is a stretch by a tenth. F is without the plastic part, and R is its rotation.
        """
    @property
    def deformation(self, /) -> _F64:
        """Deformation gradients F of the elements: float64 array (m, d, d)."""
    @property
    def stress(self, /) -> _F64:
        """Cauchy stress of the elements along the axes of the world [Pa]: float64 array (m, d, d)."""
    @property
    def elastic_energy(self, /) -> _F64:
        """Elastic energy of the elements [J]: float64 array (m,). In 2D for 1 m of depth."""
    def energies(self, /, gravity: _Vector) -> _F64:
        """Returns the kinetic, elastic and gravitational energy of each piece [J], for a gravity [m/s²]: float64
        array (pieces, 3).
        """
    def cells(self, /) -> tuple[_F32, _I32]:
        """Returns the blocks that the elements fill: corners [m] as float32 array (k, 2**d, d), the first axis fastest,
        and the row of the element of each block as int32 array (k,). In 2D, corners 0, 1, 3, 2 go around a block.
        """
    def facets(self, /) -> tuple[_I32, _I32, _Bool]:
        """Returns the exposed faces: int32 array (f, 2**(d-1)) of rows of nodes, counterclockwise as seen from
        outside, int32 array (f,) of rows of elements, and bool array (f,): whether the face was torn.
        """
    def outlines(self, /) -> list[dict[str, Any]]:
        """Returns the closed lines around all pieces of a 2D body and around their holes: a list of dicts with the
        keys piece, nodes (rows), points [m] (p, 2) and torn (p,). Empty in 3D.
        """
    def pieces(self, /) -> dict[str, NDArray[Any]]:
        """Returns the pieces: a dict of arrays whose row is the piece number. mass [kg]; centre of mass [m], velocity
        [m/s], and low and high corner of the bounding box [m], all (pieces, d); element_count; asleep; quarantined;
        removed. Removed pieces keep their row, with mass 0.
        """
    def nodes_in(self, /, region: Shape3) -> _I32:
        """Returns the rows of the nodes inside a shape or on its surface: int32 array."""
    def mass_inside(self, /, region: Shape3) -> float:
        """Returns the mass of the nodes inside a shape [kg]."""
    def sums_inside(self, /, region: Shape3) -> dict[str, Any]:
        """Returns sums over the part of the body inside a shape or on its surface: a dict with nodes, their number; mass
        [kg]; centre of mass [m]; momentum [kg m/s]; elastic_force [N], the force of the rest of the body on this part
        in the last substep; elastic_energy [J] of the elements whose centre is inside (in 2D for 1 m of depth).
        """
    def fix_nodes(self, /, nodes: ArrayLike) -> None:
        """Fixes nodes at their positions. nodes: n bools, or rows."""
    def free_nodes(self, /, nodes: ArrayLike) -> None:
        """Frees fixed nodes. nodes: n bools, or rows."""
    def set_node_states(self, /, positions: _F32 | _F64 | None = None, velocities: _F32 | _F64 | None = None) -> None:
        """Sets the positions [m] and velocities [m/s] of all nodes from arrays (n, d) of float32 or float64. Positions must
        be within `range`.
        """

@final
class RigidBodyView3:
    """View of a rigid body in a World3: `world[handle]` or `world.rigid_body(handle)`.

    Each access reads the present state of the world and raises `Error` if the body was removed.
    """

    @property
    def handle(self, /) -> RigidBodyHandle:
        """Handle of the body."""
    @property
    def world(self, /) -> World3:
        """World of the body."""
    @property
    def motion(self, /) -> dict[str, Any]:
        """Motion type and its parameters, by name."""
    @property
    def asleep(self, /) -> bool:
        """Whether the body sleeps."""
    @property
    def position(self, /) -> _F32:
        """Position [m]."""
    @property
    def rotation(self, /) -> _F32:
        """Rotation: an angle [rad] in 2D, a quaternion x, y, z, w in 3D."""
    @property
    def velocity(self, /) -> _F32:
        """Velocity [m/s]."""
    @property
    def angular_velocity(self, /) -> _F32:
        """Angular velocity [rad/s]: a number in 2D, a vector in 3D."""
    @property
    def target_position(self, /) -> _F32:
        """Target position of a kinematic or coupled body [m]."""
    @property
    def target_rotation(self, /) -> _F32:
        """Target rotation of a kinematic or coupled body."""
    @property
    def shape(self, /) -> Shape3:
        """Shape in world coordinates."""
    @property
    def local_shape(self, /) -> Shape3:
        """Shape in local coordinates."""
    @property
    def friction(self, /) -> float:
        """Coulomb friction coefficient."""
    @property
    def restitution(self, /) -> float:
        """Coefficient of restitution."""
    @property
    def layers(self, /) -> tuple[int, int]:
        """Bit masks of the layers: memberships and filters."""
    @property
    def is_sensor(self, /) -> bool:
        """Whether the body only reports what enters it."""
    @property
    def user_data(self, /) -> int:
        """Number of the program."""
    def definition(self, /) -> RigidBody3:
        """Returns the definition of the body in its present state."""
    def reactions(self, /) -> dict[str, _F32]:
        """Returns the forces on the body in each substep of the last tick: a dict of float32 arrays with s rows.
        contact (s, d) [N]: force of all contacts; coupling (s, d) [N]: force of the virtual coupling, which a
        force-feedback device should play; torque [N m]: (s,) in 2D, (s, 3) in 3D. Empty for fixed bodies.
        """

@final
class World3:
    """World in 3D: soft bodies, rigid bodies, joints, knives and grips. `step` advances its time.

    Units are metres, kilograms, seconds, newtons and pascals; y points up. The same calls give the same bits on
    every computer. In 2D, bodies are sheets 1 m deep.

    - gravity [m/s²], default (0, -9.81, 0)
    - drag: decay rate of all velocities [1/s], 0 to 10, default 0
    - max_substeps in 1/60 s, 8 to 1024, default 64
    - stiff_bodies: treatment of soft bodies that require more substeps: "mass_scaled" (default), "softened" or
      "exact"
    - tick: length of a tick [s], 1/240 to 1/30, default 1/60
    - sleep: whether bodies at rest fall asleep, default True

    Methods raise `Error` for stale handles and wrong values, and then change nothing. Several threads may step
    different worlds at once, because `step` releases the GIL. A second call on a world that steps raises
    RuntimeError.
    """

    def __new__(
        cls,
        *,
        gravity: _Vector | None = None,
        drag: float | None = None,
        max_substeps: int | None = None,
        stiff_bodies: _StiffBodies | None = None,
        tick: float | None = None,
        sleep: bool | None = None,
    ) -> World3: ...
    def set_config(
        self,
        /,
        *,
        gravity: _Vector | None = None,
        drag: float | None = None,
        max_substeps: int | None = None,
        stiff_bodies: _StiffBodies | None = None,
        tick: float | None = None,
        sleep: bool | None = None,
    ) -> None:
        """Changes settings of the world; the keywords are those of the constructor."""
    @property
    def gravity(self, /) -> _F32:
        """Gravity [m/s²]: float32 array (d,)."""
    @gravity.setter
    def gravity(self, value: _Vector, /) -> None: ...
    @property
    def drag(self, /) -> float:
        """Decay rate of all velocities [1/s]."""
    @property
    def max_substeps(self, /) -> int:
        """Maximum number of substeps in 1/60 s."""
    @property
    def stiff_bodies(self, /) -> _StiffBodies:
        """Treatment of soft bodies that require more than `max_substeps`."""
    @property
    def tick(self, /) -> float:
        """Length of a tick [s]."""
    @property
    def sleep(self, /) -> bool:
        """Whether bodies at rest fall asleep."""
    @property
    def ticks(self, /) -> int:
        """Number of ticks since the world was created."""
    @property
    def time(self, /) -> float:
        """Time since the world was created [s]: the number of ticks times the present length of a tick."""
    @property
    def substeps(self, /) -> int:
        """Number of substeps in the next tick, which the stiffest body determines."""
    @property
    def soft_bodies(self, /) -> list[SoftBodyHandle]:
        """Handles of all soft bodies."""
    @property
    def rigid_bodies(self, /) -> list[RigidBodyHandle]:
        """Handles of all rigid bodies."""
    @property
    def joints(self, /) -> list[JointHandle]:
        """Handles of all joints."""
    @property
    def knives(self, /) -> list[KnifeHandle]:
        """Handles of all knives."""
    @property
    def grips(self, /) -> list[GripHandle]:
        """Handles of all grips."""
    def step(self, /, n: int = 1) -> StepReport:
        """Advances the world by `n` ticks and returns a report. Other threads run meanwhile. Targets stay the same
        during all ticks: a kinematic body reaches its target in the first one. An interrupt from the keyboard ends
        the step between two ticks.
        """
    def events(self, /) -> list[dict[str, Any]]:
        """Returns the events of the last call of `step`, and of the actions after it: a list of dicts with the key
        "type" and the fields of the event.

        Bodies are handles. Pieces are tuples of a SoftBodyHandle and a piece number. Types: node_split,
        piece_detached, contact_force, contact_started, contact_ended, sensor_entered, sensor_exited, cut,
        joint_broke, grip_ended, fell_asleep, woke_up, piece_removed, soft_body_removed, rigid_body_removed,
        overlapped, left_range, quarantined, impact_slowed, stiff_body_scaled. A restored snapshot has the events
        of the last tick only.
        """
    def hash(self, /) -> int:
        """Returns the hash of the state: an integer of 64 bits, equal for equal worlds on every computer."""
    def add_soft_body(self, /, body: SoftBody3) -> SoftBodyHandle:
        """Adds a copy of a soft body and returns its handle."""
    def add_rigid_body(self, /, body: RigidBody3) -> RigidBodyHandle:
        """Adds a rigid body and returns its handle."""
    def add_joint(self, /, joint: Joint3) -> JointHandle:
        """Adds a joint and returns its handle. Its anchors stay attached to the points of the bodies where they are now."""
    def add_knife(
        self,
        /,
        holder: RigidBodyHandle,
        edge: tuple[_Vector, _Vector],
        toward: _Vector,
        *,
        radius: float = 0.0,
        height: float = 0.02,
    ) -> KnifeHandle:
        """Attaches a knife to a kinematic or coupled rigid body and returns its handle.

        edge: both ends of the cutting edge in local coordinates of the holder [m]; toward: cutting direction in
        local coordinates; radius of the edge [m], 0 to 1, 0 = sharp; height of the blade [m], 0 to 10. In 2D, only
        the midpoint of the edge is used.
        """
    def add_grip(
        self,
        /,
        body: SoftBodyHandle,
        region: Shape3,
        *,
        force: _Vector | None = None,
        carrier: RigidBodyHandle | None = None,
    ) -> GripHandle:
        """Grips the nodes of a soft body inside a shape, and returns the handle of the grip.

        Without force and carrier, the nodes are held where they are. carrier: handle of a rigid body that carries the
        nodes. force: force on all nodes together [N].
        """
    def set_grip_force(self, /, grip: GripHandle, force: _Vector) -> None:
        """Sets the force of a grip [N]."""
    def grip_reaction(self, /, grip: GripHandle) -> dict[str, Any]:
        """Returns the force with which a grip held or moved its nodes in the last tick: a dict with point [m], force [N]
        and torque about the point [N m].
        """
    def grip_node_count(self, /, grip: GripHandle) -> int:
        """Returns the number of nodes in a grip."""
    def joint(self, /, joint: JointHandle) -> Joint3:
        """Returns the definition of a joint as it was added."""
    def joint_reaction(self, /, joint: JointHandle) -> _F32:
        """Returns the force of a joint on its first anchor in the last substep [N]: float32 array (d,). The force on the
        second anchor is opposite.
        """
    def knife_reaction(self, /, knife: KnifeHandle) -> dict[str, Any]:
        """Returns the force of the cut material on a knife in the last substep: a dict with point, the position of the
        holder [m], force [N] and torque about the point [N m].
        """
    def acting_damping(self, /, body: SoftBodyHandle) -> list[tuple[float, float]]:
        """Returns the damping that acts in a soft body: a list of pairs of mass damping [1/s] and stiffness damping [s],
        one for each material. The substep limits stiffness damping; more substeps, larger voxels or a softer
        material raise the limit. In a body with a mass scale, mass damping is lower and stiffness damping higher.
        """
    def joint_anchors(self, /, joint: JointHandle) -> tuple[_F32, _F32] | None:
        """Returns the positions of both anchors of a joint [m]; None if an attached body was removed."""
    def remove(self, /, handle: _Handle) -> Any:
        """Removes a soft body, a rigid body, a joint, a knife or a grip. Returns the body or the joint as it was, and
        None for a knife or a grip.
        """
    def remove_piece(self, /, body: SoftBodyHandle, piece: int) -> dict[str, Any]:
        """Removes a piece of a soft body. Returns a dict with pieces, soft_bodies, rigid_bodies and mass [kg]."""
    def remove_small_pieces(
        self, /, *, voxels: int | None = None, volume: float | None = None, mass: float | None = None
    ) -> dict[str, Any]:
        """Removes all pieces with fewer voxels, less volume [m³] or less mass [kg] than given. Returns a dict with
        pieces, soft_bodies, rigid_bodies and mass [kg].
        """
    def remove_outside(self, /, region: Shape3) -> dict[str, Any]:
        """Removes the pieces and dynamic rigid bodies that are outside of a shape. Returns a dict with pieces,
        soft_bodies, rigid_bodies and mass [kg].
        """
    def soft_body(self, /, handle: SoftBodyHandle) -> SoftBodyView3:
        """Returns a view of a soft body."""
    def rigid_body(self, /, handle: RigidBodyHandle) -> RigidBodyView3:
        """Returns a view of a rigid body."""
    def __getitem__(self, handle: SoftBodyHandle | RigidBodyHandle, /) -> Any: ...
    def __contains__(self, handle: _Handle, /) -> bool: ...
    def set_target_position(self, /, body: RigidBodyHandle, position: _Vector) -> None:
        """Sets the position that a kinematic body reaches in the next tick, or to which a coupled body is pulled [m]."""
    def set_target_rotation(self, /, body: RigidBodyHandle, rotation: _Rotation) -> None:
        """Sets the rotation that a kinematic or coupled body reaches in the next tick: an angle [rad] in 2D, a
        quaternion x, y, z, w or a rotation vector in 3D.
        """
    def set_pose(self, /, body: RigidBodyHandle, position: _Vector, rotation: _Rotation | None = None) -> None:
        """Sets the position [m] and the rotation of a rigid body immediately."""
    def translate(self, /, body: _Body, by: _Vector) -> None:
        """Translates a body by a vector [m] immediately; obstacles do not stop it."""
    def rotate_about(self, /, body: _Body, rotation: _Rotation, point: _Vector) -> None:
        """Rotates a body and its velocities about a point [m] immediately; obstacles do not stop it."""
    def velocity(self, /, body: _Body) -> tuple[_F32, _F32]:
        """Returns the velocity of a body: linear [m/s], and angular [rad/s] (a number in 2D, a vector in 3D). For a soft
        body, that of the rigid motion with the same momentum.
        """
    def set_velocity(self, /, body: _Body, linear: _Vector | None = None, angular: _Vector | None = None) -> None:
        """Sets the velocity of a soft body or a dynamic rigid body: linear [m/s], and angular [rad/s] (a number in 2D, a
        vector in 3D). In a soft body, this ends all vibration.
        """
    def add_velocity(self, /, body: _Body, linear: _Vector | None = None, angular: _Vector | None = None) -> None:
        """Adds a velocity to that of a soft body or a dynamic rigid body."""
    def apply_impulse(self, /, body: _Body, point: _Vector, impulse: _Vector, radius: float = 0.0) -> None:
        """Applies an impulse [N s] at a point [m] of a soft body or a dynamic rigid body. A soft body takes it at the
        nodes within `radius` [m] of the point.
        """
    def set_motion(
        self,
        /,
        body: RigidBodyHandle,
        motion: _Motion,
        *,
        mass: float | None = None,
        stiffness: float = 3000.0,
        damping: float = 0.9,
        max_force: float = 1000.0,
    ) -> None:
        """Changes the motion type of a rigid body: "fixed", "kinematic", "coupled" or "dynamic". mass [kg] is required
        for dynamic bodies (default of coupled ones: 2). stiffness [N/m], damping ratio and max_force [N] are those of
        coupled bodies.
        """
    def set_friction(self, /, body: RigidBodyHandle, friction: float) -> None:
        """Sets the Coulomb friction coefficient of a rigid body, 0 or more."""
    def set_restitution(self, /, body: RigidBodyHandle, restitution: float) -> None:
        """Sets the coefficient of restitution of a rigid body, 0 to 1."""
    def set_sensor(self, /, body: RigidBodyHandle, is_sensor: bool) -> None:
        """Sets whether a rigid body only reports what enters it."""
    def set_layers(self, /, body: _Body, memberships: int, filters: int) -> None:
        """Sets the layers of a body: bit masks of memberships and filters."""
    def set_user_data(self, /, body: _Body, user_data: int) -> None:
        """Sets the number of the program of a body."""
    def set_gravity_scale(self, /, body: SoftBodyHandle, scale: float) -> None:
        """Sets the factor on gravity of a soft body, -100 to 100, default 1."""
    def wake_up(self, /, body: _Body) -> None:
        """Wakes a body."""
    def put_to_sleep(self, /, body: _Body) -> None:
        """Puts a body to sleep."""
    def cut(self, /, body: SoftBodyHandle, corner: _Vector, first: _Vector, second: _Vector) -> int:
        """Cuts a soft body along a parallelogram, which a corner [m] and two edge vectors [m] span. Returns the number of
        nodes that were split.
        """
    def reaction(self, /, object: _Object) -> dict[str, Any]:
        """Returns the contact force and torque on a rigid body, a soft body or a piece in the last tick: a dict with
        point [m], force [N] and torque about the point [N m].
        """
    def fixed_node_reaction(self, /, body: SoftBodyHandle, region: Shape3) -> dict[str, Any]:
        """Returns the force and torque that hold the fixed nodes of a soft body inside a shape: a dict with point [m],
        force [N] and torque about the point [N m].
        """
    def contacts_of(self, /, object: _Object) -> list[dict[str, Any]]:
        """Returns the contacts of a rigid body, a soft body or a piece: a list of dicts, like the events
        "contact_force".
        """
    def ray_cast(
        self,
        /,
        origin: _Vector,
        direction: _Vector,
        max_distance: float = ...,
        *,
        exclude: _Object | Sequence[_Object] | None = None,
        only: Literal["soft", "rigid"] | None = None,
        layers: tuple[int, int] | None = None,
        sensors: bool = False,
        predicate: Callable[[_Piece | RigidBodyHandle], object] | None = None,
    ) -> dict[str, Any] | None:
        """Returns the first object that a ray hits within `max_distance` [m], or None: a dict with object, element (id),
        material, point [m], normal and distance [m].

        The queries have the same filters. exclude: a body, a piece, or a list of them; only: "soft" or "rigid";
        layers: bit masks of memberships and filters, which the layers of an object must meet; sensors: whether
        sensors count; predicate: function that gets an object (a handle of a rigid body, or a tuple of a handle of
        a soft body and a piece number) and returns whether it counts. It may read the world, and it may be called
        several times for an object.
        """
    def closest_point(
        self,
        /,
        point: _Vector,
        max_distance: float = ...,
        *,
        exclude: _Object | Sequence[_Object] | None = None,
        only: Literal["soft", "rigid"] | None = None,
        layers: tuple[int, int] | None = None,
        sensors: bool = False,
        predicate: Callable[[_Piece | RigidBodyHandle], object] | None = None,
    ) -> dict[str, Any] | None:
        """Returns the point of a surface that is closest to a point, within `max_distance` [m], or None: a dict with
        object, element (id), material, point [m], normal and distance [m]. The filters are those of `ray_cast`.
        """
    def objects_at(
        self,
        /,
        point: _Vector,
        *,
        exclude: _Object | Sequence[_Object] | None = None,
        only: Literal["soft", "rigid"] | None = None,
        layers: tuple[int, int] | None = None,
        sensors: bool = False,
        predicate: Callable[[_Piece | RigidBodyHandle], object] | None = None,
    ) -> list[dict[str, Any]]:
        """Returns the objects that contain a point: a list of dicts with object, element (id) and material. The filters
        are those of `ray_cast`.
        """
    def overlaps(
        self,
        /,
        shape: Shape3,
        *,
        exclude: _Object | Sequence[_Object] | None = None,
        only: Literal["soft", "rigid"] | None = None,
        layers: tuple[int, int] | None = None,
        sensors: bool = False,
        predicate: Callable[[_Piece | RigidBodyHandle], object] | None = None,
    ) -> list[dict[str, Any]]:
        """Returns the objects that overlap a shape: a list of dicts with object, element (id) and material. The filters
        are those of `ray_cast`.
        """
    def snapshot(self, /) -> bytes:
        """Returns the state as bytes, for `restore`."""
    @staticmethod
    def restore(snapshot: bytes) -> World3:
        """Returns the world of a snapshot. It has the same hash and goes on with the same bits."""
    def copy(self, /) -> World3:
        """Returns a copy, which shares the mesh with this world until either tears. Handles are valid in both."""
    def __copy__(self, /) -> World3: ...
    def __deepcopy__(self, /, _memo: Any) -> World3: ...
    def __reduce__(self, /) -> tuple[Any, ...]: ...
    def to_scene(self, /) -> Scene:
        """Returns a scene that describes the present state of the world. A world that was not stepped since it was built
        is rebuilt with the same hash. Contacts, events, sleep timers and the number of ticks are not included: use
        `snapshot` to go on with the same bits.
        """
    @property
    def view(self, /) -> tuple[_F32, _F32]:
        """Low and high corner of the region that a picture shows by default [m]: that of all bodies, with a margin."""
    def rgb(self, /, *, view: tuple[_Vector, _Vector] | None = None, width: int = 480, elements: bool = False) -> _U8:
        """Returns a picture as an array: uint8 (height, width, 3), red, green and blue, the top row first.

        view: low and high corner of the visible region [m], by default that of all bodies; width [pixels], 16 to
        4096; elements: whether the elements are shown instead of the surface. The height follows from the view
        in 2D; in 3D, the picture is a square. Painted without a GPU.
        """
    def png(self, /, *, view: tuple[_Vector, _Vector] | None = None, width: int = 480, elements: bool = False) -> bytes:
        """Returns a picture as a PNG file. The keywords are those of `rgb`."""
    def _repr_png_(self, /) -> bytes: ...
    def save_png(
        self,
        /,
        path: str | PathLike[str],
        *,
        view: tuple[_Vector, _Vector] | None = None,
        width: int = 480,
        elements: bool = False,
    ) -> None:
        """Writes a picture into a PNG file. The keywords are those of `rgb`."""
    def plot(
        self,
        /,
        ax: Any = None,
        *,
        color: Literal["material", "strain", "damage", "piece"] = "material",
        cmap: str = "viridis",
        vmin: float | None = None,
        vmax: float | None = None,
    ) -> Any:
        """Draws the world with matplotlib and returns the axes.

        ax: axes to draw into, by default new ones; color: "material" (default), "strain", "damage" or "piece";
        cmap: colour map of strain and damage; vmin and vmax: range of the colours. Raises ImportError without
        matplotlib.
        """

@final
class _Rounds:
    """Rounds of a level of the game tamaire. `fuwafuwa.envs` makes them environments."""

    def __new__(
        cls,
        level: str,
        num_envs: int = 1,
        *,
        reward: str = "shaped",
        ticks_per_step: int = 4,
        max_speed: float = 2.0,
        max_steps: int = 300,
        max_pieces: int = 0,
        hands: int = 1,
        random_start: bool = True,
        threads: int = 1,
    ) -> _Rounds: ...
    @property
    def observation_names(self, /) -> list[str]:
        """Names of the numbers of an observation."""
    @property
    def action_size(self, /) -> int:
        """Number of numbers in an action: d for each hand."""
    @property
    def dim(self, /) -> int:
        """Number of dimensions: 2 or 3."""
    def reset(self, /, seeds: Sequence[int | None], chosen: Sequence[bool]) -> _F32:
        """Starts new rounds where `chosen` is true. A seed of None continues the random numbers of the round."""
    def step(
        self, /, actions: _F32, restart: Sequence[bool] | None = None
    ) -> tuple[_F32, _F64, _Bool, _Bool]:
        """Steps all rounds: actions (count, hands * d) from -1 to 1. Rounds for which `restart` is true start again
        instead. Returns observations (count, numbers), rewards, terminated and truncated (count,).
        """
    def observe(self, /) -> _F32:
        """Returns the observations (count, numbers)."""
    def progress(self, /, index: int) -> dict[str, Any]:
        """Returns the progress of a round as a dict."""
    def rgb(self, /, index: int, width: int) -> _U8:
        """Returns a picture of the room of a round: uint8 array (height, width, 3)."""
    def hash(self, /, index: int) -> int:
        """Returns the hash of the world of a round."""
    def replay(self, /, index: int) -> str:
        """Returns a round as the text of a replay file."""
    def __copy__(self, /) -> _Rounds: ...
    def __deepcopy__(self, _memo: Any, /) -> _Rounds: ...

def _network(inputs: _F32, layers: Sequence[tuple[_F32, _F32]]) -> _F32:
    """Returns the outputs (rows, outputs) of a network for inputs (rows, inputs). All layers except the last one end in tanh.

    numpy would add products in an order that depends on the processor.
    """
def _level_names() -> list[str]:
    """Returns the names of the built-in levels with a basket."""
def _verify_replay(replay: _File) -> dict[str, Any] | None:
    """Plays a replay: a path or the bytes of the file. Returns the outcome as a dict, or None for a round that was not
    won. Raises `Error` where the round differs from the recording.
    """

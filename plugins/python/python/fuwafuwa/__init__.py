"""Soft bodies that squash, tear and re-grade their elements, in 2D and in 3D.

Units are metres, kilograms, seconds, newtons and pascals; y points up. Classes that end in 2 are for the plane, those
that end in 3 for space. `World2` and `World3` are the place to start.
"""

from typing import TYPE_CHECKING, Any

from ._core import (
    Error,
    GripHandle,
    Joint2,
    Joint3,
    JointHandle,
    KnifeHandle,
    Material,
    RigidBody2,
    RigidBody3,
    RigidBodyHandle,
    RigidBodyView2,
    RigidBodyView3,
    Scene,
    Shape2,
    Shape3,
    SoftBody2,
    SoftBody3,
    SoftBodyHandle,
    SoftBodyView2,
    SoftBodyView3,
    StepReport,
    VoxelGrid2,
    VoxelGrid3,
    World2,
    World3,
    __version__,
    library,
    library_values,
)
from ._film import Film

if TYPE_CHECKING:
    from ._sweep import SweepError as SweepError
    from ._sweep import sweep as sweep

__all__ = [
    "Error",
    "Film",
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

#: Names that are imported when they are first used, and their modules.
_LAZY = {"SweepError": "_sweep", "sweep": "_sweep"}


def __getattr__(name: str) -> Any:
    if name in _LAZY:
        import importlib

        return getattr(importlib.import_module(f".{_LAZY[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *_LAZY})

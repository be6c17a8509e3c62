"""The game tamaire for learning programs: environments of Gymnasium and PettingZoo, and trained players.

    import gymnasium as gym
    import fuwafuwa.envs

    env = gym.make("Tamaire-v0")

registers and makes the level "classic". "Tamaire3D-v0" is its version in 3D, and "Tamaire-NAME-v0" any other built-in
level; `level_names()` lists them. Requires `pip install fuwafuwa[gym]`. `parallel_env`, for two hands, also requires
PettingZoo, which `fuwafuwa[gym]` installs too.
"""

from __future__ import annotations

from importlib.resources import files
from os import PathLike
from typing import TYPE_CHECKING, Any

from .._core import _level_names as _levels
from .._core import _verify_replay
from ._policy import Policy

try:
    from gymnasium.envs.registration import register as _register
except ModuleNotFoundError as error:
    raise ImportError("fuwafuwa.envs requires gymnasium: install it with `pip install fuwafuwa[gym]`") from error

from ._tamaire import TamaireEnv
from ._vector import TamaireVectorEnv

if TYPE_CHECKING:
    from ._two_hands import TwoHandsEnv

__all__ = [
    "Policy",
    "TamaireEnv",
    "TamaireVectorEnv",
    "level_names",
    "parallel_env",
    "trained_policies",
    "trained_policy",
    "verify_replay",
]

#: Limit of steps in levels other than the classic one: a minute.
_LONG = 900


def level_names() -> dict[str, str]:
    """Return the names of the built-in levels with a basket, and the id of the environment of each."""
    known = {"classic": "Tamaire-v0", "classic-3d": "Tamaire3D-v0"}
    return {name: known.get(name, f"Tamaire-{name}-v0") for name in _levels()}


def parallel_env(level: str = "classic", **settings: Any) -> TwoHandsEnv:
    """Return an environment of PettingZoo in which two agents have a hand each; see `TwoHandsEnv`."""
    try:
        from ._two_hands import TwoHandsEnv
    except ModuleNotFoundError as error:
        raise ImportError("parallel_env() requires PettingZoo: install it with `pip install fuwafuwa[gym]`") from error
    return TwoHandsEnv(level, **settings)


def verify_replay(replay: str | PathLike[str] | bytes) -> dict[str, Any] | None:
    """Play a replay and check every hash and the result. `replay` is a path, the bytes of the file, or its text.

    Returns the outcome: `seconds` on the clock, `route`, the shares of mass `kept` and `inside`, the numbers of `pieces`
    and of pieces `lost` outside the basket. Returns None for a round that was not won. Raises `fuwafuwa.Error` for a file
    that is not a replay, and where the round differs from the recording.
    """
    if isinstance(replay, str) and "\n" in replay:
        replay = replay.encode()
    return _verify_replay(replay)


def trained_policies() -> list[str]:
    """Return the names of the trained players that come with the package."""
    stored = files(__name__) / "policies"
    return sorted(file.name.removesuffix(".npz") for file in stored.iterdir() if file.name.endswith(".npz"))


def trained_policy(name: str) -> Policy:
    """Return a trained player that comes with the package, for example "classic-squeeze"."""
    if name not in trained_policies():
        known = ", ".join(trained_policies())
        raise ValueError(f"no trained player {name!r}, expected one of {known}")
    with (files(__name__) / "policies" / f"{name}.npz").open("rb") as file:
        return Policy.load(file)


for _name, _id in level_names().items():
    _steps = 300 if _id == "Tamaire-v0" else _LONG
    _register(
        id=_id,
        entry_point="fuwafuwa.envs:TamaireEnv",
        vector_entry_point="fuwafuwa.envs:TamaireVectorEnv",
        kwargs={"level": _name, "max_steps": _steps},
    )

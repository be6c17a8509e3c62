"""Many rounds of a level as a vector environment of Gymnasium."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from .._core import Error
from .._core import _Rounds as Rounds
from ._tamaire import _SEEDS, action_space, state_space


class TamaireVectorEnv(VectorEnv):
    """`num_envs` rounds of a level, which are stepped on `threads` Rust threads in one Python process.

    The other keywords are those of `TamaireEnv`, except that only state vectors can be observed: float32 array
    (num_envs, numbers). A round that has ended starts again in the next step, whose action and reward then do not count
    (autoreset mode "next step"). Infos hold an array for each key of the info of `TamaireEnv`.

    The number of threads changes no bit. `reset(seed=s)` starts the rounds of the seeds s, s + 1, …
    """

    metadata = {"autoreset_mode": AutoresetMode.NEXT_STEP, "render_modes": ["rgb_array"], "render_fps": 15}

    def __init__(
        self,
        level: str = "classic",
        num_envs: int = 16,
        *,
        threads: int = 1,
        observation: str = "state",
        ticks_per_step: int = 4,
        render_mode: str | None = None,
        render_width: int = 320,
        **settings: Any,
    ) -> None:
        if observation != "state":
            raise Error(f"observation must be 'state' in a vector environment, given {observation!r}")
        if render_mode not in (None, "rgb_array"):
            raise Error(f"render_mode must be None or 'rgb_array', given {render_mode!r}")
        self.rounds = Rounds(str(level), num_envs, threads=threads, ticks_per_step=ticks_per_step, **settings)
        self.metadata = self.metadata | {"render_fps": 60 / ticks_per_step}
        self.num_envs = num_envs
        self.render_mode = render_mode
        self._render_width = render_width
        self.single_observation_space = state_space(self.rounds)
        self.single_action_space = action_space(self.rounds)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._is_over = np.zeros(num_envs, bool)

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Start new rounds. Returns the observations and the infos. There are no options."""
        if seed is None or isinstance(seed, (int, np.integer)):
            super().reset(seed=None if seed is None else int(seed))
            first = int(self.np_random.integers(_SEEDS // 2)) if seed is None else int(seed)
            seeds: list[int | None] = [first + index for index in range(self.num_envs)]
        else:
            seeds = [None if one is None else int(one) for one in seed]
        states = self.rounds.reset([mixed(one) for one in seeds], [True] * self.num_envs)
        self._is_over[:] = False
        return states, self._infos()

    def step(self, actions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Hold an action for a step in each round: array (num_envs, hands * d)."""
        actions = np.ascontiguousarray(actions, np.float32)
        states, rewards, terminated, truncated = self.rounds.step(actions, restart=self._is_over.tolist())
        self._is_over = terminated | truncated
        return states, rewards, terminated, truncated, self._infos()

    def render(self) -> tuple[np.ndarray, ...] | None:
        """Return a picture of each round, uint8 array (height, width, 3), if the render mode is "rgb_array"."""
        if self.render_mode is None:
            return None
        return tuple(self.rounds.rgb(index, self._render_width) for index in range(self.num_envs))

    def replay(self, index: int) -> str:
        """Return a round up to now as the text of a replay file of the game."""
        return self.rounds.replay(index)

    def _infos(self) -> dict[str, Any]:
        progress = [self.rounds.progress(index) for index in range(self.num_envs)]
        return {key: np.array([row[key] for row in progress]) for key in progress[0]}


def mixed(seed: int | None) -> int | None:
    """Return the seed of the round that `TamaireEnv.reset(seed=seed)` plays."""
    if seed is None:
        return None
    from gymnasium.utils.seeding import np_random

    return int(np_random(seed)[0].integers(_SEEDS))

"""Rounds as a vector environment of stable-baselines3."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from stable_baselines3.common.vec_env import VecEnv

from .._core import _Rounds as Rounds
from ._tamaire import action_space, state_space
from ._vector import mixed


class SB3VectorEnv(VecEnv):
    """Vector environment of stable-baselines3 that steps `count` rounds of a level on Rust threads.

    The other keywords are those of `TamaireEnv`, except that only state vectors can be observed: float32 array
    (count, numbers). A round that ends starts again in the same step, with the next random numbers of its seed. The info
    of that step then has `terminal_observation`, `TimeLimit.truncated`, the info of `TamaireEnv`, and `episode`: the sum
    of rewards `r` and the number of steps `l`. `seed(s)` and `reset()` start the rounds of the seeds s, s + 1, …
    """

    def __init__(self, level: str = "classic", count: int = 16, *, threads: int = 1, **settings: Any) -> None:
        self.render_mode = None
        self.rounds = Rounds(str(level), count, threads=threads, **settings)
        self._length = np.zeros(count, np.int64)
        self._return = np.zeros(count)
        super().__init__(count, state_space(self.rounds), action_space(self.rounds))

    def reset(self) -> np.ndarray:
        seeds = [mixed(seed) for seed in self._seeds]
        self._reset_seeds()
        self._length[:] = 0
        self._return[:] = 0.0
        return self.rounds.reset(seeds, [True] * self.num_envs)

    def step_async(self, actions: np.ndarray) -> None:
        self._actions = np.ascontiguousarray(actions, np.float32)

    def step_wait(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, list[dict[str, Any]]]:
        observations, rewards, terminated, truncated = self.rounds.step(self._actions)
        self._length += 1
        self._return += rewards
        done = terminated | truncated
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for index in np.flatnonzero(done).tolist():
            infos[index] = self.rounds.progress(index) | {
                "terminal_observation": observations[index].copy(),
                "TimeLimit.truncated": bool(truncated[index]),
                "episode": {"r": float(self._return[index]), "l": int(self._length[index])},
            }
        if done.any():
            observations = self.rounds.reset([None] * self.num_envs, done.tolist())
            self._length[done] = 0
            self._return[done] = 0.0
        return observations, rewards.astype(np.float32), done, infos

    def close(self) -> None:
        """Nothing to close."""

    def get_attr(self, attr_name: str, indices: int | Iterable[int] | None = None) -> list[Any]:
        return [getattr(self, attr_name)] * len(self._get_indices(indices))

    def set_attr(self, attr_name: str, value: Any, indices: int | Iterable[int] | None = None) -> None:
        raise NotImplementedError("the rounds of a vector environment share their settings")

    def env_method(self, method_name: str, *args: Any, indices: Any = None, **keywords: Any) -> list[Any]:
        raise NotImplementedError("the rounds of a vector environment have no methods of their own")

    def env_is_wrapped(self, wrapper_class: type, indices: int | Iterable[int] | None = None) -> list[bool]:
        return [False] * len(self._get_indices(indices))

    def _get_indices(self, indices: int | Iterable[int] | None) -> Sequence[int]:
        if indices is None:
            return range(self.num_envs)
        return [indices] if isinstance(indices, int) else list(indices)

"""Two hands as two agents: an environment of PettingZoo."""

from __future__ import annotations

from os import PathLike
from typing import Any

import numpy as np
from gymnasium import spaces
from pettingzoo import ParallelEnv  # type: ignore[import-untyped]

from .._core import Error
from ._tamaire import TamaireEnv


class TwoHandsEnv(ParallelEnv):  # type: ignore[misc]
    """A round of the game for two agents, "hand_0" and "hand_1", which act at the same time and share the reward.

    The keywords are those of `TamaireEnv`, except `hands`, and `observation`, which is "state". Both agents observe the whole state vector:
    float32 array (numbers,). An action is the velocity of the agent's own hand: float32 array (d,) from -1 to 1.
    """

    metadata = {
        "name": "tamaire_v0",
        "render_modes": ["human", "rgb_array"],
        "is_parallelizable": True,
        "render_fps": 15,
    }

    def __init__(self, level: str = "classic", *, render_mode: str | None = None, **settings: Any) -> None:
        for name in ("hands", "observation"):
            if name in settings:
                raise Error(f"{name} cannot be chosen: there are two hands, which observe the state vector")
        self.env = TamaireEnv(level, hands=2, render_mode=render_mode, **settings)
        self.metadata = self.metadata | {"render_fps": self.env.metadata["render_fps"]}
        self.render_mode = render_mode
        self.possible_agents = ["hand_0", "hand_1"]
        self.agents: list[str] = []
        d = self.env.rounds.dim
        self._observation_space = self.env.observation_space
        self._action_spaces = {agent: spaces.Box(-1.0, 1.0, (d,), np.float32) for agent in self.possible_agents}

    def observation_space(self, agent: str) -> spaces.Space[Any]:
        """Return the space of observations, which is the same for both agents."""
        return self._observation_space

    def action_space(self, agent: str) -> spaces.Space[Any]:
        """Return the space of actions of an agent."""
        return self._action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Start a new round. Returns the observations and the infos of the agents."""
        state, info = self.env.reset(seed=seed)
        self.agents = list(self.possible_agents)
        return self._each(state), self._each(info)

    def step(self, actions: dict[str, np.ndarray]) -> tuple[dict[str, Any], ...]:
        """Hold the actions of both agents for a step. After the end of a round, returns empty dicts."""
        if not self.agents:
            return ({}, {}, {}, {}, {})
        action = np.concatenate([np.asarray(actions[agent], np.float32) for agent in self.possible_agents])
        results = self.env.step(action)
        answer = tuple(self._each(result) for result in results)
        if results[2] or results[3]:
            self.agents = []
        return answer

    def render(self) -> np.ndarray | None:
        """Return a picture if the render mode is "rgb_array"."""
        return self.env.render()

    def state(self) -> np.ndarray:
        """Return the state vector."""
        state: np.ndarray = self.env.rounds.observe()[0]
        return state

    def replay(self) -> str:
        """Return the round up to now as the text of a replay file of the game."""
        return self.env.replay()

    def save_replay(self, path: str | PathLike[str]) -> None:
        """Write the round up to now as a replay file of the game."""
        self.env.save_replay(path)

    def close(self) -> None:
        """Close the window."""
        self.env.close()

    def _each(self, value: Any) -> dict[str, Any]:
        copies = value.copy if hasattr(value, "copy") else lambda: value
        return {agent: copies() for agent in self.possible_agents}

"""A round of the game as an environment of Gymnasium."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from .._core import Error
from .._core import _Rounds as Rounds

OBSERVATIONS = ("state", "image", "both")
#: Largest seed of a round.
_SEEDS = 2**63


def state_space(rounds: Rounds) -> spaces.Box:
    """Return the space of state vectors: float32 array (numbers,)."""
    return spaces.Box(-np.inf, np.inf, (len(rounds.observation_names),), np.float32)


def action_space(rounds: Rounds) -> spaces.Box:
    """Return the space of actions: float32 array (hands * d,), from -1 to 1."""
    return spaces.Box(-1.0, 1.0, (rounds.action_size,), np.float32)


def image_space(rounds: Rounds, width: int) -> spaces.Box:
    """Return the space of pictures: uint8 array (height, width, 3)."""
    return spaces.Box(0, 255, rounds.rgb(0, width).shape, np.uint8)


def observation_space(rounds: Rounds, observation: str, width: int) -> spaces.Space[Any]:
    """Return the space of observations of a kind."""
    if observation not in OBSERVATIONS:
        names = ", ".join(repr(name) for name in OBSERVATIONS)
        raise Error(f"observation must be one of {names}, given {observation!r}")
    if observation == "state":
        return state_space(rounds)
    if observation == "image":
        return image_space(rounds, width)
    return spaces.Dict({"state": state_space(rounds), "image": image_space(rounds, width)})


class TamaireEnv(gymnasium.Env):
    """Push a soft body into a basket that is smaller than the body: a round of the game tamaire.

    The body can be squeezed in whole, or shaved until it fits. A round is won when enough mass has rested in the basket
    for the time that the level asks for, usually a second.

    - level: name of a built-in level, see `level_names()`, or path of a level file
    - observation: "state" (default), "image", or "both" as a dict with these keys
    - reward: "shaped" (default), "sparse", "squeeze" or "shave"; see below
    - ticks_per_step: ticks of 1/60 s in which an action holds, 1 to 60, default 4
    - max_speed: speed of the hand's target for an action of length 1 along an axis [m/s], 0.01 to 6, default 2
    - max_steps: steps after which the round is truncated, default 300, which is 20 s; 0 for no limit
    - max_pieces: pieces beyond which the round ends as lost, because torn bodies are slow; 0 (default) for no limit
    - random_start: whether the hand first moves to a random place, default True. The seed of `reset` decides the place.
    - hands: number of hands, 1 (default) or 2 in levels with two; see also `fuwafuwa.envs.parallel_env`
    - image_width: width of observed pictures [pixels], 16 to 4096, default 96; the height follows from the level
    - render_mode: None, "rgb_array" or "human", a window that requires pygame
    - render_width: width of rendered pictures [pixels], default 640

    Action: velocity of the target of the hand, float32 array (hands * d,) from -1 to 1, times `max_speed`. The hand
    follows its target with a limited force, as in the game.

    Observation "state": float32 array (numbers,); `observation_names` names each number. Lengths are in metres,
    velocities in m/s, forces in newtons; masses are shares of the whole mass. For each hand: position, velocity, offset of
    the target, and contact force. Then the corners of the (first) basket; the shares of mass within the basket, and at
    rest inside; the share of mass kept in the largest piece of each body; the share of the time that enough mass has
    rested; the number of pieces; the mean distance of the mass from the basket; the share of steps left. Then, for the
    eight heaviest pieces: mass, centre, velocity, and low and high corner; zeros for missing pieces.

    Rewards of a step, where the potential P = min(within / share, 1) - mean_distance [m]:

    - "sparse": 1 for the win
    - "shaped": 5 for the win, plus the change of P
    - "squeeze": 5 for a win by squeezing, plus the change of P, minus 2 × the share of mass torn off in this step
    - "shave": 5 for a win by shaving, plus the change of P + min(t / 0.07, 1) - 2 max(t - 0.07, 0), where t = 1 - kept is
      the share of mass torn off

    `info` is a dict with `within`, `inside`, `kept`, `pieces`, `held` [s], `seconds` on the clock, `ticks`, `is_success`
    and `route`: "squeeze", "shave", "mix", or None before a win. "mix": the body was torn, and the bars still squeeze it.

    The same seed and the same actions give the same bits on every computer. `replay()` returns the round as a file that
    the game plays and verifies. `copy.deepcopy` copies an environment in the middle of a round; environments cannot be
    pickled.
    """

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 15}

    def __init__(
        self,
        level: str = "classic",
        *,
        observation: str = "state",
        reward: str = "shaped",
        ticks_per_step: int = 4,
        max_speed: float = 2.0,
        max_steps: int = 300,
        max_pieces: int = 0,
        random_start: bool = True,
        hands: int = 1,
        image_width: int = 96,
        render_mode: str | None = None,
        render_width: int = 640,
    ) -> None:
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise Error(f"render_mode must be None, 'human' or 'rgb_array', given {render_mode!r}")
        self.rounds = Rounds(
            str(level),
            1,
            reward=reward,
            ticks_per_step=ticks_per_step,
            max_speed=max_speed,
            max_steps=max_steps,
            max_pieces=max_pieces,
            random_start=random_start,
            hands=hands,
        )
        self.metadata = self.metadata | {"render_fps": 60 / ticks_per_step}
        self.render_mode = render_mode
        self.action_space = action_space(self.rounds)
        self.observation_space = observation_space(self.rounds, observation, image_width)
        self._observation = observation
        self._image_width = image_width
        self._render_width = render_width
        self._is_running = False
        self._window: Window | None = None

    @property
    def observation_names(self) -> list[str]:
        """Names of the numbers of the state vector."""
        return self.rounds.observation_names

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Start a new round. Returns the observation and the info. There are no options."""
        super().reset(seed=seed)
        state = self.rounds.reset([int(self.np_random.integers(_SEEDS))], [True])[0]
        self._is_running = True
        self._show()
        return self._observed(state), self.rounds.progress(0)

    def step(self, action: np.ndarray) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Hold an action for a step. Returns observation, reward, terminated, truncated and info."""
        if not self._is_running:
            raise gymnasium.error.ResetNeeded("call reset() before step(), and after a round has ended")
        actions = np.ascontiguousarray(action, np.float32).reshape(1, -1)
        states, rewards, terminated, truncated = self.rounds.step(actions)
        is_over = bool(terminated[0]), bool(truncated[0])
        self._is_running = not any(is_over)
        self._show()
        return self._observed(states[0]), float(rewards[0]), *is_over, self.rounds.progress(0)

    def render(self) -> np.ndarray | None:
        """Return a picture, uint8 array (height, width, 3), if the render mode is "rgb_array"."""
        if self.render_mode == "rgb_array":
            return self.rounds.rgb(0, self._render_width)
        return None

    def replay(self) -> str:
        """Return the round up to now as the text of a replay file of the game."""
        return self.rounds.replay(0)

    def save_replay(self, path: str | Path) -> None:
        """Write the round up to now as a replay file. The game plays it, `verify_replay` and the game verify it."""
        Path(path).write_text(self.replay(), encoding="utf-8")

    def close(self) -> None:
        """Close the window."""
        if self._window is not None:
            self._window.close()
            self._window = None

    def _observed(self, state: np.ndarray) -> Any:
        if self._observation == "state":
            return state
        image = self.rounds.rgb(0, self._image_width)
        return image if self._observation == "image" else {"state": state, "image": image}

    def _show(self) -> None:
        if self.render_mode != "human":
            return
        picture = self.rounds.rgb(0, self._render_width)
        if self._window is None:
            self._window = Window(picture.shape, self.metadata["render_fps"])
        self._window.show(picture)


class Window:
    """Window that shows pictures at a fixed rate."""

    def __init__(self, shape: tuple[int, ...], rate: float) -> None:
        try:
            import pygame
        except ImportError as error:
            raise gymnasium.error.DependencyNotInstalled(
                "render_mode='human' requires pygame: install it with `pip install pygame`"
            ) from error
        self._pygame = pygame
        pygame.display.init()
        pygame.display.set_caption("tamaire")
        self._surface = pygame.display.set_mode((shape[1], shape[0]))
        self._clock = pygame.time.Clock()
        self._rate = rate

    def show(self, picture: np.ndarray) -> None:
        """Show a picture, uint8 array (height, width, 3), and wait until the next one is due."""
        pygame = self._pygame
        pygame.event.pump()
        pygame.surfarray.blit_array(self._surface, picture.swapaxes(0, 1))
        pygame.display.flip()
        self._clock.tick(self._rate)

    def close(self) -> None:
        """Close the window."""
        self._pygame.display.quit()

"""Environment steps per second on the level `classic`, and what a second thread gains.

    python benches/environments.py

Requires `pip install fuwafuwa[gym]` and Linux, whose processors the script chooses. It prints medians of several
runs:

- steps per second of one environment with state observations on one processor, for players with different bodies: at
  rest, squeezed, shaved, and torn by random actions
- steps per second of a vector environment of 16 rounds with one and with two threads, each on a processor of its own

A step is 4 ticks of 1/60 s. Torn bodies have more nodes and pieces, and take longer.
"""

from __future__ import annotations

import os
import statistics
import time
from collections.abc import Callable

import numpy as np

from fuwafuwa import envs

RUNS = 5
STEPS = 600
VECTOR_STEPS = 60
ROUNDS = 16

Player = Callable[[np.ndarray], np.ndarray]


def players() -> dict[str, Player]:
    """Return players by what they do."""
    random = np.random.default_rng(1)
    learned = {name: envs.trained_policy(name) for name in envs.trained_policies()}
    return {
        "at rest": lambda state: np.zeros((*state.shape[:-1], 2), np.float32),
        **learned,
        "random": lambda state: random.uniform(-1, 1, (*state.shape[:-1], 2)).astype(np.float32),
    }


def rate(player: Player) -> tuple[float, float]:
    """Return the steps per second of one environment, and the mean number of pieces."""
    env = envs.TamaireEnv()
    state, _ = env.reset(seed=1)
    pieces, spent = 0, 0.0
    for _ in range(STEPS):
        action = player(state)
        start = time.perf_counter()
        state, _, terminated, truncated, info = env.step(action)
        if terminated or truncated:
            state, _ = env.reset()
        spent += time.perf_counter() - start
        pieces += info["pieces"]
    return STEPS / spent, pieces / STEPS


def vector_rate(player: Player, threads: int) -> float:
    """Return the steps per second of all rounds of a vector environment."""
    env = envs.TamaireVectorEnv("classic", ROUNDS, threads=threads)
    states, _ = env.reset(seed=1)
    start = time.perf_counter()
    for _ in range(VECTOR_STEPS):
        states, *_ = env.step(player(states))
    return ROUNDS * VECTOR_STEPS / (time.perf_counter() - start)


def main() -> None:
    processors = sorted(os.sched_getaffinity(0))
    os.sched_setaffinity(0, processors[:1])
    print(f"one environment, steps per second, medians of {RUNS} runs of {STEPS} steps")
    found = {name: [rate(players()[name]) for _ in range(RUNS)] for name in players()}
    for name, runs in found.items():
        steps, pieces = (statistics.median(column) for column in zip(*runs, strict=True))
        print(f"  {name:20} {steps:6.0f}   with {pieces:.0f} pieces on average")
    if len(processors) < 2:
        print("a second processor is missing")
        return
    print(f"vector environment of {ROUNDS} rounds, steps per second, medians of {RUNS} pairs")
    for name in players():
        pairs = []
        for _ in range(RUNS):
            pair = []
            for threads in (1, 2):
                os.sched_setaffinity(0, processors[:threads])
                # A new player for each run, so that random actions are the same.
                pair.append(vector_rate(players()[name], threads))
            pairs.append(pair)
        one, two = (statistics.median(column) for column in zip(*pairs, strict=True))
        ratio = statistics.median(pair[1] / pair[0] for pair in pairs)
        print(f"  {name:20} {one:6.0f} with one thread, {two:6.0f} with two: {ratio:.2f} times")


if __name__ == "__main__":
    main()

"""Let trained players play a round each, side by side, and store the rounds as a film and as replays of the game.

    python examples/watch.py classic-squeeze classic-shave --seed 7 --film rounds.gif --replays .
    python examples/watch.py mine.npz --level mine.toml --window

Requires `pip install fuwafuwa[gym]`. The game plays the replays: `tamaire --replay classic-shave.tamaire`.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

import fuwafuwa as fw
from fuwafuwa import envs

#: Width of the picture of a round [pixels].
WIDTH = 300


def played(name: str, options: argparse.Namespace) -> list[np.ndarray]:
    """Play a round, store its replay, and return its pictures, one for each step."""
    player = envs.trained_policy(name) if name in envs.trained_policies() else envs.Policy.load(name)
    mode = "human" if options.window else "rgb_array"
    env = envs.TamaireEnv(options.level or player.about["level"], render_mode=mode, render_width=WIDTH)
    state, info = env.reset(seed=options.seed)
    pictures, is_over = [env.rounds.rgb(0, WIDTH)] if options.film else [], False
    while not is_over:
        state, _, terminated, truncated, info = env.step(player(state))
        if options.film:
            pictures.append(env.rounds.rgb(0, WIDTH))
        is_over = terminated or truncated
    result = f"won by {info['route']}" if info["is_success"] else "not won"
    pieces, kept, seconds = info["pieces"], info["kept"], info["seconds"]
    print(f"{name}: {result} after {seconds:.1f} s, {pieces} pieces, {kept:.0%} of the mass kept")
    if options.replays:
        env.save_replay(options.replays / f"{Path(name).stem}.tamaire")
    env.close()
    return pictures


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False
    )
    known = ", ".join(envs.trained_policies())
    parser.add_argument("players", nargs="+", help=f"files of train.py, or any of {known}")
    parser.add_argument("--level", help="built-in level or file; default: the level of the training")
    parser.add_argument("--seed", type=int, default=1, help="seed of the rounds")
    parser.add_argument("--film", type=Path, help="path of a film, .gif or .mp4")
    parser.add_argument("--replays", type=Path, help="folder for replays")
    parser.add_argument("--window", action="store_true", help="show the rounds in a window")
    options = parser.parse_args()
    if options.replays:
        options.replays.mkdir(parents=True, exist_ok=True)
    rounds = [played(name, options) for name in options.players]
    if options.film:
        film = fw.Film(fps=envs.TamaireEnv().metadata["render_fps"])
        for step in range(max(map(len, rounds))):
            film.add(np.concatenate([pictures[min(step, len(pictures) - 1)] for pictures in rounds], axis=1))
        film.save(options.film)


if __name__ == "__main__":
    main()

"""Let a trained player play a round, and store it as a film and as a replay of the game.

    python examples/watch.py classic-squeeze --seed 7 --film round.gif --replay round.tamaire
    python examples/watch.py my-level-shaped.npz --level my-level.toml --window

Requires `pip install fuwafuwa[gym]`. The game plays the replay: `tamaire --replay round.tamaire`.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import fuwafuwa as fw
from fuwafuwa import envs


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("player", help=f"a file of train.py, or one of {', '.join(envs.trained_policies())}")
    parser.add_argument("--level", default=None, help="built-in level or file; default: the level of the training")
    parser.add_argument("--seed", type=int, default=1, help="seed of the round")
    parser.add_argument("--film", type=Path, help="path of a film, .gif or .mp4")
    parser.add_argument("--replay", type=Path, help="path of a replay")
    parser.add_argument("--window", action="store_true", help="show the round in a window")
    options = parser.parse_args()
    is_known = options.player in envs.trained_policies()
    player = envs.trained_policy(options.player) if is_known else envs.Policy.load(options.player)
    mode = "human" if options.window else "rgb_array"
    env = envs.TamaireEnv(options.level or player.about["level"], render_mode=mode, render_width=400)
    film = fw.Film(fps=env.metadata["render_fps"])
    state, info = env.reset(seed=options.seed)
    is_over = False
    while not is_over:
        if options.film:
            film.add(env.rounds.rgb(0, 400))
        state, _, terminated, truncated, info = env.step(player(state))
        is_over = terminated or truncated
    env.close()
    result = f"won by {info['route']}" if info["is_success"] else "not won"
    print(f"{result} after {info['seconds']:.1f} s, {info['pieces']} pieces, {info['kept']:.0%} of the mass kept")
    if options.film:
        film.add(env.rounds.rgb(0, 400))
        film.save(options.film)
    if options.replay:
        env.save_replay(options.replay)


if __name__ == "__main__":
    main()

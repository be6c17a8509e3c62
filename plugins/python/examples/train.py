"""Train a player of the game with PPO, and store it as a small file.

    python examples/train.py squeeze            # or: shave, shaped, sparse
    python examples/train.py shave --level classic --steps 2_000_000

Requires `pip install fuwafuwa[train]`: stable-baselines3 with PyTorch; a CPU is enough. Training from scratch on the
level `classic` takes up to an hour on two cores. The script writes NAME.npz, which `fuwafuwa.envs.Policy` loads
without PyTorch, and NAME.csv with the learning curve.
"""

from __future__ import annotations

import argparse
import csv
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.vec_env import VecNormalize

from fuwafuwa.envs import Policy
from fuwafuwa.envs.sb3 import SB3VectorEnv

#: Number of rounds over which the curve averages.
WINDOW = 200
#: Number of steps between two stores of the policy.
STORE = 50_000


class Curve(BaseCallback):
    """Writes one row for each update: steps, share of wins and routes among the last rounds, length and return."""

    def __init__(self, path: Path, store: Callable[[], None]) -> None:
        super().__init__()
        self.store = store
        self.stored = 0
        self.path = path
        self.rounds: list[dict] = []
        self.start = time.perf_counter()

    def _on_training_start(self) -> None:
        names = ["steps", "seconds", "rounds", "won", "squeezed", "shaved", "mixed", "kept", "length", "return"]
        self.file = self.path.open("w", newline="")
        self.writer = csv.writer(self.file)
        self.writer.writerow(names)

    def _on_step(self) -> bool:
        self.rounds.extend(info for info in self.locals["infos"] if "episode" in info)
        self.rounds = self.rounds[-WINDOW:]
        return True

    def _on_rollout_end(self) -> None:
        if not self.rounds:
            return
        routes = [info["route"] for info in self.rounds]
        share = [np.mean([route == name for route in routes]) for name in ("squeeze", "shave", "mix")]
        row = [
            self.num_timesteps,
            round(time.perf_counter() - self.start),
            len(self.rounds),
            np.mean([info["is_success"] for info in self.rounds]),
            *share,
            np.mean([info["kept"] for info in self.rounds]),
            np.mean([info["episode"]["l"] for info in self.rounds]),
            np.mean([info["episode"]["r"] for info in self.rounds]),
        ]
        self.writer.writerow([round(float(value), 4) for value in row])
        self.file.flush()
        if len(self.rounds) == WINDOW and self.num_timesteps // STORE != self.stored:
            self.stored = self.num_timesteps // STORE
            self.store()
        print(" ".join(f"{value:.3f}" if isinstance(value, float) else str(value) for value in row), flush=True)

    def _on_training_end(self) -> None:
        self.file.close()


def policy_of(model: PPO, normalizer: VecNormalize, about: dict) -> Policy:
    """Return a trained model as layers of numbers."""
    net = model.policy
    modules = [module for module in net.mlp_extractor.policy_net if isinstance(module, torch.nn.Linear)]
    layers = [
        (module.weight.detach().numpy().astype(np.float32), module.bias.detach().numpy().astype(np.float32))
        for module in [*modules, net.action_net]
    ]
    mean, variance = normalizer.obs_rms.mean, normalizer.obs_rms.var
    scale = 1.0 / np.sqrt(variance + normalizer.epsilon)
    std = net.log_std.exp().detach().numpy().astype(np.float32)
    return Policy(layers, mean.astype(np.float32), scale.astype(np.float32), about, std)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("reward", choices=["sparse", "shaped", "squeeze", "shave"])
    parser.add_argument("--level", default="classic", help="built-in level or file")
    parser.add_argument("--steps", type=int, default=1_500_000, help="number of environment steps")
    parser.add_argument("--rounds", type=int, default=16, help="number of rounds that are played at once")
    parser.add_argument("--threads", type=int, default=2, help="number of threads that step the rounds")
    parser.add_argument("--max-pieces", type=int, default=40, help="number of pieces beyond which a round is lost")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=None, help="path of the policy, default LEVEL-REWARD.npz")
    options = parser.parse_args()
    out = options.out or Path(f"{Path(options.level).stem}-{options.reward}.npz")
    torch.set_num_threads(1)  # the networks are too small for several threads
    settings = {"reward": options.reward, "max_steps": 300, "max_pieces": options.max_pieces}
    rounds = SB3VectorEnv(options.level, options.rounds, threads=options.threads, **settings)
    env = VecNormalize(rounds, clip_obs=10.0)
    model = PPO(
        "MlpPolicy",
        env,
        n_steps=4096 // options.rounds,
        batch_size=512,
        n_epochs=10,
        gamma=0.99,
        learning_rate=lambda left: 3e-4 * max(left, 0.1),
        policy_kwargs={"net_arch": [64, 64], "log_std_init": -0.5},
        seed=options.seed,
        device="cpu",
    )

    def store() -> None:
        about = {
            "level": options.level,
            "reward": options.reward,
            "steps": model.num_timesteps,
            "seed": options.seed,
            "max_pieces": options.max_pieces,
        }
        policy_of(model, env, about).save(out)

    model.learn(options.steps, callback=Curve(out.with_suffix(".csv"), store))
    store()


if __name__ == "__main__":
    main()

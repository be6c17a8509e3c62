"""Overhead of a step in Python over the same step in Rust.

`python benches/overhead.py` builds `examples/steps.rs` and runs the scenes in turn in Python and in Rust, several
times. The installed package must have been built from the same sources with the same profile, as pip and
`maturin develop --release` do.
"""

from __future__ import annotations

import argparse
import pathlib
import statistics
import subprocess
import time
from collections.abc import Callable

import fuwafuwa as fw

MANIFEST = pathlib.Path(__file__).parents[1] / "Cargo.toml"
STEPS = 1000
TICKS_TO_REST = 900


def tear() -> list[int]:
    """Return the duration of each tick of the scene tear-3d [ns]."""
    scene = fw.Scene.read("tear-3d")
    world = scene.build()
    durations = []
    for tick in range(scene.ticks):
        scene.set_hand_targets(world, tick)
        start = time.perf_counter_ns()
        world.step()
        durations.append(time.perf_counter_ns() - start)
    return durations


def disc(sleep: bool) -> list[int]:
    """Return the mean duration of a step of a disc on a floor [ns]."""
    world = fw.World2(sleep=sleep)
    world.add_rigid_body(fw.RigidBody2.fixed(fw.Shape2.half_space((0, 1))))
    world.add_soft_body(fw.SoftBody2.ball(32))
    world.step(TICKS_TO_REST)
    start = time.perf_counter_ns()
    for _ in range(STEPS):
        world.step()
    return [(time.perf_counter_ns() - start) // STEPS]


SCENES: dict[str, Callable[[], list[int]]] = {
    "tear-3d": tear,
    "resting disc": lambda: disc(True),
    "disc that may not sleep": lambda: disc(False),
}


def total(rounds: list[list[int]]) -> float:
    """Return the sum over the ticks of the median duration of each tick [s]."""
    return sum(statistics.median(tick) for tick in zip(*rounds, strict=True)) * 1e-9


def main() -> None:
    """Measure all scenes and print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=7, help="number of runs of each scene in each language")
    rounds = parser.parse_args().rounds
    command = ["cargo", "run", "--quiet", "--release", "--locked", "--example", "steps", "--manifest-path", MANIFEST]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as rust:
        assert rust.stdin is not None
        assert rust.stdout is not None
        for name, run in SCENES.items():
            in_python, in_rust = [], []
            for _ in range(rounds):
                in_python.append(run())
                print(name, file=rust.stdin, flush=True)
                in_rust.append([int(word) for word in rust.stdout.readline().split()])
            ticks = len(in_rust[0])
            python_step, rust_step = total(in_python) / ticks, total(in_rust) / ticks
            overhead = python_step - rust_step
            print(
                f"{name}: a step takes {python_step * 1e6:.2f} µs in Python, {rust_step * 1e6:.2f} µs in Rust: "
                f"{overhead * 1e6:+.2f} µs, {overhead / rust_step:+.2%}"
            )
        rust.stdin.close()


if __name__ == "__main__":
    main()

"""Environments for learning programs, and trained players."""

import copy
import time

import numpy as np
import pytest

import fuwafuwa as fw

gymnasium = pytest.importorskip("gymnasium", reason="gymnasium is not installed")

from gymnasium.utils.env_checker import check_env  # noqa: E402

import fuwafuwa.envs as envs  # noqa: E402
from fuwafuwa._core import _Rounds as Rounds  # noqa: E402

TICK = 1.0 / 60.0


def named(env: envs.TamaireEnv, state: np.ndarray) -> dict[str, float]:
    """Return the numbers of a state vector by name."""
    return dict(zip(env.observation_names, state.tolist(), strict=True))


def actions(count: int, size: int, seed: int = 3) -> np.ndarray:
    """Return random actions that hold for a few steps, so that hands come far."""
    kept = np.random.default_rng(seed).uniform(-1, 1, (count // 8 + 1, size))
    return np.repeat(kept, 8, axis=0)[:count].astype(np.float32)


def pushed(env: envs.TamaireEnv, seed: int, steps: int = 60) -> tuple:
    """Play random actions, and return all observations, the rewards and the hash of the world."""
    states, rewards = [env.reset(seed=seed)[0]], []
    for action in actions(steps, env.action_space.shape[0]):
        state, reward, *over, _ = env.step(action)
        states.append(state)
        rewards.append(reward)
        if any(over):
            break
    return np.array(states), rewards, env.rounds.hash(0)


@pytest.mark.parametrize(
    ("name", "settings"),
    [
        ("Tamaire-v0", {}),
        ("Tamaire-v0", {"observation": "image", "image_width": 48}),
        ("Tamaire-v0", {"observation": "both", "hands": 2}),
        ("Tamaire3D-v0", {}),
        ("Tamaire-dough-v0", {"reward": "sparse"}),
    ],
)
@pytest.mark.filterwarnings("ignore:.*render_mode.*")
@pytest.mark.filterwarnings("ignore:.*Box observation space (m|is -|is inf).*")
def test_environment_passes_the_check_of_gymnasium(name, settings, monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    env = gymnasium.make(name, render_mode="rgb_array", **settings)
    check_env(env.unwrapped)
    env.close()


def test_every_level_with_a_basket_has_an_environment():
    names = envs.level_names()
    assert len(names) > 40 and set(names.values()) <= set(gymnasium.registry)
    assert "sandbox" not in names
    for name in names:
        env = envs.TamaireEnv(name, max_steps=2)
        state, _ = env.reset(seed=1)
        assert env.observation_space.contains(state), name
        assert np.isfinite(env.step(env.action_space.sample() * 0)[0]).all(), name


def test_same_seed_and_actions_give_the_same_bits():
    first, second = (pushed(envs.TamaireEnv(), seed=5) for _ in range(2))
    np.testing.assert_array_equal(first[0], second[0])
    assert first[1:] == second[1:]
    other = pushed(envs.TamaireEnv(), seed=6)
    assert other[2] != first[2]


def test_action_moves_the_target_at_its_velocity():
    env = envs.TamaireEnv(random_start=False, ticks_per_step=6, max_speed=0.5)
    before = named(env, env.reset(seed=1)[0])
    for _ in range(3):
        state = env.step(np.array([0.0, -1.0]))[0]
    after = named(env, state)
    target = [numbers["hand0_position_y"] + numbers["hand0_target_offset_y"] for numbers in (before, after)]
    # Targets are rounded to 1/8192 m in each of the 18 ticks.
    assert target[1] - target[0] == pytest.approx(-0.5 * 18 * TICK, abs=18 / 8192)
    assert after["hand0_velocity_y"] == pytest.approx(-0.5, abs=0.1)


def test_action_beyond_the_range_is_clamped():
    far, near = (pushed_by(np.array([0.0, size], np.float32)) for size in (9.0, 1.0))
    np.testing.assert_array_equal(far, near)


def pushed_by(action: np.ndarray) -> np.ndarray:
    """Return the state after one action."""
    env = envs.TamaireEnv()
    env.reset(seed=2)
    return env.step(action)[0]


def test_state_agrees_with_the_game():
    env = envs.TamaireEnv()
    env.reset(seed=4)
    for action in actions(40, 2):
        state, _, _, _, info = env.step(action)
    numbers = named(env, state)
    assert numbers["kept"] == pytest.approx(info["kept"])
    assert numbers["pieces"] == info["pieces"]
    assert numbers["time_left"] == pytest.approx(1 - 40 / 300)
    masses = [numbers[f"piece{piece}_mass"] for piece in range(8)]
    assert masses == sorted(masses, reverse=True)
    assert sum(masses) <= 1.0001
    # The corners of the basket in the file of the level.
    corners = [numbers[f"basket_{corner}_{axis}"] for corner in ("low", "high") for axis in "xy"]
    assert corners == pytest.approx([1.0645 - 0.4155, -0.425, 1.0645 + 0.4155, 0.425], abs=1e-5)


def test_untouched_body_has_the_distance_of_a_disc_from_the_basket():
    env = envs.TamaireEnv(random_start=False)
    numbers = named(env, env.reset(seed=1)[0])
    # Mean distance of a disc of radius 0.5 around (-0.6, 0) from the box, by sampling.
    rng = np.random.default_rng(0)
    points = rng.uniform(-0.5, 0.5, (200_000, 2))
    points = points[np.hypot(*points.T) < 0.5] + [-0.6, 0.0]
    outside = np.maximum(np.abs(points - [1.0645, 0.0]) - [0.4155, 0.425], 0.0)
    assert numbers["mean_distance"] == pytest.approx(np.hypot(*outside.T).mean(), abs=0.01)


@pytest.mark.parametrize("reward", ["shaped", "squeeze", "shave"])
def test_reward_is_the_documented_formula(reward):
    env = envs.TamaireEnv(reward=reward, ticks_per_step=8)
    before = named(env, env.reset(seed=1)[0])
    torn = 0.0
    for action in actions(150, 2, seed=8):
        state, found, terminated, truncated, info = env.step(action)
        now = named(env, state)

        def potential(numbers):
            filled = min(numbers["within"] / 0.6, 1.0) - numbers["mean_distance"]
            torn = 1.0 - numbers["kept"]
            shaved = min(torn / 0.07, 1.0) - 2.0 * max(torn - 0.07, 0.0)
            return filled + (shaved if reward == "shave" else 0.0)

        expected = potential(now) - potential(before)
        assert not info["is_success"], "the next test is about wins"
        loss = max(before["kept"] - now["kept"], 0.0)
        torn += loss
        if reward == "squeeze":
            expected -= 2.0 * loss
        assert found == pytest.approx(expected, abs=1e-5)
        before = now
        if terminated or truncated:
            break
    assert torn > 0.01, "the actions must tear the body"


@pytest.mark.parametrize(("reward", "win"), [("sparse", 1.0), ("shaped", 5.0), ("squeeze", 5.0), ("shave", 0.0)])
def test_reward_of_a_squeezed_win(reward, win):
    env = envs.TamaireEnv(reward=reward)
    player = envs.trained_policy("classic-squeeze")
    state, _ = env.reset(seed=1)
    rewards, over = [], False
    while not over:
        before = state
        state, found, terminated, truncated, info = env.step(player(state))
        rewards.append(found)
        over = terminated or truncated
    assert info["route"] == "squeeze" and info["kept"] == 1.0 and terminated and not truncated
    # The body rests in the basket before the win, so that the potential hardly changes.
    assert named(env, before)["within"] > 0.6 < named(env, state)["within"]
    assert rewards[-1] == pytest.approx(win, abs=0.05)
    if reward == "sparse":
        assert rewards == [0.0] * (len(rewards) - 1) + [1.0]
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step(player(state))


def test_state_vector_has_the_documented_length():
    for level, length in [("classic", 91), ("classic-3d", 129)]:
        env = envs.TamaireEnv(level)
        assert env.observation_space.shape == (length,) == env.reset(seed=1)[0].shape
        assert len(set(env.observation_names)) == length


def test_copy_of_an_environment_goes_on_alike():
    env = envs.TamaireEnv()
    env.reset(seed=3)
    for action in actions(30, 2):
        env.step(action)
    twin = copy.deepcopy(env)
    for action in actions(30, 2, seed=9):
        found, expected = twin.step(action), env.step(action)
        np.testing.assert_array_equal(found[0], expected[0])
    assert twin.rounds.hash(0) == env.rounds.hash(0)
    env.step(np.ones(2))
    assert twin.rounds.hash(0) != env.rounds.hash(0), "the copy has a round of its own"


def test_second_hand_keeps_away_from_the_way_of_the_first():
    for seed in range(60):
        env = envs.TamaireEnv(hands=2)
        numbers = named(env, env.reset(seed=seed)[0])
        hands = [np.array([numbers[f"hand{hand}_position_{axis}"] for axis in "xy"]) for hand in (0, 1)]
        # Two radii of 0.09 m, and the clearance.
        assert np.hypot(*(hands[0] - hands[1])) > 0.19, seed


@pytest.mark.parametrize("seed", [None, [None] * 3])
def test_rounds_without_a_seed_differ(seed):
    states = [envs.TamaireVectorEnv(num_envs=3).reset(seed=seed)[0] for _ in range(2)]
    starts = {tuple(state[:2]) for state in np.concatenate(states)}
    assert len(starts) == 6


def test_failed_reset_of_a_vector_environment_changes_nothing():
    env = envs.TamaireVectorEnv(num_envs=2, max_steps=2)
    with pytest.raises(fw.Error, match=r"reset\(\) must be called"):
        env.step(np.zeros((2, 2)))
    env.reset(seed=[np.int64(4), 5])
    for _ in range(2):
        env.step(np.zeros((2, 2)))
    with pytest.raises(fw.Error, match="seeds must be 2 values, given 1"):
        env.reset(seed=[1])
    _, rewards, _, truncated, infos = env.step(np.ones((2, 2)))
    assert not rewards.any() and not truncated.any() and (infos["ticks"] <= 91).all()


def test_adapter_of_stable_baselines3_plays_the_same_rounds():
    pytest.importorskip("stable_baselines3", reason="stable-baselines3 is not installed: fuwafuwa[train]")
    from fuwafuwa.envs.sb3 import SB3VectorEnv

    env = SB3VectorEnv("classic", 2, max_steps=6)
    env.seed(40)
    states = env.reset()
    twins = [envs.TamaireEnv(max_steps=6) for _ in range(2)]
    for index, twin in enumerate(twins):
        np.testing.assert_array_equal(states[index], twin.reset(seed=40 + index)[0])
    total = np.zeros(2)
    for step, action in enumerate(actions(6, 2)):
        states, rewards, done, infos = env.step(np.tile(action, (2, 1)))
        total += rewards
        for index, twin in enumerate(twins):
            state, reward, _, truncated, _ = twin.step(action)
            assert rewards[index] == pytest.approx(reward, abs=1e-6) and done[index] == truncated == (step == 5)
            shown = infos[index]["terminal_observation"] if truncated else states[index]
            np.testing.assert_array_equal(shown, state)
    assert [info["TimeLimit.truncated"] for info in infos] == [True, True]
    assert [info["episode"]["l"] for info in infos] == [6, 6]
    assert [info["episode"]["r"] for info in infos] == pytest.approx(total.tolist(), abs=1e-5)
    assert (states[:, env.rounds.observation_names.index("time_left")] == 1.0).all()


def test_round_ends_at_its_limits():
    env = envs.TamaireEnv(max_steps=5)
    env.reset(seed=1)
    ends = [env.step(np.zeros(2))[2:4] for _ in range(5)]
    assert ends == [(False, False)] * 4 + [(False, True)]
    env = envs.TamaireEnv(max_pieces=3, max_steps=0, max_speed=6.0)
    env.reset(seed=1)
    for action in actions(2000, 2, seed=8):
        *_, terminated, truncated, info = env.step(action)
        assert not truncated
        assert terminated == (info["pieces"] > 3 or info["is_success"])
        if terminated:
            break
    assert info["pieces"] > 3


def test_vector_environment_plays_the_rounds_of_single_ones_on_any_number_of_threads():
    size, steps = 6, 45
    moves = np.stack([actions(steps, 2, seed=index) for index in range(size)], axis=1)
    results = []
    for threads in (1, 3):
        env = envs.TamaireVectorEnv(num_envs=size, threads=threads)
        states, _ = env.reset(seed=10)
        for action in moves:
            states, *_ = env.step(action)
        results.append((states, [env.rounds.hash(index) for index in range(size)]))
    np.testing.assert_array_equal(results[0][0], results[1][0])
    assert results[0][1] == results[1][1]
    for index in (0, 4):
        env = envs.TamaireEnv()
        env.reset(seed=10 + index)
        for action in moves[:, index]:
            env.step(action)
        assert env.rounds.hash(0) == results[0][1][index]


def test_vector_environment_restarts_rounds_in_the_next_step():
    env = gymnasium.make_vec("Tamaire-v0", num_envs=3, max_steps=4)
    assert isinstance(env.unwrapped, envs.TamaireVectorEnv)
    env.reset(seed=1)
    for _ in range(4):
        states, rewards, terminated, truncated, infos = env.step(np.ones((3, 2), np.float32))
    assert truncated.all() and not terminated.any()
    ticks = infos["ticks"]
    states, rewards, terminated, truncated, infos = env.step(np.ones((3, 2), np.float32))
    assert not rewards.any() and not truncated.any()
    names = env.unwrapped.rounds.observation_names
    assert (states[:, names.index("time_left")] == 1.0).all() and len(set(states[:, 0])) == 3
    # A round begins with at most 91 ticks of its opening.
    assert (infos["ticks"] != ticks).all() and (infos["ticks"] <= 91).all()
    env.close()


@pytest.mark.parametrize("level", ["classic", "classic-3d"])
def test_replay_is_verified_and_a_changed_one_is_not(level, tmp_path):
    env = envs.TamaireEnv(level)
    env.reset(seed=7)
    for action in actions(50, env.action_space.shape[0]):
        if any(env.step(action)[2:4]):
            break
    path = tmp_path / "round.toml"
    env.save_replay(path)
    assert envs.verify_replay(path) is None, "a round that was not won has no outcome"
    assert envs.verify_replay(env.replay()) is None
    changed = _with_another_hash(path.read_text())
    with pytest.raises(fw.Error, match="goes another way at second"):
        envs.verify_replay(changed.encode())


def _with_another_hash(text: str) -> str:
    """Return a replay in which a digit of the first hash differs."""
    start = text.index("hashes = [")
    digit = text.index('"', start) + 1
    return text[:digit] + ("1" if text[digit] != "1" else "2") + text[digit + 1 :]


def test_image_shows_the_hand_where_it_is():
    env = envs.TamaireEnv(observation="both", image_width=320, random_start=False)
    first = env.reset(seed=1)[0]["image"]
    for _ in range(8):
        second = env.step(np.array([0.0, 1.0]))[0]
    assert first.dtype == np.uint8 and first.shape == (200, 320, 3)
    changed = np.argwhere((first != second["image"]).any(axis=2))
    x, y = second["state"][:2]
    # 100 pixels are a metre; the top row is at 1 m.
    assert np.hypot(*(changed - [100 * (1.0 - y), 100 * (x + 1.6)]).T).min() < 15
    assert np.mean(changed[:, 1] < 50) > 0.8, "the body, which begins there, stays"


def test_wrong_values_are_told():
    with pytest.raises(fw.Error, match='level must be a file or one of classic, .*, given "nowhere"'):
        envs.TamaireEnv("nowhere")
    with pytest.raises(fw.Error, match="level must be a level with a basket"):
        envs.TamaireEnv("sandbox")
    with pytest.raises(fw.Error, match="reward must be one of"):
        envs.TamaireEnv(reward="much")
    with pytest.raises(fw.Error, match="observation must be one of"):
        envs.TamaireEnv(observation="smell")
    with pytest.raises(fw.Error, match="max_speed must be a number from 0.01 to 6.0, given NaN"):
        envs.TamaireEnv(max_speed=np.nan)
    env = envs.TamaireEnv()
    env.reset(seed=1)
    with pytest.raises(fw.Error, match="actions must be finite numbers, given NaN"):
        env.step(np.array([np.nan, 0.0]))
    with pytest.raises(fw.Error, match=r"actions must be an array of shape \[1, 2\], given shape \[1, 3\]"):
        env.step(np.zeros(3))
    with pytest.raises(fw.Error, match="index must be less than 1, given 1"):
        Rounds("classic").progress(1)
    with pytest.raises(fw.Error, match="hands must be a number from 1 to 2, given 3"):
        envs.TamaireEnv(hands=3)
    with pytest.raises(fw.Error, match="max_steps must be a number from 0 to .*, given -1"):
        envs.TamaireEnv(max_steps=-1)
    with pytest.raises(fw.Error, match="num_envs must be a number from 1 to 4096, given 0"):
        envs.TamaireVectorEnv(num_envs=0)
    with pytest.raises(fw.Error, match="observation must be 'state' in a vector environment"):
        envs.TamaireVectorEnv(observation="image")


def test_level_from_a_file_is_played(tmp_path):
    level = tmp_path / "mine.toml"
    level.write_text(
        """dim = 2
gravity = [0.0, -5.0, 0.0]
view = [[-1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]
[game]
name = { en = "Mine" }
basket = { centre = [0.5, 0.3, 0.0], half = [0.3, 0.3, 0.0] }
[[body]]
shape = "ball"
n = 8
width = 0.4
at = [-0.4, 0.1, 0.0]
[[obstacle]]
half_space = { normal = [0.0, 1.0, 0.0], point = [0.0, 0.0, 0.0] }
[[hand]]
radius = 0.08
path = [[0.0, -0.8, 0.5, 0.0]]
"""
    )
    env = envs.TamaireEnv(level)
    assert np.isfinite(pushed(env, seed=1)[0]).all()
    assert "Mine" in env.replay()


def test_two_hands_pass_the_check_of_pettingzoo():
    pytest.importorskip("pettingzoo", reason="PettingZoo is not installed")
    from pettingzoo.test import parallel_api_test

    env = envs.parallel_env("classic", max_steps=30)
    parallel_api_test(env, num_cycles=60)
    env.reset(seed=1)
    before = env.state()
    for _ in range(5):
        env.step({"hand_0": np.zeros(2, np.float32), "hand_1": np.array([0.0, -1.0], np.float32)})
    moved = dict(zip(env.env.observation_names, (env.state() - before).tolist(), strict=True))
    assert abs(moved["hand1_position_y"]) > 0.1
    assert abs(moved["hand0_position_y"]) < 0.03
    while env.agents:
        env.step({agent: env.action_space(agent).sample() for agent in env.agents})
    assert env.step({}) == ({}, {}, {}, {}, {})
    with pytest.raises(fw.Error, match="observation cannot be chosen"):
        envs.parallel_env("classic", observation="image")


@pytest.mark.parametrize("name", ["classic-squeeze", "classic-shave"])
def test_trained_player_wins_by_its_route_on_seeds_of_its_own(name, tmp_path):
    player, size = envs.trained_policy(name), 40
    route = name.removeprefix("classic-")
    env = envs.TamaireVectorEnv("classic", size, threads=2)
    # Training began with the seeds 1 to 16.
    states, _ = env.reset(seed=2**40)
    routes, waits = [None] * size, np.ones(size, bool)
    for _ in range(300):
        states, _, terminated, truncated, infos = env.step(player(states))
        for index in np.flatnonzero(terminated & waits):
            routes[index] = infos["route"][index]
            if index == 0:
                (tmp_path / "won.toml").write_text(env.replay(0))
        waits &= ~(terminated | truncated)
        if not waits.any():
            break
    # 95 % or more of 200 rounds were won, and at least 88 % by the player's route: see docs/python.md.
    assert sum(found is not None for found in routes) >= 0.9 * size
    assert routes.count(route) >= 0.75 * size
    if routes[0] is not None:
        assert envs.verify_replay(tmp_path / "won.toml")["route"] == routes[0]


def test_policy_computes_what_a_network_computes(tmp_path):
    rng = np.random.default_rng(1)
    layers = [(rng.normal(size=(3, 5)), rng.normal(size=3)), (rng.normal(size=(2, 3)), rng.normal(size=2))]
    layers = [(weight.astype(np.float32), bias.astype(np.float32)) for weight, bias in layers]
    std = np.array([0.0, 0.1], np.float32)
    policy = envs.Policy(layers, np.ones(5, np.float32), np.full(5, 0.5, np.float32), {"level": "none"}, std)
    policy.save(tmp_path / "policy.npz")
    again = envs.Policy.load(tmp_path / "policy.npz")
    assert again.about == {"level": "none"}
    state = rng.normal(size=5)
    hidden = [np.tanh(sum(w * (s - 1) * 0.5 for w, s in zip(row, state)) + b) for row, b in zip(*layers[0])]
    output = [sum(w * h for w, h in zip(row, hidden)) + b for row, b in zip(*layers[1])]
    np.testing.assert_allclose(again(state), np.clip(output, -1, 1), rtol=1e-5)
    # A tenth of the output layer keeps the actions far from their limits, which would cut the noise off.
    layers[-1] = (0.1 * layers[-1][0], 0.1 * layers[-1][1])
    noisy = envs.Policy(layers, policy.mean, policy.scale, std=std)
    noise = noisy(np.tile(state, (4000, 1)), np.random.default_rng(2)) - noisy(state)
    np.testing.assert_allclose(noise.std(axis=0), std, rtol=0.1)


@pytest.mark.skipif("not __import__('importlib').util.find_spec('pygame')", reason="pygame is not installed")
def test_window_shows_rounds(monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    env = envs.TamaireEnv(render_mode="human")
    env.reset(seed=1)
    start = time.perf_counter()
    for _ in range(6):
        env.step(np.zeros(2))
    # Six steps of 4/60 s; the first picture need not wait.
    assert time.perf_counter() - start > 0.3
    import pygame

    shown = pygame.surfarray.array3d(pygame.display.get_surface()).swapaxes(0, 1)
    np.testing.assert_array_equal(shown, env.rounds.rgb(0, 640))
    env.close()

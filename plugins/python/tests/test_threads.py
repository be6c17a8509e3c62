"""Worlds in several threads of Python."""

import concurrent.futures
import queue
import threading

from conftest import classes, floor_world, torn_world


def falling_world(dim, ticks_before=0, n=None):
    """Return a world with a ball of `n` voxels across that falls and does not fall asleep."""
    fwd = classes(dim)
    world = floor_world(fwd, sleep=False)
    ball = fwd.SoftBody.ball(n or (64 if dim == 2 else 16))
    world.add_soft_body(ball.translated([0, 0.2, 0][:dim]))
    world.step(ticks_before)
    return world


def is_stepping(world):
    """Return whether another thread steps the world, which then refuses all calls."""
    try:
        world.hash()
    except RuntimeError:
        return True
    return False


def test_two_worlds_step_at_once_to_the_bits_of_one_after_the_other():
    expected = []
    for dim in (2, 3):
        world = falling_world(dim)
        world.step(120)
        expected.append(world.hash())

    flat, deep = worlds = [falling_world(2), falling_world(3)]
    threads = [threading.Thread(target=world.step, args=(120,)) for world in worlds]
    for thread in threads:
        thread.start()
    # Each thread makes a single call. The first world steps before and after a moment at which the second one steps:
    # at that moment, both do.
    overlaps = 0
    while any(thread.is_alive() for thread in threads):
        overlaps += is_stepping(flat) and is_stepping(deep) and is_stepping(flat)
    for thread in threads:
        thread.join()
    assert overlaps > 0, "the two steps overlap"
    assert [world.hash() for world in worlds] == expected


def test_counter_of_another_thread_advances_within_one_step():
    world = falling_world(3, n=24)
    # Fewer ticks than those between two looks at signals: the whole step runs without the lock of the interpreter.
    thread = threading.Thread(target=world.step, args=(15,))
    thread.start()
    count = 0
    while thread.is_alive():
        count += is_stepping(world)
    thread.join()
    assert count > 0
    assert world.ticks == 15


def test_world_that_changes_threads_has_the_bits_of_one_thread():
    expected = falling_world(2, 40).hash()
    passed, returned = queue.Queue(), queue.Queue()

    def step():
        for world in iter(passed.get, None):
            world.step()
            returned.put(world)

    threads = [threading.Thread(target=step) for _ in range(3)]
    for thread in threads:
        thread.start()
    world = falling_world(2)
    for _ in range(40):
        passed.put(world)
        world = returned.get()
    for _ in threads:
        passed.put(None)
    for thread in threads:
        thread.join()
    assert world.hash() == expected


def test_worlds_that_share_bodies_tear_alike_in_a_pool_of_threads():
    def tear(_):
        return torn_world(classes(2))[0].hash()

    body = classes(2).SoftBody.ball(24)

    def drop(_):
        world = floor_world(classes(2))
        world.add_soft_body(body)
        world.step(30)
        return world.hash()

    for work in (tear, drop):
        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            assert set(pool.map(work, range(8))) == {work(0)}

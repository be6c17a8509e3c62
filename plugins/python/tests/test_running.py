"""Memory, threads and overhead."""

import multiprocessing
import resource
import sys
import threading
import time

import pytest
from conftest import classes, floor_world, torn_world

import fuwafuwa as fw


def memory():
    """Return the largest memory of this process so far [MiB]."""
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 2**20


def test_ten_thousand_worlds_use_no_more_memory_than_a_thousand():
    fwd = classes(2)
    disc = fwd.SoftBody.ball(12)

    def make(count):
        for _ in range(count):
            world = floor_world(fwd)
            ball = world.add_soft_body(disc)
            world.step()
            assert len(world[ball].positions) == world[ball].node_count
            world.events()
            type(world).restore(world.snapshot())

    make(1000)
    before = memory()
    make(9000)
    assert memory() - before < 8


def test_worlds_in_two_threads_have_the_bits_of_one_thread():
    expected = [torn_world(classes(dim), 16, 50)[0].hash() for dim in (2, 3)]
    found = {}

    def run(dim):
        found[dim] = torn_world(classes(dim), 16, 50)[0].hash()

    threads = [threading.Thread(target=run, args=(dim,)) for dim in (2, 3, 2, 3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [found[2], found[3]] == expected


def test_other_threads_run_during_a_step():
    fwd = classes(3)
    world = floor_world(fwd, sleep=False)
    world.add_soft_body(fwd.SoftBody.ball(20))
    started, ended = threading.Event(), threading.Event()

    def run():
        started.set()
        world.step(60)
        ended.set()

    thread = threading.Thread(target=run)
    thread.start()
    started.wait()
    rounds, refused = 0, 0
    while not ended.is_set():
        rounds += 1
        try:
            world.hash()
        except RuntimeError:
            refused += 1
        time.sleep(0.001)
    thread.join()
    assert rounds > 5, "the main thread runs while the world steps"
    assert refused > 5, "a world that steps refuses other calls"
    assert world.ticks == 60


def test_step_costs_little_more_than_in_rust():
    world = floor_world(classes(2))
    world.add_soft_body(fw.SoftBody2.ball(16))
    world.step(900)

    def shortest(work):
        times = []
        for _ in range(7):
            start = time.perf_counter()
            work()
            times.append(time.perf_counter() - start)
        return min(times) / 1000

    def steps():
        for _ in range(1000):
            world.step()

    overhead = shortest(steps) - shortest(lambda: world.step(1000))
    assert overhead < 10e-6, f"{overhead * 1e6:.1f} µs"


@pytest.mark.skipif(not hasattr(__import__("signal"), "setitimer"), reason="needs an alarm of POSIX")
def test_interrupt_ends_a_long_step():
    import signal

    world = floor_world(classes(2), sleep=False)
    world.add_soft_body(fw.SoftBody2.ball(16))

    class Interrupted(Exception):
        pass

    def interrupt(*_):
        raise Interrupted

    known = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, 0.05)
    try:
        with pytest.raises(Interrupted):
            world.step(10**9)
    finally:
        signal.signal(signal.SIGALRM, known)
    assert 0 < world.ticks < 10**9
    world.step()


def step_in_a_process(world):
    world.step(30)
    return world.hash(), world


@pytest.mark.parametrize("method", multiprocessing.get_all_start_methods())
def test_worlds_step_in_other_processes(method):
    world, _, _ = torn_world(classes(2))
    with multiprocessing.get_context(method).Pool(2) as pool:
        results = pool.map(step_in_a_process, [world, world])
    world.step(30)
    for found, sent in results:
        assert found == sent.hash() == world.hash()

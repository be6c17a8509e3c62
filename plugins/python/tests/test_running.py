"""Memory, threads and overhead."""

import multiprocessing
import threading
import time

import pytest
from conftest import classes, floor_world, torn_world

import fuwafuwa as fw


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

"""Compares fuwafuwa with MuJoCo flex, Newton, PlasticineLab and DaXBench: seconds a simulated second, and same bytes.

All engines drop the same elastic ball on a floor: 3112 voxels, 0.2 m across, 1000 kg/m³, Young's modulus 5·10⁴ Pa,
Poisson's ratio 0.3, 0.2 m above the floor, for one simulated second. It lands, is squashed by about a third and
bounces. Nothing tears, because most of the others cannot.

- fuwafuwa and the codes with finite elements (MuJoCo, Newton) get the voxels: 8-node elements, or 5 tetrahedra a voxel.
- The material point codes (PlasticineLab, DaXBench) get one particle at the centre of each voxel, and cells of 1/64 m.

The scenes differ in what cannot be made equal: stress law, damping, contact, and time step. fuwafuwa chooses its step.
The steps of the others were chosen by hand to be fast: they are stable, and the peak squash, which is in the output, is
near a third, or a fifth for MuJoCo's quadratic flex, which is too stiff to dent. Finer steps change it: MuJoCo's full
flex to 41 % with explicit steps of 1/4020 s, Newton to 28 % with 10 iterations in steps of 1/600 s, the material point
codes by less than one percentage point.

Each engine runs in a process of its own, on one core. The rounds of timing go round robin, so a busy machine slows all
alike. Imports, compilers, building the scene, and pictures are not in the times. Hashes of the bytes of all positions
and velocities at the end are compared between two processes on one core, between two that may use all cores, between
one core and all, and between rounds of one process.

    pip install fuwafuwa mujoco newton taichi gym yacs pyyaml jax optax
    git clone https://github.com/hzaskywalker/PlasticineLab && git clone https://github.com/AdaCompNUS/DaXBench
    python benches/peers.py --plasticinelab PlasticineLab --daxbench DaXBench

Engines that are not installed are named and left out. SoftGym is not measured: its engine, FleX, needs CUDA. Linux
only.
"""

from __future__ import annotations

import argparse
import hashlib
import importlib.metadata
import importlib.util
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Protocol

import numpy as np
from numpy.typing import NDArray

ACROSS = 18
"""Voxels along the diameter."""
DIAMETER = 0.2
"""Diameter of the ball [m]."""
VOXEL = DIAMETER / ACROSS
"""Width of a voxel [m]."""
DROP = 0.2
"""Height of the lowest point above the floor at the start [m]."""
DENSITY = 1000.0
"""Density [kg/m³]."""
YOUNG = 5e4
"""Young's modulus [Pa]."""
POISSON = 0.3
"""Poisson's ratio."""
DAMPING = 2e-4
"""Stiffness-proportional damping [s], where the engine has it."""
FRICTION = 0.4
"""Coefficient of friction."""
GRAVITY = 9.81
"""Gravity [m/s²]."""
FRAMES = 60
"""Frames of 1/60 s in the measured second."""

Array = NDArray[Any]


def voxels() -> NDArray[np.bool_]:
    """Voxels whose centre is in the ball, shape (18, 18, 18), axes [x, y, z]."""
    at = (np.arange(ACROSS) + 0.5) * VOXEL - DIAMETER / 2
    x, y, z = np.meshgrid(at, at, at, indexing="ij")
    return np.asarray(x**2 + y**2 + z**2 <= (DIAMETER / 2) ** 2)


def centres() -> NDArray[np.float64]:
    """Centres of the voxels [m], shape (n, 3), with the lowest point of the ball at y = 0 and its axis at x = z = 0."""
    points: NDArray[np.float64] = (np.argwhere(voxels()) + 0.5) * VOXEL - np.array([DIAMETER / 2, 0, DIAMETER / 2])
    return points


def tetrahedra() -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Corners of the voxels [m], shape (n, 3), placed as `centres`, and 5 tetrahedra a voxel, shape (m, 4).

    The split alternates, so the faces of neighbours fit. All tetrahedra have a positive volume.
    """
    numbers: dict[tuple[int, ...], int] = {}
    rows: list[list[int]] = []
    # Corner c of a voxel is at ((c >> 2) & 1, (c >> 1) & 1, c & 1).
    even = ((0, 3, 5, 6), (1, 0, 5, 3), (2, 0, 3, 6), (4, 0, 6, 5), (7, 3, 5, 6))
    odd = ((1, 2, 4, 7), (0, 1, 2, 4), (3, 1, 7, 2), (5, 1, 4, 7), (6, 2, 7, 4))
    for voxel in np.argwhere(voxels()):
        corners = []
        for c in range(8):
            corner = tuple(int(v) for v in np.add(voxel, [(c >> 2) & 1, (c >> 1) & 1, c & 1]))
            corners.append(numbers.setdefault(corner, len(numbers)))
        rows += [[corners[i] for i in tet] for tet in (even if voxel.sum() % 2 == 0 else odd)]
    points = np.array(list(numbers)) * VOXEL - np.array([DIAMETER / 2, 0, DIAMETER / 2])
    tets = np.array(rows, dtype=np.int32)
    edges = points[tets[:, 1:]] - points[tets[:, :1]]
    wrong = np.linalg.det(edges) < 0
    tets[np.ix_(wrong, [2, 3])] = tets[np.ix_(wrong, [3, 2])]
    return points, tets


class Engine(Protocol):
    """Ball of one engine, above its floor."""

    axis: int
    """Axis that points up."""
    size: str
    """Nodes, elements or particles."""
    step: str
    """Time step, as a text."""

    def reset(self) -> None:
        """Puts the ball back to its start."""

    def frame(self) -> None:
        """Advances 1/60 s."""

    def state(self) -> tuple[Array, Array]:
        """Returns positions [m] and velocities [m/s] of all nodes, shape (n, 3) each."""


class Fuwafuwa:
    """fuwafuwa: 8-node elements, explicit steps, the number of substeps chosen by the engine."""

    axis = 1

    def __init__(self, grading: Any) -> None:
        self.grading = grading
        self.step = ""
        self.reset()
        self.size = f"{self.ball.node_count} nodes, {self.ball.element_count} elements"

    def reset(self) -> None:
        import fuwafuwa as fw

        material = fw.Material(
            young=YOUNG, poisson=POISSON, density=DENSITY, friction=FRICTION, stiffness_damping=DAMPING, strength=1e12
        )
        body = fw.SoftBody3.from_array(voxels(), VOXEL, [material], grading=self.grading)
        # No sleep: a ball at rest would cost nothing.
        self.world = fw.World3(gravity=(0, -GRAVITY, 0), sleep=False)
        self.world.add_rigid_body(fw.RigidBody3.fixed(fw.Shape3.half_space((0, 1, 0)), friction=FRICTION))
        self.ball = self.world[self.world.add_soft_body(body.translated((0, DROP, 0)))]

    def frame(self) -> None:
        self.step = f"1/{FRAMES * self.world.step().substeps} s"

    def state(self) -> tuple[Array, Array]:
        return self.ball.positions, self.ball.velocities


class MujocoFlex:
    """MuJoCo flex: tetrahedra, implicit steps; all nodes move ("full"), or 27 nodes around the ball ("quadratic")."""

    axis = 2

    def __init__(self, dof: str, steps: int) -> None:
        import mujoco

        points, tets = tetrahedra()
        points = points[:, [2, 0, 1]]  # a rotation: z points up
        # Version 4 renamed the integrator that treats the elasticity of flexes implicitly.
        integrator = "discrete" if int(mujoco.__version__.split(".")[0]) >= 4 else "implicitfast"
        text = f"""
        <mujoco>
          <option solver="CG" tolerance="1e-6" integrator="{integrator}" timestep="{1 / FRAMES / steps!r}"
                  gravity="0 0 {-GRAVITY}"/>
          <size memory="1G"/>
          <worldbody>
            <geom type="plane" size="2 2 .1" friction="{FRICTION}"/>
            <flexcomp name="ball" type="direct" dim="3" dof="{dof}" radius="0.0005" mass="{mass()}"
                      pos="0 0 {DROP}" point="{numbers_text(points)}" element="{numbers_text(tets)}">
              <contact selfcollide="none" friction="{FRICTION}" solref="0.01 1"/>
              <elasticity young="{YOUNG}" poisson="{POISSON}" damping="{DAMPING}"/>
            </flexcomp>
          </worldbody>
        </mujoco>"""
        self.mujoco = mujoco
        self.model = mujoco.MjModel.from_xml_string(text)
        self.data = mujoco.MjData(self.model)
        self.steps = steps
        self.size = f"{self.model.nflexvert} nodes, {self.model.nflexelem} tetrahedra, {self.model.nv} dofs"
        self.step = f"1/{steps * FRAMES} s"
        self.reset()

    def reset(self) -> None:
        self.mujoco.mj_resetData(self.model, self.data)
        self.mujoco.mj_forward(self.model, self.data)

    def frame(self) -> None:
        for _ in range(self.steps):
            self.mujoco.mj_step(self.model, self.data)

    def state(self) -> tuple[Array, Array]:
        return self.data.flexvert_xpos.copy(), self.data.qvel.copy().reshape(-1, 3)


class Newton:
    """Newton on the CPU: tetrahedra, solved implicitly by vertex block descent."""

    axis = 2

    def __init__(self, steps: int, iterations: int) -> None:
        import newton
        import warp

        points, tets = tetrahedra()
        points = points[:, [2, 0, 1]]  # a rotation: z points up
        builder = newton.ModelBuilder(gravity=(0.0, 0.0, -GRAVITY))
        builder.add_ground_plane()
        builder.add_soft_mesh(
            pos=warp.vec3(0.0, 0.0, DROP),
            rot=warp.quat_identity(),
            scale=1.0,
            vel=warp.vec3(0.0, 0.0, 0.0),
            vertices=[warp.vec3(*point) for point in points],
            indices=tets.reshape(-1).tolist(),
            density=DENSITY,
            k_mu=YOUNG / (2 * (1 + POISSON)),
            k_lambda=YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)),
            k_damp=DAMPING * YOUNG,
            particle_radius=0.0005,
        )
        builder.color()
        self.model = builder.finalize(device="cpu")
        self.model.soft_contact_ke = 1e4
        self.model.soft_contact_kd = 1.0
        self.model.soft_contact_mu = FRICTION
        self.solver = newton.solvers.SolverVBD(self.model, iterations=iterations, particle_enable_self_contact=False)
        self.control = self.model.control()
        self.pipeline = newton.CollisionPipeline(self.model)
        self.contacts = self.pipeline.contacts()
        self.steps = steps
        self.size = f"{self.model.particle_count} nodes, {self.model.tet_count} tetrahedra"
        self.step = f"1/{steps * FRAMES} s, {iterations} iterations"
        self.reset()

    def reset(self) -> None:
        self.states = [self.model.state(), self.model.state()]

    def frame(self) -> None:
        for _ in range(self.steps):
            self.states[0].clear_forces()
            self.pipeline.collide(self.states[0], self.contacts)
            self.solver.step(self.states[0], self.states[1], self.control, self.contacts, 1 / FRAMES / self.steps)
            self.states.reverse()

    def state(self) -> tuple[Array, Array]:
        return self.states[0].particle_q.numpy().copy(), self.states[0].particle_qd.numpy().copy()


class PlasticineLab:
    """MPM of PlasticineLab in double precision, unchanged except for the step and three names that Taichi renamed."""

    axis = 1

    def __init__(self, threads: int, steps: int) -> None:
        import taichi as ti

        ti.ext_arr = ti.types.ndarray
        ti.complex_kernel = ti.ad.grad_replaced
        ti.complex_kernel_grad = ti.ad.grad_for
        ti.init(arch=ti.cpu, cpu_max_num_threads=threads, log_level=ti.ERROR)
        from plb.config.default_config import get_cfg_defaults
        from plb.engine.mpm_simulator import MPMSimulator

        config = get_cfg_defaults().SIMULATOR
        points = centres()
        # Masses of particles cancel: E is divided by the density, because the code computes with 1 kg/m³.
        config.E, config.nu, config.yield_stress = YOUNG / DENSITY, POISSON, 1e9
        config.n_particles, config.max_steps, config.ground_friction = len(points), steps + 1, FRICTION
        config.gravity = (0.0, -GRAVITY / 30, 0.0)  # the code multiplies by 30
        self.simulator = MPMSimulator(config)
        self.simulator.dt = 1 / FRAMES / steps
        self.simulator.substeps = steps
        self.simulator.initialize()
        # The floor is three cells above the lower end of the grid.
        self.start = points + np.array([0.5, 3 * self.simulator.dx + DROP, 0.5])
        self.size = f"{len(points)} particles, {self.simulator.n_grid}³ cells"
        self.step = f"1/{steps * FRAMES} s"
        self.reset()

    def reset(self) -> None:
        self.simulator.reset(self.start)

    def frame(self) -> None:
        self.simulator.step(is_copy=True)

    def state(self) -> tuple[Array, Array]:
        return self.simulator.get_x(0), self.simulator.get_v(0)


class DaxBench:
    """MPM of DaXBench in single precision, unchanged; its elastic material, without tools."""

    axis = 1

    def __init__(self, steps: int) -> None:
        import jax
        import jax.numpy as jnp
        from daxbench.core.engine.mpm_simulator import SimpleMPMSimulator

        class Config:
            key = jax.random.PRNGKey(0)
            n_primitive = 0
            ground_friction = FRICTION
            n_grid = 64
            res = (32, 32, 32)
            dx, inv_dx = 1 / 64, 64.0
            dt = 1 / FRAMES / steps
            p_vol = (0.5 / 64) ** 2
            p_mass = p_vol  # 1 kg/m³, as in PlasticineLab
            E, nu = YOUNG / DENSITY, POISSON
            gravity = jnp.array([0, -GRAVITY, 0])

        Config.steps = steps  # type: ignore[attr-defined]
        self.simulator = SimpleMPMSimulator(Config, batch_size=1)
        self.simulator.key_global = Config.key
        points = jnp.array(centres() + np.array([0.25, 3 / 64 + DROP, 0.25]), dtype=jnp.float32)
        start = self.simulator.add_box_from_points(Config, None, points, material=1)
        self.start = self.simulator.reset_jax(start)
        self.action = jnp.zeros((1, 6))
        self.size = f"{len(points)} particles, 32³ cells"
        self.step = f"1/{steps * FRAMES} s"
        self.reset()

    def reset(self) -> None:
        self.now = self.start

    def frame(self) -> None:
        self.now = self.simulator.step_jax(self.now, self.action)[0]
        self.now.x.block_until_ready()

    def state(self) -> tuple[Array, Array]:
        return np.asarray(self.now.x[0]), np.asarray(self.now.v[0])


def mass() -> float:
    """Mass of the ball [kg]."""
    return float(voxels().sum() * VOXEL**3 * DENSITY)


def numbers_text(values: Array) -> str:
    """Numbers with spaces between them, as MJCF wants them."""
    return " ".join(repr(value) for value in values.reshape(-1).tolist())


@dataclass(frozen=True)
class Entry:
    """Row of the comparison."""

    name: str
    packages: tuple[str, ...]
    build: Callable[[int], Engine]
    """Builds the engine for a number of threads."""
    path: str | None = None
    """Option that names the clone, for codes that are in no registry."""


ENTRIES = (
    Entry("fuwafuwa", ("fuwafuwa",), lambda threads: Fuwafuwa("graded")),
    Entry("fuwafuwa, uniform elements", ("fuwafuwa",), lambda threads: Fuwafuwa("uniform")),
    Entry("MuJoCo flex, full", ("mujoco",), lambda threads: MujocoFlex("full", 4)),
    Entry("MuJoCo flex, quadratic", ("mujoco",), lambda threads: MujocoFlex("quadratic", 8)),
    Entry("Newton, VBD", ("newton", "warp"), lambda threads: Newton(8, 5)),
    Entry(
        "PlasticineLab", ("taichi", "gym", "yacs", "plb"), lambda threads: PlasticineLab(threads, 10), "plasticinelab"
    ),
    Entry("DaXBench", ("jax", "optax", "daxbench"), lambda threads: DaxBench(10), "daxbench"),
)
ROUNDS = 5
"""Rounds of timing; the output has their medians."""


def digest(engine: Engine) -> str:
    """First 16 digits of the SHA-256 of the bytes of all positions and velocities."""
    positions, velocities = engine.state()
    return hashlib.sha256(
        np.ascontiguousarray(positions).tobytes() + np.ascontiguousarray(velocities).tobytes()
    ).hexdigest()[:16]


def first_round(engine: Engine) -> dict[str, Any]:
    """Simulates the second, which also compiles what is compiled late; returns hash and squash at the first contact."""
    height = np.ptp(engine.state()[0][:, engine.axis])
    lowest = height
    for _ in range(FRAMES):
        engine.frame()
        lowest = min(lowest, np.ptp(engine.state()[0][:, engine.axis]))
    return {"hash": digest(engine), "squash": float(1 - lowest / height), "size": engine.size, "step": engine.step}


def timed_round(engine: Engine) -> dict[str, Any]:
    """Simulates the second again from its start; returns hash, wall time [s] and processor time [s]."""
    engine.reset()
    wall, processor = time.perf_counter(), time.process_time()
    for _ in range(FRAMES):
        engine.frame()
    wall, processor = time.perf_counter() - wall, time.process_time() - processor
    return {"hash": digest(engine), "wall": wall, "processor": processor}


def serve(entry: Entry, cores: set[int], paths: list[str]) -> None:
    """Child process: simulates the second once, then once more for each line of input; answers in lines of JSON."""
    os.sched_setaffinity(0, cores)
    # Some engines print to the standard output. It becomes the standard error; answers go to a copy.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    sys.path += paths
    engine: Engine = entry.build(len(cores))
    print(json.dumps(first_round(engine)), file=answers, flush=True)
    for _ in sys.stdin:
        print(json.dumps(timed_round(engine)), file=answers, flush=True)


class Child:
    """Process with one engine."""

    def __init__(self, entry: Entry, cores: set[int], paths: list[str]) -> None:
        job = json.dumps({"name": entry.name, "cores": sorted(cores), "paths": paths})
        # A file, because a pipe that nobody reads would stop an engine that prints much.
        errors = tempfile.TemporaryFile("w+", errors="replace")  # noqa: SIM115, closed by `close`
        self.process = subprocess.Popen(
            [sys.executable, __file__, "--serve", job],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=errors,
            text=True,
        )
        self.name, self.errors = entry.name, errors
        self.first = self.answer()

    def pipe(self, pipe: IO[str] | None) -> IO[str]:
        if pipe is None:
            raise RuntimeError(f"{self.name}: the process has no pipes")
        return pipe

    def answer(self) -> dict[str, Any]:
        line = self.pipe(self.process.stdout).readline()
        if not line:
            self.errors.seek(0)
            raise RuntimeError(f"{self.name}: {self.errors.read()[-2000:]}")
        answer: dict[str, Any] = json.loads(line)
        return answer

    def round(self) -> dict[str, Any]:
        self.pipe(self.process.stdin).write("go\n")
        self.pipe(self.process.stdin).flush()
        return self.answer()

    def close(self) -> None:
        self.pipe(self.process.stdin).close()
        self.process.wait()
        self.errors.close()


def missing(entry: Entry) -> list[str]:
    """Modules of an entry that cannot be imported."""
    return [name for name in entry.packages if importlib.util.find_spec(name) is None]


def version(module: str) -> str:
    """Version of an installed module, or "clone" for one that is only on the path."""
    names = importlib.metadata.packages_distributions().get(module)
    return importlib.metadata.version(names[0]) if names else "clone"


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--plasticinelab", type=Path, help="clone of github.com/hzaskywalker/PlasticineLab")
    parser.add_argument("--daxbench", type=Path, help="clone of github.com/AdaCompNUS/DaXBench")
    parser.add_argument("--rounds", type=int, default=ROUNDS, help=f"rounds of timing, default {ROUNDS}")
    parser.add_argument("--only", help="engines whose name contains this text")
    parser.add_argument("--json", type=Path, help="file for all numbers")
    parser.add_argument("--serve", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.serve:
        job = json.loads(options.serve)
        serve(next(e for e in ENTRIES if e.name == job["name"]), set(job["cores"]), job["paths"])
        return

    paths = [str(path.resolve()) for path in (options.plasticinelab, options.daxbench) if path]
    sys.path += paths
    every = os.sched_getaffinity(0)
    one = {min(every)}
    children: dict[str, Child] = {}
    results: dict[str, dict[str, Any]] = {}
    for entry in ENTRIES:
        if options.only and options.only not in entry.name:
            continue
        if lacking := missing(entry):
            hint = f" (option --{entry.path})" if entry.path else ""
            print(f"{entry.name}: not measured, no module {', '.join(lacking)}{hint}", flush=True)
            continue
        versions = ", ".join(f"{name} {version(name)}" for name in entry.packages)
        again, wide, wide_again = (Child(entry, cores, paths) for cores in (one, every, every))
        for other in (again, wide, wide_again):
            other.close()
        child = children[entry.name] = Child(entry, one, paths)
        same = {
            "one core": child.first["hash"] == again.first["hash"],
            "all cores": wide.first["hash"] == wide_again.first["hash"],
            "one and all": child.first["hash"] == wide.first["hash"],
        }
        results[entry.name] = {**child.first, "versions": versions, "same": same, "rounds": []}
    print("SoftGym: not measured, its engine FleX needs CUDA")

    for _ in range(options.rounds):
        for name, child in children.items():
            results[name]["rounds"].append(child.round())
    for child in children.values():
        child.close()

    print(f"cores: {len(every)}; one simulated second, medians of {options.rounds} rounds on one core")
    print("same bytes: two processes on one core; two on all cores; one core and all; rounds of one process")
    print("| engine | size | step | peak squash | wall s | processor s | same bytes |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for name, result in results.items():
        rounds = result["rounds"]
        wall, processor = (statistics.median(r[key] for r in rounds) for key in ("wall", "processor"))
        equal = [*result["same"].values(), all(r["hash"] == result["hash"] for r in rounds)]
        print(
            f"| {name} ({result['versions']}) | {result['size']} | {result['step']} | {100 * result['squash']:.1f} % "
            f"| {wall:.3f} | {processor:.3f} | {', '.join('yes' if e else 'no' for e in equal)} |"
        )
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()

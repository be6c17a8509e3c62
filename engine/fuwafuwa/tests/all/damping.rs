//! Rayleigh damping of materials: momentum, energy, limits, and bodies of several materials. `fuwafuwa check
//! damping` compares damping ratios with the law.

use fuwafuwa::{
    Damping, Dim, Dim2, Dim3, DimVector, Material, NodeId, SoftBody, SoftBodyHandle, Vec3,
    VoxelGrid, World, WorldConfig,
};

/// Returns a world without gravity.
fn weightless<D: Dim>() -> World<D> {
    World::new(WorldConfig {
        gravity: D::Vector::ZERO,
        ..WorldConfig::default()
    })
    .unwrap()
}

/// Returns a material with a damping that does not tear.
fn damped(damping: Damping) -> Material {
    Material {
        damping,
        strength: f32::INFINITY,
        ..Material::default()
    }
}

/// Adds a ball 1 m across whose lower half has the first material and whose upper half the second.
fn halves<D: Dim>(world: &mut World<D>, dampings: [Damping; 2]) -> SoftBodyHandle {
    let n = 12;
    let ball = VoxelGrid::<D>::ball(n, 1.0).unwrap();
    let grid = VoxelGrid::<D>::from_fn(ball.size().map(|k| k as usize), ball.voxel_size(), |at| {
        let half = if at[1] < n as i32 / 2 { 1 } else { 2 };
        half * u8::from(ball.is_solid(at))
    });
    let body = SoftBody::new(grid.unwrap(), &dampings.map(damped)).unwrap();
    world.add_soft_body(body).unwrap()
}

/// Sets the velocity of every node [m/s] as a function of its position [m].
fn set_velocities<D: Dim>(
    world: &mut World<D>,
    id: SoftBodyHandle,
    velocity: impl Fn(Vec3) -> Vec3,
) {
    let body = world.soft_body_mut(id).unwrap();
    let nodes: Vec<NodeId> = body.mesh().nodes().map(|(id, _)| id).collect();
    for node in nodes {
        let (at, _, _) = body.node_state(node);
        let velocity = D::Vector::from_vec3(velocity(at.to_vec3()));
        body.set_node_state(node, at, velocity).unwrap();
    }
}

fn energy<D: Dim>(world: &World<D>, id: SoftBodyHandle) -> f64 {
    let energies = world[id].energies(D::Vector::ZERO);
    energies.iter().map(|energy| energy.total()).sum()
}

/// Strong mass damping and strong stiffness damping.
const DIFFERENT: [Damping; 2] = [
    Damping {
        mass: 20.0,
        stiffness: 0.0,
    },
    Damping {
        mass: 0.0,
        stiffness: 5e-3,
    },
];

fn check_momentum<D: Dim>() {
    let mut world = weightless::<D>();
    let id = halves(&mut world, DIFFERENT);
    let spin = Vec3::new(0.0, 0.0, 3.0);
    set_velocities(&mut world, id, |at| {
        let x = at - Vec3::splat(0.5);
        Vec3::new(0.2, -0.1, 0.0) + spin.cross(x) + Vec3::new(x.y, x.x, 0.5 * x.z) * 1.5
    });
    let (before, mut last) = (world[id].momentum(), energy(&world, id));
    let first = last;
    for tick in 0..120 {
        world.step();
        let now = energy(&world, id);
        assert!(now < last + 2e-3 * first, "tick {tick}: {last} to {now} J");
        last = now;
    }
    assert!(last < 0.9 * first, "{first} to {last} J");
    let after = world[id].momentum();
    let drift = (after.linear - before.linear).length() / before.linear.length();
    assert!(drift < 1e-4, "{before:?} {after:?}");
    let drift = (after.angular - before.angular).length() / before.angular.length();
    assert!(drift < 1e-3, "{before:?} {after:?}");
}

#[test]
fn materials_of_different_damping_keep_momentum() {
    check_momentum::<Dim2>();
    check_momentum::<Dim3>();
}

/// Returns the fraction of the vibration energy that a stretched bar keeps: the mean over the third period
/// relative to that over the first.
fn kept(damping: Damping) -> f64 {
    // A Poisson's ratio of 0 makes the stretching along the bar a single mode, of period 2 L √(ρ / Y).
    let mut material = damped(damping);
    material.elasticity.poisson = 0.0;
    let wave_speed = (material.elasticity.young / f64::from(material.density)).sqrt();
    let mut world = weightless::<Dim2>();
    let grid = VoxelGrid::from_fn([16, 2, 1], 1.0 / 16.0, |_| 1).unwrap();
    let id = world
        .add_soft_body(SoftBody::new(grid, &[material]).unwrap())
        .unwrap();
    set_velocities(&mut world, id, |at| {
        let phase = f64::from(at.x - 0.5) * std::f64::consts::PI;
        Vec3::X * (0.3 * libm::sin(phase)) as f32
    });
    let period = (2.0 / wave_speed * 60.0).round() as usize;
    let mut mean = || {
        let sum: f64 = (0..period)
            .map(|_| {
                world.step();
                energy(&world, id)
            })
            .sum();
        sum / period as f64
    };
    let means = [mean(), mean(), mean()];
    means[2] / means[0]
}

/// The energy of a vibration falls as exp(−2 ζ ω t), with the law 2 ζ ω = α + β ω².
#[test]
fn vibration_energy_decays_by_the_law() {
    let omega = std::f64::consts::PI * 50f64.sqrt();
    let time = 2.0 * 17.0 / 60.0;
    for damping in [
        Damping::NONE,
        Damping {
            mass: 1.0,
            stiffness: 0.0,
        },
        Damping {
            mass: 0.0,
            stiffness: 2e-3,
        },
        Damping {
            mass: 0.5,
            stiffness: 1e-3,
        },
    ] {
        let rate = f64::from(damping.mass) + f64::from(damping.stiffness) * omega * omega;
        let (found, law) = (kept(damping), libm::exp(-rate * time));
        assert!(
            (found / law - 1.0).abs() < 0.03,
            "{damping:?}: {found}, {law}"
        );
    }
}

/// A body that hangs on one fixed node turns about it without damping.
fn check_pivot<D: Dim>() {
    let mut world = weightless::<D>();
    let id = halves(&mut world, [Damping::at(0.5, 4.0); 2]);
    let body = world.soft_body_mut(id).unwrap();
    let nodes: Vec<NodeId> = body.mesh().nodes().map(|(id, _)| id).collect();
    let height = |id: &NodeId| body.node_state(*id).0[1];
    let top = nodes.iter().copied();
    let top = top.max_by(|a, b| height(a).total_cmp(&height(b))).unwrap();
    let pivot = body.node_state(top).0.to_vec3();
    body.fix_node(top);
    set_velocities(&mut world, id, |at| Vec3::Z.cross(at - pivot) * 0.3);
    let before = world[id].kinetic_energy();
    (0..60).for_each(|_| _ = world.step());
    let after = world[id].kinetic_energy();
    assert!((after / before - 1.0).abs() < 0.05, "{before} {after}");
}

#[test]
fn mass_damping_does_not_stop_a_turn_about_a_fixed_node() {
    check_pivot::<Dim2>();
    check_pivot::<Dim3>();
}

#[test]
fn limited_stiffness_damping_is_reported() {
    let given = Damping {
        mass: 1.0,
        stiffness: 0.1,
    };
    for (damping, limited) in [(Damping::default(), 0), (given, 1)] {
        let mut world = weightless::<Dim3>();
        let id = halves(&mut world, [damping; 2]);
        let acting = world.acting_damping(id).unwrap();
        assert_eq!(world.step().damping_limited, limited);
        assert_eq!(acting[0] == damping, limited == 0, "{acting:?}");
        assert_eq!(acting[0].mass, damping.mass);
        if limited > 0 {
            // 0.7 (4/Ω² − h²) / 2h, with Ω² = 4 (3 λ + 2 µ) / ρ s².
            let elasticity = Material::default().elasticity;
            let modulus = 3.0 * elasticity.lame() + 2.0 * elasticity.shear_modulus();
            let squared = 4.0 * modulus / 100.0 * 144.0;
            let step = 1.0 / 60.0 / f64::from(world.substeps());
            let max = 0.7 * (4.0 / squared - step * step) / (2.0 * step);
            let found = f64::from(acting[1].stiffness);
            assert!((found / max - 1.0).abs() < 1e-4, "{found} {max}");
        }
    }
}

#[test]
fn invalid_damping_is_an_error() {
    for (mass, stiffness, field) in [
        (-1.0, 0.0, "mass_damping"),
        (f32::INFINITY, 0.0, "mass_damping"),
        (0.0, -1e-3, "stiffness_damping"),
        (0.0, f32::NAN, "stiffness_damping"),
    ] {
        let error = damped(Damping { mass, stiffness }).check().unwrap_err();
        assert!(error.to_string().contains(field), "{error}");
    }
}

//! Hyperelastic and viscoelastic materials: forces compared with the reference implementation, closed forms of
//! relaxation, creep and damping, inverted elements, large strains, and snapshots.

use fuwafuwa::inspect::{ElasticLaw, forces};
use fuwafuwa::{
    Damping, Dim, Dim2, Dim3, DimVector, Elasticity, ElementState, Law, Material, NodeId,
    PronyTerm, RigidBody, Shape, SoftBody, SoftBodyHandle, StressLaw, Vec2, Vec3, VoxelGrid, World,
    WorldConfig,
};
use glam::DVec3;

const YEOH: StressLaw = StressLaw::Yeoh {
    second: 0.05,
    third: 0.002,
};

/// Returns an undamped, unbreakable material.
fn rubber(stress_law: StressLaw, poisson: f64) -> Material {
    Material {
        elasticity: Elasticity::new(5000.0, poisson).unwrap(),
        stress_law,
        damping: Damping::NONE,
        strength: f32::INFINITY,
        toughness: f32::INFINITY,
        ..Material::default()
    }
}

/// Moves the nodes of a body from their rest positions [m].
fn place<D: Dim>(body: &mut SoftBody<D>, map: impl Fn(Vec3) -> Vec3) {
    let nodes: Vec<_> = body.mesh().nodes().collect();
    let size = body.grid().voxel_size();
    for (id, node) in nodes {
        let moved = map(Vec3::from(node.at.map(|k| k as f32 * size)));
        body.set_node_state(id, D::Vector::from_vec3(moved), D::Vector::ZERO)
            .unwrap();
    }
}

/// Bends and turns a body.
fn bend(Vec3 { x, y, z }: Vec3) -> Vec3 {
    let bent = Vec3::new(x * 1.3 + 0.3 * y * y, y * 0.7 + 0.2 * x, z + 0.3 * x * y);
    Vec3::new(
        0.8 * bent.x - 0.6 * bent.y,
        0.6 * bent.x + 0.8 * bent.y,
        bent.z,
    )
}

/// Checks the forces in a ball that is bent and grown by a factor.
fn check_batches<D: Dim>(material: &Material, growth: f32) {
    let grid = VoxelGrid::<D>::ball(16, 1.0).unwrap();
    let mut body = SoftBody::new(grid, &[*material]).unwrap();
    place(&mut body, |at| growth * bend(at));
    (0..8).for_each(|_| body.advance(0.0, D::Vector::ZERO));
    let mut expected = vec![DVec3::ZERO; body.mesh().node_capacity()];
    for (_, element) in body.mesh().elements() {
        let at = |&node: &NodeId| body.node_state(node).0.to_vec3().as_dvec3();
        let positions: Vec<DVec3> = element.nodes.iter().map(at).collect();
        let class = body.mesh().element_class(element);
        let size = f64::from(element.cell.width()) / 16.0;
        let elastic = ElasticLaw::from(material);
        let all = forces(Law::CorotationalVem, elastic, class, size, &positions);
        for (&node, force) in element.nodes.iter().zip(all) {
            expected[node.index()] += force;
        }
    }
    let largest = expected
        .iter()
        .map(|force| force.length())
        .fold(0.0, f64::max);
    for (id, node) in body.mesh().nodes() {
        let found = body.force_on(id).to_vec3().as_dvec3();
        let error = (found - expected[id.index()]).length();
        assert!(
            error < 3e-4 * largest,
            "{material:?} at {:?}: {error}",
            node.at
        );
    }
}

#[test]
fn hyperelastic_batches_match_reference_law() {
    for stress_law in [StressLaw::NeoHookean, YEOH] {
        for poisson in [0.3, 0.49] {
            for growth in [1.0, 1.2, 0.3] {
                check_batches::<Dim2>(&rubber(stress_law, poisson), growth);
                check_batches::<Dim3>(&rubber(stress_law, poisson), growth);
            }
        }
    }
}

/// Holds the surface of a graded block so that the tension in all directions is 5 times the shear modulus, and returns
/// the largest distance of a node from its place in the uniform strain, relative to that at the start.
fn rippled<D: Dim>(material: &Material) -> f32 {
    let width = if D::N == 2 { 16 } else { 8 };
    let grid = VoxelGrid::<D>::cube(width, 1.0).unwrap();
    let damping = Damping {
        mass: 2.0,
        stiffness: 0.0,
    };
    let mut body = SoftBody::new(
        grid,
        &[Material {
            damping,
            ..*material
        }],
    )
    .unwrap();
    let plain = 1 << D::N;
    let is_graded = body
        .mesh()
        .elements()
        .any(|(_, element)| element.nodes.len() > plain);
    assert!(is_graded);
    let (shear, lame) = (
        material.elasticity.shear_modulus(),
        material.elasticity.lame(),
    );
    let growth = 1.0 + 5.0 * shear / (lame + shear);
    let stretch = libm::pow(growth, 1.0 / D::N as f64) as f32;
    let sway = |at: Vec3| 1e-3 * Vec3::new(libm::sinf(37.0 * at.y), libm::sinf(41.0 * at.x), 0.0);
    place(&mut body, |at| {
        let is_inside = at.to_array()[..D::N].iter().all(|&k| k > 0.0 && k < 1.0);
        stretch * at + if is_inside { sway(at) } else { Vec3::ZERO }
    });
    let nodes: Vec<_> = body
        .mesh()
        .nodes()
        .map(|(id, node)| (id, node.at))
        .collect();
    for &(id, at) in &nodes {
        if at[..D::N].iter().any(|&k| k == 0 || k == width as i32) {
            body.fix_node(id);
        }
    }
    let config = WorldConfig {
        gravity: D::Vector::ZERO,
        ..WorldConfig::default()
    };
    let mut world = World::new(config).unwrap();
    let id = world.add_soft_body(body).unwrap();
    let farthest = |world: &World<D>| {
        let distance = |&(node, at): &(NodeId, [i32; 3])| {
            let rest = Vec3::from(at.map(|k| k as f32 / width as f32)) * stretch;
            let now = world[id].node_state(node).0.to_vec3();
            (0..D::N)
                .map(|axis| (now[axis] - rest[axis]).abs())
                .fold(0.0, f32::max)
        };
        nodes.iter().map(distance).fold(0.0, f32::max)
    };
    let start = farthest(&world);
    for _ in 0..120 {
        world.step();
    }
    farthest(&world) / start
}

#[test]
fn graded_block_stays_smooth_under_tension() {
    for stress_law in [StressLaw::NeoHookean, YEOH] {
        for poisson in [0.45, 0.49] {
            let material = rubber(stress_law, poisson);
            for ripple in [rippled::<Dim2>(&material), rippled::<Dim3>(&material)] {
                assert!(ripple < 0.5, "{material:?}: {ripple}");
            }
        }
    }
}

/// Returns the shear stress of a block that is sheared suddenly and held, and the ratio to the stress at rest by
/// the Prony series, after some times [s].
fn check_relaxation<D: Dim>(material: &Material) {
    let grid = VoxelGrid::<D>::cube(4, 1.0).unwrap();
    let mut body = SoftBody::new(grid, &[*material]).unwrap();
    let shear = 0.01;
    place(&mut body, |at| at + Vec3::X * (shear * at.y));
    let nodes: Vec<NodeId> = body.mesh().nodes().map(|(id, _)| id).collect();
    nodes.iter().for_each(|&id| body.fix_node(id));
    let step = 1e-3;
    let element = body.mesh().elements().next().unwrap().0;
    for tick in 1..=1000 {
        body.advance(step, D::Vector::ZERO);
        if tick % 100 == 0 {
            let stress = body.element_state(element).unwrap().stress[0][1];
            let rest = material.elasticity.shear_modulus() * f64::from(shear);
            let exact = material.relaxation(f64::from(tick) * f64::from(step));
            let ratio = stress / (rest * exact);
            assert!((ratio - 1.0).abs() < 0.01, "{tick}: {ratio}");
        }
    }
}

#[test]
fn held_shear_relaxes_as_prony_series_says() {
    for stress_law in [StressLaw::Corotational, StressLaw::NeoHookean] {
        let material = Material {
            prony: [PronyTerm::new(2.0, 0.1), PronyTerm::new(0.5, 1.0)],
            ..rubber(stress_law, 0.3)
        };
        check_relaxation::<Dim2>(&material);
        check_relaxation::<Dim3>(&material);
    }
}

/// Strains a block along one axis until its dashpots follow, and then along another one. Checks the forces on the nodes
/// against the stress of the reference implementation by the moments Σ f ⊗ x = −V J σ, and that they have no torque.
fn check_turned_strain<D: Dim>(material: &Material) {
    let grid = VoxelGrid::<D>::cube(4, 1.0).unwrap();
    let mut body = SoftBody::new(grid, &[*material]).unwrap();
    let stretched = |axis: Vec3| move |at: Vec3| at + 0.4 * axis * axis.dot(at);
    let first = Vec3::new(0.8, 0.6, 0.0);
    for _ in 0..60 {
        place(&mut body, stretched(first));
        body.advance(1e-4, D::Vector::ZERO);
    }
    let second = match D::N {
        2 => Vec3::new(0.1, 1.0, 0.0),
        _ => Vec3::new(0.1, 0.7, 0.7),
    };
    place(&mut body, stretched(second));
    (0..8).for_each(|_| body.advance(0.0, D::Vector::ZERO));
    let mut moments = [DVec3::ZERO; 3];
    for (id, _) in body.mesh().nodes() {
        let [force, at] = [body.force_on(id), body.node_state(id).0];
        let [force, at] = [force, at].map(|vector| vector.to_vec3().as_dvec3());
        (0..3).for_each(|i| moments[i] += force[i] * at);
    }
    let element = body.mesh().elements().next().unwrap().0;
    let state = body.element_state(element).unwrap();
    let [a, b, c] = state.deformation;
    let ratio = a.dot(b.cross(c));
    let size = moments.iter().map(|row| row.length()).fold(0.0, f64::max);
    for i in 0..D::N {
        for j in 0..D::N {
            let error = moments[i][j] + ratio * state.stress[i][j];
            assert!(error.abs() < 1e-3 * size, "{i} {j} {moments:?} {state:?}");
            let torque = moments[i][j] - moments[j][i];
            assert!(torque.abs() < 1e-3 * size, "{i} {j} {moments:?}");
        }
    }
    // The dashpots have turned the axes of the stress away from those of the strain.
    let along = |axis: Vec3| {
        let axis = axis.normalize().as_dvec3();
        DVec3::from(state.stress.map(|row| row.dot(axis)))
            .cross(axis)
            .length()
    };
    assert!(along(second) > 0.05 * size, "{state:?}");
}

#[test]
fn viscous_stress_exerts_no_torque_and_matches_reference_law() {
    for stress_law in [StressLaw::Corotational, StressLaw::NeoHookean] {
        let viscous = Material {
            prony: [PronyTerm::new(3.0, 0.005), PronyTerm::new(1.0, 0.05)],
            ..rubber(stress_law, 0.3)
        };
        check_turned_strain::<Dim2>(&viscous);
        check_turned_strain::<Dim3>(&viscous);
    }
    let plastic = Material {
        prony: [PronyTerm::new(3.0, 0.005), PronyTerm::NONE],
        yield_strain: 0.2,
        ..rubber(StressLaw::Corotational, 0.3)
    };
    check_turned_strain::<Dim2>(&plastic);
    check_turned_strain::<Dim3>(&plastic);
}

#[test]
fn sheared_layer_creeps_as_prony_solid() {
    let term = PronyTerm::new(3.0, 0.5);
    let material = Material {
        prony: [term, PronyTerm::NONE],
        damping: Damping {
            mass: 30.0,
            stiffness: 0.0,
        },
        ..rubber(StressLaw::Corotational, 0.3)
    };
    let height = 4.0 / 48.0;
    let grid = VoxelGrid::<Dim2>::from_fn([48, 4, 1], 1.0 / 48.0, |_| 1).unwrap();
    let mut body = SoftBody::new(grid, &[material]).unwrap();
    // Begins with the shear of the instantaneous equilibrium under an acceleration of 10 m/s² along the layer.
    let shear = material.elasticity.shear_modulus() as f32 * (1.0 + term.ratio);
    let slope = 10.0 * material.density / shear;
    place(&mut body, |at| {
        at + Vec3::X * (slope * at.y * (height - 0.5 * at.y) - 0.5)
    });
    let nodes: Vec<_> = body.mesh().nodes().collect();
    for &(id, node) in &nodes {
        if node.at[1] == 0 {
            body.fix_node(id);
        }
    }
    let top = nodes
        .iter()
        .find(|(_, node)| node.at[..2] == [24, 4])
        .unwrap()
        .0;
    let config = WorldConfig {
        gravity: 10.0 * Vec2::X,
        sleep: false,
        ..WorldConfig::default()
    };
    let mut world = World::new(config).unwrap();
    let body = world.add_soft_body(body).unwrap();
    let (mut ticks, mut moved) = (0, Vec::new());
    for ticks_then in [30, 60, 120, 240, 1800] {
        (ticks..ticks_then).for_each(|_| _ = world.step());
        ticks = ticks_then;
        moved.push(f64::from(world[body].node_state(top).0.x));
    }
    // Strain of a Prony solid under constant stress: 1 − g/(1 + g) exp(−t / (1 + g) τ).
    let last = moved[4];
    for (second, moved) in [0.5f64, 1.0, 2.0, 4.0].into_iter().zip(&moved) {
        let ratio = f64::from(term.ratio);
        let decay = libm::exp(-second / ((1.0 + ratio) * f64::from(term.time)));
        let exact = 1.0 - ratio / (1.0 + ratio) * decay;
        assert!(
            (moved / last / exact - 1.0).abs() < 0.04,
            "{second} {} {exact}",
            moved / last
        );
    }
}

/// Complex number.
#[derive(Copy, Clone)]
struct Complex(f64, f64);

impl Complex {
    fn over(self, other: Self) -> Self {
        let square = other.0 * other.0 + other.1 * other.1;
        Self(
            (self.0 * other.0 + self.1 * other.1) / square,
            (self.1 * other.0 - self.0 * other.1) / square,
        )
    }

    fn times(self, other: Self) -> Self {
        Self(
            self.0 * other.0 - self.1 * other.1,
            self.0 * other.1 + self.1 * other.0,
        )
    }
}

#[test]
fn bending_bar_is_damped_as_loss_factor_says() {
    let term = PronyTerm::new(0.2, 0.3);
    let material = Material {
        prony: [term, PronyTerm::NONE],
        ..rubber(StressLaw::Corotational, 0.3)
    };
    let grid = VoxelGrid::<Dim2>::from_fn([32, 8, 1], 1.0 / 32.0, |_| 1).unwrap();
    let mut body = SoftBody::new(grid, &[material]).unwrap();
    let nodes: Vec<_> = body.mesh().nodes().collect();
    for &(id, node) in &nodes {
        let (at, _, _) = body.node_state(id);
        body.set_node_state(id, at, 0.2 * at.x * at.x * Vec2::Y)
            .unwrap();
        if node.at[0] == 0 {
            body.fix_node(id);
        }
    }
    let tip = nodes
        .iter()
        .find(|(_, node)| node.at[..2] == [32, 4])
        .unwrap()
        .0;
    let rest = f64::from(body.node_state(tip).0.y);
    let step = body.longest_substep() as f32;
    let (mut times, mut peaks, mut before, mut peak) = (Vec::new(), Vec::new(), 0.0, 0.0f64);
    for tick in 0.. {
        body.advance(step, Vec2::ZERO);
        let now = f64::from(body.node_state(tip).0.y) - rest;
        peak = peak.max(now.abs());
        if before * now < 0.0 {
            times.push(f64::from(tick) * f64::from(step));
            peaks.push(peak);
            peak = 0.0;
        }
        before = now;
        if times.len() > 9 {
            break;
        }
    }
    let swings = (times.len() - 2) as f64;
    let angular = std::f64::consts::PI * swings / (times[times.len() - 1] - times[1]);
    let decrement = libm::log(peaks[1] / peaks[peaks.len() - 1]) / (std::f64::consts::PI * swings);
    // Plane-strain modulus 4 μ (3 K + μ) / (3 K + 4 μ) with the complex shear modulus μ.
    let elasticity = material.elasticity;
    let shear = elasticity.shear_modulus();
    let bulk = elasticity.lame() + 2.0 / 3.0 * shear;
    let turn = angular * f64::from(term.time);
    let relaxing = Complex(0.0, turn).over(Complex(1.0, turn));
    let ratio = f64::from(term.ratio);
    let shear = Complex(
        shear * (1.0 + ratio * relaxing.0),
        shear * ratio * relaxing.1,
    );
    let sum = |factor: f64| Complex(3.0 * bulk + factor * shear.0, factor * shear.1);
    let modulus = shear.times(sum(1.0)).over(sum(4.0));
    let exact = 0.5 * modulus.1 / modulus.0;
    assert!(
        (decrement / exact - 1.0).abs() < 0.05,
        "{decrement} {exact}"
    );
}

/// Deforms a ball, and returns the largest norm of the strain of an element after five seconds, and the number of inverted
/// elements. At the start, more than five elements have a volume ratio below `most`.
fn recovered<D: Dim>(material: &Material, map: fn(Vec3) -> Vec3, most: f64) -> (f32, u32) {
    let damped = Material {
        damping: Damping {
            mass: 8.0,
            stiffness: 1e-3,
        },
        ..*material
    };
    let grid = VoxelGrid::<D>::ball(8, 1.0).unwrap();
    let mut body = SoftBody::new(grid, &[damped]).unwrap();
    place(&mut body, map);
    let config = WorldConfig {
        gravity: D::Vector::ZERO,
        ..WorldConfig::default()
    };
    let mut world = World::new(config).unwrap();
    let id = world.add_soft_body(body).unwrap();
    let states = |world: &World<D>| -> Vec<ElementState> {
        let body = &world[id];
        let ids = body.mesh().elements().map(|(id, _)| id);
        ids.filter_map(|id| body.element_state(id)).collect()
    };
    let is_deformed = |state: &ElementState| {
        let [a, b, c] = state.deformation;
        a.dot(b.cross(c)) < most
    };
    assert!(
        states(&world)
            .iter()
            .filter(|state| is_deformed(state))
            .count()
            > 5
    );
    let mut inverted = 0;
    (0..300).for_each(|_| inverted = world.step().inverted);
    let strain = states(&world).into_iter().map(|state| {
        state
            .strain
            .iter()
            .map(|row| row.length_squared())
            .sum::<f64>()
    });
    (strain.fold(0.0, f64::max).sqrt() as f32, inverted)
}

#[test]
fn inverted_elements_recover_their_shape() {
    let folded: fn(Vec3) -> Vec3 =
        |at| Vec3::new(if at.x > 0.5 { 0.8 - 0.6 * at.x } else { at.x }, at.y, at.z);
    for poisson in [0.3, 0.49] {
        check_recovery(poisson, folded, 0.0);
    }
}

#[test]
fn crushed_elements_recover_their_shape() {
    for poisson in [0.0, 0.2, 0.3, 0.49] {
        check_recovery(poisson, |at| at * 0.2, 0.05);
    }
}

fn check_recovery(poisson: f64, map: fn(Vec3) -> Vec3, most: f64) {
    for stress_law in [StressLaw::NeoHookean, YEOH] {
        let material = rubber(stress_law, poisson);
        for (strain, inverted) in [
            recovered::<Dim2>(&material, map, most),
            recovered::<Dim3>(&material, map, most),
        ] {
            assert!(
                inverted == 0 && strain < 0.05,
                "{material:?} {strain} {inverted}"
            );
        }
    }
}

/// Multiplies the height of a ball by `height`, throws it at a floor at its wave speed, and returns the largest total
/// energy relative to that at the start.
fn violent<D: Dim>(material: &Material, height: f32) -> f64 {
    let grid = VoxelGrid::<D>::ball(12, 1.0).unwrap();
    let mut body = SoftBody::new(grid, &[*material]).unwrap();
    place(&mut body, |at| Vec3::new(at.x, height * at.y, at.z));
    let speed = (material.elasticity.shear_modulus() / f64::from(material.density)).sqrt() as f32;
    let nodes: Vec<NodeId> = body.mesh().nodes().map(|(id, _)| id).collect();
    for id in nodes {
        let at = body.node_state(id).0;
        let velocity = D::Vector::from_vec3(Vec3::new(0.0, -speed, 0.0));
        body.set_node_state(id, at, velocity).unwrap();
    }
    let config = WorldConfig {
        gravity: D::Vector::ZERO,
        max_substeps: 1024,
        ..WorldConfig::default()
    };
    let mut world = World::new(config).unwrap();
    let floor = Shape::half_space(D::Vector::from_vec3(Vec3::Y), D::Vector::ZERO);
    world.add_rigid_body(RigidBody::fixed(floor)).unwrap();
    let id = world.add_soft_body(body).unwrap();
    let total = |world: &World<D>, id: SoftBodyHandle| -> f64 {
        let energies = world[id].energies(D::Vector::ZERO);
        energies.iter().map(|energy| energy.total()).sum()
    };
    let start = total(&world, id);
    let mut most = 0.0f64;
    for _ in 0..120 {
        let report = world.step();
        assert_eq!(report.quarantined, 0, "{material:?}");
        most = most.max(total(&world, id));
    }
    most / start
}

#[test]
fn violent_motion_gains_no_energy() {
    for poisson in [0.3, 0.49] {
        for stress_law in [StressLaw::Corotational, StressLaw::NeoHookean, YEOH] {
            let material = rubber(stress_law, poisson);
            for height in [0.4, 1.5] {
                for gain in [
                    violent::<Dim2>(&material, height),
                    violent::<Dim3>(&material, height),
                ] {
                    assert!(gain < 1.1, "{material:?} {height}: {gain}");
                }
            }
        }
    }
}

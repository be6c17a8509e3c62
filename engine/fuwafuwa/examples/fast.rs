use fuwafuwa::*;

fn centre<D: Dim>(body: &SoftBody<D>) -> (D::Vector, D::Vector) {
    let (mut x, mut p, mut m) = (D::Vector::ZERO, D::Vector::ZERO, 0.0);
    for (id, _) in body.mesh().nodes() {
        let (at, v, mass) = body.node_state(id);
        x = x + at * mass;
        p = p + v * mass;
        m += mass;
    }
    (x * (1.0 / m), p * (1.0 / m))
}

fn vec<D: Dim>(x: f32, y: f32) -> D::Vector {
    D::Vector::from_vec3(Vec3::new(x, y, 0.0))
}

fn fall<D: Dim>() -> Result<(), Error> {
    for (n, width) in [(64usize, 1.0f32), (32, 0.1), (16, 0.01), (32, 0.0005)] {
        let n = if D::N == 3 { n / 4 } else { n };
        for speed in [1.0f32, 60.0, 300.0] {
            let mut world = World::<D>::new(WorldConfig::default())?;
            let body = SoftBody::<D>::new(VoxelGrid::ball(n, width)?, &[Material::default()])?;
            let id = world.add_soft_body(body);
            world.set_velocity(id, Velocity { linear: vec::<D>(speed, 0.0), ..Default::default() })?;
            let x0 = centre(&world[id]).0;
            let mut limited = 0;
            for _ in 0..30 { let r = world.step(); limited += r.speed_limited + r.slowed_impacts; }
            let x1 = centre(&world[id]);
            let t = 0.5f32;
            println!("{}D n {n} width {width} v {speed}: moved {:?} of {} {}; speed {:?}; limited {limited}", D::N, x1.0 - x0, speed * t, -0.5*9.81*t*t, x1.1);
        }
    }
    Ok(())
}

fn impact<D: Dim>(max_substeps: u32, young: f32, damping: f32) -> Result<(), Error> {
    for (n, width) in [(32usize, 1.0f32), (16, 1.0), (32, 0.05), (16, 0.002)] {
        let n = if D::N == 3 { n / 2 } else { n };
        for speed in [2.0f32, 10.0, 30.0, 60.0, 300.0] {
            if let Ok(o) = std::env::var("ONLY") { if o != format!("{n} {width} {speed}") { continue; } }
            let config = WorldConfig { gravity: D::Vector::ZERO, max_substeps, ..WorldConfig::default() };
            let mut world = World::<D>::new(config)?;
            let material = Material { elasticity: Elasticity { young: young.into(), ..Material::default().elasticity }, damping, toughness: 1e9, strength: 1e9, ..Material::default() };
            let body = SoftBody::<D>::new(VoxelGrid::ball(n, width)?, &[material])?;
            let id = world.add_soft_body(body);
            let plate = Shape::Box { centre: vec::<D>(0.0, -0.01), half: D::Vector::from_vec3(Vec3::new(3.0, 0.01, if D::N == 3 { 3.0 } else { 0.0 })) };
            world.add_rigid_body(RigidBody::fixed(plate))?;
            world.translate(id, vec::<D>(0.013, 2.03) - centre(&world[id]).0)?;
            world.set_velocity(id, Velocity { linear: vec::<D>(0.0, -speed), ..Default::default() })?;
            let (mut limited, mut slowed, mut inverted, mut low, mut substeps) = (0, 0, 0, f32::INFINITY, 0);
            let mut flat = 1e9f32;
            let mut quarantined = 0;
            let ticks = (120.0 * (2.0 / speed).max(0.1)) as usize + 60;
            for _ in 0..ticks {
                let r = world.step();
                limited += r.speed_limited; slowed += r.slowed_impacts; inverted = inverted.max(r.inverted); substeps = r.substeps;
                quarantined += r.quarantined;
                let ys: Vec<f32> = world[id].mesh().nodes().map(|(k, _)| world[id].node_state(k).0.to_vec3().y).collect();
                let min = ys.iter().copied().fold(f32::INFINITY, f32::min);
                let max = ys.iter().copied().fold(-f32::INFINITY, f32::max);
                low = low.min(min); flat = flat.min((max - min) / width);
            }
            let (x, v) = centre(&world[id]);
            let e = v.to_vec3().y / speed;
            println!("{}D n {n} w {width} v {speed} substeps {substeps}: y {:.3} e {e:.3} vx/v {:.3} low {:.4} voxels {:.2}, flattest {flat:.2}, limited {limited} slowed {slowed} inverted {inverted} quarantined {quarantined}", D::N, x.to_vec3().y, v.to_vec3().x / speed, low, low / (width / n as f32));
        }
    }
    Ok(())
}

fn main() -> Result<(), Error> {
    let which = std::env::args().nth(1).unwrap_or_default();
    let number = |k: usize, d: f32| std::env::args().nth(k).and_then(|s| s.parse().ok()).unwrap_or(d);
    match which.as_str() {
        "fall" => { fall::<Dim2>()?; fall::<Dim3>()?; }
        "impact2" => impact::<Dim2>(number(2, 64.0) as u32, number(3, 5000.0), number(4, 0.08))?,
        _ => impact::<Dim3>(number(2, 64.0) as u32, number(3, 5000.0), number(4, 0.08))?,
    }
    Ok(())
}

use fuwafuwa::*;
fn main() {
    let mut world = World::<Dim2>::new(Settings::default()).unwrap();
    world
        .add_obstacle(Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]), 0.5)
        .unwrap();
    world.add_body(
        Body::new(VoxelGrid::ball(24, 1.0).unwrap(), &[Material::default()])
            .unwrap()
            .moved([5.0, 0.0, 0.0]),
    );
    world
        .add_manipulator(Manipulator::new([5.5, 1.1, 0.0], 0.08).driven(Drive::Kinematic))
        .unwrap();
    for tick in 0..60u16 {
        world.set_goal(0, [5.5, 1.1 - 0.03 * f32::from(tick), 0.0]);
        let r = world.step();
        let body = &world.bodies()[0];
        let mut worst = (0.0, 0, 0, 0, [0.0; 4], 0.0);
        for (id, e) in body.mesh().elements() {
            let places: Vec<[f32; 3]> = e.nodes.iter().map(|&n| body.node_state(n).0).collect();
            for axis in 0..2 {
                let low = places.iter().map(|at| at[axis]).fold(f32::MAX, f32::min);
                let high = places.iter().map(|at| at[axis]).fold(f32::MIN, f32::max);
                let s = (high - low) / (e.cell.width() as f32 / 24.0);
                if s > worst.0 {
                    worst = (
                        s,
                        id,
                        e.cell.level,
                        e.nodes.len(),
                        [places[0][0], places[0][1], places[1][0], places[1][1]],
                        body.node_state(e.nodes[0]).2,
                    );
                }
            }
        }
        println!("{tick} {r:?} {worst:?} pieces {}", body.piece_views().len());
    }
}

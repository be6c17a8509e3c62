//! The same bits on one to eight threads.

use fuwafuwa::{Body, Dim3, Manipulator, Material, Settings, Shape, VoxelGrid, World};

/// A ball large enough for several threads, pushed and torn.
fn hash_on(threads: usize) -> u64 {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build().unwrap().install(|| {
        let mut world = World::<Dim3>::new(Settings::default()).unwrap();
        let floor = Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]);
        world.add_obstacle(floor, 0.4).unwrap();
        let ball = VoxelGrid::ball(28, 1.0).unwrap();
        world.add_body(Body::new(ball, &[Material::default()]).unwrap());
        let hand = Manipulator::new([0.5, 1.2, 0.5], 0.1);
        world.add_manipulator(hand).unwrap();
        for tick in 0..30u8 {
            world.set_goal(0, [0.5, 1.2 - 0.025 * f32::from(tick), 0.5]);
            world.step();
        }
        world.hash()
    })
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let alone = hash_on(1);
    for threads in [2, 3, 4, 8] {
        assert_eq!(hash_on(threads), alone, "{threads} threads");
    }
}

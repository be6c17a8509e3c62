//! The same bits in debug and in release.
//!
//! A changed hash is a changed simulation: say why in the commit.

use fuwafuwa::{Body, Dim, Dim2, Dim3, Material, VoxelGrid};

/// A ball that is squashed, let go, cut while it swings and followed for half a second.
fn hash_of_a_cut_ball<D: Dim>(n: i32) -> u64 {
    let grid = VoxelGrid::<D>::ball(n as usize, 1.0).unwrap();
    let mut body = Body::new(grid, &[Material::default()]).unwrap();
    let nodes: Vec<u32> = body.mesh().nodes().map(|(id, _)| id).collect();
    for id in nodes {
        let (x, _, _) = body.node_state(id);
        body.set_node_state(id, [x[0] * 1.2, x[1] * 0.75, x[2]], [x[1], -x[0], 0.0]);
    }
    for step in 0..480 {
        if step % 16 == 0 {
            let depth = step / 16;
            let at = [n / 2, depth % n, if D::N == 3 { n / 2 } else { 0 }];
            body.release(&[(at, 0b1010_1010)]).unwrap();
        }
        body.advance(1.0 / 960.0, [0.0, -9.81, 0.0]);
    }
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    for (id, _) in body.mesh().nodes() {
        let (position, velocity, _) = body.node_state(id);
        for value in position.iter().chain(&velocity) {
            assert!(value.is_finite());
            hash = (hash ^ u64::from(value.to_bits())).wrapping_mul(0x0100_0000_01b3);
        }
    }
    hash
}

#[test]
fn golden_hashes() {
    let found = [
        hash_of_a_cut_ball::<Dim2>(32),
        hash_of_a_cut_ball::<Dim3>(16),
    ];
    let golden = [0xd080_94ca_50fe_0cde, 0x4f86_1f57_3d6c_13e7];
    assert_eq!(found, golden, "{found:#x?}");
}

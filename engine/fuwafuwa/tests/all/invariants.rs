//! Invariants of the mesh that hold for every shape and every sequence of cuts.
#![allow(clippy::needless_range_loop)] // an axis indexes several vectors at once

use fuwafuwa::Grading;
use fuwafuwa::Law;
use fuwafuwa::inspect::CellHierarchy;
use fuwafuwa::inspect::Connectivity;
use fuwafuwa::inspect::Mesh;
use fuwafuwa::inspect::Remodelled;
use fuwafuwa::inspect::{Elasticity, forces};
use fuwafuwa::inspect::{neighbourhood, points_in};
use fuwafuwa::{Dim, Dim2, Dim3, Point, VoxelGrid};
use glam::DVec3;

/// Small reproducible random number generator (xorshift64*).
struct Random(u64);

impl Random {
    fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    fn below(&mut self, bound: i32) -> i32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) as i32 % bound
    }
}

/// Returns a union of balls and boxes minus one ball, of one or two materials; `None` if no voxel is solid.
fn random_shape<D: Dim>(random: &mut Random, n: i32) -> Option<VoxelGrid<D>> {
    let parts: Vec<([i32; 3], i32, bool)> = (0..4)
        .map(|_| {
            let at = [random.below(n), random.below(n), random.below(n)];
            (at, n / 6 + random.below(n / 3), random.below(2) == 0)
        })
        .collect();
    let inside = |part: &([i32; 3], i32, bool), at: Point| {
        let away = (0..D::N).map(|axis| (at[axis] - part.0[axis]).abs());
        if part.2 {
            away.max().is_some_and(|distance| distance < part.1)
        } else {
            away.map(|k| k * k).sum::<i32>() < part.1 * part.1
        }
    };
    let two_materials = random.below(3) == 0;
    let extent = n as usize;
    let size = [extent, extent, D::depth(extent)];
    VoxelGrid::from_fn(size, 1.0, |at| {
        let solid = parts[..3].iter().any(|part| inside(part, at)) && !inside(&parts[3], at);
        u8::from(solid) * (1 + u8::from(two_materials && at[0] > n / 2))
    })
    .ok()
}

/// Splits the connections between voxels at a few random lattice points or in a whole rectangle of points, as
/// a crack or a knife would.
fn random_cut<D: Dim>(sharing: &mut Connectivity<D>, random: &mut Random, n: i32) -> Vec<Point> {
    let axis = random.below(D::N as i32) as usize;
    let side = (0..D::CORNERS).fold(0u8, |mask, octant| {
        mask | ((octant >> axis & 1) as u8) << octant
    });
    let (mut low, mut high) = ([0; 3], [0; 3]);
    let reach = if random.below(2) == 0 { 1 } else { n };
    for k in 0..D::N {
        low[k] = random.below(n + 1);
        high[k] = (low[k] + random.below(reach)).min(n);
    }
    high[axis] = low[axis];
    let mut touched = Vec::new();
    for at in points_in(low, high) {
        if sharing.release(at, side) {
            touched.push(at);
        }
    }
    let around = touched
        .iter()
        .flat_map(|&at| neighbourhood::<D>(at, 1))
        .collect();
    touched.extend(sharing.normalise(around));
    touched
}

/// Runs `check_one_sequence` for the seeds `0..sequences` on several threads. The width of the body in voxels
/// cycles through `sizes`.
fn check_remodelling<D: Dim>(sequences: u64, sizes: std::ops::Range<i32>) {
    let threads = 4;
    let sizes = &sizes;
    std::thread::scope(|scope| {
        for thread in 0..threads {
            scope.spawn(move || {
                for seed in (thread..sequences).step_by(threads as usize) {
                    let n = sizes.start + seed as i32 % (sizes.end - sizes.start);
                    check_one_sequence::<D>(seed, n);
                }
            });
        }
    });
}

/// Cuts a random shape several times. The remodelled mesh must equal a mesh newly graded from the cut shape.
fn check_one_sequence<D: Dim>(seed: u64, n: i32) {
    let mut random = Random::new(seed + 1);
    let Some(grid) = random_shape::<D>(&mut random, n) else {
        return;
    };
    let mut sharing = Connectivity::new(&grid);
    let mut pyramid = CellHierarchy::new(&grid, &sharing, Grading::Graded);
    let mut mesh = Mesh::grade(&grid, &sharing, &pyramid).unwrap();
    for _ in 0..1 + random.below(5) {
        let touched = random_cut(&mut sharing, &mut random, n);
        let around = touched.iter().flat_map(|&at| neighbourhood::<D>(at, 1));
        let born = pyramid.refine(&grid, &sharing, around);
        let before = mesh.clone();
        let remodelled = mesh
            .remodel(&grid, &sharing, &pyramid, &touched, &born)
            .unwrap_or_else(|defect| panic!("seed {seed}: {defect}"));
        assert_affine_motion_is_inherited(&before, &mesh, &remodelled, seed);
        mesh.validate(&grid, &sharing)
            .unwrap_or_else(|defect| panic!("seed {seed}: {defect}"));
    }
    assert_eq!(
        pyramid,
        CellHierarchy::new(&grid, &sharing, Grading::Graded),
        "seed {seed}"
    );
    let scratch = Mesh::grade(&grid, &sharing, &pyramid).unwrap();
    assert!(
        mesh.is_same_as(&scratch),
        "seed {seed}: remodelled and graded meshes differ"
    );
    assert_uniform_strain_leaves_inner_nodes_at_rest(&mesh, &sharing, seed);
}

/// Checks the weights by which new nodes inherit positions: they reproduce the rest position of each new
/// node, and thus any affine motion.
fn assert_affine_motion_is_inherited<D: Dim>(
    before: &Mesh<D>,
    after: &Mesh<D>,
    remodelled: &Remodelled,
    seed: u64,
) {
    for new in &remodelled.inherited {
        let (at, from) = (after.node(new.node).at, remodelled.from(new));
        for axis in 0..D::N {
            let inherited: f64 = from
                .iter()
                .map(|&(old, weight)| weight * f64::from(before.node(old).at[axis]))
                .sum();
            assert!(
                (inherited - f64::from(at[axis])).abs() < 1e-9,
                "seed {seed}: {at:?}"
            );
        }
    }
}

/// Patch test: under uniform strain, the default law must leave inner nodes without force. The residual is
/// relative to the product of stress and the area of a voxel's face.
fn assert_uniform_strain_leaves_inner_nodes_at_rest<D: Dim>(
    mesh: &Mesh<D>,
    sharing: &Connectivity<D>,
    seed: u64,
) {
    let elasticity = Elasticity::new(1000.0, 0.3).unwrap();
    let strain = [[1.12, 0.07, 0.0], [-0.21, 0.91, 0.05], [0.0, 0.11, 1.04]];
    let deformed = |at: Point| {
        let mut x = DVec3::ZERO;
        for i in 0..D::N {
            x[i] = (0..D::N).map(|j| strain[i][j] * f64::from(at[j])).sum();
        }
        x
    };
    let mut sums = vec![[0.0; 3]; mesh.node_capacity()];
    for (_, element) in mesh.elements() {
        let positions: Vec<_> = element
            .nodes
            .iter()
            .map(|&node| deformed(mesh.node(node).at))
            .collect();
        let size = f64::from(element.cell.width());
        let all = forces(
            Law::CorotationalVem,
            elasticity.into(),
            mesh.element_class(element),
            size,
            &positions,
        );
        for (&node, force) in element.nodes.iter().zip(all) {
            for axis in 0..3 {
                sums[node.index()][axis] += force[axis];
            }
        }
    }
    let stress = 0.2 * elasticity.young;
    for (id, node) in mesh.nodes() {
        let sum = sums[id.index()];
        let inner = node.group == D::ALL_CORNERS && !sharing.is_open(node.at);
        let residual = sum.iter().fold(0.0f64, |most, k| most.max(k.abs())) / stress;
        assert!(
            !inner || residual < 1e-9,
            "seed {seed}: {residual} at {:?}",
            node.at
        );
    }
}

#[test]
fn remodelling_equals_grading_from_scratch_in_2d() {
    check_remodelling::<Dim2>(10_000, 6..20);
}

#[test]
fn remodelling_equals_grading_from_scratch_in_3d() {
    check_remodelling::<Dim3>(10_000, 6..11);
}

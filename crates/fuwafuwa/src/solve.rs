//! The forces of all elements, eight of one class at a time.
//!
//! Elements of one class and material stand side by side in the lanes of a block. Each lane does
//! the operations of the scalar formula in the scalar order and nothing is summed across lanes: the
//! width of the machine's vectors cannot change a bit. The tests hold the forces against [`crate::law`]. An element writes to its own slots, and a node adds up
//! its slots in the order of the octants around it: neither thread nor numbering can change a bit.
//!
//! With x relative to the first node, unit stencil (b, r, w, V) and half size h, the formulas of
//! [`crate::law`] become
//!
//! ```text
//! F = Σ x bᵀ / (V h)     G = Σ x (w r)ᵀ     c = Σ w x / V     W = Σ w r rᵀ
//! A = (k / V) (G − h F W) − h^(d−1) P       B = k h F
//! f = A b + B (w r) − k w (x − c)
//! ```

use crate::dim::Dim;
use crate::grid::VoxelGrid;
use crate::law::{Elasticity, Law, SQUASH_LIMIT};
use crate::mesh::{Element, Mesh};
use crate::stencil::Stencil;
use std::collections::BTreeMap;
use std::marker::PhantomData;
use std::ops::{Add, Div, Mul, Sub};

/// Three coordinates and a pad, so that a row is one aligned load; in 2D the third is 0.
pub type Row = [f32; 4];

/// Elements in a block.
pub const LANES: usize = 8;

const VACANT: u32 = u32::MAX;

/// Places of the forces on a node: one an element, eight at most, in the order of the octants.
#[derive(Copy, Clone, Debug, Default)]
struct Slots {
    places: [u32; 8],
    count: u8,
}

/// One number for each element of a block.
#[derive(Copy, Clone)]
struct Lane([f32; LANES]);

/// All elements of a body in blocks, with the forces they put on their nodes.
#[derive(Clone, Debug)]
pub struct Blocks<D: Dim> {
    law: Law,
    elasticities: Vec<Elasticity>,
    voxel_size: f32,
    blocks: Vec<Block>,
    classes: BTreeMap<(u8, u32), Class>,
    constants: Vec<Constants>,
    /// Block and lane of each element, by id; the block is [`VACANT`] while it has none.
    seats: Vec<(u32, u8)>,
    /// Where the forces on each node stand: places in `forces`, by id.
    slots: Vec<Slots>,
    forces: Vec<Row>,
    dim: PhantomData<D>,
}

#[derive(Clone, Debug)]
struct Block {
    constants: u32,
    elasticity: Elasticity,
    elements: [u32; LANES],
    half_size: [f32; LANES],
    rotation: [[f32; LANES]; 4],
    /// The nodes of each lane: node k of lane l at k · LANES + l, and its force at `first_slot` on.
    nodes: Vec<u32>,
    first_slot: u32,
}

/// The blocks of one class and material, some with vacant lanes.
#[derive(Clone, Debug)]
struct Class {
    constants: u32,
    open: Vec<u32>,
}

/// A stencil in single precision.
#[derive(Clone, Debug)]
struct Constants {
    /// b, w r and w of each node.
    nodes: Vec<([f32; 3], [f32; 3], f32)>,
    /// W, by rows.
    spread: [[f32; 3]; 3],
    /// 1 / V.
    inverse_volume: f32,
    /// Of [`Law::Endo2004`]: the stiffness over Y h^(d−2).
    stiffness: f32,
}

impl<D: Dim> Blocks<D> {
    /// No elements yet. `elasticities[number - 1]` belongs to material `number`; `voxel_size` [m].
    pub fn new(law: Law, elasticities: Vec<Elasticity>, voxel_size: f32) -> Self {
        Self {
            law,
            elasticities,
            voxel_size,
            blocks: Vec::new(),
            classes: BTreeMap::new(),
            constants: Vec::new(),
            seats: Vec::new(),
            slots: Vec::new(),
            forces: Vec::new(),
            dim: PhantomData,
        }
    }

    /// Follows a remodelling: takes out `removed` elements and puts in, or in other blocks, those
    /// that were `seated`. Costs by what changed.
    pub fn update(&mut self, mesh: &Mesh<D>, grid: &VoxelGrid<D>, removed: &[u32], seated: &[u32]) {
        let rotations: Vec<[f32; 4]> = seated.iter().map(|&id| self.rotation_of(id)).collect();
        for &id in removed.iter().chain(seated) {
            self.take_out(id);
        }
        let mut touched = Vec::new();
        for (&id, rotation) in seated.iter().zip(rotations) {
            let element = mesh.element(id).expect("seated elements are alive");
            let material = grid.material(mesh.first_voxel(element));
            self.put_in(id, element, mesh.stencil(element), material, rotation);
            touched.extend_from_slice(&element.nodes);
        }
        touched.sort_unstable();
        touched.dedup();
        self.slots.resize(mesh.node_capacity(), Slots::default());
        for node in touched {
            let mut slots = Slots::default();
            for id in mesh.carrier_ids(node) {
                slots.places[slots.count as usize] = self.slot(id, node);
                slots.count += 1;
            }
            self.slots[node as usize] = slots;
        }
    }

    /// Computes the forces of all elements at the given node positions [m].
    pub fn evaluate(&mut self, position: &[Row]) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the machine has AVX2; the function is safe code otherwise.
            #[allow(unsafe_code)]
            unsafe {
                self.evaluate_avx2(position);
            }
            return;
        }
        self.evaluate_in::<false>(position);
    }

    /// As [`Blocks::evaluate`], compiled for wider vectors: the same operations, the same bits.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn evaluate_avx2(&mut self, position: &[Row]) {
        self.evaluate_in::<true>(position);
    }

    #[inline(always)]
    fn evaluate_in<const WIDE: bool>(&mut self, position: &[Row]) {
        for block in &mut self.blocks {
            let constants = &self.constants[block.constants as usize];
            let first = block.first_slot as usize;
            let forces = &mut self.forces[first..first + block.nodes.len()];
            evaluate::<D, WIDE>(self.law, constants, block, position, forces);
        }
    }

    /// The force [N] on a node, as of the last evaluation.
    #[inline]
    pub fn force_on(&self, node: u32) -> Row {
        let mut sum = [0.0; 4];
        let slots = &self.slots[node as usize];
        for &slot in &slots.places[..slots.count as usize] {
            for (total, part) in sum.iter_mut().zip(self.forces[slot as usize]) {
                *total += part;
            }
        }
        sum
    }

    fn rotation_of(&self, id: u32) -> [f32; 4] {
        match self.seats.get(id as usize) {
            Some(&(block, lane)) if block != VACANT => self.blocks[block as usize]
                .rotation
                .map(|part| part[lane as usize]),
            _ => [0.0, 0.0, 0.0, 1.0],
        }
    }

    /// The place of an element's force on a node.
    fn slot(&self, id: u32, node: u32) -> u32 {
        let (block, lane) = self.seats[id as usize];
        let block = &self.blocks[block as usize];
        let mut lane_nodes = block.nodes[lane as usize..].iter().step_by(LANES);
        let place = lane_nodes
            .position(|&other| other == node)
            .expect("the element carries the node");
        block.first_slot + (place * LANES) as u32 + u32::from(lane)
    }

    fn take_out(&mut self, id: u32) {
        let Some(&(index, lane)) = self.seats.get(id as usize) else {
            return;
        };
        if index == VACANT {
            return;
        }
        self.seats[id as usize] = (VACANT, 0);
        let block = &mut self.blocks[index as usize];
        block.elements[lane as usize] = VACANT;
        let mut classes = self.classes.values_mut();
        let class = classes.find(|class| class.constants == block.constants);
        let class = class.expect("every block belongs to a class");
        if !class.open.contains(&index) {
            class.open.push(index);
        }
    }

    fn put_in(
        &mut self,
        id: u32,
        element: &Element,
        stencil: &Stencil<D>,
        material: u8,
        rotation: [f32; 4],
    ) {
        let constants = &mut self.constants;
        let law = self.law;
        let class = self
            .classes
            .entry((material, element.stencil))
            .or_insert_with(|| {
                constants.push(Constants::new(law, stencil));
                Class {
                    constants: constants.len() as u32 - 1,
                    open: Vec::new(),
                }
            });
        let index = match class.open.last() {
            Some(&index) => index,
            None => {
                let index = self.blocks.len() as u32;
                let slots = element.nodes.len() * LANES;
                self.blocks.push(Block {
                    constants: class.constants,
                    elasticity: self.elasticities[material as usize - 1],
                    elements: [VACANT; LANES],
                    half_size: [self.voxel_size; LANES],
                    rotation: [[0.0; LANES], [0.0; LANES], [0.0; LANES], [1.0; LANES]],
                    nodes: vec![element.nodes[0]; slots],
                    first_slot: self.forces.len() as u32,
                });
                self.forces.resize(self.forces.len() + slots, [0.0; 4]);
                class.open.push(index);
                index
            }
        };
        let block = &mut self.blocks[index as usize];
        let lane = block
            .elements
            .iter()
            .position(|&other| other == VACANT)
            .expect("open blocks have a vacancy");
        block.elements[lane] = id;
        block.half_size[lane] = 0.5 * self.voxel_size * element.cell.width() as f32;
        for (place, &node) in element.nodes.iter().enumerate() {
            block.nodes[place * LANES + lane] = node;
        }
        for part in 0..4 {
            block.rotation[part][lane] = rotation[part];
        }
        if !block.elements.contains(&VACANT) {
            class.open.retain(|&other| other != index);
        }
        let seats = &mut self.seats;
        seats.resize(seats.len().max(id as usize + 1), (VACANT, 0));
        seats[id as usize] = (index, lane as u8);
    }
}

impl Constants {
    fn new<D: Dim>(law: Law, stencil: &Stencil<D>) -> Self {
        let count = stencil.slots.len();
        let mut mean = [0.0; 3];
        for offset in &stencil.offsets {
            for axis in 0..3 {
                mean[axis] += offset[axis] / count as f64;
            }
        }
        let centred = |k: usize| [0, 1, 2].map(|axis: usize| stencil.offsets[k][axis] - mean[axis]);
        let spread_of = |k: usize| centred(k).iter().map(|r| r * r).sum::<f64>();
        let total: f64 = (0..count).map(spread_of).sum();
        let single = |v: [f64; 3]| v.map(|component| component as f32);
        let node = |k: usize| match law {
            Law::PatchExact => {
                let w = stencil.volumes[k];
                (
                    single(stencil.gradients[k]),
                    single(stencil.offsets[k].map(|r| w * r)),
                    w as f32,
                )
            }
            Law::Endo2004 => (single(centred(k)), [0.0; 3], 1.0),
        };
        let mut spread = [[0.0f32; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                let terms = (0..count)
                    .map(|k| stencil.volumes[k] * stencil.offsets[k][i] * stencil.offsets[k][j]);
                spread[i][j] = terms.sum::<f64>() as f32;
            }
        }
        let volume = match law {
            Law::PatchExact => stencil.volume,
            Law::Endo2004 => count as f64,
        };
        Self {
            nodes: (0..count).map(node).collect(),
            spread,
            inverse_volume: (1.0 / volume) as f32,
            stiffness: (stencil.volume * D::N as f64 / total) as f32,
        }
    }
}

/// The forces of one block, all lanes at once; a vacant lane repeats what it held.
#[inline(always)]
fn evaluate<D: Dim, const WIDE: bool>(
    law: Law,
    constants: &Constants,
    block: &mut Block,
    position: &[Row],
    forces: &mut [Row],
) {
    let zero = Lane::splat(0.0);
    let half = Lane(block.half_size);
    let one = Lane::splat(1.0);
    let origin = gather::<D, WIDE>(position, block, 0);

    let mut gradient = [[zero; 3]; 3];
    let mut moment = [[zero; 3]; 3];
    let mut centre = [zero; 3];
    for (place, (b, wr, w)) in constants.nodes.iter().enumerate().skip(1) {
        let x = relative::<D, WIDE>(position, block, place, origin);
        for i in 0..D::N {
            for j in 0..D::N {
                gradient[i][j] = gradient[i][j] + x[i] * Lane::splat(b[j]);
                moment[i][j] = moment[i][j] + x[i] * Lane::splat(wr[j]);
            }
            centre[i] = centre[i] + x[i] * Lane::splat(*w);
        }
    }
    let inverse_volume = Lane::splat(constants.inverse_volume);
    let scale = inverse_volume / half;
    for i in 0..D::N {
        for j in 0..D::N {
            gradient[i][j] = gradient[i][j] * scale;
        }
        centre[i] = centre[i] * inverse_volume;
    }
    if D::N == 2 {
        gradient[2][2] = one;
    }

    let mut turned = [zero; 4];
    for part in 0..4 {
        turned[part] = Lane(block.rotation[part]);
    }
    // Two rounds keep up with a body that spins and is squashed at once; one lags.
    turned = turn::<D>(&gradient, turn::<D>(&gradient, turned));
    for part in 0..4 {
        block.rotation[part] = turned[part].0;
    }
    let rotation = matrix_of(turned);

    let size_power = if D::N == 2 { half } else { half * half };
    let size_rest = if D::N == 2 { one } else { half };
    let double_power = if D::N == 2 { one } else { half + half };
    let (mut pull, mut shear) = ([[zero; 3]; 3], [[zero; 3]; 3]);
    let stiffness;
    match law {
        Law::PatchExact => {
            let young = block.elasticity.young * D::HOURGLASS;
            stiffness = Lane::splat(young as f32) * double_power;
            let stress = stress::<D>(block.elasticity, &gradient, &rotation);
            for i in 0..D::N {
                for j in 0..D::N {
                    let mut bent = zero;
                    for k in 0..D::N {
                        bent = bent + gradient[i][k] * Lane::splat(constants.spread[k][j]);
                    }
                    let skew = moment[i][j] - half * bent;
                    pull[i][j] = stiffness * inverse_volume * skew - size_power * stress[i][j];
                    shear[i][j] = stiffness * half * gradient[i][j];
                }
            }
        }
        Law::Endo2004 => {
            let young = block.elasticity.young as f32;
            stiffness = Lane::splat(young * constants.stiffness) * size_rest;
            for i in 0..D::N {
                for j in 0..D::N {
                    pull[i][j] = stiffness * half * rotation[i][j];
                }
            }
        }
    }

    for (place, (b, wr, w)) in constants.nodes.iter().enumerate() {
        let x = if place == 0 {
            [zero; 3]
        } else {
            relative::<D, WIDE>(position, block, place, origin)
        };
        let mut all = [zero; 3];
        for i in 0..D::N {
            let mut force = stiffness * Lane::splat(*w) * (centre[i] - x[i]);
            for j in 0..D::N {
                force = force + pull[i][j] * Lane::splat(b[j]) + shear[i][j] * Lane::splat(wr[j]);
            }
            all[i] = force;
        }
        let target: &mut [Row; LANES] = (&mut forces[place * LANES..][..LANES])
            .try_into()
            .expect("a place has a force for every lane");
        #[cfg(target_arch = "x86_64")]
        if WIDE {
            avx::store(all, target);
            continue;
        }
        for lane in 0..LANES {
            target[lane] = [all[0].0[lane], all[1].0[lane], all[2].0[lane], 0.0];
        }
    }
}

/// The positions of one node of every lane.
#[inline(always)]
fn gather<D: Dim, const WIDE: bool>(position: &[Row], block: &Block, place: usize) -> [Lane; 3] {
    let nodes: &[u32; LANES] = block.nodes[place * LANES..][..LANES]
        .try_into()
        .expect("a place has a node for every lane");
    let rows = [
        &position[nodes[0] as usize],
        &position[nodes[1] as usize],
        &position[nodes[2] as usize],
        &position[nodes[3] as usize],
        &position[nodes[4] as usize],
        &position[nodes[5] as usize],
        &position[nodes[6] as usize],
        &position[nodes[7] as usize],
    ];
    #[cfg(target_arch = "x86_64")]
    if WIDE {
        return avx::columns(rows);
    }
    let mut columns = [Lane::splat(0.0); 3];
    for axis in 0..D::N {
        for lane in 0..LANES {
            columns[axis].0[lane] = rows[lane][axis];
        }
    }
    columns
}

/// As [`gather`], from `origin`.
#[inline(always)]
fn relative<D: Dim, const WIDE: bool>(
    position: &[Row],
    block: &Block,
    place: usize,
    origin: [Lane; 3],
) -> [Lane; 3] {
    let mut rows = gather::<D, WIDE>(position, block, place);
    for axis in 0..D::N {
        rows[axis] = rows[axis] - origin[axis];
    }
    rows
}

/// The minor of rows a, b and columns c, d.
#[inline(always)]
fn minor(f: &[[Lane; 3]; 3], a: usize, b: usize, c: usize, d: usize) -> Lane {
    f[a][c] * f[b][d] - f[a][d] * f[b][c]
}

/// Rows to columns and back in registers: what the compiler does through memory by itself.
///
/// Every function here needs AVX. They are reached with `WIDE` alone, which only
/// [`Blocks::evaluate_avx2`] sets, and that is called after the machine was asked for AVX2.
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
mod avx {
    use super::{LANES, Lane, Row};
    use std::arch::x86_64::*;

    /// The first three columns of eight rows.
    #[inline(always)]
    pub fn columns(rows: [&Row; LANES]) -> [Lane; 3] {
        // SAFETY: AVX is there (see the module); a row is four floats, read without alignment;
        // a Lane and a register are eight floats each.
        unsafe {
            let (a, b) = (pair(rows[0], rows[4]), pair(rows[1], rows[5]));
            let (c, d) = (pair(rows[2], rows[6]), pair(rows[3], rows[7]));
            let (ab, cd) = (_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d));
            let (ab_high, cd_high) = (_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d));
            [
                lane(_mm256_shuffle_ps::<0x44>(ab, cd)),
                lane(_mm256_shuffle_ps::<0xEE>(ab, cd)),
                lane(_mm256_shuffle_ps::<0x44>(ab_high, cd_high)),
            ]
        }
    }

    /// Three columns as eight rows, the fourth number 0.
    #[inline(always)]
    pub fn store(columns: [Lane; 3], rows: &mut [Row; LANES]) {
        // SAFETY: as in `columns`; each store fills one row.
        unsafe {
            let (x, y, z) = (
                register(columns[0]),
                register(columns[1]),
                register(columns[2]),
            );
            let zero = _mm256_setzero_ps();
            let (xy, xy_high) = (_mm256_unpacklo_ps(x, y), _mm256_unpackhi_ps(x, y));
            let (z, z_high) = (_mm256_unpacklo_ps(z, zero), _mm256_unpackhi_ps(z, zero));
            let pairs = [
                _mm256_shuffle_ps::<0x44>(xy, z),
                _mm256_shuffle_ps::<0xEE>(xy, z),
                _mm256_shuffle_ps::<0x44>(xy_high, z_high),
                _mm256_shuffle_ps::<0xEE>(xy_high, z_high),
            ];
            for lane in 0..LANES / 2 {
                _mm_storeu_ps(rows[lane].as_mut_ptr(), _mm256_castps256_ps128(pairs[lane]));
                let high = _mm256_extractf128_ps::<1>(pairs[lane]);
                _mm_storeu_ps(rows[lane + LANES / 2].as_mut_ptr(), high);
            }
        }
    }

    #[inline(always)]
    unsafe fn pair(low: &Row, high: &Row) -> __m256 {
        unsafe {
            let low = _mm256_castps128_ps256(_mm_loadu_ps(low.as_ptr()));
            _mm256_insertf128_ps::<1>(low, _mm_loadu_ps(high.as_ptr()))
        }
    }

    #[inline(always)]
    unsafe fn lane(register: __m256) -> Lane {
        unsafe { Lane(std::mem::transmute::<__m256, [f32; LANES]>(register)) }
    }

    #[inline(always)]
    unsafe fn register(lane: Lane) -> __m256 {
        unsafe { std::mem::transmute::<[f32; LANES], __m256>(lane.0) }
    }
}

/// One round towards the rotation of a deformation; see [`crate::law::rotation_of`].
#[inline(always)]
fn turn<D: Dim>(f: &[[Lane; 3]; 3], q: [Lane; 4]) -> [Lane; 4] {
    let zero = Lane::splat(0.0);
    let half = Lane::splat(0.5);
    if D::N == 2 {
        // (w, z) is the half angle of (cos, sin) ∝ (F₀₀ + F₁₁, F₁₀ − F₀₁), in closed form; the
        // quaternion then turns by twice that half angle. Where the sum vanishes, q stays.
        return turn_in_plane(f, q);
    }
    let r = matrix_of(q);
    let mut s = [[zero; 3]; 3];
    let mut norm = zero;
    for i in 0..3 {
        for j in 0..3 {
            s[i][j] = f[i][0] * r[j][0] + f[i][1] * r[j][1] + f[i][2] * r[j][2];
            norm = norm + f[i][j] * f[i][j];
        }
    }
    let t = (Lane::splat(3.0) * norm).sqrt() + Lane::splat(1e-6);
    let axial = [s[2][1] - s[1][2], s[0][2] - s[2][0], s[1][0] - s[0][1]];
    let (a, d, g) = (t - s[0][0], t - s[1][1], t - s[2][2]);
    let b = zero - half * (s[0][1] + s[1][0]);
    let c = zero - half * (s[0][2] + s[2][0]);
    let e = zero - half * (s[1][2] + s[2][1]);
    let (c00, c01, c02) = (d * g - e * e, c * e - b * g, b * e - c * d);
    let (c11, c12, c22) = (a * g - c * c, b * c - a * e, a * d - b * b);
    let k = half / (a * c00 + b * c01 + c * c02);
    let w = [
        k * (c00 * axial[0] + c01 * axial[1] + c02 * axial[2]),
        k * (c01 * axial[0] + c11 * axial[1] + c12 * axial[2]),
        k * (c02 * axial[0] + c12 * axial[1] + c22 * axial[2]),
    ];
    let [x, y, z, o] = q;
    normalised([
        x + w[0] * o + w[1] * z - w[2] * y,
        y + w[1] * o + w[2] * x - w[0] * z,
        z + w[2] * o + w[0] * y - w[1] * x,
        o - w[0] * x - w[1] * y - w[2] * z,
    ])
}

/// The exact rotation in the plane: no trigonometry, no rounds.
#[inline(always)]
fn turn_in_plane(f: &[[Lane; 3]; 3], q: [Lane; 4]) -> [Lane; 4] {
    let (a, b) = (f[0][0] + f[1][1], f[1][0] - f[0][1]);
    let length = (a * a + b * b).sqrt();
    let mut next = q;
    for lane in 0..LANES {
        let (a, b, length) = (a.0[lane], b.0[lane], length.0[lane]);
        if length > 1e-12 {
            // Half of the angle, from the side that does not cancel.
            let (z, w) = if a >= 0.0 {
                (b, length + a)
            } else {
                (length - a, b)
            };
            let scale = 1.0 / (z * z + w * w).sqrt();
            next[2].0[lane] = z * scale;
            next[3].0[lane] = w * scale;
        }
    }
    next
}

#[inline(always)]
fn normalised(q: [Lane; 4]) -> [Lane; 4] {
    let squared = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    let scale = Lane::splat(1.0) / squared.sqrt();
    [q[0] * scale, q[1] * scale, q[2] * scale, q[3] * scale]
}

#[inline(always)]
fn matrix_of(q: [Lane; 4]) -> [[Lane; 3]; 3] {
    let [x, y, z, w] = q;
    let (x2, y2, z2) = (x + x, y + y, z + z);
    let one = Lane::splat(1.0);
    [
        [one - (y * y2 + z * z2), x * y2 - w * z2, x * z2 + w * y2],
        [x * y2 + w * z2, one - (x * x2 + z * z2), y * z2 - w * x2],
        [x * z2 - w * y2, y * z2 + w * x2, one - (x * x2 + y * y2)],
    ]
}

/// First Piola–Kirchhoff stress [Pa]; see [`crate::law`].
#[inline(always)]
fn stress<D: Dim>(
    elasticity: Elasticity,
    f: &[[Lane; 3]; 3],
    r: &[[Lane; 3]; 3],
) -> [[Lane; 3]; 3] {
    let twice_shear = Lane::splat((2.0 * elasticity.shear_modulus()) as f32);
    let lame = Lane::splat(elasticity.lame() as f32);
    let mut stretch = Lane::splat(-3.0);
    for i in 0..3 {
        for j in 0..3 {
            stretch = stretch + f[i][j] * r[i][j];
        }
    }
    let pressure = lame * stretch - twice_shear;
    let cofactor = [
        [
            minor(f, 1, 2, 1, 2),
            minor(f, 1, 2, 2, 0),
            minor(f, 1, 2, 0, 1),
        ],
        [
            minor(f, 2, 0, 1, 2),
            minor(f, 2, 0, 2, 0),
            minor(f, 2, 0, 0, 1),
        ],
        [
            minor(f, 0, 1, 1, 2),
            minor(f, 0, 1, 2, 0),
            minor(f, 0, 1, 0, 1),
        ],
    ];
    let volume_ratio =
        f[0][0] * cofactor[0][0] + f[0][1] * cofactor[0][1] + f[0][2] * cofactor[0][2];
    let squash = (Lane::splat(SQUASH_LIMIT as f32) - volume_ratio).at_least_zero();
    let barrier = Lane::splat(elasticity.young as f32) * squash;
    let mut stress = [[Lane::splat(0.0); 3]; 3];
    for i in 0..D::N {
        for j in 0..D::N {
            stress[i][j] = twice_shear * f[i][j] + pressure * r[i][j] - barrier * cofactor[i][j];
        }
    }
    stress
}

impl Lane {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn sqrt(mut self) -> Self {
        for value in &mut self.0 {
            *value = value.sqrt();
        }
        self
    }

    #[inline(always)]
    fn at_least_zero(mut self) -> Self {
        for value in &mut self.0 {
            *value = if *value > 0.0 { *value } else { 0.0 };
        }
        self
    }
}

macro_rules! lane_operator {
    ($trait:ident, $method:ident, $operator:tt) => {
        impl $trait for Lane {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for lane in 0..LANES {
                    self.0[lane] $operator other.0[lane];
                }
                self
            }
        }
    };
}

lane_operator!(Add, add, +=);
lane_operator!(Sub, sub, -=);
lane_operator!(Mul, mul, *=);
lane_operator!(Div, div, /=);

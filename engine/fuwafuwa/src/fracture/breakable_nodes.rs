//! Nodes at which a crack can start or grow, and the possible cuts there.
//!
//! A *breakable node* is shared by several voxels at an open point, or at any point of a material in which cracks start
//! inside ([`StrengthCriterion::DruckerPrager`]). Closed faces connect these voxels. A
//! *cut* opens some of the closed faces across one axis, so that the voxels are divided into two sides.
//!
//! ```text
//!       A │ B      a cut opens the faces across x: side A and side B
//!     ────●────    the threshold and the possible cuts of a node change only when something is
//!       A │ B      released nearby, so they are cached until then
//! ```

use crate::foundation::dim::{Dim, FAR, Point, voxel_around};
use crate::foundation::ids::{Id, IndexVec, NodeId};
#[cfg(doc)]
use crate::fracture::strength::StrengthCriterion;
use crate::material::Material;
use crate::topology::connectivity::{Connectivity, PointNeighbourhood};
use crate::topology::grid::VoxelGrid;
use crate::topology::mesh::{Mesh, Node};
use std::collections::BTreeMap;
use std::ops::Range;

/// Node at which a crack can start or continue.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct BreakableNode {
    /// Mask of the octants that share the node.
    pub group: u8,
    /// Mask of the octants whose voxel, if a cut separated it alone from the node, would become a crumb or
    /// stay attached by a single face.
    pub crumbs: u8,
    /// Number of the weakest material around the node; 1 is the first material of the body.
    pub material: u8,
    /// Whether the node is a crack tip: some voxels that share it are separated by an open face.
    pub is_tip: bool,
    /// Whether the node lies inside the body, away from surfaces and cracks.
    pub is_inside: bool,
    /// Limit of the tension at the node [Pa]. At a smooth surface, the strength with its scatter: the limit of
    /// the mean tension. At a crack tip, toughness / √voxel size: a scale for the nodal tension, which is about
    /// as large when the crack begins to grow, and its limit under
    /// [`Law::Endo2004`](crate::Law::Endo2004).
    pub threshold: f32,
    /// Index of the node's list of cuts in the list of all patterns of closed faces.
    cuts: u32,
}

/// Division of the voxels that share a node into two sides, by opening faces across `axis`.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct NodeCut {
    /// Axis normal to the opened faces.
    pub axis: u8,
    /// Mask of the octants on the far side of the opened faces. The cut separates their voxels from those of
    /// all other octants.
    pub side: u8,
    /// Number of opened faces.
    pub faces: u8,
    /// Mask of the octants whose voxel would be alone on its side of the cut.
    pub single_voxel_octants: u8,
    /// Step by which the cut advances a crack, in lattice units: the mean direction from the node to the opened
    /// faces, (1, 0, 0) if these lie beyond the node along x. Zero if faces on both sides open.
    pub advance: [f32; 3],
}

/// For each axis, mask of the octants on the near side of a closed face normal to that axis.
type Closed = [u8; 3];

/// Breakable nodes of a body.
#[derive(Clone, Debug, Default)]
pub struct BreakableNodes {
    of_node: IndexVec<NodeId, Option<BreakableNode>>,
    /// Possible cuts for each pattern of closed faces that occurred so far.
    cuts: Vec<Vec<NodeCut>>,
    known: BTreeMap<Closed, u32>,
}

impl BreakableNodes {
    /// Returns the breakable nodes within a range of ids, ascending.
    pub fn among(&self, ids: Range<usize>) -> impl Iterator<Item = (NodeId, &BreakableNode)> {
        let end = ids.end.min(self.of_node.len());
        let first = ids.start.min(end);
        let all = self.of_node.as_slice()[first..end].iter().zip(first..);
        all.filter_map(|(node, id)| Some((NodeId::of(id), node.as_ref()?)))
    }

    /// Returns whether a node is a crack tip.
    pub fn is_tip(&self, id: NodeId) -> bool {
        let node = self.of_node.get(id.index());
        node.is_some_and(|node| node.is_some_and(|node| node.is_tip))
    }

    /// Returns all possible cuts at a breakable node.
    pub fn cuts(&self, node: &BreakableNode) -> &[NodeCut] {
        &self.cuts[node.cuts as usize]
    }

    /// Recomputes which of `nodes` are breakable, and their cuts. `nodes` must contain all nodes whose
    /// elements or connectivity may have changed.
    pub fn update<D: Dim>(
        &mut self,
        nodes: &[NodeId],
        grid: &VoxelGrid<D>,
        connectivity: &Connectivity<D>,
        mesh: &Mesh<D>,
        materials: &[Material],
    ) {
        self.of_node.resize(mesh.node_capacity(), None);
        let cracks_inside = materials.iter().any(Material::cracks_inside);
        for &id in nodes {
            let node = mesh.node(id);
            let several = node.group & node.group.wrapping_sub(1) != 0;
            self.of_node[id] = None;
            if several && mesh.is_alive(id) {
                let around = connectivity.around(node.at);
                let is_open = around.is_open();
                if is_open || cracks_inside {
                    let mut judged = self.judge(node, grid, &around, materials);
                    judged.is_inside = !is_open;
                    let material = &materials[judged.material as usize - 1];
                    self.of_node[id] = (is_open || material.cracks_inside()).then_some(judged);
                }
            }
        }
    }

    fn judge<D: Dim>(
        &mut self,
        node: Node,
        grid: &VoxelGrid<D>,
        around: &PointNeighbourhood<D>,
        materials: &[Material],
    ) -> BreakableNode {
        let Node { at, group } = node;
        // All faces between voxels of the group; below, the closed ones among them.
        let faces: Closed = [0, 1, 2].map(|axis| group & group >> (1 << axis) & !FAR[axis]);
        let mut closed = around.closed_faces();
        closed
            .iter_mut()
            .zip(faces)
            .for_each(|(closed, faces)| *closed &= faces);
        // At a crack tip, some voxels of the group share the node, but the face between them is open.
        let is_tip = closed != faces;
        let octants = (0..D::CORNERS).filter(|octant| group >> octant & 1 == 1);
        let numbers = octants.map(|octant| grid.material(voxel_around::<D>(at, octant)));
        let strength = |&number: &u8| materials[number as usize - 1].strength;
        let material = numbers
            .min_by(|a, b| strength(a).total_cmp(&strength(b)))
            .expect("a group has voxels");
        let weakest = &materials[material as usize - 1];
        let threshold = if is_tip {
            weakest.toughness / grid.voxel_size().sqrt()
        } else {
            weakest.strength * (1.0 + weakest.strength_scatter * chance(at))
        };
        let cuts = self.pattern::<D>(closed, group);
        let lone = self.cuts[cuts as usize]
            .iter()
            .fold(0, |lone, cut| lone | cut.single_voxel_octants);
        let crumbs = (0..D::CORNERS)
            .filter(|octant| lone >> octant & 1 == 1)
            .filter(|&octant| would_crumble(around, octant))
            .fold(0, |crumbs, octant| crumbs | 1 << octant);
        BreakableNode {
            group,
            crumbs,
            material,
            is_tip,
            is_inside: false,
            threshold,
            cuts,
        }
    }

    /// Returns the index in `cuts` of the possible cuts for a pattern of closed faces in a group.
    fn pattern<D: Dim>(&mut self, closed: Closed, group: u8) -> u32 {
        let all = &mut self.cuts;
        *self.known.entry(closed).or_insert_with(|| {
            all.push(cuts::<D>(closed, group).collect());
            all.len() as u32 - 1
        })
    }
}

/// Returns all cuts that divide the octants of `group` by opening all, half or a quarter of their closed
/// faces across one axis.
fn cuts<D: Dim>(closed: Closed, group: u8) -> impl Iterator<Item = NodeCut> {
    (0..D::N).flat_map(move |axis| {
        let others = 3usize.pow(D::N as u32 - 1);
        let mut known = [0u8; 9];
        (0..others).filter_map(move |choice| {
            let opened = closed[axis] & part_of::<D>(axis, choice);
            if opened == 0 || known[..choice].contains(&opened) {
                return None;
            }
            known[choice] = opened;
            let side = side_of::<D>(closed, axis, opened)?;
            let alone = |side: u8| if side.count_ones() == 1 { side } else { 0 };
            Some(NodeCut {
                axis: axis as u8,
                side,
                faces: opened.count_ones() as u8,
                single_voxel_octants: alone(side) | alone(group & !side),
                advance: advance::<D>(axis, opened),
            })
        })
    })
}

/// Returns the mean direction from a node to the faces across `axis` of some near octants, in lattice units.
fn advance<D: Dim>(axis: usize, opened: u8) -> [f32; 3] {
    let mut sum = [0.0; 3];
    for octant in (0..D::CORNERS).filter(|octant| opened >> octant & 1 == 1) {
        for other in (0..D::N).filter(|&other| other != axis) {
            sum[other] += if octant >> other & 1 == 1 { 1.0 } else { -1.0 };
        }
    }
    sum.map(|k| k / opened.count_ones() as f32)
}

/// Returns the mask of the octants that `choice` selects. Each ternary digit of `choice` stands for one axis
/// other than `axis`: 0 = both sides of that axis, 1 = near side, 2 = far side.
fn part_of<D: Dim>(axis: usize, mut choice: usize) -> u8 {
    let mut part = D::ALL_CORNERS;
    for other in (0..D::N).filter(|&other| other != axis) {
        part &= match choice % 3 {
            0 => u8::MAX,
            1 => !FAR[other],
            _ => FAR[other],
        };
        choice /= 3;
    }
    part
}

/// Returns the octants on the far side of the opened faces, with all octants that stay connected to them.
/// `opened` is the mask of the octants on the near side of these faces. Returns `None` if one of those stays
/// connected, because the cut then divides nothing.
fn side_of<D: Dim>(mut closed: Closed, axis: usize, opened: u8) -> Option<u8> {
    closed[axis] &= !opened;
    let near = opened;
    let mut side = opened << (1 << axis);
    loop {
        let mut grown = side;
        for (across, &faces) in closed.iter().enumerate().take(D::N) {
            let step = 1 << across;
            grown |= (side & faces) << step | (side >> step) & faces;
        }
        if grown & near != 0 {
            return None;
        }
        if grown == side {
            return Some(side);
        }
        side = grown;
    }
}

/// Returns whether the voxel of an octant would become a crumb or stay attached by a single face, if it were
/// separated at the point. This is so if at most one of its faces that do not touch the point is closed.
fn would_crumble<D: Dim>(around: &PointNeighbourhood<D>, octant: usize) -> bool {
    let is_held = |axis: &usize| around.is_far_face_closed(octant, *axis);
    (0..D::N).filter(is_held).count() <= 1
}

/// Returns a fixed pseudo-random number between 0 and 1 for a lattice point.
fn chance(at: Point) -> f32 {
    let mix = |hash: u64, k: i32| {
        let hash = (hash ^ u64::from(k as u32)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        hash ^ hash >> 29
    };
    let hash = at.iter().fold(0x5eed, |hash, &k| mix(hash, k));
    let hash = hash.wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 40;
    hash as f32 / (1u32 << 24) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::{Dim2, Dim3};
    use crate::soft_body::SoftBody;

    /// Checks that breakable nodes updated after random releases equal those of a search from scratch.
    fn check_upkeep<D: Dim>(n: usize) {
        let grid = VoxelGrid::<D>::ball(n, 1.0).expect("a ball is not empty");
        let mut body = SoftBody::new(grid, &[Material::default()]).expect("the material is valid");
        let mut seed = 5u32;
        let mut random = |below: i32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as i32 % below
        };
        for _ in 0..60 {
            let at = [0, 1, 2].map(|axis: usize| if axis < D::N { random(n as i32) } else { 0 });
            let side = random(254) as u8 + 1;
            body.release(&[(at, side)]);
        }
        let mut fresh = BreakableNodes::default();
        let nodes: Vec<NodeId> = body.mesh().nodes().map(|(id, _)| id).collect();
        let materials = body.materials();
        fresh.update(
            &nodes,
            body.grid(),
            body.connectivity(),
            body.mesh(),
            materials,
        );
        let listed = |breakable: &BreakableNodes| -> Vec<_> {
            let all = breakable.among(0..usize::MAX);
            all.map(|(id, node)| {
                let cuts = breakable.cuts(node).to_vec();
                (id, node.group, node.crumbs, node.threshold, cuts)
            })
            .collect()
        };
        assert_eq!(listed(body.breakable_nodes()), listed(&fresh));
        assert!(fresh.among(0..usize::MAX).any(|(_, node)| node.crumbs != 0));
    }

    #[test]
    fn breakable_nodes_match_fresh_search_after_releases() {
        check_upkeep::<Dim2>(24);
        check_upkeep::<Dim3>(10);
    }
}

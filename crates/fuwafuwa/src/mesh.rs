//! Nodes and elements: the graded mesh that follows from what is solid and what is connected.
//!
//! A node is a lattice point with one group of voxels there. It exists exactly when it is a corner
//! of some element's own cell, at a child that the element fills; an element carries every such
//! node in the closure of its children. Hanging nodes are true nodes of the bigger element.
//!
//! ```text
//!   ┌───┬─┬─┐     the level-1 element on the left carries five nodes: its four corners and the
//!   │   ├─┼─┤     middle of its right edge, which is a corner of its level-0 neighbours
//!   └───┴─┴─┘
//! ```

use crate::dim::{Dim, Point, add, corner, scale, voxel_around};
use crate::grid::VoxelGrid;
use crate::pyramid::{Cell, Pyramid, parts};
use crate::sharing::Sharing;
use crate::stencil::{MissingCorner, Stencil, cell_corners, closure, slot_at};
use std::collections::BTreeMap;
use std::fmt;

/// An elastic unit on a cell or on a face-connected part of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// Where it sits.
    pub cell: Cell,
    /// Its class: an index into [`Mesh::stencils`].
    pub stencil: u32,
    /// Its nodes, in the order of the stencil's slots.
    pub nodes: Vec<u32>,
}

/// A mass point: a lattice point and the octants of the group that shares it.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Node {
    /// Lattice point at rest.
    pub at: Point,
    /// The voxels around the point that share this node, as a mask of octants.
    pub group: u8,
}

/// The elements of one body and the nodes they share.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh<D: Dim> {
    /// All elements, by level, cell and part.
    pub elements: Vec<Element>,
    /// All nodes, in the order in which the elements first use them.
    pub nodes: Vec<Node>,
    /// The classes in use.
    pub stencils: Vec<Stencil<D>>,
}

/// A broken invariant of a mesh: what, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Defect(String);

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Defect {}

impl From<MissingCorner> for Defect {
    fn from(missing: MissingCorner) -> Self {
        Self(missing.to_string())
    }
}

impl<D: Dim> Mesh<D> {
    /// Places the elements of a body from scratch.
    ///
    /// # Errors
    /// A [`Defect`] when the pyramid does not belong to this grid and sharing.
    pub fn grade(
        grid: &VoxelGrid<D>,
        sharing: &Sharing<D>,
        pyramid: &Pyramid<D>,
    ) -> Result<Self, Defect> {
        let mut builder = Builder {
            classes: BTreeMap::new(),
            node_ids: BTreeMap::new(),
            mesh: Self {
                elements: Vec::new(),
                nodes: Vec::new(),
                stencils: Vec::new(),
            },
        };
        for level in 0..pyramid.level_count() as u8 {
            for cell in pyramid.cells(level) {
                for children in parts::<D>(pyramid.filled(grid, cell)) {
                    builder.place(sharing, pyramid, cell, children)?;
                }
            }
        }
        Ok(builder.mesh)
    }

    /// Number of elements on each level, finest first.
    pub fn elements_per_level(&self) -> Vec<usize> {
        let top = self.elements.iter().map(|element| element.cell.level).max();
        let mut counts = vec![0; top.map_or(0, |level| level as usize + 1)];
        for element in &self.elements {
            counts[element.cell.level as usize] += 1;
        }
        counts
    }

    /// Number of vertices when each element counts its own, as the paper does in §3.1.
    pub fn independent_vertex_count(&self) -> usize {
        self.elements
            .iter()
            .map(|element| element.nodes.len())
            .sum()
    }

    /// The stencil of an element.
    pub fn stencil(&self, element: &Element) -> &Stencil<D> {
        &self.stencils[element.stencil as usize]
    }

    /// Checks that every solid voxel is owned once, that neighbours differ by at most one level,
    /// that no coarse element meets a split point, and that gradients balance at inner nodes.
    ///
    /// # Errors
    /// The first [`Defect`] found.
    pub fn validate(&self, grid: &VoxelGrid<D>, sharing: &Sharing<D>) -> Result<(), Defect> {
        let levels = self.check_ownership(grid)?;
        check_grading(grid, &levels)?;
        self.check_split_points(sharing)?;
        self.check_gradients(sharing)
    }

    /// The level that owns each voxel; `u8::MAX` where there is none.
    fn check_ownership(&self, grid: &VoxelGrid<D>) -> Result<Vec<u8>, Defect> {
        let mut owners = vec![u8::MAX; grid.voxels().count()];
        for element in &self.elements {
            for voxel in self.voxels(element) {
                if !grid.is_solid(voxel) {
                    return Err(Defect(format!(
                        "{:?} fills the empty voxel {voxel:?}",
                        element.cell
                    )));
                }
                let owner = &mut owners[grid.index(voxel)];
                if *owner != u8::MAX {
                    return Err(Defect(format!("two elements own the voxel {voxel:?}")));
                }
                *owner = element.cell.level;
            }
        }
        let orphan = grid
            .voxels()
            .find(|&voxel| grid.is_solid(voxel) && owners[grid.index(voxel)] == u8::MAX);
        match orphan {
            Some(voxel) => Err(Defect(format!("no element owns the voxel {voxel:?}"))),
            None => Ok(owners),
        }
    }

    fn check_split_points(&self, sharing: &Sharing<D>) -> Result<(), Defect> {
        for element in self
            .elements
            .iter()
            .filter(|element| element.cell.level > 0)
        {
            for &node in &element.nodes {
                let at = self.nodes[node as usize].at;
                if sharing.groups(at).iter().count() > 1 {
                    return Err(Defect(format!(
                        "{:?} meets the split point {at:?}",
                        element.cell
                    )));
                }
            }
        }
        Ok(())
    }

    fn check_gradients(&self, sharing: &Sharing<D>) -> Result<(), Defect> {
        let mut sums = vec![[0.0; 3]; self.nodes.len()];
        for element in &self.elements {
            let stencil = self.stencil(element);
            let half = element.cell.width() as f64 * 0.5;
            let scale = (1..D::N).fold(1.0, |scale, _| scale * half);
            for (&node, gradient) in element.nodes.iter().zip(&stencil.gradients) {
                for axis in 0..3 {
                    sums[node as usize][axis] += gradient[axis] * scale;
                }
            }
        }
        for (node, sum) in self.nodes.iter().zip(&sums) {
            let inner = node.group == D::ALL_CORNERS && !sharing.is_front(node.at);
            if inner && sum.iter().any(|&component| component.abs() > 1e-9) {
                return Err(Defect(format!(
                    "gradients do not balance at {:?}: {sum:?}",
                    node.at
                )));
            }
        }
        Ok(())
    }

    /// The voxels that an element fills.
    pub fn voxels(&self, element: &Element) -> Vec<Point> {
        if element.cell.level == 0 {
            return vec![element.cell.at];
        }
        let children = self.stencil(element).children;
        let reach = element.cell.width() / 2 - 1;
        (0..D::CORNERS)
            .filter(|child| children >> child & 1 == 1)
            .flat_map(|child| {
                let low = element.cell.child(child).first_voxel();
                let mut high = low;
                high.iter_mut().take(D::N).for_each(|k| *k += reach);
                crate::dim::points_in(low, high)
            })
            .collect()
    }
}

struct Builder<D: Dim> {
    classes: BTreeMap<(u8, u32), u32>,
    node_ids: BTreeMap<Node, u32>,
    mesh: Mesh<D>,
}

impl<D: Dim> Builder<D> {
    /// Places the element that fills `children` of `cell`.
    fn place(
        &mut self,
        sharing: &Sharing<D>,
        pyramid: &Pyramid<D>,
        cell: Cell,
        children: u8,
    ) -> Result<(), Defect> {
        let whole = cell.level == 0;
        let candidates = if whole {
            cell_corners::<D>()
        } else {
            closure::<D>(children)
        };
        let mut slots = 0u32;
        let mut nodes = Vec::new();
        for slot in (0..D::SLOTS).filter(|slot| candidates >> slot & 1 == 1) {
            let (at, octant) = seat::<D>(cell, children, slot);
            let node = Node {
                at,
                group: sharing.groups(at).group_of(octant),
            };
            if whole || is_node(pyramid, node) {
                slots |= 1 << slot;
                nodes.push(self.node_id(node));
            }
        }
        let next = self.classes.len() as u32;
        let stencil = match self.classes.get(&(children, slots)) {
            Some(&class) => class,
            None => {
                self.mesh.stencils.push(Stencil::new(children, slots)?);
                self.classes.insert((children, slots), next);
                next
            }
        };
        self.mesh.elements.push(Element {
            cell,
            stencil,
            nodes,
        });
        Ok(())
    }

    fn node_id(&mut self, node: Node) -> u32 {
        let next = self.mesh.nodes.len() as u32;
        *self.node_ids.entry(node).or_insert_with(|| {
            self.mesh.nodes.push(node);
            next
        })
    }
}

/// The lattice point of a slot, and an octant there that belongs to the element.
fn seat<D: Dim>(cell: Cell, children: u8, slot: usize) -> (Point, usize) {
    let steps = slot_at(slot);
    if cell.level == 0 {
        let at = add(cell.at, steps.map(|k| k / 2));
        let octant = (0..D::N).fold(0, |octant, axis| {
            octant | usize::from(steps[axis] == 0) << axis
        });
        return (at, octant);
    }
    let at = scale(add(scale(cell.at, 2), steps), cell.width() / 2);
    let touches = |&child: &usize| {
        let step = |axis: usize| steps[axis] - (child >> axis & 1) as i32;
        children >> child & 1 == 1 && (0..D::N).all(|axis| (0..=1).contains(&step(axis)))
    };
    let child = (0..D::CORNERS)
        .find(touches)
        .expect("the slot lies in the closure of the children");
    let low = corner(child);
    let octant = (0..D::N).fold(0, |octant, axis| {
        octant | usize::from(steps[axis] == low[axis]) << axis
    });
    (at, octant)
}

/// Whether a (point, group) is a corner of some owner's own cell.
fn is_node<D: Dim>(pyramid: &Pyramid<D>, node: Node) -> bool {
    (0..D::CORNERS)
        .filter(|octant| node.group >> octant & 1 == 1)
        .any(|octant| {
            let (owner, _) = pyramid.owner(voxel_around::<D>(node.at, octant));
            (0..D::N).all(|axis| node.at[axis] % owner.width() == 0)
        })
}

fn check_grading<D: Dim>(grid: &VoxelGrid<D>, levels: &[u8]) -> Result<(), Defect> {
    for voxel in grid.voxels().filter(|&voxel| grid.is_solid(voxel)) {
        let level = levels[grid.index(voxel)];
        for near in crate::dim::neighbourhood::<D>(voxel, 1).filter(|&near| grid.is_solid(near)) {
            if level.abs_diff(levels[grid.index(near)]) > 1 {
                return Err(Defect(format!(
                    "levels jump between {voxel:?} and {near:?}"
                )));
            }
        }
    }
    Ok(())
}

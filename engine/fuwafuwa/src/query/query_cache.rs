//! Search trees of a world, kept between queries.
//!
//! Each body has a tree over its exposed faces. Once a query requires it, the body also has a tree over its
//! filled cells, the cells that contain material. A tree over all objects stands above the trees of the
//! bodies. Before a query, the trees of changed bodies are updated. If faces or cells only moved, their boxes
//! are refitted; if some were added or removed, the tree is rebuilt. The trees are not part of the state of a
//! world: clones and loaded worlds start without trees.

use super::bounding_tree::{Tree, around_all, with_margin};
use crate::foundation::arena::{RigidBodyHandle, SoftBodyHandle};
use crate::foundation::dim::Dim;
use crate::foundation::ids::{ElementId, IndexVec, NodeId, PieceId};
use crate::rigid_body::solid::{Bounds, Solid};
use crate::soft_body::SoftBody;
use crate::soft_body::element_forces::Row;
use crate::soft_body::view::Facet;
use crate::topology::changes::Bookmark;
use crate::world::World;
use glam::Vec3;
use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Search trees of a world, shared by the queries that run at the same time.
#[derive(Default)]
pub struct QueryCache {
    trees: Mutex<Arc<QueryTrees>>,
}

/// The trees can be rebuilt from the world, so `Debug` omits them.
impl fmt::Debug for QueryCache {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("QueryCache").finish_non_exhaustive()
    }
}

/// A clone of a world starts without trees.
impl Clone for QueryCache {
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// Search trees over all objects of a world.
#[derive(Debug, Default)]
pub struct QueryTrees {
    /// Revision counters of the soft bodies and of the rigid bodies at the last update of the trees; `None`
    /// before the first update.
    revisions: Option<[u64; 2]>,
    /// Search trees of all soft bodies, ascending by body handle.
    pub bodies: Vec<BodyTrees>,
    /// All objects, in the order of [`ObjectRef`](crate::ObjectRef).
    pub objects: Vec<TreeObject>,
    /// Tree over the bounding boxes of the objects in `bounded`.
    pub tree: Tree,
    /// Indices in `objects` of all soft bodies and all rigid bodies with bounded shapes.
    pub bounded: Vec<u32>,
    /// Indices in `objects` of rigid bodies with unbounded shapes, the half-spaces.
    pub unbounded: Vec<u32>,
}

/// Object of a world: a soft body, by its index in [`QueryTrees::bodies`], or a rigid body.
#[derive(Copy, Clone, Debug)]
pub enum TreeObject {
    Soft(u32),
    Rigid(RigidBodyHandle),
}

/// Search trees of a soft body.
#[derive(Debug)]
pub struct BodyTrees {
    pub body: SoftBodyHandle,
    /// Topology of the body at the last update of the trees.
    /// Node positions at the last update of the trees [m].
    bookmark: Bookmark,
    positions: IndexVec<NodeId, Row>,
    /// Bounding box of all nodes [m].
    bounds: Bounds,
    /// Smooth surface, in the order of [`SoftBody::skin_facets`].
    pub surface: ListTree<Facet>,
    /// Filled cells, built by the first query that requires them.
    cells: OnceLock<ListTree<FilledCell>>,
    /// Whether a query has used `cells` since the last update. If not, the next update discards `cells`.
    uses_cells: AtomicBool,
}

/// Part of an element that contains material: a voxel for elements of level 0, otherwise one child cell.
#[derive(Copy, Clone, Debug)]
pub struct FilledCell {
    pub element: ElementId,
    pub piece: PieceId,
    /// Material number, counted from 1.
    pub material: u8,
    /// Index of the child within the cell of the element; 0 if the element is one voxel.
    child: u8,
    /// Corners [m], in the order of [`corner`](crate::foundation::dim::corner); only the first four in 2D.
    pub corners: [Vec3; 8],
}

/// List of items, and a search tree over their bounding boxes.
#[derive(Debug)]
pub struct ListTree<T> {
    pub items: Vec<T>,
    pub tree: Tree,
}

impl QueryCache {
    /// Returns the search trees, updated to the present state of `world`, which must own this cache.
    pub fn trees<D: Dim>(&self, world: &World<D>) -> Arc<QueryTrees> {
        let revisions = [world.bodies.revision(), world.rigids.revision()];
        let mut shared = self.trees.lock().unwrap_or_else(PoisonError::into_inner);
        if shared.revisions != Some(revisions) {
            match Arc::get_mut(&mut shared) {
                Some(trees) => trees.update(world, revisions),
                None => {
                    let mut trees = QueryTrees::default();
                    trees.update(world, revisions);
                    *shared = Arc::new(trees);
                }
            }
        }
        Arc::clone(&shared)
    }
}

impl QueryTrees {
    fn update<D: Dim>(&mut self, world: &World<D>, revisions: [u64; 2]) {
        let known = self.revisions.take();
        if known.is_none_or(|[soft, _]| soft != revisions[0]) {
            self.update_bodies(world);
        }
        self.objects.clear();
        self.bounded.clear();
        self.unbounded.clear();
        let mut boxes = Vec::new();
        for trees in &self.bodies {
            self.bounded.push(self.objects.len() as u32);
            boxes.push(trees.bounds);
            self.objects.push(TreeObject::Soft(boxes.len() as u32 - 1));
        }
        for (id, rigid) in world.rigids.entries() {
            let index = self.objects.len() as u32;
            match rigid.shape() {
                Solid::HalfSpace { .. } => self.unbounded.push(index),
                shape => {
                    self.bounded.push(index);
                    boxes.push(with_margin(shape.bounds()));
                }
            }
            self.objects.push(TreeObject::Rigid(id));
        }
        self.tree = Tree::new(&boxes);
        self.revisions = Some(revisions);
    }

    fn update_bodies<D: Dim>(&mut self, world: &World<D>) {
        let mut known = std::mem::take(&mut self.bodies).into_iter().peekable();
        for (id, body) in world.bodies.entries() {
            while known.next_if(|trees| trees.body < id).is_some() {}
            let trees = match known.next_if(|trees| trees.body == id) {
                Some(mut trees) => {
                    trees.update(body);
                    trees
                }
                None => BodyTrees::new(id, body),
            };
            self.bodies.push(trees);
        }
    }
}

impl BodyTrees {
    fn new<D: Dim>(id: SoftBodyHandle, body: &SoftBody<D>) -> Self {
        Self {
            body: id,
            bookmark: body.bookmark(),
            positions: body.positions().clone(),
            bounds: body_bounds(body),
            surface: ListTree::new(body.skin_facets().collect(), facet_bounds::<D>),
            cells: OnceLock::new(),
            uses_cells: AtomicBool::new(false),
        }
    }

    fn update<D: Dim>(&mut self, body: &SoftBody<D>) {
        let is_same =
            self.bookmark == body.bookmark() && self.positions.iter().eq(body.positions().iter());
        if is_same {
            return;
        }
        self.bookmark = body.bookmark();
        self.positions.clone_from(body.positions());
        self.bounds = body_bounds(body);
        let is_same = |a: &Facet, b: &Facet| a.element == b.element && a.nodes == b.nodes;
        let surface = &mut self.surface;
        surface.update(body.skin_facets().collect(), is_same, facet_bounds::<D>);
        let uses_cells = std::mem::take(self.uses_cells.get_mut());
        match self.cells.get_mut() {
            Some(cells) if uses_cells => {
                let is_same =
                    |a: &FilledCell, b: &FilledCell| (a.element, a.child) == (b.element, b.child);
                cells.update(filled_cells(body), is_same, cell_bounds::<D>);
            }
            _ => self.cells = OnceLock::new(),
        }
    }

    /// Returns the filled cells of the body.
    pub fn cells<D: Dim>(&self, body: &SoftBody<D>) -> &ListTree<FilledCell> {
        self.uses_cells.store(true, Ordering::Relaxed);
        { &self.cells }.get_or_init(|| ListTree::new(filled_cells(body), cell_bounds::<D>))
    }
}

impl<T> ListTree<T> {
    fn new(items: Vec<T>, bounds: impl Fn(&T) -> Bounds) -> Self {
        let boxes: Vec<Bounds> = items.iter().map(bounds).collect();
        Self {
            tree: Tree::new(&boxes),
            items,
        }
    }

    /// Replaces the items. The tree is refitted if `is_same` holds for each old and new item; otherwise it is
    /// rebuilt. It is also rebuilt if refitting would make it slow.
    fn update(
        &mut self,
        items: Vec<T>,
        is_same: impl Fn(&T, &T) -> bool,
        bounds: impl Fn(&T) -> Bounds,
    ) {
        let boxes: Vec<Bounds> = items.iter().map(bounds).collect();
        let are_same = items.len() == self.items.len() && { items.iter().zip(&self.items) }
            .all(|(new, old)| is_same(new, old));
        self.items = items;
        if !(are_same && self.tree.refit(&boxes)) {
            self.tree = Tree::new(&boxes);
        }
    }
}

fn facet_bounds<D: Dim>(facet: &Facet) -> Bounds {
    around_all(facet.corners.into_iter().take(D::CORNERS / 2))
}

fn cell_bounds<D: Dim>(cell: &FilledCell) -> Bounds {
    around_all(cell.corners.into_iter().take(D::CORNERS))
}

/// Returns the bounding box of all nodes of a body and of the smooth surface. Interior nodes are included, because they
/// can lie outside the surface where a body is strongly folded.
fn body_bounds<D: Dim>(body: &SoftBody<D>) -> Bounds {
    let nodes = body.mesh().nodes();
    around_all(nodes.flat_map(|(node, _)| [body.positions()[node].xyz(), body.skin_position(node)]))
}

/// Returns the filled cells of a body, in the order of the elements that contain them.
fn filled_cells<D: Dim>(body: &SoftBody<D>) -> Vec<FilledCell> {
    let mut cells = Vec::new();
    for view in body.element_views() {
        let count = if view.level == 0 { 1 } else { D::CORNERS };
        for child in (0..count).filter(|child| view.children >> child & 1 == 1) {
            let mut corners = [Vec3::ZERO; 8];
            corners[..D::CORNERS].copy_from_slice(&view.child_corners::<D>(child));
            cells.push(FilledCell {
                element: view.id,
                piece: view.piece,
                material: view.material,
                child: child as u8,
                corners,
            });
        }
    }
    cells
}

//! Pictures of bodies and worlds, by their elements or by their surface.

use crate::solid::Scene3d;
use crate::{Painter, PaperPoint, PaperTransform, Role};
use fuwafuwa::inspect::{faces, hands, obstacles, outline_slots};
use fuwafuwa::{
    Dim, Dim2, Dim3, ElementId, ElementView, Facet, NodeId, Outline, PieceId, Rotation, Shape,
    SoftBody, Vec2, Vec3, World,
};
use std::collections::{BTreeMap, BTreeSet};

/// Function that paints a 2D body.
pub type DrawPlane = fn(&mut Painter, PaperTransform, &SoftBody<Dim2>);
/// Function that paints a 3D body.
pub type DrawSpace = fn(&mut Scene3d, &SoftBody<Dim3>);

/// Number of line segments that approximate each round end of a capsule.
const ROUND: usize = 24;

/// Paints a 2D world; `draw` paints each body.
pub fn plane(painter: &mut Painter, frame: PaperTransform, world: &World<Dim2>, draw: DrawPlane) {
    for obstacle in obstacles(world) {
        rigid(painter, frame, obstacle.shape(), Role::Obstacle);
    }
    for (_, body) in world.soft_bodies() {
        draw(painter, frame, body);
    }
    for (_, hand) in hands(world) {
        if let Shape::Ball { centre, radius } = hand.shape() {
            let radius = radius * frame.unit + 1.5;
            painter.dot(frame.spot(centre), radius, Role::Ink);
        }
        rigid(painter, frame, hand.shape(), Role::Hand);
    }
}

/// Paints the elements of a 2D body, with torn edges in another colour.
pub fn plane_elements(painter: &mut Painter, frame: PaperTransform, body: &SoftBody<Dim2>) {
    plane_pieces(painter, frame, body, Role::Crack, |painter, view, _| {
        plane_element(painter, frame, view, 1.2);
    });
}

/// Paints the surface of a 2D body.
pub fn plane_skin(painter: &mut Painter, frame: PaperTransform, body: &SoftBody<Dim2>) {
    plane_pieces(
        painter,
        frame,
        body,
        Role::Ink,
        |painter, view, is_crumb| {
            let role = match view.material {
                1 if is_crumb => Role::Crumb,
                number => Role::Material(number),
            };
            // The outline has the colour of the element and closes the seams to its neighbours.
            painter.polygon(outline(frame, view), role, role, 1.0);
        },
    );
}

/// Paints the pieces of a body, the small ones on top. `draw` paints each element and receives whether it is
/// a crumb. Edges of cracks get the role `torn`.
fn plane_pieces(
    painter: &mut Painter,
    frame: PaperTransform,
    body: &SoftBody<Dim2>,
    torn: Role,
    draw: impl Fn(&mut Painter, &ElementView, bool),
) {
    let mut elements: BTreeMap<PieceId, Vec<ElementView>> = BTreeMap::new();
    for view in body.element_views() {
        elements.entry(view.piece).or_default().push(view);
    }
    let mut pieces: Vec<(PieceId, Vec<ElementView>)> = elements.into_iter().collect();
    pieces.sort_by_key(|(_, views)| std::cmp::Reverse(views.len()));
    let outlines = body.outlines();
    for (piece, views) in &pieces {
        for view in views {
            draw(painter, view, views.len() == 1);
        }
        for line in outlines.iter().filter(|line| line.piece == *piece) {
            plane_outline(painter, frame, line, torn);
        }
    }
}

fn plane_outline(painter: &mut Painter, frame: PaperTransform, line: &Outline, torn: Role) {
    let spots: Vec<PaperPoint> = line.points.iter().map(|&at| frame.spot(at)).collect();
    for (k, &is_torn) in line.is_torn.iter().enumerate() {
        let ends = vec![spots[k], spots[(k + 1) % spots.len()]];
        let (width, role) = match is_torn {
            true => (1.5, torn),
            false => (2.0, Role::Ink),
        };
        painter.line(ends, width, role);
    }
}

/// Paints a 2D element with an outline of a width [px].
pub fn plane_element(painter: &mut Painter, frame: PaperTransform, view: &ElementView, width: f32) {
    let role = Role::Level(view.level);
    painter.polygon(outline(frame, view), role, Role::Edge, width);
}

/// Returns the outline of an element on the paper.
pub fn outline(frame: PaperTransform, view: &ElementView) -> Vec<PaperPoint> {
    let ring = outline_slots(view.level, view.children).into_iter();
    ring.map(|slot| frame.spot(view.slots[slot])).collect()
}

/// Paints a 3D world; `draw` paints each body.
pub fn space(solid: &mut Scene3d, world: &World<Dim3>, draw: DrawSpace) {
    for obstacle in obstacles(world) {
        match obstacle.shape() {
            Shape::HalfSpace { normal, offset } if normal.y > 0.99 => solid.floor(offset),
            // Half-spaces other than a floor are not painted, because they would hide the bodies.
            Shape::HalfSpace { .. } => {}
            shape => solid_shape(solid, shape, Role::Obstacle),
        }
    }
    for (_, body) in world.soft_bodies() {
        draw(solid, body);
    }
    for (_, hand) in hands(world) {
        solid_shape(solid, hand.shape(), Role::Hand);
    }
}

/// Paints a bounded rigid shape.
fn solid_shape(solid: &mut Scene3d, shape: Shape<Dim3>, role: Role) {
    match shape {
        Shape::HalfSpace { .. } => {}
        Shape::Box { centre, half } => solid.block(centre, half, Rotation::NONE, role),
        Shape::OrientedBox {
            centre,
            half,
            rotation,
        } => solid.block(centre, half, rotation, role),
        Shape::Capsule { from, to, radius } => solid.bar([from, to], radius, role),
        Shape::Ball { centre, radius } => solid.ball(centre, radius, role),
    }
}

/// Paints the chosen elements of a 3D body.
pub fn space_elements(
    solid: &mut Scene3d,
    body: &SoftBody<Dim3>,
    is_chosen: impl Fn(&ElementView) -> bool,
) {
    for view in body.element_views().filter(|view| is_chosen(view)) {
        space_element(solid, &view);
    }
}

/// Paints the surface of a 3D body. Smooths the voxel staircase, but keeps the edges of cracks.
pub fn space_skin(solid: &mut Scene3d, body: &SoftBody<Dim3>) {
    let crumbs = crumbs(body);
    let inner: BTreeMap<ElementId, u8> = match body.materials() {
        [_] => BTreeMap::new(),
        _ => body
            .element_views()
            .map(|view| (view.id, view.material))
            .collect(),
    };
    let facets: Vec<Facet> = body.facets().collect();
    let places = smoothed(&facets);
    let corners = |facet: &Facet| facet.nodes.map(|node| places[&node]);
    let mut sums: BTreeMap<(NodeId, bool), Vec3> = BTreeMap::new();
    for facet in &facets {
        let [a, b, c, d] = corners(facet);
        let normal = (c - a).cross(d - b);
        for node in facet.nodes {
            *sums.entry((node, facet.is_torn)).or_default() += normal;
        }
    }
    for facet in &facets {
        let role = match facet.is_torn {
            _ if inner.get(&facet.element).is_some_and(|&number| number > 1) => {
                Role::Material(inner[&facet.element])
            }
            _ if crumbs.contains(&facet.piece) => Role::Crumb,
            true => Role::TornSurface,
            false => Role::Skin,
        };
        let normals = facet.nodes.map(|node| sums[&(node, facet.is_torn)]);
        solid.smooth_quad(corners(facet), normals, role);
    }
}

/// Smooths a surface: moves each node half-way to the mean of its neighbours, several times.
fn smoothed(facets: &[Facet]) -> BTreeMap<NodeId, Vec3> {
    const ROUNDS: usize = 4;
    let corners = facets
        .iter()
        .flat_map(|facet| facet.nodes.into_iter().zip(facet.corners));
    let mut places: BTreeMap<NodeId, Vec3> = corners.collect();
    for _ in 0..ROUNDS {
        let mut sums: BTreeMap<NodeId, (Vec3, f32)> = BTreeMap::new();
        for facet in facets {
            for k in 0..4 {
                let sum = sums.entry(facet.nodes[k]).or_insert((Vec3::ZERO, 0.0));
                sum.0 += places[&facet.nodes[(k + 1) % 4]];
                sum.1 += 1.0;
            }
        }
        for (node, place) in &mut places {
            let (sum, count) = sums[node];
            *place = *place * 0.5 + sum * (0.5 / count);
        }
    }
    places
}

/// Paints the faces of an element, and those of its edges at which two faces of different direction meet.
fn space_element(solid: &mut Scene3d, view: &ElementView) {
    let mut edges = BTreeSet::new();
    for face in faces::<Dim3>(view.level, view.children) {
        let corners = face.slots.map(|slot| view.slots[slot]);
        solid.quad(corners, Role::Level(view.level));
        for k in (0..4).filter(|&k| face.is_edge[k]) {
            let (a, b) = (face.slots[k], face.slots[(k + 1) % 4]);
            edges.insert((a.min(b), a.max(b)));
        }
    }
    for (a, b) in edges {
        solid.segment([view.slots[a], view.slots[b]], 1.1, Role::Edge);
    }
}

/// Returns the crumbs of a body: the pieces that consist of a single element.
fn crumbs<D: Dim>(body: &SoftBody<D>) -> BTreeSet<PieceId> {
    let views = body.piece_views().into_iter();
    views
        .filter(|view| view.element_count == 1)
        .map(|view| view.number)
        .collect()
}

/// Paints a rigid shape in 2D.
fn rigid(painter: &mut Painter, frame: PaperTransform, shape: Shape<Dim2>, role: Role) {
    let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(Vec2::from);
    let rim = match shape {
        Shape::Ball { centre, radius } => {
            return painter.dot(frame.spot(centre), radius * frame.unit, role);
        }
        Shape::HalfSpace { normal, offset } => {
            const FAR: f32 = 1e3;
            let deep = normal * -FAR;
            let [from, to] = [-FAR, FAR].map(|by| normal * offset + normal.perp() * by);
            vec![from, to, to + deep, from + deep]
        }
        Shape::Box { centre, half } => signs.map(|sign| centre + sign * half).to_vec(),
        Shape::OrientedBox {
            centre,
            half,
            rotation,
        } => {
            let corner = |sign: Vec2| centre + rotation.apply(sign * half);
            signs.map(corner).to_vec()
        }
        Shape::Capsule { from, to, radius } => {
            let along = (to - from).to_angle();
            let round = (0..=2 * ROUND).map(|k| {
                let (end, start) = if k <= ROUND { (to, 0) } else { (from, 1) };
                let turn = (k - start) as f32 / ROUND as f32 - 0.5;
                let angle = along + turn * std::f32::consts::PI;
                end + radius * Vec2::from_angle(angle)
            });
            round.collect()
        }
    };
    painter.area(rim.into_iter().map(|at| frame.spot(at)).collect(), role);
}

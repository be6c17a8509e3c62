//! Contact spheres that were forced into another piece, and how they get out.
//!
//! Inside a piece there are no contact spheres that could push anything out, so a crumb forced through a
//! stretched surface would stay there. Therefore, once per tick, sphere centres are tested against the
//! elements of pieces that have more elements than the sphere's own piece. A sphere with its centre in such
//! an element is an *embedded sphere*, and the piece of that element is its *host piece*. The sphere has no
//! contacts with its host piece, except for the *escape contact* with the nearest surface sphere of that
//! piece, the *exit*.

use super::bins::Bins;
use super::contact_sphere::{ContactSphere, SphereId};
use super::contact_spheres::Spheres;
use super::sphere_pair::SpherePair;
use crate::foundation::arena::BodySlot;
use crate::foundation::dim::Dim;
use crate::foundation::ids::{ElementId, IndexVec, PieceId};
use crate::math::lanes::on_widest_lanes;
use crate::soft_body::element_forces::Row;
use crate::soft_body::{SoftBodies, SoftBody};
use glam::Vec3;
use std::collections::BTreeMap;

/// Distance from an embedded sphere within which its exit, the nearest surface sphere of the host piece, is
/// searched in bins [voxels]. For the few spheres that are embedded deeper, all surface spheres of the host
/// piece are compared.
const EXIT_REACH: f32 = 2.0;

/// Sphere with its centre inside another piece.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct EmbeddedSphere {
    pub sphere: SphereId,
    /// Nearest surface sphere of the host piece.
    pub exit: SphereId,
}

/// Host piece of an embedded sphere: body and piece number.
type HostPiece = (BodySlot, PieceId);

/// Spheres embedded in other pieces.
#[derive(Clone, Debug, Default)]
pub struct EmbeddedSpheres {
    /// Embedded spheres, ascending.
    pub list: Vec<EmbeddedSphere>,
    /// Host piece of each sphere; `None` if the sphere is not embedded.
    host_pieces: IndexVec<SphereId, Option<HostPiece>>,
}

impl EmbeddedSpheres {
    /// Finds the spheres with their centre in a piece that has more elements than their own piece.
    pub fn find<D: Dim>(
        &mut self,
        spheres: &Spheres,
        pairs: &[SpherePair],
        bodies: &SoftBodies<D>,
    ) {
        self.list.clear();
        self.host_pieces.clear();
        self.host_pieces.resize(spheres.list.len(), None);
        if spheres.awake.is_empty() {
            return;
        }
        let mut pieces: Extents = bodies.slots().map(extents).collect();
        let largest = { pieces.iter().flatten() }.map(|piece| piece.count).max();
        let own = |pieces: &Extents, sphere: SphereId| {
            let sphere = &spheres.list[sphere];
            pieces[sphere.body][sphere.piece].count
        };
        let small = spheres.awake.iter().copied();
        let small: Vec<SphereId> = small
            .filter(|&sphere| Some(own(&pieces, sphere)) < largest)
            .collect();
        if small.is_empty() {
            return;
        }
        // First finds spheres inside surface elements. Such a sphere is close to the contact sphere of that
        // element, so testing the listed pairs is enough.
        for pair in pairs {
            let [a, b] = pair.both(&spheres.list);
            let [at, other] = pair.spheres.map(|sphere| spheres.centres[sphere]);
            let (apart, reach) = (at - other, a.radius + b.radius);
            if apart.dot(apart) > reach * reach {
                continue;
            }
            for (inner, outer, at) in [(0, b, at), (1, a, other)] {
                let sphere = pair.spheres[inner];
                let host_piece = (outer.body, outer.piece);
                let is_smaller = own(&pieces, sphere) < own(&pieces, pair.spheres[1 - inner]);
                let body = bodies.at(outer.body);
                let layers = bodies.at(spheres.list[sphere].body).layers();
                let may_be = is_smaller && layers.meet(body.layers());
                if may_be && body.holds(outer.element, at.xyz()) {
                    self.host_pieces[sphere] = Some(host_piece);
                }
            }
        }
        // Then finds spheres inside inner elements. A piece is skipped if its bounding box contains no sphere
        // of a smaller piece; this excludes most pieces.
        for (sphere, &centre) in spheres.list.iter().zip(&spheres.centres) {
            pieces[sphere.body][sphere.piece].extend(&centre);
        }
        let placed = |&sphere: &SphereId| (sphere, own(&pieces, sphere), spheres.centres[sphere]);
        let mut placed: Vec<(SphereId, u32, Row)> = small.iter().map(placed).collect();
        // Sorts the spheres along the first axis, so that the spheres within the width of a bounding box are
        // consecutive. Non-finite centres are removed, because no box contains them.
        placed.retain(|(.., centre)| centre[0].is_finite());
        placed.sort_unstable_by(|(.., a), (.., b)| a[0].total_cmp(&b[0]));
        let mut near: Vec<SphereId> = Vec::new();
        for piece in { pieces.iter_mut().flatten() }.filter(|piece| piece.has_inner) {
            piece.has_inner = false;
            let first = placed.partition_point(|(.., centre)| centre[0] < piece.low[0]);
            let within = |&&(.., centre): &&(SphereId, u32, Row)| centre[0] <= piece.high[0];
            for &(sphere, count, centre) in placed[first..].iter().take_while(within) {
                if count < piece.count && piece.encloses(centre) {
                    piece.has_inner = true;
                    near.push(sphere);
                }
            }
        }
        near.sort_unstable();
        near.dedup();
        let centres = near.iter().map(|&sphere| spheres.centres[sphere]);
        let centres: Vec<Row> = centres.collect();
        let inner = inner_elements(bodies, &pieces, &Extent::around(&centres));
        for same in inner.chunk_by(|a, b| a.level == b.level) {
            let bins = Bins::new::<D>(&centres, usual_radius(same));
            let mut inside = Vec::new();
            for inner in same {
                let (at, reach) = (inner.centre, inner.radius);
                on_widest_lanes!(simd => bins.near::<D, _>(simd, at, reach, |_| 0, &mut inside));
                for &at in &inside {
                    let number = bins.numbers()[at as usize] as usize;
                    let (sphere, at) = (near[number], centres[number].xyz());
                    let body = bodies.at(inner.host_piece.0);
                    let layers = bodies.at(spheres.list[sphere].body).layers();
                    let is_smaller = own(&pieces, sphere) < inner.count;
                    let may_be = is_smaller && layers.meet(body.layers());
                    if may_be && body.holds(inner.element, at) {
                        self.host_pieces[sphere] = Some(inner.host_piece);
                    }
                }
            }
        }
        let mut exits: BTreeMap<HostPiece, Exits> = BTreeMap::new();
        for sphere in small {
            let Some(host_piece) = self.host_pieces[sphere] else {
                continue;
            };
            let exits = exits.entry(host_piece);
            let exits = exits.or_insert_with(|| Exits::of(host_piece, spheres, bodies));
            match exits.nearest::<D>(spheres.centres[sphere]) {
                Some(exit) => self.list.push(EmbeddedSphere { sphere, exit }),
                None => self.host_pieces[sphere] = None,
            }
        }
    }

    /// Updates the host pieces after a tear. The host piece of an embedded sphere is now the fragment that
    /// contains the sphere's exit. Until the next tick, the sphere has ordinary contacts with all other
    /// fragments.
    pub fn tear(&mut self, spheres: &Spheres) {
        for embedded in &self.list {
            let exit = &spheres.list[embedded.exit];
            self.host_pieces[embedded.sphere] = Some((exit.body, exit.piece));
        }
    }

    /// Returns whether one of two spheres is embedded in the piece of the other.
    #[inline(always)]
    pub fn is_inside(&self, spheres: [SphereId; 2], [a, b]: [&ContactSphere; 2]) -> bool {
        let inside = |own: SphereId, other: &ContactSphere| {
            let host_piece = self.host_pieces.get(own.index()).copied().flatten();
            host_piece.is_some_and(|host_piece| host_piece == (other.body, other.piece))
        };
        inside(spheres[0], b) || inside(spheres[1], a)
    }
}

/// Surface spheres of one host piece through which an embedded sphere can get out.
struct Exits {
    /// Numbers of the exit spheres, ascending.
    list: Vec<SphereId>,
    /// Centres of the exit spheres [m].
    centres: Vec<Row>,
    bins: Bins,
    /// Radius within which the bins are searched for an exit [m].
    reach: f32,
}

impl Exits {
    fn of<D: Dim>((body, piece): HostPiece, spheres: &Spheres, bodies: &SoftBodies<D>) -> Self {
        let all = spheres.list.entries();
        let exits = all.filter(|(_, sphere)| {
            (sphere.body, sphere.piece) == (body, piece) && sphere.leads_out()
        });
        let exits: Vec<SphereId> = exits.map(|(id, _)| id).collect();
        let centres = exits.iter().map(|&exit| spheres.centres[exit]);
        let centres: Vec<Row> = centres.collect();
        let reach = EXIT_REACH * bodies.at(body).grid().voxel_size();
        Self {
            bins: Bins::new::<D>(&centres, reach),
            list: exits,
            centres,
            reach,
        }
    }

    /// Returns the exit nearest to a position [m]. Of several exits at the same distance, returns the one
    /// with the lowest number.
    fn nearest<D: Dim>(&self, at: Row) -> Option<SphereId> {
        let nearer = |nearest: (f32, u32), number: u32| {
            let apart = self.centres[number as usize] - at;
            let found = (apart.dot(apart), number);
            if found < nearest { found } else { nearest }
        };
        let none = (f32::INFINITY, u32::MAX);
        let mut near = Vec::new();
        on_widest_lanes!(simd => self.bins.near::<D, _>(simd, at, self.reach, |_| 0, &mut near));
        let near = { near.iter() }.map(|&place| self.bins.numbers()[place as usize]);
        let mut nearest = near.fold(none, nearer);
        if nearest == none {
            nearest = (0..self.list.len() as u32).fold(none, nearer);
        }
        self.list.get(nearest.1 as usize).copied()
    }
}

/// Inner element, which has no bare face, and a ball around its nodes.
struct Inner {
    level: u8,
    element: ElementId,
    /// Piece that contains the element.
    host_piece: HostPiece,
    /// Number of elements in this piece.
    count: u32,
    /// Mean position of the element's nodes [m].
    centre: Row,
    /// Distance from `centre` to the farthest node [m].
    radius: f32,
}

/// Returns the inner elements that overlap the box `within`, ascending by level. Skips pieces for which
/// `has_inner` is false.
fn inner_elements<D: Dim>(bodies: &SoftBodies<D>, pieces: &Extents, within: &Extent) -> Vec<Inner> {
    let mut found = Vec::new();
    for (slot, body) in bodies.by_slot() {
        for (id, element) in body.mesh().elements() {
            let level = element.cell.level;
            let piece = body.pieces().of_element(id);
            let extent = &pieces[slot][piece];
            if !extent.has_inner || level == 0 && body.exposed_faces(id) != Some(0) {
                continue;
            }
            let nodes = element.nodes.iter();
            let places = nodes.map(|&node| body.positions()[node]);
            let sum = places.clone().sum::<Row>();
            let centre = sum * (1.0 / element.nodes.len() as f32);
            let furthest = places.map(|at| at - centre).map(|way| way.dot(way));
            let radius = furthest.fold(0.0, f32::max).sqrt();
            if within.reaches(centre, radius) {
                found.push(Inner {
                    level,
                    element: id,
                    host_piece: (slot, piece),
                    count: extent.count,
                    centre,
                    radius,
                });
            }
        }
    }
    found.sort_by_key(|inner| inner.level);
    found
}

/// Returns the median radius of the elements [m], which becomes the width of the bins. A few widely stretched
/// elements do not affect the median.
fn usual_radius(elements: &[Inner]) -> f32 {
    let mut radii: Vec<f32> = elements.iter().map(|inner| inner.radius).collect();
    let middle = radii.len() / 2;
    *radii.select_nth_unstable_by(middle, f32::total_cmp).1
}

/// Extents of all pieces of all bodies.
type Extents = IndexVec<BodySlot, IndexVec<PieceId, Extent>>;

/// Number of elements and bounding box of a piece.
#[derive(Copy, Clone, Debug)]
struct Extent {
    /// Number of elements.
    count: u32,
    /// Whether the piece has inner elements, which have no bare face. [`EmbeddedSpheres::find`] clears the
    /// flag if the box contains no sphere of a smaller piece.
    has_inner: bool,
    /// Low corner of the box around the centres of the piece's contact spheres [m].
    low: Row,
    /// High corner of the box [m].
    high: Row,
}

impl Extent {
    const NONE: Self = Self {
        count: 0,
        has_inner: false,
        low: Row::from_array([f32::MAX; 4]),
        high: Row::from_array([f32::MIN; 4]),
    };

    /// Returns the box around some points.
    fn around(places: &[Row]) -> Self {
        let mut extent = Self::NONE;
        places.iter().for_each(|at| extent.extend(at));
        extent
    }

    fn extend(&mut self, at: &Row) {
        for axis in 0..4 {
            self.low[axis] = self.low[axis].min(at[axis]);
            self.high[axis] = self.high[axis].max(at[axis]);
        }
    }

    /// Returns whether a ball may reach into the box.
    fn reaches(&self, at: Row, radius: f32) -> bool {
        (0..3).all(|axis| (self.low[axis] - radius..=self.high[axis] + radius).contains(&at[axis]))
    }

    fn encloses(&self, at: Row) -> bool {
        self.reaches(at, 0.0)
    }
}

/// Returns an extent for each piece of a body: its number of elements and whether it has inner elements. The
/// boxes are still empty.
fn extents<D: Dim>(body: Option<&SoftBody<D>>) -> IndexVec<PieceId, Extent> {
    let Some(body) = body else {
        return IndexVec::default();
    };
    let count = body.pieces().list.len();
    let mut extents: IndexVec<PieceId, Extent> = vec![Extent::NONE; count].into();
    for (id, element) in body.mesh().elements() {
        let extent = &mut extents[body.pieces().of_element(id)];
        extent.count += 1;
        extent.has_inner |= element.cell.level > 0 || body.exposed_faces(id) == Some(0);
    }
    extents
}

impl<D: Dim> SoftBody<D> {
    /// Returns whether a position [m] is in an element. Treats the deformation of the element as affine.
    fn holds(&self, id: ElementId, at: Vec3) -> bool {
        let Some(element) = self.mesh().element(id) else {
            return false;
        };
        let child = self.child_at(element, at);
        child.is_some_and(|child| element.children >> child & 1 == 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::Dim3;

    #[test]
    fn nearest_exit_is_found_inside_and_outside_the_search_radius() {
        let mut seed = 7u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 24) as f32
        };
        let centres: Vec<Row> = (0..400)
            .map(|_| Row::from_array([random(), random(), random(), 0.0]))
            .collect();
        let reach = 0.1;
        let exits = Exits {
            list: (0..400).map(|number| SphereId(3 * number)).collect(),
            bins: Bins::new::<Dim3>(&centres, reach),
            centres,
            reach,
        };
        let (mut near, mut far) = (0, 0);
        for _ in 0..400 {
            let at = Row::from_array([2.0 * random(), random(), random(), 0.0]);
            let apart = |number: &usize| {
                let apart = exits.centres[*number] - at;
                apart.dot(apart)
            };
            let all = 0..exits.centres.len();
            let nearest = all.min_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap();
            assert_eq!(
                exits.nearest::<Dim3>(at),
                Some(SphereId(3 * nearest as u32))
            );
            let is_near = apart(&nearest) <= reach * reach;
            (near, far) = (near + u32::from(is_near), far + u32::from(!is_near));
        }
        assert!(near > 100 && far > 100, "{near} near, {far} far");
    }

    /// Regression test: the bins once were as wide as the widest element. A single stretched element then
    /// made every element test all crumbs.
    #[test]
    fn usual_radius_ignores_stretched_elements() {
        let inner = |radius| Inner {
            level: 1,
            element: ElementId(0),
            host_piece: (BodySlot(0), PieceId(0)),
            count: 9,
            centre: Row::ZERO,
            radius,
        };
        for stretched in [100.0, f32::INFINITY, f32::NAN] {
            let elements = [0.1, 0.2, stretched, 0.3, 0.2].map(inner);
            assert_eq!(usual_radius(&elements), 0.2, "{stretched}");
        }
    }
}

//! Follows a cutting edge through bodies: the rest position of each sample, and the area that the samples
//! sweep.

use super::edge_sample::{MAX_SAMPLES, Near, Sample};
use super::knife_state::{EdgePose, KnifeState};
use super::material_point::{self, MaterialPoint};
use super::swept_area::{self, Faces, RestPosition};
use crate::foundation::arena::SoftBodyHandle;
use crate::foundation::dim::{Dim, Point};
use crate::rigid_body::RigidState;
use crate::soft_body::{SoftBodies, SoftBody};
use glam::Vec3;

/// Number of edge samples per width of the smallest voxel. With two, no voxel slips between adjacent samples,
/// even at an oblique edge. With half a sample per voxel, the area and work of a cut are wrong by more than
/// 10 %.
const SAMPLES_PER_VOXEL: f32 = 2.0;
/// Stretch up to which the search for elements near a sample finds all of them: present length divided by
/// rest length.
const STRETCH: f32 = 1.5;
/// Factor in the limit of a sample's movement in rest coordinates between two sweeps. The limit is
/// `MAX_STRETCH` times the movement in world space, plus `MAX_JUMP` voxels. A sample that moved farther has
/// entered other tissue, so it cuts nothing in this sweep. The factor is twice [`STRETCH`].
const MAX_STRETCH: f64 = 3.0;
/// Constant term in the limit of a sample's movement in rest coordinates [voxels], see [`MAX_STRETCH`].
const MAX_JUMP: f64 = 2.0;

/// Cut that an edge has made in one body since the last sweep.
pub struct Cut {
    pub body: SoftBodyHandle,
    pub faces: Faces,
    /// Area that was swept through uncut material, measured at rest [m²].
    pub area: f64,
    /// Middle of the part of the edge that is inside the body [m].
    pub at: Vec3,
}

impl KnifeState {
    /// Finds, for each sample of the edge, the body that contains the sample and the rest position in that
    /// body. `ahead` is the time for which the lists of elements near the samples must suffice [s].
    pub(crate) fn follow<D: Dim>(
        &mut self,
        bodies: &SoftBodies<D>,
        holder: &RigidState,
        ahead: f32,
    ) {
        let pose = self.edge_pose::<D>(holder);
        self.update_sample_count(&pose, bodies);
        if !self.knows_near {
            self.find_near_elements(&pose, bodies, holder, ahead);
        }
        for place in 0..self.samples.len() {
            let at = self.place(&pose, place);
            self.samples[place].inside = self.find(bodies, place, at);
        }
    }

    /// Ends a sweep: returns the cuts that the edge made in the last `since` seconds, one for each body that
    /// the edge is in or has just left.
    pub(crate) fn end_sweep<D: Dim>(
        &mut self,
        bodies: &SoftBodies<D>,
        holder: &RigidState,
        since: f32,
    ) -> Vec<Cut> {
        let pose = self.edge_pose::<D>(holder);
        let points = self.samples.iter().flat_map(|k| [k.inside, k.passed]);
        let mut ids: Vec<SoftBodyHandle> = points.flatten().map(|(body, _)| body).collect();
        ids.sort_unstable();
        ids.dedup();
        let known = ids
            .iter()
            .filter_map(|&id| Some((id, bodies.get(id).ok()?)));
        let cuts = known.map(|(id, body)| self.cut_in(&pose, (id, body), since));
        let mut cuts: Vec<Cut> = cuts.collect();
        self.area += cuts.iter().map(|cut| cut.area).sum::<f64>();
        cuts.retain(|cut| !cut.faces.is_empty());
        for place in 0..self.samples.len() {
            let at = self.place(&pose, place);
            let sample = &mut self.samples[place];
            let toughened = sample.inside.and_then(|(id, _)| {
                let body = bodies.get(id).ok()?;
                let size = body.grid().voxel_size();
                body.has_rate_toughening().then_some(size)
            });
            sample.update_speed(since, toughened);
            if !sample.is_stuck() {
                (sample.passed, sample.before) = (sample.inside, at);
            }
            (sample.slid, sample.cut) = (false, false);
        }
        self.knows_near = false;
        cuts
    }

    /// Returns the part of the edge's length that a sample represents [m].
    pub(super) fn share<D: Dim>(&self, pose: &EdgePose, place: usize) -> f32 {
        let last = self.samples.len() - 1;
        // In 2D the edge is a point that cuts a sheet 1 m thick.
        if D::N == 2 {
            return 1.0;
        }
        let spacing = pose.length() / last as f32;
        match place == 0 || place == last {
            true => 0.5 * spacing,
            false => spacing,
        }
    }

    /// Returns the position of a sample relative to the holder [m].
    pub(super) fn lever(&self, pose: &EdgePose, place: usize) -> Vec3 {
        let [from, to] = pose.levers;
        let share = match self.samples.len() {
            1 => 0.5,
            many => place as f32 / (many - 1) as f32,
        };
        from + (to - from) * share
    }

    /// Returns the world-space position of a sample [m].
    fn place(&self, pose: &EdgePose, place: usize) -> Vec3 {
        pose.position + self.lever(pose, place)
    }

    /// Adjusts the number of samples to the smallest voxel of all bodies.
    fn update_sample_count<D: Dim>(&mut self, pose: &EdgePose, bodies: &SoftBodies<D>) {
        let sizes = bodies.iter().map(|body| body.grid().voxel_size());
        let least = sizes.fold(f32::INFINITY, f32::min);
        // Measures the edge in local coordinates, because the length of the rotated edge fluctuates by
        // rounding.
        let length = (self.edge[1] - self.edge[0]).length();
        let asked = (SAMPLES_PER_VOXEL * length / least).ceil() as usize;
        // In 2D the edge is a point with a single sample.
        let count = match D::N {
            2 => 1,
            _ => asked.clamp(1, MAX_SAMPLES) + 1,
        };
        if count != self.samples.len() {
            self.samples = vec![Sample::default(); count];
            self.knows_near = false;
            for place in 0..count {
                self.samples[place].before = self.place(pose, place);
            }
        }
    }

    /// Lists, for each sample, the elements that it may enter within `ahead` seconds.
    fn find_near_elements<D: Dim>(
        &mut self,
        pose: &EdgePose,
        bodies: &SoftBodies<D>,
        holder: &RigidState,
        ahead: f32,
    ) {
        self.knows_near = true;
        self.near.resize(self.samples.len(), Vec::new());
        self.near.iter_mut().for_each(Vec::clear);
        let from = pose.position + pose.levers[0];
        let length = pose.length();
        // In 2D the infinite spacing assigns all listed elements to the only sample.
        let spacing = match D::N {
            2 => f32::INFINITY,
            _ => length / (self.samples.len() - 1) as f32,
        };
        for (id, body) in bodies.entries() {
            if !holder.layers.meet(body.layers()) {
                continue;
            }
            let size = body.grid().voxel_size();
            let margin = size + STRETCH * ahead * holder.top_speed();
            for (_, element) in body.mesh().elements() {
                let node = element.nodes[0];
                let diagonal = size * element.cell.width() as f32 * (D::N as f32).sqrt();
                let reach = STRETCH * diagonal + margin;
                let apart = body.positions()[node].xyz() - from;
                let (along, span) = match D::N {
                    2 => (0.0, 0.0),
                    _ => (apart.dot(pose.along), length),
                };
                let nearest = pose.along * along.clamp(0.0, span);
                if (apart - nearest).length() > reach {
                    continue;
                }
                let voxel = body.mesh().first_voxel(element);
                let first = ((along - reach) / spacing).ceil().max(0.0) as usize;
                let last = ((along + reach) / spacing).floor().max(0.0) as usize;
                let count = last.saturating_add(1).saturating_sub(first);
                let places = self.near.iter_mut().skip(first).take(count);
                places.for_each(|near| {
                    near.push(Near {
                        body: id,
                        voxel,
                        node,
                        reach,
                    });
                });
            }
        }
    }

    /// Returns the body that contains a sample, and the rest position of the sample there. Begins the search
    /// at the last rest position of the sample, then at those of adjacent samples, then in the listed
    /// elements nearby.
    fn find<D: Dim>(
        &self,
        bodies: &SoftBodies<D>,
        place: usize,
        at: Vec3,
    ) -> Option<(SoftBodyHandle, MaterialPoint)> {
        if let Some((id, point)) = self.samples[place].inside
            && let Ok(body) = bodies.get(id)
        {
            // In an element that is pressed flat, the search finds no point. The sample then keeps its last
            // rest position if that is still near.
            let found = MaterialPoint::find(body, at, point.voxel);
            if let Some(point) = found.or(Some(point).filter(|point| point.is_near(body, at))) {
                return Some((id, point));
            }
        }
        let beside = [place.checked_sub(1), Some(place + 1)];
        let others = beside.into_iter().flatten();
        let known = others.filter_map(|place| self.samples.get(place)?.inside);
        let known = known.map(|(body, point)| (body, point.voxel));
        let is_in_reach = |near: &&Near| {
            let Ok(body) = bodies.get(near.body) else {
                return false;
            };
            let node = body.positions()[near.node].xyz();
            (node - at).length() <= near.reach
                && (body.mesh().element_at(near.voxel))
                    .is_some_and(|element| material_point::may_contain(body, element, at))
        };
        let near = self.near[place].iter().filter(is_in_reach);
        let mut tried = known.chain(near.map(|near| (near.body, near.voxel)));
        tried.find_map(|(id, voxel)| {
            Some((id, MaterialPoint::find(bodies.get(id).ok()?, at, voxel)?))
        })
    }

    /// Returns the cut of the edge in one body since the last sweep.
    fn cut_in<D: Dim>(
        &self,
        pose: &EdgePose,
        (id, body): (SoftBodyHandle, &SoftBody<D>),
        since: f32,
    ) -> Cut {
        let size = body.grid().voxel_size();
        let rows: Vec<Option<[RestPosition; 2]>> = (0..self.samples.len())
            .map(|place| self.path_in(pose, (id, body), place, since))
            .collect();
        let is_inside = |place: usize| self.samples[place].inside_of(id).is_some();
        let cuts = |place: usize| f64::from(u8::from(self.samples[place].cut && is_inside(place)));
        let (mut faces, mut area) = (Faces::new(), 0.0);
        let mut add = |patch: [RestPosition; 4], share: f64| {
            swept_area::add_crossed_faces::<D>(patch, body.grid().size(), &mut faces);
            area += share * swept_area::area(patch);
        };
        // In 2D a sample sweeps a line, which stands for an area through the 1 m thick body.
        if D::N == 2 {
            if let Some([from, to]) = rows[0] {
                let deep = |place: RestPosition, z: f64| place.with_z(z);
                let patch = [
                    deep(from, 0.0),
                    deep(from, 1.0),
                    deep(to, 1.0),
                    deep(to, 0.0),
                ];
                add(patch, cuts(0) / f64::from(size));
            }
        } else {
            let apart = f64::from(pose.length() / size) / (self.samples.len() - 1) as f64;
            for (place, pair) in rows.windows(2).enumerate() {
                let [Some([a, b]), Some([d, c])] = pair else {
                    continue;
                };
                let most = MAX_STRETCH * apart + MAX_JUMP;
                if far(*a, *d) > most || far(*b, *c) > most {
                    continue;
                }
                add([*a, *b, *c, *d], 0.5 * (cuts(place) + cuts(place + 1)));
            }
        }
        let grid = body.grid();
        faces.retain(|&(voxel, axis)| {
            let mut next = voxel;
            next[axis] += 1;
            let is_cut = |voxel: Point| {
                let number = grid.material(voxel);
                number != 0 && body.materials()[number as usize - 1].toughness.is_finite()
            };
            is_cut(voxel) && is_cut(next)
        });
        let all = 0..rows.len();
        let mut within: Vec<usize> = all.clone().filter(|&place| is_inside(place)).collect();
        if within.is_empty() {
            // If the edge has just left the body, uses all samples with a path through the body.
            within = all.filter(|&place| rows[place].is_some()).collect();
        }
        let middle = within.get(within.len() / 2).copied().unwrap_or(0);
        Cut {
            body: id,
            faces,
            area: area * f64::from(size * size),
            at: self.place(pose, middle),
        }
    }

    /// Returns the start and end of a sample's path through a body since the last sweep, in rest coordinates
    /// [voxels]. Returns `None` if neither the sample nor an adjacent one is or was in the body.
    fn path_in<D: Dim>(
        &self,
        pose: &EdgePose,
        (id, body): (SoftBodyHandle, &SoftBody<D>),
        place: usize,
        since: f32,
    ) -> Option<[RestPosition; 2]> {
        let sample = &self.samples[place];
        let beside = [place.checked_sub(1), Some(place + 1)];
        let mut others = beside.into_iter().flatten();
        let (inside, passed) = (sample.inside_of(id), sample.passed_in(id));
        let of_neighbour = || others.find_map(|other| self.samples.get(other)?.inside_of(id));
        // For a sample outside of the body, extrapolates the deformation at its last position or at an
        // adjacent sample.
        let base = inside.or(passed).or_else(of_neighbour)?;
        let size = body.grid().voxel_size();
        let at = self.place(pose, place);
        let now = inside.map_or_else(|| base.extend(body, at), |point| Some(point.at))?;
        // Includes the motion of the tissue: tissue that moves against a resting edge is cut.
        let tissue = base.velocity(body)? * since;
        let before = || base.extend(body, sample.before + tissue);
        let before = passed.map_or_else(before, |point| Some(point.at))?;
        if sample.is_stuck() {
            let place = before.as_dvec3();
            return Some([place, place]);
        }
        let [toward] = base.rest_directions(body, [pose.toward])?;
        let [now, before, toward] = [now, before, toward].map(Vec3::as_dvec3);
        let way = now - before;
        let travel = (at - sample.before).length() + tissue.length();
        let reach = f64::from(travel / size);
        let is_jump = way.length() > MAX_STRETCH * reach + MAX_JUMP;
        // A sample that moves backwards, through its own cut, opens no faces.
        let forth = way.dot(toward) / toward.length().max(1e-9);
        let is_drawn_back = forth < 0.0 && 2.0 * forth * forth > way.dot(way);
        match is_jump || is_drawn_back {
            true => Some([now, now]),
            false => Some([before, now]),
        }
    }
}

fn far(a: RestPosition, b: RestPosition) -> f64 {
    let apart = a - b;
    apart.length()
}

//! The simulated world and its time step, [`World::step`].

mod actions;
mod body_handle;
mod config;
mod contact_events;
mod contents;
mod cuts;
mod fast_impacts;
mod grips;
mod hooks;
mod overlaps;
mod reactions;
mod removal;
mod sleep;
#[cfg(feature = "serde")]
mod stored_world;
mod world_joints;

use crate::contact::broad_phase::{Nearby, NodePair};
use crate::contact::joint::{self, Joints};
use crate::contact::solver::{Contacts, Hit, Hits};
use crate::error::Error;
use crate::event::{Contact, Event, StepReport};
use crate::foundation::arena::{BodySlot, RigidBodyHandle, RigidSlot};
use crate::foundation::dim::{Dim, Dim2, Dim3, DimVector};
use crate::foundation::hash::hash_state;
use crate::foundation::ids::{IndexVec, PieceId};
use crate::foundation::threads;
use crate::fracture::crack_growth::{Failure, failures};
use crate::fracture::knife::{KnifeState, Knives};
use crate::object_ref::ObjectRef;
use crate::query::query_cache::QueryCache;
use crate::rigid_body::RigidBodies;
use crate::soft_body::damping::{PieceDamping, apply_damping, motions};
use crate::soft_body::{SoftBodies, SoftBody, for_each_body};
use crate::world::fast_impacts::SlowedPieces;
use crate::world::sleep::{
    all_motions, fall_asleep, fall_asleep_rigid, filter_centres, pressed_sleepers, wake,
};
pub use body_handle::{BodyHandle, Removable};
pub use config::{
    DEFAULT_SUBSTEPS, DEFAULT_TICK, MAX_EXACT_SUBSTEPS, MAX_TICK, MIN_SUBSTEPS, MIN_TICK,
    StiffBodies, WorldConfig,
};
use contact_events::SettlingContact;
use grips::Grips;
pub use grips::{Grip, GripDrive, GripRef};
pub use hooks::{AfterSubstep, Hooks, Substep, field_around};
use overlaps::Overlaps;
pub use reactions::ReactionForce;
pub use removal::{PieceSize, Removed};
#[cfg(feature = "serde")]
pub(crate) use stored_world::StoredWorld;

/// Node speed above which a piece is quarantined [m/s].
const TOP_SPEED: f32 = 1000.0;

/// Simulated world: soft bodies, rigid bodies, joints and knives. [`World::step`] advances its time.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "", try_from = "StoredWorld<D>"))]
pub struct World<D: Dim> {
    config: WorldConfig<D>,
    pub(crate) bodies: SoftBodies<D>,
    pub(crate) rigids: RigidBodies,
    joints: Joints,
    knives: Knives,
    grips: Grips,
    ticks: u64,
    nearby: Nearby,
    events: Vec<Event<D>>,
    /// Contacts of the last tick, ascending by their pair of objects.
    touching: Vec<Contact<D>>,
    /// Mean forces of contacts between objects that settle, ascending by their pair of objects.
    settling: Vec<SettlingContact<D>>,
    /// Pairs of a sensor and an object inside it at the end of the last tick, in ascending order.
    inside: Vec<(RigidBodyHandle, ObjectRef)>,
    /// Objects that were placed inside each other.
    overlaps: Overlaps,
    #[cfg_attr(feature = "serde", serde(skip))]
    contacts: Contacts,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) query_cache: QueryCache,
    /// Pieces slowed in this tick; empty between ticks.
    #[cfg_attr(feature = "serde", serde(skip))]
    slowed: SlowedPieces,
}

/// World in 2D.
pub type World2 = World<Dim2>;

/// World in 3D.
pub type World3 = World<Dim3>;

hash_state! {
    [D: Dim] struct World<D> {
        config, bodies, rigids, joints, knives, grips, ticks, nearby, events, touching,
        settling, inside, overlaps,
    } skip { contacts, query_cache, slowed }
}

impl<D: Dim> World<D> {
    /// Returns an empty world.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if a field of `config` is out of range.
    #[inline(never)]
    pub fn new(config: WorldConfig<D>) -> Result<Self, Error> {
        config.check()?;
        Ok(Self {
            config,
            bodies: SoftBodies::default(),
            rigids: RigidBodies::default(),
            joints: Joints::default(),
            knives: Knives::default(),
            grips: Grips::default(),
            ticks: 0,
            nearby: Nearby::default(),
            events: Vec::new(),
            touching: Vec::new(),
            settling: Vec::new(),
            inside: Vec::new(),
            overlaps: Overlaps::default(),
            contacts: Contacts::default(),
            query_cache: QueryCache::default(),
            slowed: SlowedPieces::default(),
        })
    }

    /// Advances the world by one tick.
    #[inline(never)]
    pub fn step(&mut self) -> StepReport {
        self.step_with(&mut Hooks::default())
    }

    /// Advances the world by one tick, with hooks for an external field and for a callback after each
    /// substep. A field does not act on sleeping pieces; [`wake_up`](World::wake_up) wakes them.
    ///
    /// ```
    /// use fuwafuwa::{Dim2, Hooks, RigidBody, Shape, Substep, Vec2, World, WorldConfig};
    ///
    /// let mut world = World::<Dim2>::new(WorldConfig::default())?;
    /// let hand = world.add_rigid_body(RigidBody::coupled(Shape::ball(0.1)))?;
    /// world.set_target_position(hand, Vec2::new(0.1, 0.0))?;
    /// let mut forces = Vec::new();
    /// let mut note = |substep: &Substep<'_, Dim2>| {
    ///     forces.push(substep.reaction(hand).unwrap_or_default().coupling);
    /// };
    /// let report = world.step_with(&mut Hooks { after_substep: Some(&mut note), ..Hooks::default() });
    /// assert_eq!(forces.len(), report.substeps as usize);
    /// assert!(forces[15].x < 0.0);
    /// # Ok::<(), fuwafuwa::Error>(())
    /// ```
    #[inline(never)]
    pub fn step_with(&mut self, hooks: &mut Hooks<'_, D>) -> StepReport {
        let awake = self.bodies.iter().map(|body| body.awake_nodes().len());
        threads::in_pool(awake.sum(), || self.advance(hooks))
    }

    /// Advances the world by one tick, on the calling thread and others of its pool.
    fn advance(&mut self, hooks: &mut Hooks<'_, D>) -> StepReport {
        self.events.clear();
        let config = &self.config;
        for_each_body(&mut self.bodies, |_, body| body.follow_stiffening(config));
        let substeps = self.substeps();
        let duration = self.config.tick / substeps as f32;
        let rounds = self.config.fracture_rounds_per_tick();
        let mut report = StepReport {
            substeps,
            ..StepReport::default()
        };
        self.start_tick();
        for substep in 0..substeps {
            if is_due(substep, substeps, rounds) {
                self.cut_along_edges(&mut report);
                self.fracture(&mut report);
                self.damp();
            }
            self.integrate_velocities(duration, hooks);
            let gripped = self.apply_grips(duration);
            self.nearby.follow(&self.bodies, &self.rigids, duration);
            self.limit_fast_motion(duration, &mut report);
            let hits = self.solve_constraints(duration);
            self.integrate_positions(duration);
            self.wake(&hits.pieces);
            self.wake(&gripped);
            self.wake_rigids(&hits.rigids);
            if let Some(after) = &mut hooks.after_substep {
                after(&Substep::new(substep, duration, &self.rigids));
            }
        }
        report.inverted = self.bodies.iter().map(SoftBody::inverted_count).sum();
        report.damping_limited = self.limited_bodies(duration);
        self.report_scaled_bodies(&mut report);
        self.quarantine(&mut report);
        self.end_fast_impacts(&mut report);
        self.sleep();
        self.end_tick();
        report
    }

    /// Returns the number of substeps in a tick. The stiffest body determines this number, within limits: in
    /// 1/60 s there are at least [`DEFAULT_SUBSTEPS`] and at most [`WorldConfig::max_substeps`]. If the
    /// maximum is below the minimum, the maximum applies. Under [`StiffBodies::Exact`] the maximum is
    /// [`MAX_EXACT_SUBSTEPS`].
    pub fn substeps(&self) -> u32 {
        let longest = self.bodies.iter().map(SoftBody::longest_substep);
        let longest = longest.fold(f64::INFINITY, f64::min);
        let required = (f64::from(self.config.tick) / longest - 1e-6).ceil() as u32;
        let config = &self.config;
        required.clamp(
            config.min_substeps_per_tick(),
            config.max_substeps_per_tick(),
        )
    }

    /// Returns the number of soft bodies of which the substep limits the stiffness damping.
    fn limited_bodies(&self, duration: f32) -> u32 {
        let is_limited = |body: &&SoftBody<D>| body.is_damping_limited(duration);
        self.bodies.iter().filter(is_limited).count() as u32
    }

    /// Counts the scaled soft bodies, and sends an event for each body with a scale that is new.
    fn report_scaled_bodies(&mut self, report: &mut StepReport) {
        report.largest_scale = 1.0;
        for (id, body) in self.bodies.entries_mut() {
            let (mass_scale, stiffness_scale) = (body.mass_scale(), body.stiffness_scale());
            let scale = (mass_scale / stiffness_scale) as f32;
            report.scaled_bodies += u32::from(scale > 1.0);
            report.largest_scale = report.largest_scale.max(scale);
            if body.take_scale_changed() {
                self.events.push(Event::StiffBodyScaled {
                    body: id,
                    mass_scale: mass_scale as f32,
                    stiffness_scale: stiffness_scale as f32,
                });
            }
        }
    }

    fn start_tick(&mut self) {
        for_each_body(&mut self.bodies, |_, body| body.start_tick());
        for rigid in self.rigids.iter_mut() {
            rigid.start_tick(self.config.tick);
        }
        self.update_grips();
        self.separate_overlaps();
        self.nearby.start_tick(&self.bodies, self.config.tick);
    }

    fn end_tick(&mut self) {
        for (id, rigid) in self.rigids.entries_mut() {
            if rigid.end_tick() {
                let object = ObjectRef::RigidBody(id);
                self.events.push(Event::LeftRange { object });
            }
        }
        self.report_contacts();
        self.ticks += 1;
    }

    /// Splits overstrained nodes and remodels the elements around them.
    fn fracture(&mut self, report: &mut StepReport) {
        let duration = self.config.fracture_interval();
        let failures = for_each_body(&mut self.bodies, |_, body| failures(body, duration));
        for ((id, body), failures) in self.bodies.entries_mut().zip(failures) {
            if failures.is_empty() {
                continue;
            }
            let released = |failure: &Failure| Event::NodeSplit {
                body: id,
                point: D::Vector::from_vec3(body.positions()[failure.node].xyz()),
                energy: failure.energy,
            };
            self.events.extend(failures.iter().map(released));
            let sides = failures.iter().map(|failure| (failure.at, failure.side));
            let changes = body.tear(&sides.collect::<Vec<_>>());
            report.nodes_split += failures.len() as u32;
            report.pieces_detached += changes.detached.len() as u32;
            self.events
                .extend(Event::pieces_detached(id, &changes.detached));
            self.nearby.tear(id.slot(), body, &changes);
        }
    }

    /// Damps the internal vibration of each piece, and applies drag.
    fn damp(&mut self) {
        let interval = self.config.fracture_interval();
        let touching = self.pieces_in_contact();
        let drag = self.config.drag;
        for_each_body(&mut self.bodies, |slot, body| {
            body.refresh_awake();
            let motions = motions(body);
            let vibration = body.mass_damping().unwrap_or(0.0);
            let rolling_resistance = body.rolling_resistance();
            let damping = motions.iter().zip(&touching[slot]);
            let damping = damping.map(|(motion, &touches)| {
                let is_crumb = motion.nodes as usize == D::CORNERS;
                let spin = if is_crumb && touches {
                    rolling_resistance
                } else {
                    0.0
                };
                let rates = PieceDamping {
                    vibration,
                    spin,
                    drag,
                };
                rates.over(interval)
            });
            let damping: Vec<PieceDamping> = damping.collect();
            apply_damping(body, &motions, &damping, interval);
        });
    }

    /// Integrates velocities: elastic forces, gravity, external field and virtual coupling.
    fn integrate_velocities(&mut self, duration: f32, hooks: &Hooks<'_, D>) {
        let WorldConfig { gravity, drag, .. } = self.config;
        let gravity = gravity.to_vec3();
        let field = hooks.field;
        for_each_body(&mut self.bodies, |_, body| {
            body.apply_forces(duration, gravity);
            if let Some(field) = field {
                body.apply_field(duration, field);
            }
        });
        for rigid in self.rigids.iter_mut() {
            rigid.start_substep(duration);
            if rigid.is_dynamic() && rigid.moves() {
                let at = D::Vector::from_vec3(rigid.position());
                let field = hooks.field.map(|field| field(at).to_vec3());
                let field = field.filter(|acceleration| acceleration.is_finite());
                let acceleration = field.map_or(gravity, |field| gravity + field);
                rigid.integrate_forces::<D>(acceleration, drag, duration);
            }
        }
    }

    /// Solves joints, knives and contacts, and applies their impulses to the velocities. Returns the sleeping
    /// pieces and rigid bodies that were hit. They act as immovable walls in this substep and wake at its
    /// end.
    fn solve_constraints(&mut self, duration: f32) -> Hits {
        let rest = self.config.rest_speeds();
        let (bodies, rigids) = (&mut self.bodies, &mut self.rigids);
        let (broken, woken) = joint::solve(&mut self.joints, bodies, rigids, rest, duration);
        let woken_by_knives = self.solve_knife_contacts(duration);
        for_each_body(&mut self.bodies, |_, body| body.apply_responses());
        let (bodies, rigids) = (&mut self.bodies, &mut self.rigids);
        let nearby = &mut self.nearby;
        let mut hits = self.contacts.find(bodies, rigids, nearby, rest, duration);
        self.contacts.solve(bodies, rigids, nearby, duration);
        hits.add(woken.pieces, woken.rigids);
        hits.add(woken_by_knives, Vec::new());
        self.remove_broken_joints(broken);
        hits
    }

    /// Integrates positions, then removes the part of the velocities that was added only to resolve overlaps.
    fn integrate_positions(&mut self, duration: f32) {
        let moved = for_each_body(&mut self.bodies, |_, body| {
            let (_, lead) = body.leads(duration);
            body.move_nodes(duration, lead)
        });
        let furthest = moved.into_iter().fold(0.0, f32::max);
        self.nearby.pass(duration, furthest);
        for rigid in self.rigids.iter_mut() {
            rigid.integrate_pose(duration);
        }
        if self.joints.iter().next().is_some() || self.contacts.relax_soft_bodies() {
            for_each_body(&mut self.bodies, |_, body| body.measure_responses(duration));
        }
        let (bodies, rigids) = (&mut self.bodies, &mut self.rigids);
        let broken = joint::relax(&mut self.joints, bodies, rigids, duration);
        for_each_body(bodies, |_, body| body.apply_responses());
        self.contacts
            .relax(bodies, rigids, &mut self.nearby, duration);
        self.remove_broken_joints(broken);
    }

    /// Quarantines pieces that are non-finite or too fast: resets their nodes to the positions at the start
    /// of the tick, and freezes the pieces permanently. Reports pieces that left their range.
    fn quarantine(&mut self, report: &mut StepReport) {
        let found = for_each_body(&mut self.bodies, |_, body| {
            body.refresh_awake();
            (body.quarantine(TOP_SPEED), body.pieces_out_of_range())
        });
        for (id, (quarantined, out)) in self.bodies.ids().zip(found) {
            for piece in quarantined {
                report.quarantined += 1;
                self.events.push(Event::Quarantined { body: id, piece });
            }
            let out = out.into_iter();
            let out = out.map(|piece| ObjectRef::Piece { body: id, piece });
            self.events
                .extend(out.map(|object| Event::LeftRange { object }));
        }
    }

    /// Wakes sleepers that are pressed, and puts pieces and rigid bodies to sleep that are at rest.
    fn sleep(&mut self) {
        let (tick, rest) = (self.config.tick, self.config.rest_speeds());
        let motions = all_motions(&mut self.bodies);
        filter_centres(&mut self.bodies, &motions, &mut self.rigids, tick);
        let hits = pressed_sleepers(&self.bodies, &motions, &self.rigids, &self.nearby);
        self.wake(&hits.pieces);
        self.wake_rigids(&hits.rigids);
        if !self.config.sleep {
            return;
        }
        let pairs = self.nearby.nodes.list.iter();
        let is_pushed = |pair: &&NodePair| self.rigids.at(pair.rigid).pushes();
        let kept_awake = pairs
            .filter(is_pushed)
            .filter(|pair| pair.impulse.normal_impulse > 0.0);
        let kept_awake = kept_awake.filter_map(|pair| Some((pair.body, pair.piece(&self.bodies)?)));
        let embedded = self.nearby.embedded.list.iter();
        let embedded = embedded.map(|embedded| &self.nearby.spheres.list[embedded.sphere]);
        let embedded = embedded.map(|sphere| (sphere.body, sphere.piece));
        let is_pushed = |knife: &&KnifeState| {
            let holder = self.rigids.get(knife.holder);
            holder.is_ok_and(|holder| holder.pushes())
        };
        let pushed = self.knives.iter().filter(is_pushed);
        let cut = pushed.flat_map(|knife| knife.pieces_inside(&self.bodies));
        let overlapping = self.nearby.overlapping.pieces();
        let kept_awake = kept_awake.chain(embedded).chain(cut).chain(overlapping);
        let kept_awake: Vec<Hit> = kept_awake.collect();
        let fallen = fall_asleep(&mut self.bodies, &motions, &kept_awake, rest, tick);
        let events = fallen.iter().map(|&(body, piece)| Event::FellAsleep {
            body: self.bodies.id(body),
            piece,
        });
        self.events.extend(events);
        let mut kept_awake = self.contacts.pushed_bodies(&self.rigids);
        kept_awake.extend(self.nearby.overlapping.rigids());
        fall_asleep_rigid(&mut self.rigids, &kept_awake, rest, tick);
    }

    /// Wakes the dynamic rigid bodies in `hits`, and requests a new search for nodes near rigid bodies.
    fn wake_rigids(&mut self, hits: &[RigidSlot]) {
        for &slot in hits {
            self.rigids.at_mut(slot).wake();
        }
        if !hits.is_empty() {
            self.nearby.nodes.request_full_search();
        }
    }

    /// Wakes the sleeping pieces in `hits`, and reports an event for each.
    fn wake(&mut self, hits: &[Hit]) {
        let woken = wake(&mut self.bodies, hits);
        if woken.is_empty() {
            return;
        }
        for body in self.bodies.iter_mut() {
            body.refresh_awake();
        }
        self.nearby.wake(&woken, &self.bodies);
        let events = woken.iter().map(|&(body, piece)| Event::WokeUp {
            body: self.bodies.id(body),
            piece,
        });
        self.events.extend(events);
    }

    /// Returns a flag for each piece of each body: whether a contact presses on the piece.
    fn pieces_in_contact(&self) -> IndexVec<BodySlot, IndexVec<PieceId, bool>> {
        let none = |body: Option<&SoftBody<D>>| {
            let pieces = body.map_or(0, |body| body.pieces().list.len());
            vec![false; pieces].into()
        };
        let mut touching: IndexVec<_, IndexVec<_, bool>> = self.bodies.slots().map(none).collect();
        for (body, piece) in self.nearby.pressed_pieces(&self.bodies) {
            // `pressed_pieces` reads the contacts of the last substep. If a new body has since replaced the
            // body in its arena slot, a contact may name a piece that the new body does not have; it is
            // skipped.
            if let Some(touches) = touching[body].get_mut(piece.index()) {
                *touches = true;
            }
        }
        touching
    }
}

/// Returns whether fracture and damping are due in this substep. They run `rounds` times per tick, spread
/// evenly over the substeps.
fn is_due(substep: u32, substeps: u32, rounds: u32) -> bool {
    substep * rounds % substeps < rounds
}

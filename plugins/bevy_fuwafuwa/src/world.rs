//! The engine's world as a resource, and the mapping between entities and bodies.

use crate::dimension::Dimension;
use bevy_ecs::entity::Entity;
use bevy_ecs::resource::Resource;
use fuwafuwa::{
    Error, Event, RigidBody, RigidBodyHandle, SoftBodyHandle, StepReport, World, WorldConfig,
};
use std::collections::{BTreeMap, BTreeSet};

/// Configuration of the world: gravity, drag, substeps and tick length. It can be changed at any time. A value
/// out of range has no effect and is reported by [`crate::message::Rejection`].
#[derive(Resource, Copy, Clone, Debug, Default, PartialEq)]
pub struct SoftWorldConfig<D: Dimension>(pub WorldConfig<D>);

/// The engine's world, and the mapping between entities and bodies.
///
/// Use it between two ticks for everything that has no component: cuts, snapshots, energies, forces on rigid
/// bodies. Bodies that you add directly to the engine move and collide as usual, but have no entity and send
/// no messages.
#[derive(Resource, Debug)]
pub struct SoftWorld<D: Dimension> {
    engine: World<D>,
    bodies: Pairs<SoftBodyHandle>,
    rigids: Pairs<RigidBodyHandle>,
    /// Rigid bodies that slept after the last tick.
    sleepers: BTreeSet<RigidBodyHandle>,
    is_paused: bool,
    single_ticks: u32,
    has_ticked: bool,
    /// Number of the engine's current events that were already sent as messages.
    sent: usize,
    report: StepReport,
}

/// Bidirectional map between entities and ids.
#[derive(Debug)]
struct Pairs<Id> {
    ids: BTreeMap<Entity, Id>,
    entities: BTreeMap<Id, Entity>,
}

impl<Id> Default for Pairs<Id> {
    fn default() -> Self {
        Self {
            ids: BTreeMap::new(),
            entities: BTreeMap::new(),
        }
    }
}

impl<Id: Copy + Ord> Pairs<Id> {
    fn add(&mut self, entity: Entity, id: Id) {
        if let Some(before) = self.ids.insert(entity, id) {
            self.entities.remove(&before);
        }
        self.entities.insert(id, entity);
    }

    fn take(&mut self, entity: Entity) -> Option<Id> {
        let id = self.ids.remove(&entity)?;
        self.entities.remove(&id);
        Some(id)
    }
}

impl<D: Dimension> Default for SoftWorld<D> {
    fn default() -> Self {
        Self {
            engine: World::new(WorldConfig::default()).expect("the default configuration is valid"),
            bodies: Pairs::default(),
            rigids: Pairs::default(),
            sleepers: BTreeSet::new(),
            is_paused: false,
            single_ticks: 0,
            has_ticked: false,
            sent: 0,
            report: StepReport::default(),
        }
    }
}

impl<D: Dimension> SoftWorld<D> {
    /// Returns the engine's world.
    pub fn engine(&self) -> &World<D> {
        &self.engine
    }

    /// Returns the engine's world for changes. If you remove a body there, its entity stays and has no body
    /// any more.
    pub fn engine_mut(&mut self) -> &mut World<D> {
        &mut self.engine
    }

    /// Returns the soft body of an entity. `None` before it has entered the world.
    pub fn soft_body_of(&self, entity: Entity) -> Option<SoftBodyHandle> {
        self.bodies.ids.get(&entity).copied()
    }

    /// Returns the entity of a soft body.
    pub fn entity_of_soft_body(&self, body: SoftBodyHandle) -> Option<Entity> {
        self.bodies.entities.get(&body).copied()
    }

    /// Returns the rigid body of an entity. `None` before it has entered the world.
    pub fn rigid_body_of(&self, entity: Entity) -> Option<RigidBodyHandle> {
        self.rigids.ids.get(&entity).copied()
    }

    /// Returns the entity of a rigid body.
    pub fn entity_of_rigid_body(&self, rigid: RigidBodyHandle) -> Option<Entity> {
        self.rigids.entities.get(&rigid).copied()
    }

    /// Pauses the simulation; entities still enter and leave.
    pub fn pause(&mut self) {
        self.is_paused = true;
    }

    /// Resumes the simulation.
    pub fn resume(&mut self) {
        self.is_paused = false;
    }

    /// Returns whether the simulation is paused.
    pub fn is_paused(&self) -> bool {
        self.is_paused
    }

    /// Requests a single tick for the next run of the schedule while the simulation is paused. Repeated calls
    /// request one tick in each of the following runs.
    pub fn step_once(&mut self) {
        self.single_ticks += 1;
    }

    /// Returns the engine's report of the last tick, such as the number of split nodes.
    pub fn report(&self) -> StepReport {
        self.report
    }

    /// Runs a tick unless paused. Returns whether a tick ran.
    pub(crate) fn tick(&mut self) -> bool {
        self.has_ticked = !self.is_paused || self.single_ticks > 0;
        if self.has_ticked {
            self.single_ticks = self.single_ticks.saturating_sub(1);
            self.report = self.engine.step();
            self.sent = self.engine.events().len();
        }
        self.has_ticked
    }

    /// Returns the events that direct calls of the engine caused since the last tick. They were not sent as
    /// messages yet.
    pub(crate) fn unsent_events(&self) -> Vec<Event<D>> {
        self.engine
            .events()
            .get(self.sent..)
            .unwrap_or_default()
            .to_vec()
    }

    /// Returns whether the last run of the schedule ran a tick.
    pub(crate) fn has_ticked(&self) -> bool {
        self.has_ticked
    }

    /// Returns the entities of rigid bodies that fell asleep (`true`) or woke up (`false`) since the last
    /// call.
    pub(crate) fn follow_sleep(&mut self) -> Vec<(Entity, bool)> {
        let asleep = self.engine.rigid_bodies();
        let asleep = asleep.filter(|(_, rigid)| rigid.is_asleep());
        let asleep: BTreeSet<RigidBodyHandle> = asleep.map(|(id, _)| id).collect();
        let before = std::mem::replace(&mut self.sleepers, asleep);
        let changed = before.symmetric_difference(&self.sleepers);
        let entities = changed.filter_map(|&id| {
            let entity = self.entity_of_rigid_body(id)?;
            Some((entity, self.sleepers.contains(&id)))
        });
        entities.collect()
    }

    /// Returns soft bodies and their entities, in the order of ids.
    pub(crate) fn soft_entities(&self) -> Vec<(SoftBodyHandle, Entity)> {
        let entities = self.bodies.entities.iter();
        entities.map(|(&id, &entity)| (id, entity)).collect()
    }

    /// Returns rigid bodies and their entities, in the order of ids.
    pub(crate) fn rigid_entities(&self) -> Vec<(RigidBodyHandle, Entity)> {
        let entities = self.rigids.entities.iter();
        entities.map(|(&id, &entity)| (id, entity)).collect()
    }

    pub(crate) fn add_body(
        &mut self,
        entity: Entity,
        body: fuwafuwa::SoftBody<D>,
    ) -> Result<SoftBodyHandle, Error> {
        let id = self.engine.add_soft_body(body)?;
        self.bodies.add(entity, id);
        Ok(id)
    }

    pub(crate) fn add_rigid(
        &mut self,
        entity: Entity,
        rigid: RigidBody<D>,
    ) -> Result<RigidBodyHandle, Error> {
        let id = self.engine.add_rigid_body(rigid)?;
        self.rigids.add(entity, id);
        Ok(id)
    }

    /// Removes the soft body of an entity. Returns `None` if the entity has no soft body.
    pub(crate) fn remove_body(&mut self, entity: Entity) -> Option<Result<(), Error>> {
        let id = self.bodies.take(entity)?;
        Some(self.engine.remove(id).map(drop))
    }

    /// Removes the rigid body of an entity. Returns `None` if the entity has no rigid body.
    pub(crate) fn remove_rigid(&mut self, entity: Entity) -> Option<Result<(), Error>> {
        let id = self.rigids.take(entity)?;
        Some(self.engine.remove(id).map(drop))
    }
}

//! The engine's world as a resource, and which entity is which thing in it.

use crate::dimension::Dimension;
use bevy_ecs::entity::Entity;
use bevy_ecs::resource::Resource;
use fuwafuwa::handle::Gone;
use fuwafuwa::{BodyId, Event, RigidBody, RigidId, Settings, StepReport, World};
use std::collections::{BTreeMap, BTreeSet};

/// What holds for all worlds of an app: gravity, drag, substeps. Change it whenever you like; what the engine refuses is
/// told by [`crate::message::Rejection`] and changes nothing.
#[derive(Resource, Copy, Clone, Debug, Default, PartialEq)]
pub struct SoftSettings(pub Settings);

/// The engine's world, and which entity is which thing in it.
///
/// Whatever has no component is done here, between two ticks: cuts, snapshots, energies, forces on hands. Things that you
/// put into the engine by hand move and collide as others do; they have no entity, and send no messages.
#[derive(Resource, Debug)]
pub struct SoftWorld<D: Dimension> {
    engine: World<D>,
    bodies: Pairs<BodyId>,
    rigids: Pairs<RigidId>,
    /// What is rigid and slept after the last tick.
    sleepers: BTreeSet<RigidId>,
    is_paused: bool,
    single_ticks: u32,
    has_ticked: bool,
    /// How many events of the last tick were told.
    told: usize,
    report: StepReport,
}

/// Which entity has which id, both ways.
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
            engine: World::new(Settings::default()).expect("the default is in range"),
            bodies: Pairs::default(),
            rigids: Pairs::default(),
            sleepers: BTreeSet::new(),
            is_paused: false,
            single_ticks: 0,
            has_ticked: false,
            told: 0,
            report: StepReport::default(),
        }
    }
}

impl<D: Dimension> SoftWorld<D> {
    /// The engine's world.
    pub fn engine(&self) -> &World<D> {
        &self.engine
    }

    /// The engine's world, to be changed. An entity whose body you remove there stays, and has none.
    pub fn engine_mut(&mut self) -> &mut World<D> {
        &mut self.engine
    }

    /// The body of an entity, once it has entered.
    pub fn body_of(&self, entity: Entity) -> Option<BodyId> {
        self.bodies.ids.get(&entity).copied()
    }

    /// The entity of a body.
    pub fn entity_of_body(&self, body: BodyId) -> Option<Entity> {
        self.bodies.entities.get(&body).copied()
    }

    /// The rigid thing of an entity, once it has entered.
    pub fn rigid_of(&self, entity: Entity) -> Option<RigidId> {
        self.rigids.ids.get(&entity).copied()
    }

    /// The entity of a rigid thing.
    pub fn entity_of_rigid(&self, rigid: RigidId) -> Option<Entity> {
        self.rigids.entities.get(&rigid).copied()
    }

    /// Stops time: entities still enter and leave.
    pub fn pause(&mut self) {
        self.is_paused = true;
    }

    /// Lets time go on.
    pub fn resume(&mut self) {
        self.is_paused = false;
    }

    /// Whether time stands still.
    pub fn is_paused(&self) -> bool {
        self.is_paused
    }

    /// Lets one tick pass the next time, though time stands still.
    pub fn step_once(&mut self) {
        self.single_ticks += 1;
    }

    /// What the last tick did.
    pub fn report(&self) -> StepReport {
        self.report
    }

    /// Lets a tick pass, if it may; whether it did.
    pub(crate) fn tick(&mut self) -> bool {
        self.has_ticked = !self.is_paused || self.single_ticks > 0;
        if self.has_ticked {
            self.single_ticks = self.single_ticks.saturating_sub(1);
            self.report = self.engine.step();
            self.told = self.engine.events().len();
        }
        self.has_ticked
    }

    /// What happened since the last tick, by what was asked of the engine by hand.
    pub(crate) fn untold(&self) -> Vec<Event> {
        self.engine
            .events()
            .get(self.told..)
            .unwrap_or_default()
            .to_vec()
    }

    /// Whether a tick passed the last time.
    pub(crate) fn has_ticked(&self) -> bool {
        self.has_ticked
    }

    /// The rigid entities that fell asleep or woke since this was asked last, and whether they sleep.
    pub(crate) fn follow_sleep(&mut self) -> Vec<(Entity, bool)> {
        let asleep = self.engine.rigids().entries();
        let asleep = asleep.filter(|(_, rigid)| rigid.is_asleep());
        let asleep: BTreeSet<RigidId> = asleep.map(|(id, _)| id).collect();
        let before = std::mem::replace(&mut self.sleepers, asleep);
        let changed = before.symmetric_difference(&self.sleepers);
        let told = changed
            .filter_map(|&id| Some((self.entity_of_rigid(id)?, self.sleepers.contains(&id))));
        told.collect()
    }

    /// The bodies of entities, in the order of their ids.
    pub(crate) fn soft_entities(&self) -> Vec<(BodyId, Entity)> {
        let entities = self.bodies.entities.iter();
        entities.map(|(&id, &entity)| (id, entity)).collect()
    }

    /// The rigid things of entities, in the order of their ids.
    pub(crate) fn rigid_entities(&self) -> Vec<(RigidId, Entity)> {
        let entities = self.rigids.entities.iter();
        entities.map(|(&id, &entity)| (id, entity)).collect()
    }

    pub(crate) fn add_body(&mut self, entity: Entity, body: fuwafuwa::Body<D>) -> BodyId {
        let id = self.engine.add_body(body);
        self.bodies.add(entity, id);
        id
    }

    pub(crate) fn add_rigid(
        &mut self,
        entity: Entity,
        rigid: RigidBody,
    ) -> Result<RigidId, fuwafuwa::Refused> {
        let id = self.engine.add_rigid(rigid)?;
        self.rigids.add(entity, id);
        Ok(id)
    }

    /// Takes the body of an entity out, if it has one that is still there.
    pub(crate) fn remove_body(&mut self, entity: Entity) -> Option<Result<(), Gone>> {
        let id = self.bodies.take(entity)?;
        Some(self.engine.remove_body(id).map(drop))
    }

    /// Takes the rigid thing of an entity out, if it has one that is still there.
    pub(crate) fn remove_rigid(&mut self, entity: Entity) -> Option<Result<(), Gone>> {
        let id = self.rigids.take(entity)?;
        Some(self.engine.remove_rigid(id).map(drop))
    }
}

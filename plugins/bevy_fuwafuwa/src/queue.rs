//! Who wants to enter the world and who wants to leave it, in the order in which that was asked for.

use bevy_ecs::entity::Entity;
use bevy_ecs::resource::Resource;
use bevy_ecs::world::DeferredWorld;
use fuwafuwa::Dim;
use std::marker::PhantomData;

/// What components were inserted and removed since the last tick.
#[derive(Resource, Debug)]
pub struct Queue<D: Dim> {
    requests: Vec<(Entity, Request)>,
    dim: PhantomData<D>,
}

/// What an entity asks for.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Request {
    AddBody,
    RemoveBody,
    AddRigid,
    RemoveRigid,
}

impl<D: Dim> Default for Queue<D> {
    fn default() -> Self {
        let (requests, dim) = (Vec::new(), PhantomData);
        Self { requests, dim }
    }
}

impl<D: Dim> Queue<D> {
    /// Hands the queue of a world to `ask`, if there is one.
    pub fn of(world: &mut DeferredWorld<'_>, ask: impl FnOnce(&mut Self)) {
        if let Some(mut queue) = world.get_resource_mut::<Self>() {
            ask(&mut queue);
        }
    }

    /// Notes what an entity asks for.
    pub fn add(&mut self, entity: Entity, request: Request) {
        self.requests.push((entity, request));
    }

    /// All that was asked for, in order.
    pub fn take(&mut self) -> Vec<(Entity, Request)> {
        std::mem::take(&mut self.requests)
    }

    /// Puts those back who have to wait, before all who asked since.
    pub fn wait(&mut self, mut waiting: Vec<(Entity, Request)>) {
        waiting.append(&mut self.requests);
        self.requests = waiting;
    }
}

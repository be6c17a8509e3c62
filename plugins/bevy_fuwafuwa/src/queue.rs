//! Requests to enter and leave the world, in the order in which they were made.

use bevy_ecs::entity::Entity;
use bevy_ecs::resource::Resource;
use bevy_ecs::world::DeferredWorld;
use fuwafuwa::Dim;
use std::marker::PhantomData;

/// Body components inserted and removed since the last tick.
#[derive(Resource, Debug)]
pub struct Queue<D: Dim> {
    requests: Vec<(Entity, Request)>,
    dim: PhantomData<D>,
}

/// Request of an entity to add or remove its body.
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
    /// Calls `ask` with the queue of a Bevy world. Does nothing if this world has no queue, because the
    /// plugin was not added.
    pub fn of(world: &mut DeferredWorld<'_>, ask: impl FnOnce(&mut Self)) {
        if let Some(mut queue) = world.get_resource_mut::<Self>() {
            ask(&mut queue);
        }
    }

    /// Appends a request.
    pub fn add(&mut self, entity: Entity, request: Request) {
        self.requests.push((entity, request));
    }

    /// Removes and returns all requests, in order.
    pub fn take(&mut self) -> Vec<(Entity, Request)> {
        std::mem::take(&mut self.requests)
    }

    /// Puts requests that must wait for an asset back, before all newer requests.
    pub fn wait(&mut self, mut waiting: Vec<(Entity, Request)>) {
        waiting.append(&mut self.requests);
        self.requests = waiting;
    }
}

//! Plugin and system sets.

use crate::asset::Voxels;
use crate::component::SoftBody;
use crate::dimension::Dimension;
use crate::enter::enter_and_leave;
use crate::message::{
    ContactBegan, ContactEnded, Cut, FellAsleep, JointBroke, NodeSplit, PieceDetached, Quarantined,
    Rejection, Removed, SensorEntered, SensorExited, Touched, Woke,
};
use crate::push::{change_settings, push_bodies};
use crate::queue::Queue;
use crate::steer::steer_rigids;
use crate::step::step;
use crate::world::{SoftSettings, SoftWorld};
use crate::write::{write_bodies, write_meshes, write_rigids};
use bevy_app::{App, FixedPostUpdate, Plugin};
use bevy_asset::{AssetApp, AssetServer, Assets};
use bevy_ecs::intern::Interned;
use bevy_ecs::schedule::{IntoScheduleConfigs, ScheduleLabel, SystemSet};
use bevy_math::Vec3;
use bevy_mesh::Mesh;
use fuwafuwa::WorldConfig;
use std::marker::PhantomData;

/// Plugin for soft bodies in 2D or 3D. Add it after `DefaultPlugins`. If no `AssetPlugin` was added before,
/// there are no meshes and no shapes from files, which suits servers and tests.
#[derive(Debug)]
pub struct FuwafuwaPlugin<D: Dimension> {
    schedule: Interned<dyn ScheduleLabel>,
    settings: WorldConfig,
    dim: PhantomData<D>,
}

/// System sets of the plugin. They run in this order, once per run of the schedule.
#[derive(SystemSet, Copy, Clone, Debug, PartialEq, Eq, Hash)]
pub enum FuwafuwaSystems {
    /// Adds and removes bodies and applies changed components.
    Prepare,
    /// Runs a tick and sends messages.
    Step,
    /// Updates transforms, velocities and meshes.
    Writeback,
}

impl<D: Dimension> Default for FuwafuwaPlugin<D> {
    /// Runs in `FixedPostUpdate`, with the default settings of the engine.
    fn default() -> Self {
        Self {
            schedule: FixedPostUpdate.intern(),
            settings: WorldConfig::default(),
            dim: PhantomData,
        }
    }
}

impl<D: Dimension> FuwafuwaPlugin<D> {
    /// Runs the plugin in another schedule. Each run is one tick of length [`WorldConfig::tick`], by default
    /// 1/60 s.
    pub fn in_schedule(self, schedule: impl ScheduleLabel) -> Self {
        let schedule = schedule.intern();
        Self { schedule, ..self }
    }

    /// Sets the initial settings. To change settings later, write to [`SoftSettings`].
    pub fn with_settings(self, settings: WorldConfig) -> Self {
        Self { settings, ..self }
    }

    /// Sets gravity [m/s²].
    pub fn with_gravity(self, gravity: Vec3) -> Self {
        let settings = WorldConfig {
            gravity: gravity.into(),
            ..self.settings
        };
        Self { settings, ..self }
    }
}

impl<D: Dimension> Plugin for FuwafuwaPlugin<D> {
    fn build(&self, app: &mut App) {
        app.insert_resource(SoftSettings(self.settings))
            .init_resource::<SoftWorld<D>>()
            .init_resource::<Queue<D>>()
            .add_message::<NodeSplit>()
            .add_message::<PieceDetached>()
            .add_message::<Touched>()
            .add_message::<ContactBegan>()
            .add_message::<ContactEnded>()
            .add_message::<SensorEntered>()
            .add_message::<SensorExited>()
            .add_message::<JointBroke>()
            .add_message::<Cut>()
            .add_message::<Removed>()
            .add_message::<FellAsleep>()
            .add_message::<Woke>()
            .add_message::<Quarantined>()
            .add_message::<Rejection>();
        if app.world().contains_resource::<AssetServer>() {
            app.init_asset::<Voxels<D>>();
            D::read_files(app);
            if !app.world().contains_resource::<Assets<Mesh>>() {
                app.init_asset::<Mesh>();
            }
        }
        let sets = (
            FuwafuwaSystems::Prepare,
            FuwafuwaSystems::Step,
            FuwafuwaSystems::Writeback,
        );
        app.configure_sets(self.schedule, sets.chain());
        let prepare = (
            change_settings::<D>,
            enter_and_leave::<D>,
            push_bodies::<D>,
            steer_rigids::<D>,
        );
        app.add_systems(
            self.schedule,
            (
                prepare.chain().in_set(FuwafuwaSystems::Prepare),
                step::<D>.in_set(FuwafuwaSystems::Step),
                (write_bodies::<D>, write_rigids::<D>, write_meshes::<D>)
                    .chain()
                    .in_set(FuwafuwaSystems::Writeback),
            ),
        );
    }

    fn name(&self) -> &str {
        std::any::type_name::<SoftBody<D>>()
    }
}

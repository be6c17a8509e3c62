//! Plugin and system sets.

use crate::asset::Voxels;
use crate::component::SoftBody;
use crate::convert::engine_vector;
use crate::dimension::Dimension;
use crate::enter::enter_and_leave;
use crate::message::{
    ContactEnded, ContactForce, ContactStarted, Cut, FellAsleep, ImpactSlowed, JointBroke,
    LeftRange, NodeSplit, Overlapped, PieceDetached, Quarantined, Rejection, Removed,
    SensorEntered, SensorExited, StiffBodyScaled, WokeUp,
};
use crate::push::{change_config, push_bodies};
use crate::queue::Queue;
use crate::steer::steer_rigids;
use crate::step::step;
use crate::world::{SoftWorld, SoftWorldConfig};
use crate::write::{write_bodies, write_meshes, write_rigids};
use bevy_app::{App, FixedPostUpdate, Plugin};
use bevy_asset::{AssetApp, AssetServer, Assets};
use bevy_ecs::intern::Interned;
use bevy_ecs::schedule::{IntoScheduleConfigs, ScheduleLabel, SystemSet};
use bevy_math::Vec3;
use bevy_mesh::Mesh;
use fuwafuwa::WorldConfig;

/// Plugin for soft bodies in 2D or 3D. Add it after `DefaultPlugins`. If no `AssetPlugin` was added before,
/// there are no meshes and no shapes from files, which suits servers and tests.
#[derive(Debug)]
pub struct FuwafuwaPlugin<D: Dimension> {
    schedule: Interned<dyn ScheduleLabel>,
    config: WorldConfig<D>,
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
    /// Runs in `FixedPostUpdate`, with the default configuration of the engine.
    fn default() -> Self {
        Self {
            schedule: FixedPostUpdate.intern(),
            config: WorldConfig::default(),
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

    /// Sets the initial configuration. To change it later, write to [`SoftWorldConfig`].
    pub fn with_config(self, config: WorldConfig<D>) -> Self {
        Self { config, ..self }
    }

    /// Sets gravity [m/s²].
    pub fn with_gravity(self, gravity: Vec3) -> Self {
        let config = WorldConfig {
            gravity: engine_vector(gravity),
            ..self.config
        };
        Self { config, ..self }
    }
}

impl<D: Dimension> Plugin for FuwafuwaPlugin<D> {
    fn build(&self, app: &mut App) {
        app.insert_resource(SoftWorldConfig(self.config))
            .init_resource::<SoftWorld<D>>()
            .init_resource::<Queue<D>>()
            .add_message::<NodeSplit>()
            .add_message::<PieceDetached>()
            .add_message::<ContactForce>()
            .add_message::<ContactStarted>()
            .add_message::<ContactEnded>()
            .add_message::<SensorEntered>()
            .add_message::<SensorExited>()
            .add_message::<JointBroke>()
            .add_message::<Cut>()
            .add_message::<Removed>()
            .add_message::<FellAsleep>()
            .add_message::<WokeUp>()
            .add_message::<ImpactSlowed>()
            .add_message::<Overlapped>()
            .add_message::<LeftRange>()
            .add_message::<StiffBodyScaled>()
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
            change_config::<D>,
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

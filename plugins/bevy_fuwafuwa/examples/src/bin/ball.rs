//! A ball that falls and cracks: `cargo run -p bevy_fuwafuwa_examples --bin ball`, in `plugins/bevy_fuwafuwa`.

use bevy::prelude::*;
use bevy_fuwafuwa::prelude::*;

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, FuwafuwaPlugin3d::default()))
        .insert_resource(Time::<Fixed>::from_hz(60.0))
        .add_systems(Startup, set_up)
        .run();
}

fn set_up(mut commands: Commands, mut skins: ResMut<Assets<StandardMaterial>>) {
    let skin = MeshMaterial3d(skins.add(StandardMaterial::default()));
    commands.spawn((SoftBody3d::ball(24, 1.0), skin));
    commands.spawn((RigidBody3d::floor(), Transform::from_xyz(0.0, -1.2, 0.0)));
    commands.spawn((PointLight::default(), Transform::from_xyz(-2.0, 2.0, 3.0)));
    commands.spawn((Camera3d::default(), Transform::from_xyz(0.0, -0.6, 3.5)));
}

//! Tests of the public interface. They are one program, because each further one adds seconds of compilation.

mod blades;
mod body_actions;
mod contacts;
mod crumbs;
mod damping;
mod documents;
mod errors;
mod faults;
mod hostile;
mod invariants;
mod joints;
mod kinematic;
mod knives;
mod measuring;
mod motion;
mod paper;
mod pictures;
mod plasticity;
mod queries;
#[cfg(feature = "serde")]
mod removal;
mod rigid_bodies;
mod skin;
mod sleep;
#[cfg(feature = "serde")]
mod snapshots;
#[cfg(feature = "serde")]
mod state_hash;
mod stiff_bodies;
mod strength_laws;
mod stress_laws;
mod ticks;
mod vectors;
mod world;
mod world_actions;

//! Particles, confetti, and the reactions of bodies to recent events.

use super::confetti::Confetti;
use super::feelings::{Feeling, MoodInput, largest_mass};
use app_shell::CameraRig;
use fuwafuwa::inspect::is_hand;
use fuwafuwa::{
    Contact, Dim, DimVector, Event, NodeId, ObjectRef, SoftBody, SoftBodyHandle, Vec3, VoxelGrid,
};
use tamaire_play::{AnyRound, Basket, Round};

/// Maximum number of particles.
const MOST: usize = 400;
/// Number of dust particles created when a node splits.
const DUST: usize = 3;
/// Number of node splits in a tick for which the material is looked up. Further splits use the material found
/// last, because a look-up searches all nodes.
const LOOKED_UP: usize = 8;
/// Hand force above which a body winces [N].
const HURTS: f32 = 350.0;
/// Distance of the hand from its start position at which the start hint fades [m].
const MOVED: f32 = 0.12;
/// Time for which the start hint is shown again to a player who is stuck [s].
const REMINDER: f32 = 8.0;
/// Air drag of particles [1/s].
const DRAG: f32 = 1.5;
/// Duration that is multiplied by gravity to get the upward velocity of new particles [s].
const THROWN: f32 = 0.35;
/// Factors on the normal and the tangential velocity of a particle that bounces off a wall.
const BOUNCE: [f32; 2] = [0.45, 0.7];
/// Normal speed below which a particle stays on the wall instead of bouncing [m/s].
const LIES: f32 = 0.25;

/// Dust particle.
#[derive(Copy, Clone, Debug)]
pub struct DustParticle {
    /// Position [m].
    pub at: Vec3,
    /// Velocity [m/s].
    velocity: Vec3,
    /// Remaining lifetime [s].
    left: f32,
    /// Radius [m].
    pub radius: f32,
    /// Material number.
    pub material: u8,
    /// Whether the particle shows fresh material from inside a body.
    pub is_fresh: bool,
}

impl DustParticle {
    /// Bounces off a wall whose normal is along `axis`.
    fn bounce(&mut self, axis: usize) {
        let across = -BOUNCE[0] * self.velocity[axis];
        self.velocity *= BOUNCE[1];
        self.velocity[axis] = if across.abs() < LIES { 0.0 } else { across };
    }

    /// Opacity: 1, fading to 0 in the last 0.7 s.
    pub fn strength(&self) -> f32 {
        (self.left / 0.7).clamp(0.0, 1.0)
    }
}

/// Particles, confetti, and the reactions of bodies to recent events.
#[derive(Clone, Debug)]
pub struct Effects {
    /// Dust particles.
    pub specks: Vec<DustParticle>,
    /// Confetti after a win.
    pub confetti: Confetti,
    /// Feeling of each body (expression and position of its drawn face), in the order of the world's bodies.
    pub feelings: Vec<Feeling>,
    /// The bodies, in the same order.
    bodies: Vec<SoftBodyHandle>,
    /// Mass of each body's largest piece at the start of a replay that was wound [kg]. Otherwise empty.
    start_masses: Vec<f32>,
    /// Contact force between hands and each body [N], smoothed over some ticks.
    pressures: Vec<f32>,
    /// Opacity of the start hint, 0 to 1.
    pub hint: f32,
    /// Position of the first hand at the start [m].
    start: Option<Vec3>,
    has_moved: bool,
    /// Time for which the start hint is shown again [s].
    reminder: f32,
    has_won: bool,
    /// Last tick that was processed.
    tick: u64,
    /// Gravity [m/s²].
    gravity: Vec3,
    /// Lower and upper corner of the arena [m].
    room: [Vec3; 2],
    /// Number of axes along which particles move: 2 or 3.
    axes: usize,
    random: fastrand::Rng,
}

impl Default for Effects {
    fn default() -> Self {
        Self {
            specks: Vec::new(),
            confetti: Confetti::default(),
            feelings: Vec::new(),
            bodies: Vec::new(),
            start_masses: Vec::new(),
            pressures: Vec::new(),
            hint: 0.0,
            start: None,
            has_moved: false,
            reminder: 0.0,
            has_won: false,
            tick: 0,
            gravity: Vec3::ZERO,
            room: [Vec3::splat(-1.0e9), Vec3::splat(1.0e9)],
            axes: 2,
            random: fastrand::Rng::with_seed(1),
        }
    }
}

impl Effects {
    /// Creates the effects of a replay that was wound. A body that has lost a large part of itself since `start`,
    /// the start of the replay, is sad.
    pub fn resumed(start: &AnyRound) -> Self {
        Self {
            start_masses: match start {
                AnyRound::Plane(round) => largest_masses(round),
                AnyRound::Space(round) => largest_masses(round),
            },
            ..Self::default()
        }
    }

    /// Processes the events of a tick. `still` selects reduced motion: fewer particles, no confetti.
    pub fn process_tick(&mut self, round: &AnyRound, camera: &mut CameraRig, still: bool) {
        match round {
            AnyRound::Plane(round) => self.look_at(round, camera, still),
            AnyRound::Space(round) => self.look_at(round, camera, still),
        }
    }

    /// Adapts to bodies that were added or removed in a playground. The others keep their feelings.
    fn follow_bodies<D: Dim>(
        &mut self,
        round: &Round<D>,
        camera: &CameraRig,
        handles: Vec<SoftBodyHandle>,
    ) {
        let eye = (D::N == 3).then(|| camera.eye(round.level().arena()));
        let known = |handle: &SoftBodyHandle| self.bodies.iter().position(|known| known == handle);
        let known: Vec<Option<usize>> = handles.iter().map(known).collect();
        let bodies = known.iter().zip(&handles).enumerate();
        let feelings = bodies.map(|(place, (known, &handle))| match known {
            Some(index) => self.feelings[*index].clone(),
            None => Feeling::new(&round.world()[handle], eye, round.level().is_drawing(place)),
        });
        self.feelings = feelings.collect();
        let pressures = known
            .iter()
            .map(|known| known.map_or(0.0, |index| self.pressures[index]));
        self.pressures = pressures.collect();
        self.bodies = handles;
    }

    fn look_at<D: Dim>(&mut self, round: &Round<D>, camera: &mut CameraRig, still: bool) {
        let world = round.world();
        let bodies = world.soft_bodies();
        let handles: Vec<SoftBodyHandle> = bodies.clone().map(|(body, _)| body).collect();
        let is_new = world.ticks() <= self.tick || self.bodies.is_empty();
        if is_new {
            // A new round has begun, or time runs back, so all effects restart.
            let eye = (D::N == 3).then(|| camera.eye(round.level().arena()));
            let masses = std::mem::take(&mut self.start_masses);
            let mut masses = masses.into_iter();
            let feeling = |(place, (_, body)): (usize, (_, &SoftBody<D>))| {
                let feeling = Feeling::new(body, eye, round.level().is_drawing(place));
                match masses.next() {
                    Some(mass) => feeling.since(body, mass),
                    None => feeling,
                }
            };
            *self = Self {
                pressures: vec![0.0; bodies.clone().count()],
                feelings: bodies.enumerate().map(feeling).collect(),
                room: round.level().arena(),
                axes: D::N,
                reminder: self.reminder,
                bodies: handles,
                ..Self::default()
            };
        } else if handles != self.bodies {
            self.follow_bodies(round, camera, handles);
        }
        self.gravity = world.config().gravity.to_vec3();
        self.tick = world.ticks();
        let mut pressed = vec![0.0f32; self.feelings.len()];
        let mut material = 1;
        let mut looked_up = 0;
        let follows_target = |rigid| {
            let rigid = world.rigid_body(rigid);
            rigid.is_ok_and(is_hand)
        };
        let mut torn: Vec<Option<Vec3>> = vec![None; self.feelings.len()];
        let rank_of = |body| {
            let rank = world.soft_bodies().position(|(id, _)| id == body);
            rank.expect("the event names a body of this world")
        };
        for event in world.events() {
            match *event {
                Event::NodeSplit {
                    body,
                    point,
                    energy,
                } => {
                    let rank = rank_of(body);
                    let face = self.feelings[rank].at;
                    let at = point.to_vec3();
                    let is_nearer = |known: Vec3| (at - face).length() < (known - face).length();
                    if torn[rank].is_none_or(is_nearer) {
                        torn[rank] = Some(at);
                    }
                    camera.shake(0.002 + 0.002 * energy.clamp(0.0, 2.0));
                    if looked_up < LOOKED_UP {
                        looked_up += 1;
                        let grids = round.level().tint_grids::<D>();
                        let grid = grids.get(rank).and_then(Option::as_ref);
                        let body = &world[body];
                        material = material_at(body, grid.unwrap_or(body.grid()), point);
                    }
                    let count = if still { 1 } else { DUST };
                    (0..count).for_each(|_| self.spawn_dust(point.to_vec3(), material));
                }
                Event::ContactForce(Contact {
                    pair: [ObjectRef::Piece { body, .. }, ObjectRef::RigidBody(rigid)],
                    impulse,
                    ..
                }) if follows_target(rigid) => {
                    pressed[rank_of(body)] += impulse / fuwafuwa::DEFAULT_TICK;
                }
                _ => {}
            }
        }
        for (pressure, pressed) in self.pressures.iter_mut().zip(pressed) {
            *pressure += 0.2 * (pressed - *pressure);
        }
        self.watch_hand(round);
        self.celebrate(round, still);
        let progress = round.progress();
        let is_in = progress.outcome.is_some() || progress.held > 0.2;
        let events = torn.into_iter().zip(&self.pressures);
        let bodies = self.feelings.iter_mut().zip(world.soft_bodies());
        for ((feeling, (_, body)), (torn, pressure)) in bodies.zip(events) {
            let middle = D::Vector::from_vec3(feeling.middle);
            let in_basket = |basket: &Basket<D>| basket.region.distance(middle).0 < 0.0;
            let fate = MoodInput {
                eye: (D::N == 3).then(|| camera.eye(self.room)),
                tick: world.ticks(),
                torn,
                pressed: *pressure > HURTS,
                is_in_basket: is_in && round.baskets().iter().any(in_basket),
            };
            feeling.update(body, fate);
        }
    }

    /// Total contact force between hands and bodies [N], smoothed over some ticks.
    pub fn pressure(&self) -> f32 {
        self.pressures.iter().sum()
    }

    /// Shows the start hint again for some seconds, to a player who is stuck.
    pub fn remind(&mut self) {
        self.reminder = REMINDER;
    }

    /// Whether the start hint is shown again because the player is stuck.
    pub fn is_reminding(&self) -> bool {
        self.reminder > 0.0
    }

    /// Advances particles, confetti and the start hint by `seconds`.
    pub fn advance(&mut self, seconds: f32) {
        let [low, high] = self.room;
        for speck in &mut self.specks {
            speck.left -= seconds;
            let slower = (1.0 - DRAG * seconds).max(0.0);
            for axis in 0..self.axes {
                speck.velocity[axis] *= slower;
                speck.velocity[axis] += self.gravity[axis] * seconds;
                speck.at[axis] += speck.velocity[axis] * seconds;
                let (first, last) = (low[axis] + speck.radius, high[axis] - speck.radius);
                let (is_low, is_high) = (speck.at[axis] < first, speck.at[axis] > last);
                if is_low || is_high {
                    // Not `clamp`, which panics in a room that is narrower than the particle.
                    speck.at[axis] = speck.at[axis].min(last).max(first);
                    let outward = speck.velocity[axis];
                    // A particle created at a wall may already be moving away from it.
                    if is_low && outward < 0.0 || is_high && outward > 0.0 {
                        speck.bounce(axis);
                    }
                }
            }
        }
        self.specks.retain(|speck| speck.left > 0.0);
        self.confetti.pass(seconds);
        self.reminder = (self.reminder - seconds).max(0.0);
        let is_hidden = self.has_moved && self.reminder == 0.0;
        let (wish, pace) = if is_hidden { (0.0, 3.0) } else { (1.0, 1.2) };
        let step = (pace * seconds).min(1.0);
        self.hint += (wish - self.hint).clamp(-step, step);
    }

    fn watch_hand<D: Dim>(&mut self, round: &Round<D>) {
        let Some(hand) = round.hands().next() else {
            return;
        };
        let hand = hand.position().to_vec3();
        let start = *self.start.get_or_insert(hand);
        self.has_moved |= (hand - start).length() > MOVED;
    }

    fn celebrate<D: Dim>(&mut self, round: &Round<D>, still: bool) {
        if round.progress().outcome.is_none() || self.has_won {
            return;
        }
        self.has_won = true;
        if !still {
            self.confetti.rain(self.room, &mut self.random);
        }
    }

    fn spawn_dust(&mut self, at: Vec3, material: u8) {
        if self.specks.len() >= MOST {
            self.specks.swap_remove(0);
        }
        let mut any = |low: f32, high: f32| low + (high - low) * self.random.f32();
        let depth = if self.axes == 3 { any(-0.9, 0.9) } else { 0.0 };
        let thrown = self.gravity * -THROWN;
        let velocity = Vec3::new(any(-0.9, 0.9), any(-0.9, 0.9), depth);
        // The cube of `size` favours small particles.
        let size = any(0.0, 1.0);
        let speck = DustParticle {
            at,
            velocity: velocity + thrown,
            left: any(1.5, 5.0),
            radius: 0.004 + 0.016 * size * size * size,
            material,
            is_fresh: any(0.0, 1.0) < 0.4,
        };
        self.specks.push(speck);
    }
}

/// Returns the mass of the largest piece of each body [kg].
fn largest_masses<D: Dim>(round: &Round<D>) -> Vec<f32> {
    let bodies = round.world().soft_bodies();
    bodies.map(|(_, body)| largest_mass(body)).collect()
}

/// Returns the number in `grid` at the node of `body` nearest to `at` [m]. `grid` is that of the body, or has its
/// tints.
fn material_at<D: Dim>(body: &SoftBody<D>, grid: &VoxelGrid<D>, at: D::Vector) -> u8 {
    let mesh = body.mesh();
    let square = |id: NodeId| {
        let position = body.node_state(id).0;
        (0..D::N)
            .map(|axis| (position[axis] - at[axis]).powi(2))
            .sum::<f32>()
    };
    let nearest = mesh
        .nodes()
        .map(|(id, _)| (square(id), id))
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let element = nearest.and_then(|(_, id)| mesh.carriers_of(id).next());
    element.map_or(1, |(element, _)| grid.material(mesh.first_voxel(element)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use tamaire_play::{InputFrame, Level};

    fn round(level: &str) -> AnyRound {
        AnyRound::new(Arc::new(Level::open(level).expect("the level is built in")))
    }

    #[test]
    fn hint_fades_when_hand_moves_and_returns_in_new_round() {
        let (mut effects, mut camera) = (Effects::default(), CameraRig::default());
        let mut play = |round: &mut AnyRound, effects: &mut Effects, frame, ticks: usize| {
            for _ in 0..ticks {
                round.step(frame);
                effects.process_tick(round, &mut camera, false);
                effects.advance(fuwafuwa::DEFAULT_TICK);
            }
        };
        let mut first = round("classic");
        play(&mut first, &mut effects, InputFrame::default(), 60);
        assert_eq!(effects.hint, 1.0);
        let away = InputFrame::towards(Vec3::new(-1.4, 0.6, 0.0));
        play(&mut first, &mut effects, away, 60);
        assert_eq!(effects.hint, 0.0);
        play(
            &mut round("classic"),
            &mut effects,
            InputFrame::default(),
            60,
        );
        assert_eq!(effects.hint, 1.0);
        // A player who is stuck sees the hint again for a while.
        let mut second = round("classic");
        play(&mut second, &mut effects, away, 60);
        assert_eq!(effects.hint, 0.0);
        effects.remind();
        play(&mut second, &mut effects, away, 120);
        assert_eq!((effects.hint, effects.is_reminding()), (1.0, true));
        play(&mut second, &mut effects, away, 600);
        assert_eq!((effects.hint, effects.is_reminding()), (0.0, false));
    }

    #[test]
    fn dust_falls_to_the_floor_and_stays() {
        let mut effects = Effects {
            gravity: Vec3::new(0.0, -5.0, 0.0),
            room: [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, 1.0, 0.0)],
            ..Effects::default()
        };
        effects.spawn_dust(Vec3::ZERO, 2);
        effects.specks[0].left = 9.0;
        (0..300).for_each(|_| effects.advance(0.02));
        let speck = effects.specks[0];
        assert!((speck.at[1] + 1.0 - speck.radius).abs() < 1e-3, "{speck:?}");
        assert_eq!(speck.material, 2);
        (0..300).for_each(|_| effects.advance(0.02));
        assert!(effects.specks.is_empty());
    }

    #[test]
    fn dust_has_material_of_torn_body() {
        let AnyRound::Plane(round) = round("twins") else {
            panic!("the level is 2D")
        };
        let materials = round.world().soft_bodies().map(|(_, body)| {
            let middle = body.piece_views()[0].centre;
            material_at(body, body.grid(), middle.truncate())
        });
        assert_eq!(materials.collect::<Vec<_>>(), [1, 2]);
    }
}

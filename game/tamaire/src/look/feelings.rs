//! Feelings of a body, and the position of its drawn face.

use super::Mood;
use super::face_anchor::{FaceAnchor, UPRIGHT, largest, masses, square};
use fuwafuwa::{DEFAULT_TICK, Dim, DimVector, NodeId, PieceId, SoftBody, Vec3};
use fuwafuwa_render::anchor;

/// Duration of the shocked expression after a tear [s]. A body that is still being torn afterwards winces.
const SHOCK: f32 = 0.6;
/// Time without a tear after which a new tear causes the shocked expression again [s].
const CALMED: f32 = 0.5;
/// Thresholds of a body's mean strain, without the strain from its own weight. The body winces from the first
/// threshold until its strain is below the second.
const HURTS: [f32; 2] = [0.065, 0.045];
/// Mean speed of the nodes of a piece below which the piece counts as still [m/s].
const STILL: f32 = 0.06;
/// Time after which a still body that no hand presses is calm, whatever its strain [s].
const SETTLED: f32 = 0.6;
/// Distance of a tear from the centre of a drawn face, in sizes of the face, up to which the face is torn.
const REGION: f32 = 1.3;
/// Share of its largest piece that a body may lose before it is sad.
const LOST: f32 = 0.25;
/// Interval at which the strain of a body and the position of its drawn face are evaluated [ticks].
const LOOK: u64 = 5;
/// Difference in depth by which another node must exceed the node that carries a 2D drawn face, before the
/// face moves there [voxels].
const LAZY: f32 = 2.0;
/// Maximum number of distances computed in the search for a node that carries the drawn face.
const MOST_LOOKS: usize = 4_000_000;
/// Maximum number of elements sampled for the mean strain.
const MOST_ELEMENTS: usize = 1500;
/// Minimum size of a drawn face [m]. Smaller faces would be unreadable and are hidden.
const LEAST: f32 = 0.03;
/// Rate at which a drawn face moves to a new place [1/s].
const GLIDE: f32 = 7.0;
/// Rate at which a drawn face changes its size [1/s].
const GROW: f32 = 6.0;
/// Rate at which a drawn face turns [1/s].
const TURN: f32 = 25.0;

/// Feelings of a body, and the position of its drawn face.
#[derive(Clone, Debug)]
pub struct Feeling {
    /// Expression of the body's drawn face.
    pub mood: Mood,
    /// Time since the expression last changed [s].
    pub age: f32,
    /// Centre of the drawn face [m]. In 3D the centre is inside the body.
    pub at: Vec3,
    /// Approximate centre of the piece that carries the drawn face [m].
    pub middle: Vec3,
    /// Unit axes of the drawn face: to the right as seen, up, and outwards.
    pub axes: [Vec3; 3],
    /// About half the width of the drawn face [m]; 0 if the body has crumbled to dust.
    pub size: f32,
    /// Piece that carries the drawn face.
    pub piece: PieceId,
    /// In 3D: anchor of the drawn face on the skin.
    anchor: Option<FaceAnchor>,
    seat: Option<Seat>,
    /// Whether the body is a drawing, with its face in the upper half.
    is_drawing: bool,
    /// In 2D: offset from the seat to the current position of the drawn face [m]. The offset decays to zero.
    seat_offset: Vec3,
    strain: f32,
    /// Mean strain when the body last lay still, which comes from its own weight.
    weight_strain: f32,
    /// Whether the body lies still, as seen last.
    is_still: bool,
    /// Time for which the body has lain still and no hand has pressed it [s].
    settled: f32,
    /// Mass of the largest piece at the start [kg].
    whole: f32,
    /// Whether the body is sad for good: it was torn near its drawn face, or it has lost a large part.
    is_scarred: bool,
    shock: f32,
    /// Time since the last tear [s].
    seconds_since_tear: f32,
}

/// Seat of a 2D drawn face: a node deep inside the largest piece.
#[derive(Copy, Clone, Debug, PartialEq)]
struct Seat {
    node: NodeId,
    /// Rest position of the seat's node. A node with this index at another rest position is a different node.
    rest: [i32; 3],
    /// Distance of the seat from the skin in the rest shape [voxels].
    depth: f32,
}

/// Input of [`Feeling::update`] for a tick.
#[derive(Copy, Clone, Debug, Default)]
pub struct MoodInput {
    /// Tick number.
    pub tick: u64,
    /// Position of a tear of the body in this tick that is nearest to its drawn face [m].
    pub torn: Option<Vec3>,
    /// Whether a hand presses hard.
    pub pressed: bool,
    /// Whether the body is in the basket.
    pub is_in_basket: bool,
    /// In 3D: camera position [m].
    pub eye: Option<Vec3>,
}

impl Feeling {
    /// Creates the feeling of an undisturbed body. In 3D the drawn face is turned towards `eye` [m], if
    /// given. In 2D the drawn face of a drawing sits in the deepest place of the upper half, where the head
    /// usually is; other bodies have it near their centre.
    pub fn new<D: Dim>(body: &SoftBody<D>, eye: Option<Vec3>, is_drawing: bool) -> Self {
        let mut feeling = Self {
            mood: Mood::Calm,
            age: 9.0,
            at: Vec3::ZERO,
            axes: UPRIGHT,
            size: 0.0,
            piece: PieceId(0),
            middle: Vec3::ZERO,
            anchor: (D::N == 3).then(|| FaceAnchor::new(body, eye)),
            seat: None,
            is_drawing,
            seat_offset: Vec3::ZERO,
            strain: 0.0,
            weight_strain: 0.0,
            is_still: false,
            settled: 0.0,
            whole: largest_mass(body),
            is_scarred: false,
            shock: 0.0,
            seconds_since_tear: CALMED,
        };
        match feeling.anchor.is_some() {
            true => feeling.stick(),
            false => feeling.sit(body, 1.0e9),
        }
        feeling
    }

    /// Returns the feeling of a body whose largest piece had the mass `whole` [kg] at the start of the round.
    pub(super) fn since<D: Dim>(mut self, body: &SoftBody<D>, whole: f32) -> Self {
        self.whole = whole;
        self.is_scarred = self.has_lost_much(body);
        self
    }

    /// Whether the largest piece of the body has lost a large part.
    fn has_lost_much<D: Dim>(&self, body: &SoftBody<D>) -> bool {
        largest_mass(body) < (1.0 - LOST) * self.whole
    }

    /// Advances the feeling and the drawn face by one tick.
    pub fn update<D: Dim>(&mut self, body: &SoftBody<D>, fate: MoodInput) {
        if fate.tick.is_multiple_of(LOOK) {
            (self.strain, self.is_still) = (strain(body), mean_speed(body) < STILL);
            self.is_scarred |= self.has_lost_much(body);
        }
        self.is_scarred |=
            { fate.torn }.is_some_and(|at| (at - self.at).length() < REGION * self.size);
        let looks = fate.tick.is_multiple_of(LOOK);
        if let Some(anchor) = &mut self.anchor {
            anchor.follow(body, fate.eye, looks, DEFAULT_TICK);
            self.stick();
        } else {
            if looks || !self.seat.is_some_and(|seat| is_there(body, seat)) {
                self.choose_seat(body);
            }
            self.sit(body, DEFAULT_TICK);
        }
        self.feel(fate);
    }

    /// In 3D: copies position, axes and size of the drawn face from its anchor on the skin.
    fn stick(&mut self) {
        if let Some(anchor) = &self.anchor {
            (self.at, self.axes, self.piece) = (anchor.at, anchor.axes, anchor.piece);
            self.middle = anchor.middle;
            self.size = if anchor.size < LEAST {
                0.0
            } else {
                anchor.size
            };
        }
    }

    fn feel(&mut self, fate: MoodInput) {
        self.age += DEFAULT_TICK;
        self.shock = (self.shock - DEFAULT_TICK).max(0.0);
        self.settled = match self.is_still && !fate.pressed {
            true => self.settled + DEFAULT_TICK,
            false => 0.0,
        };
        let is_settled = self.settled > SETTLED;
        if is_settled {
            self.weight_strain = self.strain;
        }
        if fate.torn.is_some() {
            if self.seconds_since_tear >= CALMED {
                self.shock = SHOCK;
            }
            self.seconds_since_tear = 0.0;
        }
        self.seconds_since_tear += DEFAULT_TICK;
        let limit = HURTS[usize::from(self.mood == Mood::Wince)];
        let is_strained = !is_settled && self.strain - self.weight_strain > limit;
        let hurts = fate.pressed || is_strained || self.seconds_since_tear < CALMED;
        let mood = match () {
            () if fate.is_in_basket => Mood::Beam,
            () if self.shock > 0.0 => Mood::Shock,
            () if hurts => Mood::Wince,
            () if self.is_scarred => Mood::Sad,
            () => Mood::Calm,
        };
        // A mood lasts at least 0.25 s, so that it can be read.
        let is_urgent = matches!(mood, Mood::Beam | Mood::Shock);
        if mood != self.mood && (is_urgent || self.age > 0.25) {
            (self.mood, self.age) = (mood, 0.0);
        }
    }

    /// In 2D: moves the drawn face smoothly towards its seat.
    fn sit<D: Dim>(&mut self, body: &SoftBody<D>, seconds: f32) {
        if self.seat.is_none() {
            self.choose_seat(body);
        }
        let frame = anchor(body);
        let share = |pace: f32| (pace * seconds).min(1.0);
        let Some(seat) = self.seat else {
            self.size -= self.size * share(GROW);
            return;
        };
        let at = body.node_state(seat.node).0.to_vec3();
        self.seat_offset -= self.seat_offset * share(GLIDE);
        self.at = at + self.seat_offset;
        self.middle = self.at;
        self.piece = body.pieces().of_node(seat.node);
        let turned = [0, 1, 2].map(|k| self.axes[k] + (frame.axes[k] - self.axes[k]) * share(TURN));
        // Interpolating across half a turn gives axes of almost zero length, so the drawn face then turns at
        // once.
        self.axes = match turned[2].length().min(turned[1].length()) > 0.1 {
            true => square(turned),
            false => frame.axes,
        };
        let room = 1.1 * seat.depth * body.grid().voxel_size();
        let size = (0.55 * frame.scale).min(room);
        let size = if size < LEAST { 0.0 } else { size };
        self.size += (size - self.size) * share(GROW);
    }

    /// Searches for a better seat. The drawn face glides there from its current position.
    fn choose_seat<D: Dim>(&mut self, body: &SoftBody<D>) {
        let before = self.seat.filter(|&seat| is_there(body, seat));
        let after = best_seat(body, before.map(|seat| seat.node), self.is_drawing);
        if let (Some(old), Some(new)) = (self.seat, after)
            && old.node != new.node
        {
            let at = body.node_state(new.node).0.to_vec3();
            self.seat_offset = self.at - at;
        }
        self.seat = after;
    }
}

fn is_there<D: Dim>(body: &SoftBody<D>, seat: Seat) -> bool {
    let mesh = body.mesh();
    seat.node.index() < mesh.node_capacity()
        && mesh.is_alive(seat.node)
        && mesh.node(seat.node).at == seat.rest
}

/// Returns the piece with the largest mass.
fn largest_piece<D: Dim>(body: &SoftBody<D>) -> PieceId {
    largest(&masses(body))
}

/// Returns the best seat of a 2D drawn face: the node of the largest piece that is deepest inside and near
/// the centre, or for a drawing deepest in the upper half at rest. The current node `now` is kept unless another
/// one is clearly better.
fn best_seat<D: Dim>(body: &SoftBody<D>, now: Option<NodeId>, is_drawing: bool) -> Option<Seat> {
    let (mesh, pieces) = (body.mesh(), body.pieces());
    let piece = largest_piece(body);
    let own = || mesh.nodes().filter(|&(id, _)| pieces.of_node(id) == piece);
    let heights = || own().map(|(_, node)| node.at[1]);
    let half = (heights().min().unwrap_or(0) + heights().max().unwrap_or(0)) / 2;
    let is_seat = |at: [i32; 3]| !is_drawing || at[1] >= half;
    let skin: Vec<[i32; 3]> = body
        .facets()
        .filter(|facet| facet.piece == piece)
        .map(|facet| mesh.node(facet.nodes[0]).at)
        .collect();
    let (mut sum, mut count) = (Vec3::ZERO, 0.0f32);
    for (id, node) in own() {
        let mass = body.node_state(id).2;
        sum += Vec3::from(node.at.map(|k| k as f32)) * mass;
        count += mass;
    }
    let middle = sum / count.max(1e-9);
    let mut best: Option<(f32, Seat)> = None;
    // Stride that limits the number of distances in large bodies.
    let seats = || own().filter(|(_, node)| is_seat(node.at));
    let stride = 1 + seats().count() * skin.len() / MOST_LOOKS;
    let seated = now.and_then(|now| seats().find(|(id, _)| *id == now));
    for (id, node) in seated.into_iter().chain(seats().step_by(stride)) {
        let rest = node.at;
        let away = Vec3::from(rest.map(|k| k as f32)) - middle;
        let lazy = if now == Some(id) { LAZY } else { 0.0 };
        // Prefers nodes above the centre, so that a ring has its drawn face at the top.
        let bonus = match is_drawing {
            true => lazy - 0.05 * away.x.abs(),
            false => lazy - 0.3 * away.length() + 0.05 * away.y,
        };
        // Stops early once this node cannot win any more, because the search runs often.
        let enough = best.map_or(0.0, |(score, _)| (score - bonus).max(0.0));
        let mut depth = f32::MAX;
        for at in &skin {
            let apart = [0, 1, 2].map(|axis| (at[axis] - rest[axis]) as f32);
            depth = depth.min(Vec3::from(apart).length());
            if depth < enough {
                break;
            }
        }
        if best.is_none_or(|(score, _)| depth + bonus > score) {
            let node = id;
            best = Some((depth + bonus, Seat { node, rest, depth }));
        }
    }
    best.map(|(_, seat)| seat)
}

/// Returns the mass of the largest piece [kg].
pub(super) fn largest_mass<D: Dim>(body: &SoftBody<D>) -> f32 {
    masses(body).iter().copied().fold(0.0, f32::max)
}

/// Returns the mean speed of the nodes of the largest piece [m/s].
fn mean_speed<D: Dim>(body: &SoftBody<D>) -> f32 {
    let piece = largest_piece(body);
    let nodes = body.mesh().nodes();
    let own = nodes.filter(|&(id, _)| body.pieces().of_node(id) == piece);
    let (sum, mass) = own.fold((0.0, 0.0), |(sum, all), (id, _)| {
        let (_, velocity, mass) = body.node_state(id);
        (sum + mass * velocity.to_vec3().length(), all + mass)
    });
    sum / mass.max(1e-9)
}

/// Mean strain of the largest piece, weighted by volume. In a large piece only some of the elements are
/// sampled.
fn strain<D: Dim>(body: &SoftBody<D>) -> f32 {
    let piece = largest_piece(body);
    let (mut sum, mut volume) = (0.0, 0.0);
    let own = || {
        let elements = body.mesh().elements();
        elements.filter(|&(id, _)| body.pieces().of_element(id) == piece)
    };
    let stride = 1 + own().count() / MOST_ELEMENTS;
    for (id, element) in own().step_by(stride) {
        let share = (D::CORNERS as f32).powi(i32::from(element.cell.level));
        sum += share * body.strain(id).unwrap_or(0.0);
        volume += share;
    }
    if volume > 0.0 { sum / volume } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::{
        Blade, Dim2, Dim3, Material, SoftBodyHandle, Vec2, VoxelGrid, World, WorldConfig,
    };

    fn alone<D: Dim>(grid: VoxelGrid<D>) -> (World<D>, SoftBodyHandle) {
        let mut world = World::new(WorldConfig::default()).expect("the defaults are valid");
        let body = SoftBody::new(grid, &[Material::default()]).expect("the defaults are valid");
        let body = world.add_soft_body(body).unwrap();
        (world, body)
    }

    #[test]
    fn face_of_ring_lies_on_ring() {
        let grid = VoxelGrid::<Dim2>::from_fn([48, 48, 1], 1.0 / 48.0, |[x, y, _]| {
            let from_middle = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) - Vec2::splat(24.0);
            u8::from((10.0..24.0).contains(&from_middle.length()))
        });
        let (world, body) = alone(grid.expect("the grid is valid"));
        let feeling = Feeling::new(&world[body], None, false);
        let radius = (feeling.at.truncate() - Vec2::splat(0.5)).length();
        assert!((0.25..0.45).contains(&radius), "{feeling:?}");
        assert!(
            feeling.at[1] > 0.7 && (0.1..0.2).contains(&feeling.size),
            "{feeling:?}"
        );
    }

    #[test]
    fn face_of_drawing_sits_in_its_head() {
        // A large belly with its centre at (24, 16) voxels, and above it a head of half its width at (24, 46).
        let grid = VoxelGrid::<Dim2>::from_fn([48, 56, 1], 1.0 / 48.0, |[x, y, _]| {
            let from = |y_of: f32| Vec2::new(x as f32 + 0.5 - 24.0, y as f32 + 0.5 - y_of).length();
            u8::from(
                from(16.0) < 16.0 || from(46.0) < 8.0 || x.abs_diff(24) < 3 && y < 40 && y > 16,
            )
        });
        let (world, body) = alone(grid.expect("the grid is valid"));
        let face = |is_drawing| {
            let feeling = Feeling::new(&world[body], None, is_drawing);
            (48.0 * feeling.at.truncate(), 48.0 * feeling.size)
        };
        let (at, size) = face(true);
        // Inside a head of this size, nodes are up to four voxels apart.
        assert!((at - Vec2::new(24.0, 46.0)).length() < 3.0, "{at}");
        assert!(
            (5.0..9.0).contains(&size),
            "the head has a radius of 8: {size}"
        );
        let (at, _) = face(false);
        assert!((at - Vec2::new(24.0, 16.0)).length() < 6.0, "{at}");
    }

    #[test]
    fn face_glides_to_remaining_piece_and_dust_has_none() {
        let grid = VoxelGrid::<Dim2>::ball(32, 1.0);
        let (mut world, body) = alone(grid.expect("the grid is valid"));
        let mut feeling = Feeling::new(&world[body], None, false);
        let (before, size) = (feeling.at, feeling.size);
        let blade = Blade::segment(Vec2::new(0.375, -1.0), Vec2::new(0.375, 2.0));
        world.cut(body, &blade).unwrap();
        let fate = MoodInput {
            tick: LOOK,
            ..MoodInput::default()
        };
        feeling.update(&world[body], fate);
        let step = feeling.at[0] - before[0];
        assert!(step.abs() < 0.03, "the face does not jump: {step}");
        for _ in 0..200 {
            feeling.update(&world[body], MoodInput::default());
        }
        assert!(feeling.at[0] > before[0] + 0.05 && feeling.size < size);
        let grid = VoxelGrid::<Dim2>::ball(4, 0.05);
        let (dust, body) = alone(grid.expect("the grid is valid"));
        assert_eq!(Feeling::new(&dust[body], None, false).size, 0.0);
    }

    #[test]
    fn face_3d_turns_with_body_and_returns_to_camera() {
        let grid = VoxelGrid::<Dim3>::ball(12, 1.0);
        let (mut world, soft) = alone(grid.expect("the grid is valid"));
        let mut feeling = Feeling::new(&world[soft], None, false);
        assert!(feeling.axes[2][2] > 0.99, "{feeling:?}");
        // Turns the body's back to the camera.
        let body = world.soft_body_mut(soft).unwrap();
        let ids: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
        for id in ids {
            let Vec3 { x, y, z } = body.node_state(id).0;
            let turned = Vec3::new(1.0 - x, y, 1.0 - z);
            body.set_node_state(id, turned, Vec3::ZERO).unwrap();
        }
        let mut see = |eye, ticks: usize| {
            let fate = MoodInput {
                eye,
                ..MoodInput::default()
            };
            (0..ticks).for_each(|_| feeling.update(&world[soft], fate));
            feeling.axes
        };
        let [_, up, out] = see(None, 60);
        assert!(out[2] < -0.99 && up[1] > 0.99, "{out:?}");
        let [_, up, out] = see(Some(Vec3::new(0.5, 0.0, 9.0)), 90);
        assert!(out[2] > 0.9 && up[1] > 0.9, "{out:?}");
    }

    #[test]
    fn tear_shocks_once_then_hurts() {
        let grid = VoxelGrid::<Dim2>::ball(16, 1.0);
        let (world, body) = alone(grid.expect("the grid is valid"));
        let body = &world[body];
        let mut feeling = Feeling::new(body, None, false);
        let torn = MoodInput {
            tick: 1,
            torn: Some(Vec3::splat(99.0)),
            ..MoodInput::default()
        };
        feeling.update(body, torn);
        assert_eq!(feeling.mood, Mood::Shock);
        (0..60).for_each(|_| feeling.update(body, torn));
        assert_eq!(feeling.mood, Mood::Wince);
        (0..60).for_each(|_| {
            feeling.update(
                body,
                MoodInput {
                    tick: 1,
                    ..MoodInput::default()
                },
            )
        });
        assert_eq!(feeling.mood, Mood::Calm);
        feeling.update(
            body,
            MoodInput {
                tick: 1,
                is_in_basket: true,
                ..MoodInput::default()
            },
        );
        assert_eq!(feeling.mood, Mood::Beam);
    }

    /// Returns the mood after `ticks` ticks with the same input.
    fn mood<D: Dim>(
        feeling: &mut Feeling,
        body: &SoftBody<D>,
        fate: MoodInput,
        ticks: usize,
    ) -> Mood {
        let fate = MoodInput { tick: LOOK, ..fate };
        (0..ticks).for_each(|_| feeling.update(body, fate));
        feeling.mood
    }

    #[test]
    fn strained_body_at_rest_is_calm_after_a_second() {
        let grid = VoxelGrid::<Dim2>::ball(16, 1.0);
        let (mut world, soft) = alone(grid.expect("the grid is valid"));
        let body = world.soft_body_mut(soft).unwrap();
        let ids: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
        let stretch = |world: &mut World<Dim2>, share: f32, velocity: Vec2| {
            let body = world.soft_body_mut(soft).unwrap();
            for &id in &ids {
                let at = body.node_state(id).0 * Vec2::new(share, 1.0 / share);
                body.set_node_state(id, at, velocity).unwrap();
            }
        };
        stretch(&mut world, 1.2, Vec2::X);
        let mut feeling = Feeling::new(&world[soft], None, false);
        let none = MoodInput::default();
        assert_eq!(
            mood(&mut feeling, &world[soft], none, 60),
            Mood::Wince,
            "moving"
        );
        stretch(&mut world, 1.0, Vec2::ZERO);
        assert_eq!(mood(&mut feeling, &world[soft], none, 60), Mood::Calm);
        let pressed = MoodInput {
            pressed: true,
            ..none
        };
        assert_eq!(mood(&mut feeling, &world[soft], pressed, 60), Mood::Wince);
        // The strain at rest does not hurt later, either.
        stretch(&mut world, 1.0, Vec2::X);
        assert_eq!(mood(&mut feeling, &world[soft], none, 60), Mood::Calm);
        stretch(&mut world, 1.2, Vec2::X);
        assert_eq!(mood(&mut feeling, &world[soft], none, 60), Mood::Wince);
    }

    #[test]
    fn body_halved_before_a_replay_was_wound_is_sad() {
        let (mut world, soft) = alone(VoxelGrid::<Dim2>::ball(16, 1.0).expect("the grid is valid"));
        let none = MoodInput::default();
        let whole = largest_mass(&world[soft]);
        let mut unharmed = Feeling::new(&world[soft], None, false).since(&world[soft], whole);
        assert_eq!(mood(&mut unharmed, &world[soft], none, 60), Mood::Calm);
        let blade = Blade::segment(Vec2::new(0.5, -1.0), Vec2::new(0.5, 2.0));
        world.cut(soft, &blade).unwrap();
        let mut halved = Feeling::new(&world[soft], None, false).since(&world[soft], whole);
        assert_eq!(mood(&mut halved, &world[soft], none, 60), Mood::Sad);
    }

    #[test]
    fn body_torn_at_its_face_or_halved_stays_sad() {
        let ball = || alone(VoxelGrid::<Dim2>::ball(16, 1.0).expect("the grid is valid"));
        let (mut world, soft) = ball();
        let none = MoodInput::default();
        let torn_at = |point: Vec3| MoodInput {
            torn: Some(point),
            ..none
        };
        let after = |feeling: &mut Feeling, fate, body: &SoftBody<Dim2>| {
            mood(feeling, body, fate, 1);
            mood(feeling, body, none, 200)
        };
        let mut feeling = Feeling::new(&world[soft], None, false);
        let (face, size) = (feeling.at, feeling.size);
        let aside = face + Vec3::new(2.0 * size, 0.0, 0.0);
        assert_eq!(
            after(&mut feeling, torn_at(aside), &world[soft]),
            Mood::Calm
        );
        let near = face + Vec3::new(0.5 * size, 0.0, 0.0);
        assert_eq!(after(&mut feeling, torn_at(near), &world[soft]), Mood::Sad);

        let mut feeling = Feeling::new(&world[soft], None, false);
        let blade = Blade::segment(Vec2::new(0.5, -1.0), Vec2::new(0.5, 2.0));
        world.cut(soft, &blade).unwrap();
        assert_eq!(mood(&mut feeling, &world[soft], none, 200), Mood::Sad);
        let beam = MoodInput {
            is_in_basket: true,
            ..none
        };
        assert_eq!(mood(&mut feeling, &world[soft], beam, 1), Mood::Beam);
    }
}

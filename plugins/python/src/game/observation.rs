//! The state of a round as numbers.

use fuwafuwa::{Dim, DimVector, PieceView, Vec3};
use tamaire_play::{Basket, Round};

/// Number of pieces in an observation, the heaviest first.
pub const PIECES: usize = 8;
const AXES: [&str; 3] = ["x", "y", "z"];

/// Returns the names of the numbers of an observation, in their order. [`observe`] fills in the numbers.
pub fn names(dim: usize, players: usize) -> Vec<String> {
    let mut names = Vec::new();
    let vector = |names: &mut Vec<String>, name: String| {
        names.extend(AXES[..dim].iter().map(|axis| format!("{name}_{axis}")));
    };
    for player in 0..players {
        for quantity in ["position", "velocity", "target_offset", "contact_force"] {
            vector(&mut names, format!("hand{player}_{quantity}"));
        }
    }
    vector(&mut names, "basket_low".into());
    vector(&mut names, "basket_high".into());
    let scalars = [
        "within",
        "inside",
        "kept",
        "held_share",
        "pieces",
        "mean_distance",
        "time_left",
    ];
    names.extend(scalars.map(String::from));
    for piece in 0..PIECES {
        names.push(format!("piece{piece}_mass"));
        for quantity in ["centre", "velocity", "low", "high"] {
            vector(&mut names, format!("piece{piece}_{quantity}"));
        }
    }
    names
}

/// Returns the observation of a round. `distance` is the mean distance of its mass from the basket [m], and `time_left`
/// the share of the time that is left, 0 to 1.
pub fn observe<D: Dim>(
    round: &Round<D>,
    players: usize,
    distance: f32,
    time_left: f32,
) -> Vec<f32> {
    let mut numbers = Vec::with_capacity(128);
    let vector = |numbers: &mut Vec<f32>, vector: Vec3| {
        numbers.extend_from_slice(&vector.to_array()[..D::N]);
    };
    let hands: Vec<_> = round.hands().take(players).collect();
    for hand in hands {
        let (position, target) = (hand.position().to_vec3(), hand.target_position().to_vec3());
        let forces = hand.reactions().map(|reaction| reaction.contact.to_vec3());
        let (sum, count) = forces.fold((Vec3::ZERO, 0.0_f32), |(sum, count), force| {
            (sum + force, count + 1.0)
        });
        vector(&mut numbers, position);
        vector(&mut numbers, hand.velocity().linear.to_vec3());
        vector(&mut numbers, target - position);
        vector(&mut numbers, sum / count.max(1.0));
    }
    let [low, high] = round.baskets()[0].region.bounds();
    vector(&mut numbers, low.to_vec3());
    vector(&mut numbers, high.to_vec3());
    let progress = round.progress();
    numbers.extend([
        progress.within,
        progress.inside,
        progress.kept,
        round.share_held(),
        progress.pieces as f32,
        distance,
        time_left,
    ]);
    let views = round.counted_bodies().flat_map(|body| body.piece_views());
    let mut views: Vec<PieceView> = views.filter(|view| !view.removed).collect();
    views.sort_by(|a, b| b.mass.total_cmp(&a.mass));
    for place in 0..PIECES {
        let Some(view) = views.get(place) else {
            numbers.extend(std::iter::repeat_n(0.0, 1 + 4 * D::N));
            continue;
        };
        numbers.push(view.mass / progress.mass);
        for part in [view.centre, view.velocity, view.low, view.high] {
            vector(&mut numbers, part);
        }
    }
    numbers
}

/// Returns the mean distance of the mass of the bodies from their basket [m]; mass in it has the distance 0. With
/// several baskets, that of a body is the nearest one for which it counts.
pub fn mean_distance<D: Dim>(round: &Round<D>) -> f32 {
    let (mut sum, mut total) = (0.0_f64, 0.0_f64);
    for (number, (_, body)) in (1..).zip(round.world().soft_bodies()) {
        let takes =
            |basket: &&Basket<D>| basket.bodies.is_empty() || basket.bodies.contains(&number);
        let regions: Vec<_> = round
            .baskets()
            .iter()
            .filter(takes)
            .map(|basket| &basket.region)
            .collect();
        if regions.is_empty() {
            continue;
        }
        for (id, _) in body.mesh().nodes() {
            let (position, _, mass) = body.node_state(id);
            let distances = regions
                .iter()
                .map(|region| region.distance(position).0.max(0.0));
            let distance = distances.fold(f32::INFINITY, f32::min);
            sum += f64::from(mass) * f64::from(distance);
            total += f64::from(mass);
        }
    }
    if total > 0.0 {
        (sum / total) as f32
    } else {
        0.0
    }
}

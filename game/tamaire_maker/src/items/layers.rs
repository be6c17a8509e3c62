//! What obstacles stop.

use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::LayersText;

/// Layer of everything that is in no other layer.
const BODIES: u32 = 1;

/// Layer of hands in a level with obstacles that stop only hands or only bodies.
const HANDS: u32 = 2;

/// Layers of everything whose text names none.
const USUAL: LayersText = LayersText {
    memberships: BODIES,
    filters: u32::MAX,
};

/// What an obstacle stops.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Stops {
    /// Hands and bodies.
    All,
    /// Hands only.
    Hands,
    /// Bodies only.
    Bodies,
}

/// Sets what an obstacle stops. For [`Stops::Hands`] and [`Stops::Bodies`], all hands move to the second layer. Changes
/// nothing if the scene does not have the obstacle.
pub fn set_stops(scene: &mut Scene, obstacle: usize, stops: Stops) {
    let Some(text) = scene.obstacle.get_mut(obstacle) else {
        return;
    };
    let filters = match stops {
        Stops::All => {
            text.layers = None;
            return;
        }
        Stops::Hands => HANDS,
        Stops::Bodies => BODIES,
    };
    text.layers = Some(LayersText {
        memberships: BODIES,
        filters,
    });
    for hand in &mut scene.hand {
        let layers = hand.layers.get_or_insert(USUAL);
        layers.memberships = layers.memberships & !BODIES | HANDS;
    }
}

/// Returns what an obstacle stops. `None` if it has other layers than those of [`set_stops`], or if the scene does not have
/// the obstacle.
pub fn stops_of(scene: &Scene, obstacle: usize) -> Option<Stops> {
    let layers = scene.obstacle.get(obstacle)?.layers.unwrap_or(USUAL);
    match (layers.memberships, layers.filters) {
        (BODIES, u32::MAX) => Some(Stops::All),
        (BODIES, HANDS) => Some(Stops::Hands),
        (BODIES, BODIES) => Some(Stops::Bodies),
        _ => None,
    }
}

//! What is heard: of a tick, and for as long as it lasts.

use super::{Game, Screen};
use fuwafuwa::{Dim, Event, Vector, With};
use tamaire_play::rules::CRUMB;
use tamaire_play::{AnyRound, Round};
use tamaire_sound::{Cue, Hush, Press, Soundscape};

/// What is slower than this is heard no more when it lands [m/s].
const LANDING: f32 = 0.3;

/// What there is to hear now.
pub(super) fn soundscape(game: &Game) -> Soundscape {
    let round = game.session.round();
    let arena = round.level().arena();
    let hold = round.level().game().hold.max(0.1);
    let mut presses = [Press::default(); 2];
    for (press, hand) in presses.iter_mut().zip(round.hands()) {
        let all = hand.reactions().iter();
        let force = all.map(|reaction| length(reaction.contact));
        let count = hand.reactions().len().max(1) as f32;
        *press = Press {
            force: force.sum::<f32>() / count,
            slip: length(hand.velocity()),
            x: across(arena, hand.position()[0]),
        };
    }
    Soundscape {
        presses,
        squash: (game.effects.pressure / 1000.0).min(1.0),
        hold: (round.progress().held / hold).min(1.0),
        music: true,
        hush: match game.screen {
            _ if game.is_away => Hush::Everything,
            Screen::Paused | Screen::Settings(_) | Screen::Forces(_) | Screen::Title => Hush::World,
            _ => Hush::Nothing,
        },
    }
}

/// What there is to hear of a tick.
pub(super) fn cues(round: &AnyRound) -> Vec<Cue> {
    match round {
        AnyRound::Plane(round) => cues_of(round),
        AnyRound::Space(round) => cues_of(round),
    }
}

fn cues_of<D: Dim>(round: &Round<D>) -> Vec<Cue> {
    let arena = round.level().arena();
    let bodies = round.world().bodies();
    // The masses of the pieces of each body, looked up once they are asked for [kg].
    let mut masses: Vec<Option<Vec<f32>>> = vec![None; bodies.len()];
    let mut mass_of = |body: u32, piece: u32| {
        let place = body as usize;
        let views = || bodies[place].piece_views().into_iter();
        let masses = masses[place].get_or_insert_with(|| views().map(|view| view.mass).collect());
        masses[piece as usize]
    };
    let mut cues = Vec::new();
    let (mut torn, mut at) = (0.0, 0.0);
    for event in round.world().events() {
        match *event {
            Event::Released {
                at: place, energy, ..
            } => {
                torn += energy.max(0.01);
                at = across(arena, place[0]);
            }
            Event::Touched {
                with: With::Obstacle(_),
                impulse,
                at: place,
                body,
                piece,
            } => {
                let x = across(arena, place[0]);
                let mass = mass_of(body, piece);
                let speed = impulse / mass;
                if mass > CRUMB * round.progress().mass {
                    cues.push(Cue::Thud { impulse, x });
                } else if speed > LANDING {
                    cues.push(Cue::Crumb { speed, x });
                }
            }
            _ => {}
        }
    }
    if torn > 0.0 {
        cues.push(Cue::Tear {
            energy: torn,
            x: at,
        });
    }
    cues
}

/// Where in the arena, from -1 at its left to 1 at its right.
fn across(arena: [Vector; 2], x: f32) -> f32 {
    let (low, high) = (arena[0][0], arena[1][0]);
    (2.0 * (x - low) / (high - low) - 1.0).clamp(-1.0, 1.0)
}

fn length(v: Vector) -> f32 {
    v.iter().map(|k| k * k).sum::<f32>().sqrt()
}

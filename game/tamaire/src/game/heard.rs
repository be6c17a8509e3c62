//! Sounds of the game: those that a tick triggers, and continuous ones.

use super::{Game, Screen};
use crate::journey::chapter_of;
use app_shell::View;
use fuwafuwa::{
    Contact, Dim, DimVector, Event, MotionType, ObjectRef, PieceId, SoftBodyHandle, Vec3,
};
use std::collections::BTreeMap;
use tamaire_play::rules::CRUMB;
use tamaire_play::{AnyRound, Round};
use tamaire_sound::{Cue, Mute, Press, Soundscape};

/// Speed below which the impact of a crumb is silent [m/s].
const LANDING: f32 = 0.3;

/// Returns the current continuous sounds.
pub(super) fn soundscape(game: &Game) -> Soundscape {
    let round = game.bout.round();
    let hold = round.level().game().hold.max(0.1);
    let mut presses = [Press::default(); 2];
    for (press, hand) in presses.iter_mut().zip(round.hands()) {
        let all = hand.reactions.iter();
        let force = all.map(|reaction| reaction.contact.length());
        let count = hand.reactions.len().max(1) as f32;
        *press = Press {
            force: force.sum::<f32>() / count,
            slip: hand.velocity.length(),
            x: across(game.bout.view, hand.position),
        };
    }
    Soundscape {
        presses,
        squash: (game.bout.effects.pressure() / 1000.0).min(1.0),
        hold: (round.progress().held / hold).min(1.0),
        rewind: game.bout.session.is_rewinding(),
        music: true,
        song: song(game),
        hush: match game.screen() {
            _ if game.is_away => Mute::Everything,
            Screen::Paused | Screen::Title => Mute::World,
            _ if !game.is_seen() => Mute::World,
            _ => Mute::Nothing,
        },
    }
}

/// Returns the song: each chapter of the path has its own.
fn song(game: &Game) -> u8 {
    let level = game.bout.round().level();
    let chapter = match game.screen() {
        Screen::Title | Screen::Ending => None,
        _ => chapter_of(level),
    };
    chapter.map_or(0, |chapter| chapter as u8)
}

/// Returns the sounds of the switches that were pressed or released since `before`, and updates it.
pub(super) fn switched(round: &AnyRound, before: &mut Vec<bool>, view: Option<View>) -> Vec<Cue> {
    match round {
        AnyRound::Plane(round) => switched_of(round, before, view),
        AnyRound::Space(round) => switched_of(round, before, view),
    }
}

fn switched_of<D: Dim>(round: &Round<D>, before: &mut Vec<bool>, view: Option<View>) -> Vec<Cue> {
    let switches: Vec<_> = round.machinery().switches().collect();
    before.resize(switches.len(), false);
    let changed = switches
        .into_iter()
        .zip(before)
        .filter(|((_, is_on), was_on)| is_on != *was_on);
    let heard = changed.map(|((region, is_on), was_on)| {
        *was_on = is_on;
        let [low, high] = region.bounds();
        let middle = (low.to_vec3() + high.to_vec3()) * 0.5;
        Cue::Switch {
            is_on,
            x: across(view, middle),
        }
    });
    heard.collect()
}

/// Returns the sounds of the last tick of a round. `view` gives their stereo position.
pub(super) fn cues(round: &AnyRound, view: Option<View>) -> Vec<Cue> {
    match round {
        AnyRound::Plane(round) => cues_of(round, view),
        AnyRound::Space(round) => cues_of(round, view),
    }
}

fn cues_of<D: Dim>(round: &Round<D>, view: Option<View>) -> Vec<Cue> {
    let world = round.world();
    // Masses of the pieces of each body [kg], computed when first used.
    let mut masses: BTreeMap<SoftBodyHandle, Vec<f32>> = BTreeMap::new();
    let mut mass_of = |body: SoftBodyHandle, piece: PieceId| {
        let views = || world[body].piece_views().into_iter();
        let masses = masses.entry(body);
        let masses = masses.or_insert_with(|| views().map(|view| view.mass).collect());
        masses[piece.index()]
    };
    let is_fixed = |rigid| {
        let rigid = world.rigid_body(rigid);
        rigid.is_ok_and(|rigid| rigid.motion_type() == MotionType::Fixed)
    };
    let mut cues = Vec::new();
    let (mut torn, mut at) = (0.0, 0.0);
    for event in world.events() {
        match *event {
            Event::NodeSplit { point, energy, .. } => {
                torn += energy.max(0.01);
                at = across(view, point.to_vec3());
            }
            Event::ContactForce(Contact {
                pair:
                    [
                        ObjectRef::Piece { body, piece },
                        ObjectRef::RigidBody(rigid),
                    ],
                point,
                impulse,
                ..
            }) if is_fixed(rigid) => {
                let x = across(view, point.to_vec3());
                let mass = mass_of(body, piece);
                let speed = impulse / mass;
                if mass > CRUMB * round.progress().mass {
                    cues.push(Cue::Thud { impulse, x });
                } else if speed > LANDING {
                    cues.push(Cue::Crumb { speed, x });
                }
            }
            // The joint is gone, and with it its position.
            Event::JointBroke { .. } => cues.push(Cue::Snap { x: 0.0 }),
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

/// Horizontal position on the screen, from -1 (left) to 1 (right). 0 before the first frame.
fn across(view: Option<View>, at: Vec3) -> f32 {
    view.map_or(0.0, |view| view.across(at))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::look::view_of_level;
    use crate::platform::{Files, Sound};
    use app_shell::Pads;
    use egui::{Rect, pos2};

    #[test]
    fn hand_sound_is_panned_to_position_on_screen() {
        let mut game = Game::new(Files::nowhere(), Sound::none(), Pads::none());
        let mut heard = |level: &str, turn: f32| {
            let mut levels = game.levels.iter();
            let index = levels.position(|known| known.id == level);
            game.start(index.expect("built-in level exists"));
            assert_eq!(soundscape(&game).presses[0].x, 0.0, "there is no view yet");
            game.bout.camera.orbit(turn, 0.0);
            let screen = Rect::from_min_max(pos2(0.0, 0.0), pos2(900.0, 600.0));
            game.bout.view = Some(view_of_level(
                &game.bout.camera,
                screen,
                game.bout.round().level(),
            ));
            soundscape(&game).presses[0].x
        };
        for level in ["classic", "classic-3d"] {
            let x = heard(level, 0.0);
            assert!((-1.0..-0.5).contains(&x), "{level}: {x}");
        }
        let behind = heard("classic-3d", std::f32::consts::PI);
        assert!(behind > 0.5, "{behind}");
        let before = heard("classic-3d", -std::f32::consts::FRAC_PI_2);
        assert!(before.abs() < 0.1, "{before}");
    }
}

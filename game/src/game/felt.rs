//! What is felt of a tick, and by whom.

use super::trial::{Outcome, Trial};
use super::{Game, Screen};
use force_feedback::{Manner, State, Stop};
use fuwafuwa::world::TICK;
use fuwafuwa::{Dim, Event, Manipulator, Vector, World};
use sticks::DeviceId;
use tamaire_play::{PLAYERS, Round};

/// A round has begun once it is so old [s]: until then hands are elsewhere.
const BEGUN: f32 = 0.1;
/// What one node that is released is felt like, and each further one adds.
const TEAR: f32 = 0.2;
const MORE: f32 = 0.05;

/// With what everything that a hand touches pushed it, averaged over the last tick [N].
pub fn contact(hand: &Manipulator) -> Vector {
    let all = hand.reactions();
    let mean = |axis: usize| {
        let sum: f32 = all.iter().map(|reaction| reaction.contact[axis]).sum();
        sum / all.len().max(1) as f32
    };
    [0, 1, 2].map(mean)
}

/// How strongly each player feels what tore in the last tick, 0 to 1: whoever's hand is nearest.
pub fn tears<D: Dim>(world: &World<D>) -> [f32; PLAYERS] {
    let mut counts = [0u32; PLAYERS];
    for event in world.events() {
        let Event::Released { at, .. } = *event else {
            continue;
        };
        let away = |hand: &Manipulator| {
            let square = |axis: usize| (hand.position()[axis] - at[axis]).powi(2);
            square(0) + square(1) + square(2)
        };
        let hands = world.manipulators().iter().take(PLAYERS).enumerate();
        let nearest = hands.min_by(|(_, a), (_, b)| away(a).total_cmp(&away(b)));
        if let Some((player, _)) = nearest {
            counts[player] += 1;
        }
    }
    counts.map(|count| match count {
        0 => 0.0,
        count => (TEAR + MORE * (count - 1) as f32).min(1.0),
    })
}

/// Why nobody feels anything in a round that goes on, if so.
pub fn silence<D: Dim>(round: &Round<D>) -> Option<Stop> {
    if round.progress().outcome.is_some() {
        return Some(Stop::Won);
    }
    ((round.world().ticks() as f32) < BEGUN / TICK).then_some(Stop::Reset)
}

impl Game {
    /// Tells devices what there is to feel, and those that feel nothing why.
    pub(super) fn feel(&mut self, seconds: f32) {
        self.pass_trial(seconds);
        let (settings, trial) = (&self.settings, &self.trial);
        self.forces
            .attend(&self.devices.sticks, &self.pads, |device| {
                let usual = settings.force(&device.about.guid)?;
                let tried = trial.as_ref().and_then(|trial| trial.settings(device.id));
                Some(tried.unwrap_or(usual))
            });
        let silence = self.silence();
        self.forces.tell(|id| match (trial, silence) {
            (Some(trial), _) => trial.state(id).ok_or(Stop::Menu),
            (None, Some(why)) => Err(why),
            (None, None) => self.state(id).ok_or(Stop::Idle),
        });
        if let Some((id, size)) = self.trial.as_mut().and_then(Trial::take_tear) {
            self.forces.tear(id, size);
        }
    }

    fn pass_trial(&mut self, seconds: f32) {
        let Some(trial) = &mut self.trial else {
            return;
        };
        let outcome = match self.is_away || self.forces.is_cut() {
            true => Outcome::Gone,
            false => trial.pass(&self.devices.sticks, seconds),
        };
        if outcome == Outcome::GoesOn {
            return;
        }
        let device = self.devices.sticks.device(trial.device);
        self.trial = None;
        match (outcome, device) {
            (Outcome::Known(Some(calibration)), Some(device)) => {
                let model = device.about.guid.clone();
                self.settings.calibrations.insert(model, calibration);
                self.keep_settings();
                self.notify(self.words().measured.to_string());
            }
            (Outcome::Known(None), _) => self.notify(self.words().not_measured.to_string()),
            _ => {}
        }
    }

    /// What the player who holds a device feels.
    fn state(&self, id: DeviceId) -> Option<State> {
        let player = (0..PLAYERS).find(|&player| self.players.held(player) == Some(id))?;
        let hands = self.session.round().world().manipulators();
        let [x, y, _] = contact(hands.get(player)?);
        let manner = match self.settings.stick_places {
            true => Manner::Places,
            false => Manner::Steers,
        };
        Some(State {
            contact: [x, y],
            manner,
        })
    }

    /// Why nobody feels anything now, if so.
    pub fn silence(&self) -> Option<Stop> {
        match self.screen {
            _ if self.is_away => Some(Stop::FocusLost),
            Screen::Play if !self.session.is_played() => Some(Stop::Idle),
            Screen::Play if self.stepping => Some(Stop::Paused),
            Screen::Play => silence(self.session.round()),
            Screen::Paused => Some(Stop::Paused),
            _ => Some(Stop::Menu),
        }
    }
}

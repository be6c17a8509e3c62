//! Tells devices what there is to feel.

use super::trial::{Outcome, Trial};
use super::{Game, Screen};
use crate::felt;
use force_feedback::{Manner, State, Stop};
use sticks::DeviceId;
use tamaire_play::PLAYERS;

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
        let hands = self.session.round().hands();
        let contact = felt::on_stick(felt::contact(hands.get(player)?), self.turn());
        let manner = match self.settings.stick_places {
            true => Manner::Places,
            false => Manner::Steers,
        };
        Some(State { contact, manner })
    }

    /// Why nobody feels anything now, if so.
    pub fn silence(&self) -> Option<Stop> {
        match self.screen {
            _ if self.is_away => Some(Stop::FocusLost),
            Screen::Play if !self.session.is_played() => Some(Stop::Idle),
            Screen::Play if self.stepping => Some(Stop::Paused),
            Screen::Play => felt::silence(self.session.round()),
            Screen::Paused => Some(Stop::Paused),
            _ => Some(Stop::Menu),
        }
    }
}

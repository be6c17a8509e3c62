//! Force feedback of a frame.

use super::trial::{Trial, TrialStatus};
use super::{Game, Screen};
use crate::haptics;
use crate::settings::FULL;
use app_shell::direction::to_user;
use force_feedback::{Ability, Calibration, State, StickMode, Stop};
use sticks::DeviceId;
use tamaire_play::PLAYERS;

/// Time without movement after which a device without force feedback stops rumbling [s].
const RESTED: f32 = 1.5;

/// Duration of the gentle movement by which an idle stick attracts visitors [s].
const CALL: f64 = 1.6;
/// Time from the start of one gentle movement of an idle stick to the start of the next [s].
const CALLS: f64 = 24.0;
/// Strength of the gentle movement of an idle stick, as a fraction of full force.
const GENTLE: f32 = 0.12;

impl Game {
    /// Sends force feedback to the devices. A device that gets none is given the reason.
    pub(super) fn drive_forces(&mut self, seconds: f32) {
        self.pass_trial(seconds);
        let (settings, trial) = (&self.settings, &self.trial);
        self.forces.attend(
            &self.controls.devices.sticks,
            &self.controls.pads,
            |device| {
                let usual = settings.force(&device.about.guid)?;
                let tried = trial.as_ref().and_then(|trial| trial.settings(device.id));
                Some(tried.unwrap_or(usual))
            },
        );
        let sticks = self.controls.devices.sticks.devices.iter();
        let pushing = sticks.map(|device| device.id).filter(|&id| {
            let report = self.forces.report(id);
            report.is_some_and(|report| report.ability == Ability::Force)
        });
        self.controls.devices.pushing = pushing.collect();
        let silence = self.silence();
        self.forces.tell(|id| match (trial, silence) {
            (Some(trial), _) => trial.state(id).ok_or(Stop::Menu),
            (None, Some(why)) => Err(why),
            (None, None) => self.state(id).ok_or(Stop::Idle),
        });
        if let Some((id, size)) = self.trial.as_mut().and_then(Trial::take_tear) {
            self.forces.tear(id, size);
        }
        self.forces.update();
    }

    fn pass_trial(&mut self, seconds: f32) {
        let Some(trial) = &mut self.trial else {
            return;
        };
        let is_held = self.forces.report(trial.device).is_some();
        let outcome = match self.is_away || !is_held || self.forces.is_cut() {
            true => TrialStatus::Gone,
            false => trial.pass(&self.controls.devices.sticks, seconds),
        };
        if outcome == TrialStatus::GoesOn {
            return;
        }
        let device = self.controls.devices.sticks.device(trial.device);
        self.trial = None;
        match (outcome, device) {
            (TrialStatus::Known(Some(found)), Some(device)) => {
                let known = self.settings.calibrations.entry(device.about.guid.clone());
                let known = known.or_default();
                // The measurement does not determine the gain of the device, so the previous gain is kept.
                let gain = known.gain;
                *known = Calibration { gain, ..found };
                self.keep_settings();
                self.notify(self.words().measured.to_string());
            }
            (TrialStatus::Known(None), _) => self.notify(self.words().not_measured.to_string()),
            _ => {}
        }
    }

    /// Returns the feedback for the player with this device.
    fn state(&self, id: DeviceId) -> Option<State> {
        if self.screen() == Screen::Title {
            return self.call();
        }
        let player =
            (0..PLAYERS).find(|&player| self.controls.players.device_of(player) == Some(id))?;
        let hands = self.bout.round().hands();
        let contact = to_user(self.bout.turn(), haptics::contact(hands.get(player)?));
        let pushes_back = self.controls.devices.pushing.contains(&id);
        // A pad that was put down stops rumbling, even if the hand still presses. A force-feedback stick is
        // excluded, since a player may hold it still.
        if !pushes_back && self.controls.players.idle_time(player) > RESTED {
            return None;
        }
        let manner = match self.settings.stick_places || pushes_back {
            true => StickMode::Position,
            false => StickMode::Velocity,
        };
        Some(State { contact, manner })
    }

    /// Returns the force that moves an idle stick in order to attract visitors. Once every `CALLS` seconds the
    /// stick moves in a slow circle; between the circles the result is `None`.
    fn call(&self) -> Option<State> {
        let share = self.time % CALLS / CALL;
        let (sin, cos) = (std::f64::consts::TAU * share).sin_cos();
        let swell = FULL * GENTLE * (std::f64::consts::PI * share).sin() as f32;
        (share < 1.0).then_some(State {
            contact: [swell * sin as f32, swell * cos as f32],
            manner: StickMode::OpenLoop,
        })
    }

    /// Whether the game moves idle sticks to attract visitors now, or did so a moment ago.
    pub fn is_calling(&self) -> bool {
        self.calls && self.time % CALLS < 2.0 * CALL
    }

    /// Returns the reason why no device gets feedback now, if any.
    pub fn silence(&self) -> Option<Stop> {
        match self.screen() {
            _ if self.is_away => Some(Stop::FocusLost),
            _ if self.public.as_ref().is_some_and(|public| public.is_left) => Some(Stop::Idle),
            Screen::Play if !self.bout.session.is_played() => Some(Stop::Idle),
            Screen::Play if self.bout.stepping => Some(Stop::Paused),
            Screen::Play if self.bout.session.is_rewinding() => Some(Stop::Reset),
            Screen::Play => haptics::silence(self.bout.round()),
            Screen::Paused => Some(Stop::Paused),
            Screen::Title if self.calls => None,
            _ => Some(Stop::Menu),
        }
    }
}

//! Collection of ended rounds in public mode.

use super::Game;
use super::public::EndedRound;

impl Game {
    /// In public mode, adds the current round to [`PublicMode::ended`](super::PublicMode::ended). Does
    /// nothing if it was already added, has not begun, or is a replay.
    pub(super) fn note_end(&mut self) {
        let (bout, round) = (&self.bout, self.bout.round());
        let is_begun = round.ticks() > 0 && bout.session.is_played();
        let Some(public) = self.public.as_mut().filter(|_| is_begun && !bout.is_noted) else {
            return;
        };
        let players = 1 + usize::from(self.controls.players.second().is_some());
        public.ended.push(EndedRound {
            level: round.level().clone(),
            progress: round.progress().clone(),
            players,
            replay: round.replay(),
        });
        self.bout.is_noted = true;
    }
}

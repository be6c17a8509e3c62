//! State of the game between two frames, and the actions that change it. The screens are drawn from this
//! state alone.

mod bout;
mod controls;
mod drawing;
mod editing;
mod ended;
mod ending;
mod forces;
mod heard;
mod keep;
mod lesson;
mod links;
mod making;
mod notices;
mod packs;
mod public;
mod screen;
mod sharing;
mod shelf;
mod teach;
mod time;
mod toys;
pub mod trial;
mod watching;

use crate::attract::attract;
use crate::input::{Action, InputSource};
use crate::journey::{Journey, Lock, Section};
use crate::platform::{Damage, Dialog, DialogResult, Files, MOST_LEVELS, OpenRequest, Sound};
use crate::records::Records;
use crate::session::Session;
use crate::settings::Settings;
use crate::words::{Language, MakingWords, Words};
use app_shell::{Clock, Forces, Pads, Theme};
pub use bout::CurrentRound;
pub use controls::{Controls, ScreenButton};
use drawing::DrawingWatch;
pub use editing::{Drag, Editor, EditorOrigin, EditorPart, GRID, TURN};
pub use ending::Ending;
use fuwafuwa::DEFAULT_TICK;
pub use keep::ListEntry;
pub use making::{Cursor, DrawingTool, Flaws, Maker, WIDTHS};
pub use notices::{Notice, Notices};
pub use public::{EndedRound, PublicMode};
pub use screen::{Screen, Screens};
pub(crate) use sharing::is_made_here;
pub use sharing::{MOST_NAME, credits};
pub use shelf::{RoundDetails, SavedRound, SavedRounds};
use std::collections::BTreeSet;
use std::sync::Arc;
use tamaire_play::daily::level_of;
use tamaire_play::level::{LevelError, built_in};
use tamaire_play::{Assist, Level, Playback, Replay, ReplayError};
use tamaire_sound::{Cue, Menu};
pub use toys::Toys;
use trial::Trial;
pub use watching::SPEEDS;

/// State of the game.
pub struct Game {
    /// Stack of open screens.
    pub screens: Screens,
    /// The player's settings.
    pub settings: Settings,
    /// Results of the player.
    pub records: Records,
    /// Storage of settings, records and replays.
    pub files: Files,
    /// Available levels.
    pub levels: Vec<Arc<Level>>,
    /// Index of the chosen level in [`Self::levels`].
    pub chosen: usize,
    /// Returns today's date, in the form 2026-11-28. `None` = there is no level of the day.
    pub calendar: Option<fn() -> String>,
    /// Levels that the player removed, the last one last.
    removed: Vec<RemovedLevel>,
    /// Level of the day, which is also in [`Self::levels`].
    day: Option<Arc<Level>>,
    /// Progress of the ending.
    pub ending: Ending,
    /// Drawing and level in the making.
    pub maker: Maker,
    /// Current round.
    pub bout: CurrentRound,
    /// Input devices and players.
    pub controls: Controls,
    /// File dialog.
    pub dialog: Dialog,
    /// Saved rounds.
    pub shelf: SavedRounds,
    /// Level received through a link, with the round of it that was sent, if any.
    pub offered: Option<(Option<Arc<Replay>>, Arc<Level>)>,
    /// Text to copy to the clipboard.
    pub copied: Option<String>,
    /// Messages to the player.
    pub notices: Notices,
    /// Time since the start of the game [s].
    pub time: f64,
    /// Clock that measures how long the computation of a tick takes.
    pub clock: Clock,
    /// Whether the window has lost the focus.
    pub is_away: bool,
    /// Force feedback and rumble of sticks and pads.
    pub forces: Forces,
    /// Running test or measurement of a device.
    pub trial: Option<Trial>,
    /// State of public mode. `None` outside of a stand.
    pub public: Option<PublicMode>,
    /// Whether idle sticks may move gently to attract visitors.
    pub calls: bool,
    sound: Sound,
    /// Last sound problem that was shown to the player.
    trouble: Option<String>,
    /// Number of recorded rounds that the title screen has shown.
    attracted: usize,
    drawing: DrawingWatch,
}

/// A level that the player removed.
struct RemovedLevel {
    level: Arc<Level>,
    /// Text of the level as it was stored.
    text: String,
    /// Index in [`Game::levels`] that it had.
    place: usize,
    /// Whether the list of levels still shows a card in its place.
    is_shown: bool,
}

impl Game {
    /// Starts the game with the data stored in `files`.
    pub fn new(mut files: Files, sound: Sound, pads: Pads) -> Self {
        let (settings, settings_damage) = files.settings();
        let (records, records_damage) = files.records();
        let open = |(id, _)| Arc::new(Level::open(id).expect("built-in level opens"));
        let levels: Vec<Arc<Level>> = built_in().map(open).collect();
        let mut game = Self {
            screens: Screens::default(),
            records: records.by_name(levels.iter().map(Arc::as_ref)),
            settings,
            files,
            maker: Maker::default(),
            bout: CurrentRound::new(attract(0)),
            controls: Controls::new(pads),
            levels,
            chosen: 0,
            calendar: None,
            removed: Vec::new(),
            day: None,
            ending: Ending::default(),
            dialog: Dialog::default(),
            shelf: SavedRounds::default(),
            offered: None,
            copied: None,
            notices: Notices::default(),
            time: 0.0,
            clock: Clock::of_machine(),
            is_away: false,
            trouble: None,
            sound,
            forces: Forces::default(),
            trial: None,
            public: None,
            calls: false,
            attracted: 0,
            drawing: DrawingWatch::default(),
        };
        if settings_damage.is_some() && game.settings.haptics == 0.0 {
            game.notify(game.words().forces_zero.to_string());
        }
        let is_aside = |damage: &Option<Damage>| {
            { damage.as_ref() }.is_some_and(|damage| damage.aside.is_some())
        };
        if is_aside(&settings_damage) {
            // The damaged settings were copied to another file. Overwriting the damaged file prevents a
            // second message at the next start.
            game.keep_settings();
        }
        if is_aside(&records_damage) {
            game.files.keep_records(&game.records, &game.levels);
        }
        for damage in [settings_damage, records_damage].into_iter().flatten() {
            game.tell_of(damage);
        }
        game.files.read_levels();
        if game.controls.pads.open_error().is_some() {
            game.notify(game.words().no_sticks.to_string());
        }
        game
    }

    /// Returns the texts in the language of the player.
    pub fn words(&self) -> &'static Words {
        self.settings.language.words()
    }

    /// Returns the texts about making in the language of the player.
    pub fn making(&self) -> &'static MakingWords {
        self.settings.language.making()
    }

    /// Returns what is wrong with a level, in words for its maker.
    pub fn told(&self, error: &LevelError) -> String {
        told(self.settings.language, error)
    }

    /// Returns the colour theme.
    pub fn theme(&self) -> Theme {
        Theme::of(self.settings.colour_safe)
    }

    /// Shows a message. A message with the same text that is still visible is replaced.
    pub fn notify(&mut self, text: String) {
        self.notices.tell(&text);
    }

    /// Whether the sound was turned off when the game started, for example with `--mute`.
    pub fn is_mute(&self) -> bool {
        self.sound.is_off()
    }

    /// Returns the reason why sound does not work, if any.
    pub fn sound_trouble(&self) -> Option<String> {
        self.trouble.clone()
    }

    /// Plays a menu sound.
    pub fn blip(&self, menu: Menu) {
        self.sound.play(Cue::Menu(menu));
    }

    /// Shows the next recorded round behind the title screen.
    fn attract(&mut self) {
        self.note_end();
        self.attracted += 1;
        let shown = self.public.as_ref();
        let shown = shown.and_then(|public| public.attraction(self.attracted));
        // In calm mode nothing tears, so only the round that is won by squeezing is shown.
        let number = if self.settings.calm {
            0
        } else {
            self.attracted
        };
        self.bout.session = shown.unwrap_or_else(|| attract(number));
    }

    /// Returns the visible screen.
    pub fn screen(&self) -> Screen {
        self.screens.top()
    }

    /// Opens a screen, or returns to it if it is open.
    pub fn go(&mut self, screen: Screen) {
        self.change_screens(|screens| screens.go(screen));
    }

    /// Closes the visible screen.
    pub fn go_back(&mut self) {
        self.close_screen(self.screen());
    }

    /// Closes a screen and all screens above it.
    fn close_screen(&mut self, screen: Screen) {
        self.change_screens(|screens| screens.close(screen));
    }

    /// Changes the open screens. A level whose editor is closed by the change is kept if possible.
    fn change_screens(&mut self, change: impl FnOnce(&mut Screens)) {
        let was_editing = self.screens.has(Screen::Editor);
        change(&mut self.screens);
        if was_editing && !self.screens.has(Screen::Editor) {
            self.keep_left_level();
        }
        self.arrive();
    }

    /// Leaves the round and returns to the screen from which it was started.
    pub fn leave_round(&mut self) {
        // After a way was shown, it is the player's turn.
        if self.bout.session.shows_way() && self.bout.session.is_over() {
            let level = self.bout.round().level().clone();
            return self.play(&level);
        }
        self.close_screen(Screen::Play);
    }

    /// Adapts the state to a newly visible screen; for example, ends single steps, key binding and device
    /// tests.
    fn arrive(&mut self) {
        self.bout.slow &= self.screens.has(Screen::Play);
        self.bout.stepping = false;
        self.controls.rebinding = None;
        self.trial = None;
        match self.screen() {
            Screen::Levels => {
                if let Some(today) = self.calendar {
                    self.follow_date(&today());
                }
            }
            Screen::Title if self.bout.session.is_played() => self.attract(),
            Screen::Editor => self.show_draft(),
            Screen::Replays => self.shelf.refresh(&self.files),
            _ => {}
        }
    }

    /// Returns the player's way along the path.
    pub fn journey(&self) -> Journey {
        Journey::of(self.levels.iter().map(Arc::as_ref), &self.records)
    }

    /// Returns the indices in [`Self::levels`] of the levels of a section.
    pub fn levels_of(&self, section: Section) -> Vec<usize> {
        let all = 0..self.levels.len();
        all.filter(|&index| self.section_of(index) == section)
            .collect()
    }

    /// Returns the section of the level with this index in [`Self::levels`].
    fn section_of(&self, index: usize) -> Section {
        match self.is_of_day(index) {
            true => Section::Day,
            false => Section::of(&self.levels[index], self.is_own(index)),
        }
    }

    /// Whether the level with this index in [`Self::levels`] is the level of the day.
    fn is_of_day(&self, index: usize) -> bool {
        self.day
            .as_ref()
            .is_some_and(|day| Arc::ptr_eq(day, &self.levels[index]))
    }

    /// Returns why a section is closed; `None` if it is open.
    pub fn lock_of(&self, section: Section) -> Option<Lock> {
        let Settings { open_all, calm, .. } = self.settings;
        match section {
            Section::Chapter(chapter) if !(open_all || calm) => self.journey().lock(chapter),
            _ => None,
        }
    }

    /// Returns why the level with this index in [`Self::levels`] is closed although its section may be open.
    pub fn own_lock_of(&self, index: usize) -> Option<Lock> {
        let must_tear = self.settings.calm && self.levels[index].must_tear();
        must_tear.then_some(Lock::Calm)
    }

    /// Returns why the level with this index in [`Self::levels`] is closed; `None` if it is open.
    pub fn lock_of_level(&self, index: usize) -> Option<Lock> {
        let own = self.own_lock_of(index);
        own.or_else(|| self.lock_of(self.section_of(index)))
    }

    /// Starts the next open level after the chosen one in the order of the list. After the last one, shows the list.
    /// When the whole path has just been won, shows the ending.
    pub fn start_next(&mut self) {
        if std::mem::take(&mut self.ending.is_due) {
            return self.show_ending();
        }
        let order: Vec<usize> = Section::all()
            .flat_map(|section| self.levels_of(section))
            .collect();
        let place = order.iter().position(|&index| index == self.chosen);
        let mut after = order
            .iter()
            .skip(place.map_or(order.len(), |place| place + 1));
        match after.find(|&&index| self.lock_of_level(index).is_none()) {
            Some(&next) => self.start(next),
            None => self.go(Screen::Levels),
        }
    }

    /// Starts the level with this index in [`Self::levels`], viewed from the front.
    pub fn start(&mut self, level: usize) {
        let level = self.levels[level.min(self.levels.len() - 1)].clone();
        self.bout.camera.face_front();
        self.play(&level);
    }

    /// Starts a level with the chosen assists, and with the ghost of the best round if the player wants it.
    fn play(&mut self, level: &Arc<Level>) {
        if self.bout.round().level().id != level.id {
            let (said, chosen) = (self.words(), self.settings.chosen_assists());
            for assist in chosen.filter(|&assist| level.game().ignores(assist)) {
                self.notices
                    .tell(&(said.assist_ignored)((said.assist)(assist)));
            }
        }
        let level = self.eased(level);
        self.begin(self.with_best(Session::of_people(level)));
    }

    /// Returns the level with the chosen assists applied, except those that the level ignores.
    fn eased(&mut self, level: &Arc<Level>) -> Arc<Level> {
        let chosen = self.settings.chosen_assists();
        let assists = chosen.filter(|&assist| !level.game().ignores(assist));
        let assists: BTreeSet<Assist> = assists.collect();
        if assists.is_empty() {
            return level.clone();
        }
        let current = self.bout.round().level();
        if current.game().assists == assists && current.is_version_of(level) {
            // Reuses the level of the current round, because building a level takes long.
            return current.clone();
        }
        match level.assisted(&assists) {
            Ok(eased) => Arc::new(eased),
            Err(error) => {
                self.notify((self.words().level_error)(&error));
                level.clone()
            }
        }
    }

    /// Starts the level of a replay with the replay as ghost.
    pub fn race(&mut self, replay: Arc<Replay>) -> Result<(), ReplayError> {
        // Prefers the level in the list if it has the same rules, even under another name, so that a win is
        // recorded.
        let known = self
            .levels
            .iter()
            .find(|level| replay.is_of(level))
            .cloned();
        let ghost = Playback::new(replay)?;
        let level = known.unwrap_or_else(|| ghost.round().level().clone());
        self.begin(Session::of_people(level).against(ghost));
        self.bout.is_ghost_chosen = true;
        Ok(())
    }

    /// Shows a replay.
    pub fn watch(&mut self, replay: Arc<Replay>) -> Result<(), ReplayError> {
        self.begin(Session::of_replay(replay)?);
        Ok(())
    }

    /// Restarts the current round, or the current replay.
    pub fn retry(&mut self) {
        let (session, is_chosen) = (&self.bout.session, self.bout.is_ghost_chosen);
        if session.is_played() && !is_chosen {
            let level = session.round().level();
            // Starts from the level without assists, because the player may have changed the assists since
            // the round began.
            let level = self
                .listed(level)
                .map_or(level, |index| &self.levels[index]);
            return self.play(&level.clone());
        }
        self.begin(session.again());
        self.bout.is_ghost_chosen = is_chosen;
    }

    /// Adds the ghost of the best round in this level, if the player wants it.
    fn with_best(&self, session: Session) -> Session {
        if !self.settings.race_best {
            return session;
        }
        let level = session.round().level();
        // The saved round is ignored if the rules have changed or if another level has this name.
        let best = self.files.best(level).filter(|best| best.is_of(level));
        match best.and_then(|best| Playback::new(Arc::new(best)).ok()) {
            Some(ghost) => session.against(ghost),
            None => session,
        }
    }

    fn begin(&mut self, session: Session) {
        self.note_end();
        self.ending.is_due = false;
        let session = match self.may_rewind() {
            true => session,
            false => session.without_rewind(),
        };
        self.bout.begin(session, self.time);
        self.maker.editor.end_test();
        let is_space = self.bout.turn().is_some();
        self.controls.begin(is_space);
        let listed = self.listed(self.bout.round().level());
        self.chosen = listed.unwrap_or(self.chosen);
        if self.controls.players.second().is_some() && self.bout.lacks_second_hand() {
            self.notify(self.words().one_hand.to_string());
        }
        self.go(Screen::Play);
    }

    /// Opens a file or link that was dropped onto the window or named on the command line: a level, a
    /// picture, a model, a pack of levels or a replay.
    pub fn open(&mut self, given: OpenRequest) {
        match given {
            OpenRequest::Level(Ok(level)) => self.offer(*level),
            OpenRequest::Body(name, bytes) if self.screen() == Screen::Paper => {
                self.draw_picture(name, bytes);
            }
            OpenRequest::Body(name, bytes) => match OpenRequest::level_around(&name, &bytes) {
                Ok(level) => self.offer(level),
                Err(error) => self.notify((self.words().level_error)(&error)),
            },
            OpenRequest::Level(Err(error)) => self.notify((self.words().level_error)(&error)),
            OpenRequest::Replay(name, replay) => {
                let outcome = replay.and_then(|replay| self.watch(Arc::from(replay)));
                if let Err(error) = outcome {
                    self.tell_of_replay(&name, &error);
                }
            }
            OpenRequest::Pack(_, pack) => self.open_pack(pack.map(|pack| *pack)),
            OpenRequest::Link(link) => self.open_link(&link),
        }
    }

    /// Opens a file dialog. The chosen file is opened like one dropped onto the window.
    pub fn ask_for_file(&mut self) {
        self.dialog.ask(self.words().what_opens);
    }

    /// Opens the file chosen in the dialog.
    fn open_picked(&mut self) {
        match self.dialog.take() {
            Some(DialogResult::File(given)) => self.open(given),
            Some(DialogResult::NoDialog) => self.notify(self.words().no_dialog.to_string()),
            Some(DialogResult::Nothing) | None => {}
        }
    }

    /// Loads a saved replay and calls `act` with it.
    pub fn open_kept(
        &mut self,
        name: &str,
        act: fn(&mut Self, Arc<Replay>) -> Result<(), ReplayError>,
    ) {
        let replay = self.files.replay(name);
        let outcome = replay.and_then(|replay| act(self, Arc::new(replay)));
        if let Err(error) = outcome {
            self.tell_of_replay(&self.files.location(name), &error);
        }
    }

    fn tell_of_replay(&mut self, name: &str, error: &ReplayError) {
        let reason = (self.words().replay_error)(error);
        self.notify(format!("{name}: {reason}"));
    }

    /// Adds a level from a file to those of the player, and starts it. A level that the game has is not added again.
    fn offer(&mut self, level: Level) {
        // A stored level that is still being read is one that the game has, too.
        for news in self.files.await_levels() {
            self.tell(news);
        }
        let notes = level.scene().notes().iter();
        let notes: Vec<String> = notes.map(self.words().import_note).collect();
        let index = match (self.place_of_scene(&level), self.place_of_earlier(&level)) {
            (Some(index), _) => index,
            (None, Some(index)) => {
                self.replace_own(index, level);
                index
            }
            (None, None) if self.has_all_own_levels() => {
                return self.notify((self.making().own_full)(MOST_LEVELS));
            }
            (None, None) => self.add_own(level),
        };
        self.start(index);
        notes.into_iter().for_each(|note| self.notify(note));
    }

    /// Returns the levels that lists show with a thumbnail. Thumbnails are made in this order.
    pub fn pictured(&self) -> Vec<Arc<Level>> {
        let offered = self.offered.iter().map(|(_, level)| level.clone());
        offered
            .chain(self.levels.iter().cloned())
            .chain(self.shelf.levels())
            .collect()
    }

    /// Index of a level in [`Self::levels`]. Assists are ignored in the comparison.
    fn listed(&self, level: &Level) -> Option<usize> {
        self.levels
            .iter()
            .position(|known| level.is_version_of(known))
    }

    /// Whether the game shows names that other people chose, for example in a shared level. Such names may be
    /// in any script.
    pub fn has_strange_names(&self) -> bool {
        self.offered.is_some() || (0..self.levels.len()).any(|index| self.is_own(index))
    }

    /// Whether the level with index `index` in [`Self::levels`] is one that the player added.
    pub fn is_own(&self, index: usize) -> bool {
        index >= built_in().count() && !self.is_of_day(index)
    }

    /// Puts the level of the day into the list in place of that of an earlier day. `today` has the form 2026-11-28.
    fn follow_date(&mut self, today: &str) {
        if { self.day.iter() }.any(|day| day.id.ends_with(today)) {
            return;
        }
        let chosen = self.levels[self.chosen].clone();
        if let Some(before) = self.day.take() {
            self.levels.retain(|level| !Arc::ptr_eq(level, &before));
        }
        self.day = level_of(today).map(Arc::new);
        self.levels.extend(self.day.clone());
        let place = self
            .levels
            .iter()
            .position(|level| Arc::ptr_eq(level, &chosen));
        self.chosen = place.unwrap_or(0);
    }

    /// Performs an action requested by a key or button.
    pub fn act(&mut self, action: Action, seat: InputSource) {
        match (self.screen(), action) {
            (_, Action::CutForces) => {
                self.forces.cut();
                self.notify(self.words().cut_now.to_string());
            }
            (Screen::Play | Screen::Paused | Screen::Result, Action::Retry) => self.retry(),
            // The key for slow motion has no use at a stand, so there it changes the language.
            (_, Action::Slow) if self.public.is_some() => {
                self.public.get_or_insert_default().asks_for_language = true;
            }
            (_, Action::Pause | Action::Step) if self.public.is_some() => {}
            (Screen::Play, Action::Pause) => {
                self.go(Screen::Paused);
                self.blip(Menu::Back);
            }
            (Screen::Paused, Action::Pause) => self.go(Screen::Play),
            (Screen::Play | Screen::Title, Action::Elements) => self.bout.show_elements(self.time),
            // While the round advances by single steps, the key for slow motion resumes it.
            (Screen::Play, Action::Slow) if self.bout.stepping => self.bout.stepping = false,
            (Screen::Play, Action::Left | Action::Right) if !self.bout.session.is_played() => {
                self.leap(action == Action::Right);
            }
            (Screen::Play, Action::Slow) => self.bout.slow = !self.bout.slow,
            (Screen::Play, Action::Step) => {
                self.bout.stepping = true;
                self.bout.session.forget_time();
                self.pass_ticks(DEFAULT_TICK);
                self.bout.effects.advance(DEFAULT_TICK);
            }
            (Screen::Play, Action::Make) if self.is_test() => self.end_test(),
            (Screen::Play, Action::Make) if self.is_with_drawing() => self.leave_round(),
            (Screen::Play, Action::Join) if self.takes_two() => self.controls.players.join(seat),
            _ => {}
        }
    }

    /// Whether a second player can join: the level has a second hand, and the operator of a stand allows two
    /// players.
    pub fn takes_two(&self) -> bool {
        let may = self.public.as_ref().is_none_or(|public| public.takes_two);
        may && self.bout.takes_two()
    }

    /// Whether players can let time run back. The operator of a stand may have turned it off.
    pub fn may_rewind(&self) -> bool {
        self.public
            .as_ref()
            .is_none_or(|public| !public.is_rewind_off)
    }

    /// Turns forces on again after they were cut.
    pub fn restore_forces(&mut self) {
        self.forces.restore();
        self.notices.take_back(self.words().cut_now);
        self.notify(self.words().restored.to_string());
    }

    /// Reads sticks and pads, and returns their changes since the last call. Pauses the round when a device
    /// is unplugged.
    pub fn hear_sticks(&mut self) -> Vec<sticks::Change> {
        let changes = self.controls.hear_sticks();
        let has_left = |change: &sticks::Change| matches!(change, sticks::Change::Disconnected(_));
        if changes.iter().any(has_left) {
            self.pause_round();
        }
        changes
    }

    /// Whether the round is visible, even if dimmed. A hidden round stands still and is silent.
    pub fn is_seen(&self) -> bool {
        use Screen::{Ending, Finish, Forces, Levels, Licences, Paper, Replays, Settings, Toolbox};
        !matches!(
            self.screen(),
            Levels | Ending | Replays | Settings | Forces | Licences | Toolbox | Paper | Finish
        )
    }

    /// Whether a round is being played and is not over.
    pub fn is_in_round(&self) -> bool {
        let is_on = self.screens.has(Screen::Play);
        is_on && self.bout.session.is_played() && !self.bout.session.is_over()
    }

    /// Pauses a round that is being played. Does nothing at a stand.
    pub fn pause_round(&mut self) {
        let goes_on = self.public.is_some();
        if self.screen() == Screen::Play && self.bout.session.is_played() && !goes_on {
            self.go(Screen::Paused);
        }
    }
}

/// Returns what is wrong with a level, in words for its maker.
fn told(language: Language, error: &LevelError) -> String {
    match error {
        LevelError::NoGame { field: "body", .. } => language.making().body_outside.to_string(),
        error => (language.words().level_error)(error),
    }
}

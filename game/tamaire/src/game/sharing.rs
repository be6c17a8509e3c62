//! Checking, keeping and sending of levels that the player makes.

use super::{Game, Maker, Screen, told};
use crate::platform::{MOST_LEVELS, address_of_page};
use crate::qr::Code;
use crate::records::Record;
use crate::words::MakingWords;
use fuwafuwa::DEFAULT_TICK;
use fuwafuwa_scenes::Scene;
use std::sync::Arc;
use tamaire_maker::check::Check;
use tamaire_maker::draft::{Draft, Language, is_usual_name, name_in, set_name, without_number};
use tamaire_play::level::{LevelError, MAX_KEPT_BYTES};
use tamaire_play::pack::without_marks;
use tamaire_play::{Level, Replay, Route};

/// Maximum length of the name of a level or of its maker [characters].
pub const MOST_NAME: usize = 40;
/// All languages of names.
const LANGUAGES: [Language; 2] = [Language::English, Language::Japanese];
/// Beginning of the ids of levels that the player makes. Levels from elsewhere get other ids.
const MADE_HERE: &str = "my-level-";
/// Share of a frame for the checks, and the minimum and maximum of this time [s]. It grows with the frame, so that checks
/// advance on slow machines, too.
const BUDGET: (f64, [f64; 2]) = (0.6, [0.008, 0.15]);

/// Whether a level with this id was made by the player of this game.
pub(crate) fn is_made_here(id: &str) -> bool {
    id.starts_with(MADE_HERE)
}

/// Returns the id of a level from elsewhere.
pub(super) fn foreign_id(id: &str) -> String {
    match id.strip_prefix(MADE_HERE) {
        Some(rest) => format!("sent-level-{rest}"),
        None => id.to_string(),
    }
}

/// Win of a level by its maker.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct MakerWin {
    /// Shortest time [s].
    pub seconds: f32,
    /// Whether a round was won with the whole body.
    pub is_whole: bool,
}

/// Summary of a level for the page *Finish*, computed once for each scene.
pub struct Summary {
    scene: Arc<Scene>,
    /// The level, or why it cannot be played.
    pub level: Result<Arc<Level>, LevelError>,
    /// Win of its maker in a test.
    won: Option<MakerWin>,
    /// QR code of the link to the level, and the name of the maker in it, after the code was shown. The inner `None` = the
    /// level is too large for a code.
    code: Option<(String, Option<Code>)>,
}

impl Maker {
    /// Returns the summary of the level as it is now.
    pub fn summary(&mut self) -> &mut Summary {
        let scene = self.draft.shared_scene();
        let is_known = |known: &Summary| Arc::ptr_eq(&known.scene, scene);
        if !self.summary.as_ref().is_some_and(is_known) {
            let level = self.draft.level().map(Arc::new);
            let won = level.as_ref().ok().and_then(|level| self.win_of(level));
            let won = won.and_then(|won| won.outcome);
            self.summary = Some(Summary {
                scene: scene.clone(),
                won: won.map(|outcome| MakerWin {
                    seconds: outcome.seconds(),
                    is_whole: outcome.route == Route::Squeeze,
                }),
                level,
                code: None,
            });
        }
        self.summary.as_mut().expect("the summary was just made")
    }

    /// Returns the win of the level as it is now by its maker, even if the level has another name since.
    fn win_of(&self, level: &Level) -> Option<Replay> {
        self.won.as_ref()?.renamed(level)
    }

    /// Returns the scene with the names of its maker and of its origin.
    fn credited(&self, maker: &str) -> Scene {
        let mut scene = self.draft.scene().clone();
        let maker = cleaned(maker);
        if let Some(game) = &mut scene.game {
            game.made_by = (!maker.is_empty()).then_some(maker);
            if let Some(origin) = &self.origin {
                game.changed_from = Some(origin.clone());
            }
        }
        scene
    }
}

impl Game {
    /// Returns the name of the level that is being edited, in the language of the player if it has one.
    pub fn draft_name(&self) -> &str {
        let names =
            [self.language_of_names(), Language::English].map(|it| self.maker.draft.name(it));
        names
            .into_iter()
            .find(|name| !name.is_empty())
            .unwrap_or_default()
    }

    /// Names the level that is being edited, in the language of the player. In the other language it gets the same name,
    /// unless a name was given to it there. The name is a preview, see [`Game::settle_preview`].
    pub fn name_draft(&mut self, name: &str) {
        let language = self.language_of_names();
        let other = match language {
            Language::English => Language::Japanese,
            Language::Japanese => Language::English,
        };
        let follows = self.follows_name(other, language);
        // Without a Japanese name, the English one is shown.
        let other_name = if other == Language::English { name } else { "" };
        let names = [(language, name), (other, other_name)];
        let count = if follows { 2 } else { 1 };
        self.maker.draft.set_names(&names[..count]);
    }

    /// Whether the name in the language `other` follows a new one in `language`: it is empty, equal, that of a new level, or
    /// that of a level of others of which this is a copy.
    fn follows_name(&self, other: Language, language: Language) -> bool {
        let draft = &self.maker.draft;
        let [known, renamed] = [other, language].map(|it| name_in(draft.scene_before(), it));
        let is_of_others = self.maker.origin.is_some() && known == draft.first_name(other);
        known.is_empty() || known == renamed || is_usual_name(known, other) || is_of_others
    }

    /// Gives a draft names that no own level has, with the same number in all languages, at least `least`. A first level gets
    /// no number.
    pub(super) fn take_free_name(&self, draft: &mut Draft, least: usize) {
        let names = LANGUAGES.map(|it| draft.name(it).to_string());
        let stems = names.each_ref().map(|name| without_number(name));
        let own = stems.iter().filter_map(|(_, number)| *number).max();
        let first = own.map_or(least, |number| number + 1);
        let with = |stem: &str, number: usize| match number {
            1 => stem.to_string(),
            _ => format!("{stem} {number}"),
        };
        let is_free = |number: &usize| {
            LANGUAGES
                .into_iter()
                .zip(&stems)
                .all(|(language, (stem, _))| {
                    let name = with(stem, *number);
                    let mut own = self.own_levels();
                    stem.is_empty() || !own.any(|level| name_in(level.scene(), language) == name)
                })
        };
        let Some(number) = (first..).find(is_free) else {
            return;
        };
        draft.restart(|scene| {
            for (language, (stem, _)) in LANGUAGES.into_iter().zip(&stems) {
                if !stem.is_empty() {
                    set_name(scene, language, &with(stem, number));
                }
            }
        });
    }

    fn language_of_names(&self) -> Language {
        match self.settings.language {
            crate::words::Language::English => Language::English,
            crate::words::Language::Japanese => Language::Japanese,
        }
    }

    /// Notes that the maker has won the level, if the round is a test of it.
    pub(super) fn note_test_win(&mut self) {
        if !self.is_test() {
            return;
        }
        let level = self.bout.round().level().clone();
        let tested = self.maker.summary().level.as_ref().ok();
        if !tested.is_some_and(|tested| tested.differs_only_in_names(&level)) {
            return;
        }
        let replay = self.bout.round().replay();
        let known = self.maker.win_of(&level);
        if known.is_none_or(|known| replay.clock_ticks() < known.clock_ticks()) {
            self.maker.won = Some(replay);
            self.maker.summary = None;
        }
    }

    /// Begins to check the level that is being edited, or goes on with it in a frame of `seconds` [s].
    pub fn check_draft(&mut self, seconds: f32) {
        let Ok(level) = self.maker.summary().level.as_ref().map(Arc::clone) else {
            self.maker.check = None;
            return;
        };
        let is_known = { self.maker.check.as_ref() }.is_some_and(|check| {
            Arc::ptr_eq(check.level(), &level) || check.level().differs_only_in_names(&level)
        });
        if !is_known {
            self.maker.check = Some(Check::new(level));
        }
        let clock = self.clock.clone();
        if let Some(check) = &mut self.maker.check {
            let (share, [least, most]) = BUDGET;
            let budget = (share * f64::from(seconds)).clamp(least, most);
            check.go_on(budget, || clock.now());
        }
    }

    /// Returns why the level that is being edited is not finished, in words for its maker. `None` if it can be kept.
    pub fn draft_problem(&mut self) -> Option<String> {
        if self.maker.draft.name(Language::English).trim().is_empty() {
            return Some(self.making().needs_name.to_string());
        }
        let language = self.settings.language;
        let level = self.maker.summary().level.as_ref();
        level.err().map(|error| told(language, error))
    }

    /// Returns the level that is being edited with the names of its maker and of its origin, ready to be kept. If it is not
    /// finished, returns the reason in words for its maker.
    fn finished(&mut self) -> Result<Level, String> {
        self.maker.draft.settle();
        if let Some(problem) = self.draft_problem() {
            return Err(problem);
        }
        let credited = self.maker.credited(&self.settings.maker_name);
        let level = Level::from_scene(self.maker.draft.id(), credited);
        level.map_err(|error| self.told(&error))
    }

    /// Keeps the level beside the shipped ones, and tells the player. Returns whether it can be kept.
    pub fn keep_draft(&mut self) -> bool {
        let outcome = self.store_draft();
        let is_kept = outcome.is_ok();
        self.notify(outcome.map_or_else(|problem| problem, |()| self.making().kept.to_string()));
        is_kept
    }

    /// Stores the level beside the shipped ones. If it cannot be kept, returns the reason in words for its maker.
    fn store_draft(&mut self) -> Result<(), String> {
        let mut level = self.finished()?;
        level.id = self.free_id(&level);
        let is_new = !self.levels.iter().any(|known| known.id == level.id);
        if is_new && self.has_all_own_levels() {
            return Err((self.making().own_full)(MOST_LEVELS));
        }
        let mut draft = self.maker.draft.clone();
        draft.amend(|scene| scene.clone_from(level.scene()));
        draft.set_id(&level.id);
        let text = draft.text();
        self.check_text(&text)?;
        self.maker.draft = draft;
        let level = Arc::new(level);
        let before = self.levels.iter().find(|known| known.id == level.id);
        self.records.change(before.map(Arc::as_ref), &level);
        // A changed level keeps its place in the list.
        match self.levels.iter_mut().find(|known| known.id == level.id) {
            Some(known) => *known = level.clone(),
            None => self.levels.push(level.clone()),
        }
        self.files.keep_level_text(&level.id, text);
        self.maker.saved = Some(level.scene().clone());
        // From now on, this is the player's own level.
        self.maker.origin = None;
        if let Some(won) = self.maker.win_of(&level) {
            self.note_kept_win(&level, won);
        }
        self.files.keep_records(&self.records, &self.levels);
        Ok(())
    }

    /// Records the win of a level that its maker won in a test before the level was kept.
    fn note_kept_win(&mut self, level: &Level, won: Replay) {
        if let Some(outcome) = &won.outcome {
            self.records.note(level, outcome, won.rewinds);
        }
        if won.rewinds == 0 {
            self.files.keep_best(level, won);
        }
    }

    /// Returns how the maker has won the level as it is now, in a test or from the list of levels.
    pub fn win_of_maker(&mut self) -> Option<MakerWin> {
        let is_own = self.maker.origin.is_none();
        let summary = self.maker.summary();
        let tested = summary.won;
        let level = summary.level.as_ref().ok()?.clone();
        let record = self.records.of_level(&level);
        let record = record.filter(|_| is_own && is_made_here(&level.id));
        let listed = record
            .and_then(Record::shortest)
            .map(|(ticks, is_whole)| MakerWin {
                seconds: ticks as f32 * DEFAULT_TICK,
                is_whole,
            });
        let both = tested.into_iter().chain(listed);
        both.reduce(|one, other| MakerWin {
            seconds: one.seconds.min(other.seconds),
            is_whole: one.is_whole || other.is_whole,
        })
    }

    /// Returns why the text of a level cannot be kept, in words for its maker.
    fn check_text(&self, text: &str) -> Result<(), String> {
        let words = self.making();
        match text.len() as u64 {
            0 => Err(words.has_huge_number.to_string()),
            1..=MAX_KEPT_BYTES => Ok(()),
            _ => Err(words.not_kept.to_string()),
        }
    }

    /// Adds a copy of an own level.
    pub fn duplicate(&mut self, index: usize) {
        let mut level = Level::clone(&self.levels[index]);
        let text = self.text_of(&level);
        let mut draft = Draft::of_level(&level, text.as_deref());
        self.take_free_name(&mut draft, 2);
        if !is_made_here(&level.id) {
            draft.set_origin(&origin_of(&level));
        }
        if self.has_all_own_levels() {
            return self.notify((self.making().own_full)(MOST_LEVELS));
        }
        let copy = match draft.level() {
            Ok(copy) => copy,
            Err(error) => return self.notify(self.told(&error)),
        };
        let text = draft.text();
        if let Err(problem) = self.check_text(&text) {
            return self.notify(problem);
        }
        level = copy;
        level.id = self.new_id();
        self.files.keep_level_text(&level.id, text);
        self.levels.push(Arc::new(level));
    }

    /// Returns the id under which a level is kept: that of the own level that was changed, or a new one. The id of a level
    /// that can be brought back stays free for it.
    fn free_id(&self, level: &Level) -> String {
        let is_own = self.maker.origin.is_none() && is_made_here(&level.id);
        let mut removed = self.removed.iter();
        let is_removed = removed.any(|known| known.level.id == level.id);
        match is_own && !is_removed {
            true => level.id.clone(),
            false => self.new_id(),
        }
    }

    /// Returns an id that no level has, not even one that was removed.
    fn new_id(&self) -> String {
        let numbered = (1..).map(|number| format!("{MADE_HERE}{number}"));
        let mut free = numbered.filter(|id| !self.is_taken(id));
        free.next().expect("there are more numbers than levels")
    }

    /// Copies a link to the level, with the maker's own round as a ghost to race if there is one.
    pub fn copy_link_to_draft(&mut self) {
        let level = match self.finished() {
            Ok(level) => level,
            Err(problem) => return self.notify(problem),
        };
        // A round that is too long for a link is left out.
        let link = self.maker.win_of(&level).and_then(|won| won.link().ok());
        self.copy(link.map_or_else(|| level.link(), Ok));
    }

    /// Returns the QR code of the link to the level. `None` if the level is too large for one.
    pub fn code_of_draft(&mut self) -> Option<Code> {
        let maker = self.settings.maker_name.clone();
        let known = self.maker.summary().code.as_ref();
        if known.is_none_or(|(known, _)| *known != maker) {
            let credited = self.maker.credited(&maker);
            let level = Level::from_scene(self.maker.draft.id(), credited).ok();
            let code = level.and_then(|level| Code::of_level(&address_of_page(), &level));
            self.maker.summary().code = Some((maker, code));
        }
        let code = self.maker.summary().code.as_ref();
        code.and_then(|(_, code)| code.clone())
    }

    /// Whether links lead to a page, so that a phone can open their QR codes.
    pub fn has_page(&self) -> bool {
        !address_of_page().is_empty()
    }

    /// Keeps the level, and gives it to the player as a file or tells where its file is.
    pub fn save_draft_file(&mut self) {
        match self.store_draft() {
            Ok(()) => {
                let (id, text) = (self.maker.draft.id().to_string(), self.maker.draft.text());
                self.files.save_level(&id, text);
            }
            Err(problem) => self.notify(problem),
        }
    }

    /// Whether the level that was left in the editor has changes that were not kept.
    pub fn has_unsaved_level(&self) -> bool {
        let maker = &self.maker;
        maker.saved.as_ref() != Some(maker.draft.scene())
    }

    /// Leaves the editor to where it was opened: the list, the paper, or the pause menu of a round. A changed level is kept.
    /// One without a name, or that cannot be played yet, stays in the making until another level is opened.
    pub fn leave_editor(&mut self) {
        self.close_screen(Screen::Editor);
        self.return_from_editor();
    }

    /// Keeps the level whose editor was closed if it was changed, and tells the player.
    pub(super) fn keep_left_level(&mut self) {
        self.end_drag();
        if self.has_unsaved_level() && !self.keep_draft() {
            self.notify(self.making().still_open.to_string());
        }
    }

    /// Keeps the level in the editor if it was changed, and tells the player only that. Called before another level replaces
    /// it.
    pub(super) fn keep_replaced_level(&mut self) {
        if self.keep_silently() {
            self.notify(self.making().kept.to_string());
        }
    }

    /// Keeps the level in the editor if it was changed and can be kept. Returns whether it was stored.
    pub(super) fn keep_silently(&mut self) -> bool {
        self.end_drag();
        self.has_unsaved_level() && self.store_draft().is_ok()
    }
}

/// Returns the maker and the origin of a level, as lines for the player.
pub fn credits(level: &Level, words: &MakingWords) -> Vec<String> {
    let game = level.game();
    let line = |name: &Option<String>, most: usize, told: fn(&str) -> String| {
        let name = plain(name.as_deref()?, most);
        (!name.is_empty()).then(|| told(&name))
    };
    let lines = [
        line(&game.made_by, MOST_NAME, words.by),
        // The names of a level and of its maker, in brackets.
        line(&game.changed_from, 2 * MOST_NAME + 3, words.changed_from),
    ];
    lines.into_iter().flatten().collect()
}

/// Returns the name of a level and of its maker, as the origin of another level.
pub(super) fn origin_of(level: &Level) -> String {
    let game = level.game();
    let name = cleaned(&game.name.en);
    match game.made_by.as_deref().map(cleaned) {
        Some(maker) if !maker.is_empty() => format!("{name} ({maker})"),
        _ => name,
    }
}

/// Returns a name that other people chose as plain text: without control characters and without characters that change
/// the direction of writing, with single spaces, and at most [`MOST_NAME`] characters long.
pub fn cleaned(name: &str) -> String {
    plain(name, MOST_NAME)
}

/// Returns plain text as [`cleaned`] does, at most `most` characters long.
fn plain(name: &str, most: usize) -> String {
    let plain = without_marks(&name.replace('\t', " "));
    let words = plain.split_whitespace().collect::<Vec<_>>().join(" ");
    let cut: String = words.chars().take(most).collect();
    cut.trim_end().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_others_become_plain_text() {
        for (name, expected) in [
            ("Mika", "Mika"),
            ("  two\twords \n", "two words"),
            ("\u{202e}evil\u{200f}", "evil"),
            ("\u{7}", ""),
            ("みか", "みか"),
        ] {
            assert_eq!(cleaned(name), expected, "{name:?}");
        }
        assert_eq!(cleaned(&"x".repeat(100)).len(), MOST_NAME);
    }
}
